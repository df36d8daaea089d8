// The keys of a scene file.
#pragma once

#include "sinew/io/fields.hpp"
#include "sinew/sim/scene.hpp"

namespace sinew::io {

/// Every key of a scene file, what it means and where it goes.
const Type<Scene>& scene_type();

}  // namespace sinew::io
