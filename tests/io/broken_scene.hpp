// A scene with one fault, and what is said about it.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "sinew/error/input_error.hpp"
#include "sinew/io/scene_file.hpp"

namespace sinew::io {

/// One piece of text of a sound scene replaced, and what is said about it. `value` empty: not compared.
struct Broken {
  std::string from, to;
  int line;
  std::string path, value, rule, remedy;
};

/// `rule` and `remedy` are parts of what is said, the others the whole.
inline void expect_refused(const std::string& scene, const Broken& broken) {
  SCOPED_TRACE(broken.from + " -> " + broken.to);
  std::string text = scene;
  const std::size_t place = text.find(broken.from);
  ASSERT_NE(place, std::string::npos);
  text.replace(place, broken.from.size(), broken.to);
  try {
    parse_scene(text, "finger.yaml", "");
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    const InputFault& fault = error.fault();
    EXPECT_EQ(fault.file, "finger.yaml");
    EXPECT_EQ(fault.line, broken.line) << error.what();
    EXPECT_EQ(fault.path, broken.path) << error.what();
    EXPECT_TRUE(broken.value.empty() || fault.value == broken.value) << error.what();
    EXPECT_NE(fault.rule.find(broken.rule), std::string::npos) << error.what();
    EXPECT_NE(fault.remedy.find(broken.remedy), std::string::npos) << error.what();
    EXPECT_FALSE(fault.remedy.empty()) << error.what();
  }
}

}  // namespace sinew::io
