// That `build` rejects a scene.
#pragma once

#include <gtest/gtest.h>

#include "sinew/error/input_error.hpp"
#include "sinew/sim/model.hpp"

namespace sinew::test {

inline void expect_rejected(const Scene& scene, const solid::Mesh& mesh, const std::string& path,
                            const std::string& rule) {
  try {
    build(scene, [&mesh](const auto&) { return mesh; });
    ADD_FAILURE() << "accepted: " << path << " " << rule;
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().path, path);
    EXPECT_NE(error.fault().rule.find(rule), std::string::npos) << error.fault().rule;
    EXPECT_FALSE(error.fault().remedy.empty());
  }
}

}  // namespace sinew::test
