#pragma once

#include <string>
#include <vector>

#include "sinew/io/scene_file.hpp"

namespace sinew::io {

inline SceneFile parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "finger.yaml", "scenes", overrides);
}

}  // namespace sinew::io
