// Solids: mesh, material, what is clamped.
#include <fmt/format.h>

#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_regions.hpp"

namespace sinew::io {
namespace {

using enum Need;

/// One, or a list of several.
template <class V>
Type<std::vector<V>> one_or_more(const std::string& what, Type<V> one) {
  const Type<std::vector<V>> several = list<V>(what, one, {1});
  return {[=](const At& at) { return at.is(Node::Kind::list) ? several.read(at) : std::vector<V>{one.read(at)}; },
          [=] {
            return any_of({one.schema(), several.schema()});
          }};
}

Type<Held> held() {
  return map<Held>(
      {"a region",
       together<Held>(region_fields<Held>(&Held::region),
                      {field<Held>({"axes", optional, "the axes of the world along which it is held", "[x, y]"},
                                   &Held::axes, axes({1, 3})),
                       field<Held>({"frame", optional, "the frame that holds and moves it; the solid's own", "hand"},
                                   &Held::frame, name_of("frame"))}),
       {exactly_one(region_names())}});
}

Type<Spring> spring() {
  return map<Spring>({"springs",
                      together<Spring>(region_fields<Spring>(&Spring::region),
                                       {field<Spring>({"stiffness", required,
                                                       "along x, y and z, all nodes together [N/m]", "[0, 0, 200 N/m]"},
                                                      &Spring::stiffness, vec3(Dimension::line_load))}),
                      {exactly_one(region_names())}});
}

Type<SolidPart> solid_part() {
  return map<SolidPart>({"a part of a solid",
                         together<SolidPart>(region_fields<SolidPart>(&SolidPart::region),
                                             {field<SolidPart>({"material", required, "what it is made of",
                                                                "{young: 2 MPa, poisson: 0.45}"},
                                                               &SolidPart::material, solid_material())}),
                         {exactly_one(region_names())}});
}

/// The mass is known from one of mass and density, or from the materials' own densities.
Rule mass_or_density() {
  const Rule one = exactly_one({"mass", "density"}), none = at_most_one({"mass", "density"});
  const auto check = [=](const At& at, const std::vector<Key>& keys) {
    const bool own =
        at.has("material") && at.child("material").is(Node::Kind::map) && at.child("material").has("density");
    (own ? none : one).check(at, keys);
  };
  const Json own = {{"required", {"material"}}, {"properties", {{"material", {{"required", {"density"}}}}}}};
  return {check, {{"if", own}, {"then", none.schema}, {"else", one.schema}}};
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
       {field<Solid>({"mesh", required, "the file with its elements, looked up from the scene's folder", "finger.vtk"},
                     &Solid::mesh, file_name()),
        field<Solid>({"scale", optional, "what mesh coordinates are multiplied by to be in m", "0.001"}, &Solid::scale,
                     quantity(Dimension::number, above(0.0))),
        field<Solid>(
            {"order", optional,
             "of its elements: 1 as the file has them, 2 with 10-node tetrahedra in place of 4-node ones", "2"},
            &Solid::order, whole_number(1, 2)),
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
        field<Solid>(
            {"mass_matrix", optional,
             "lumped at the nodes, or consistent; none: consistent with 10-node tetrahedra, else lumped", "lumped"},
            &Solid::mass_matrix,
            word_of<solid::MassMatrix>(
                {{"lumped", solid::MassMatrix::lumped}, {"consistent", solid::MassMatrix::consistent}})),
        field<Solid>({"parts", optional, "regions of another material",
                      "[{group: bone, material: {young: 1 GPa, poisson: 0.3}}]"},
                     &Solid::parts, list<SolidPart>("parts", solid_part(), {1})),
        field<Solid>({"fixed", optional, "a region, or a list of regions, whose nodes are held",
                      "{box: [[0, 0, 0], [5 mm, 1 cm, 1 cm]]}"},
                     &Solid::fixed, one_or_more<Held>("regions", held())),
        field<Solid>({"springs", optional, "springs to where it is at rest",
                      "[{surface: true, stiffness: [10 N/m, 10 N/m, 10 N/m]}]"},
                     &Solid::springs, list<Spring>("springs", spring(), {1}))},
       {mass_or_density()}});
}

}  // namespace sinew::io
