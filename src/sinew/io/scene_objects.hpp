// The objects of a scene file; each has its keys in a file of its own, scene_solids.cpp and so on.
#pragma once

#include "sinew/io/fields.hpp"
#include "sinew/sim/scene.hpp"

namespace sinew::io {

Type<Frame> frame();
Type<Solid> solid();
Type<Rod> rod();
Type<RigidBody> rigid_body();
Type<Obstacle> obstacle();
Type<Contact> contact();
Type<Coupling> coupling();
Type<Actuator> actuator();
Type<Load> load();
Type<Output> output();
/// By the names of their outputs.
Type<std::vector<Target>> targets();

/// Of a rod, or of a part of one.
Type<CrossSection> cross_section();
/// Of a solid, or of a part of one.
Type<SolidMaterial> solid_material();
/// A section whose stiffness is given wants no modulus.
enum class Wants { modulus, nothing };
Type<RodMaterial> rod_material(Wants wants);
/// A `section` goes with a `material`, unless its stiffness is given.
Rule material_for_section();

}  // namespace sinew::io
