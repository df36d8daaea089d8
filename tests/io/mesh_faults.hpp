// What is wrong with a mesh file, as its reader says it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "sinew/error/input_error.hpp"
#include "sinew/io/mesh_file.hpp"

namespace sinew::io {

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("the test replaces what is not there: " + what);
  return text.replace(at, what.size(), by);
}

/// The fault that reading these bytes ends with; an empty one, and a failed test, if they are accepted.
inline InputFault fault_of(const std::string& bytes) {
  try {
    parse_mesh(bytes, "mesh");
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().file, "mesh");
    EXPECT_FALSE(error.fault().rule.empty());
    EXPECT_FALSE(error.fault().remedy.empty());
    return error.fault();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

inline void expect_fault(const std::string& bytes, int line, const std::string& value, const std::string& rule) {
  const InputFault fault = fault_of(bytes);
  EXPECT_EQ(fault.line, line) << to_string(fault);
  EXPECT_THAT(fault.value, testing::HasSubstr(value));
  EXPECT_THAT(fault.rule, testing::HasSubstr(rule));
}

/// The fault that check_mesh finds.
inline InputFault check_fault(const solid::Mesh& mesh) {
  try {
    check_mesh(mesh, "mesh");
  } catch (const InputError& error) {
    return error.fault();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

}  // namespace sinew::io
