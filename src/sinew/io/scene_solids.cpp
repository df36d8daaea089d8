// Solids: mesh, material, what is clamped.
#include <fmt/format.h>

#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_values.hpp"

namespace sinew::io {
namespace {

using enum Need;

Type<Box> region() {
  const auto set_corners = [](Box& box, const std::vector<Vec3>& corners) {
    box.lower = corners[0];
    box.upper = corners[1];
  };
  const auto check = [](const std::vector<Vec3>& corners, const At& at) {
    for (int axis = 0; axis < 3; ++axis) {
      if (corners[0][axis] <= corners[1][axis]) continue;
      at.refuse(fmt::format("must have its lower corner first: {} > {} m along {}", corners[0][axis], corners[1][axis],
                            "xyz"[axis]),
                "swap the two numbers of this axis");
    }
    if (corners[0] == corners[1]) at.refuse("must not be empty: both corners are the same point", "enlarge the box");
  };
  const Type<std::vector<Vec3>> corners =
      list<Vec3>("corners, lower then upper", vec3(Dimension::length), {2, 2}, check);
  Field<Box> box = {{"box", required, "the lower and the upper corner of a box [m]", "[[0, 0, 0], [5 mm, 1 cm, 1 cm]]"},
                    [=](Box& target, const At& at) { set_corners(target, corners.read(at)); },
                    corners.schema};
  return map<Box>(
      {"a region",
       {box,
        field<Box>({"in", optional, "where the corners are given, in the object before its pose or the world", "world"},
                   &Box::in, in())}});
}

Type<std::vector<Box>> regions() {
  const Type<Box> one = region();
  const Type<std::vector<Box>> several = list<Box>("regions", one, {1});
  return {[=](const At& at) { return at.is(Node::Kind::list) ? several.read(at) : std::vector<Box>{one.read(at)}; },
          [=] {
            return any_of({one.schema(), several.schema()});
          }};
}

Type<std::filesystem::path> file_name() {
  const Type<std::string> name = text();
  return {[=](const At& at) { return std::filesystem::path(name.read(at)); }, name.schema};
}

Type<SolidMaterial> solid_material() {
  using M = SolidMaterial;
  const Range poisson = {-1.0, 0.5, true, true, " in a solid", "use 0.49 for a nearly incompressible silicone"};
  return map<M>(
      {"a solid's material",
       {field<M>({"law", optional, "the constitutive law", "corotational"}, &M::law, word_of<Law>({"corotational"})),
        field<M>({"young", required, "Young's modulus [Pa]", "600 kPa"}, &M::young,
                 quantity(Dimension::pressure, above(0.0))),
        field<M>({"poisson", required, "Poisson's ratio", "0.45"}, &M::poisson,
                 quantity(Dimension::number, poisson))}});
}

Type<Rayleigh> rayleigh() {
  using R = Rayleigh;
  return map<R>({"rayleigh",
                 {field<R>({"mass", optional, "the damping per mass [1/s]", "0.1 1/s"}, &R::mass,
                           quantity(Dimension::rate, at_least(0.0))),
                  field<R>({"stiffness", optional, "the damping per stiffness [s]", "10 ms"}, &R::stiffness,
                           quantity(Dimension::time, at_least(0.0)))}});
}

}  // namespace

Type<Solid> solid() {
  return map<Solid>(
      {"a solid",
       {field<Solid>(
            {"mesh", required, "the file with its tetrahedra, looked up from the scene's folder", "finger.vtk"},
            &Solid::mesh, file_name()),
        field<Solid>({"scale", optional, "what mesh coordinates are multiplied by to be in m", "0.001"}, &Solid::scale,
                     quantity(Dimension::number, above(0.0))),
        field<Solid>({"pose", optional, "where the solid stands, after scale", "{translate: [0, 20 mm, 0]}"},
                     &Solid::pose, pose()),
        field<Solid>({"frame", optional, "the frame that carries it and its pose", "hand"}, &Solid::frame,
                     name_of("frame")),
        field<Solid>({"material", required, "what it is made of", "{young: 600 kPa, poisson: 0.45}"}, &Solid::material,
                     solid_material()),
        field<Solid>({"mass", optional, "its total mass [kg], instead of density", "75 g"}, &Solid::mass,
                     quantity(Dimension::mass, above(0.0))),
        field<Solid>({"density", optional, "its density [kg/m^3], instead of mass", "1100 kg/m^3"}, &Solid::density,
                     quantity(Dimension::density, above(0.0))),
        field<Solid>({"rayleigh", optional, "its damping", "{mass: 0.1, stiffness: 0.1}"}, &Solid::rayleigh,
                     rayleigh()),
        field<Solid>({"fixed", optional, "a region, or a list of regions, whose nodes are clamped",
                      "{box: [[0, 0, 0], [5 mm, 1 cm, 1 cm]]}"},
                     &Solid::fixed, regions())},
       {exactly_one({"mass", "density"})}});
}

}  // namespace sinew::io
