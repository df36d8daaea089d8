// One line of table for each key: name, needed or not, meaning with unit, example, place in the scene, kind.
#include "sinew/io/scene_fields.hpp"

#include "sinew/io/scene_values.hpp"

namespace sinew::io {
namespace {

constexpr Need optional = Need::optional;
constexpr Need required = Need::required;

Type<Time> time_of_run() {
  return map<Time>({"time",
                    {field<Time>({"step", optional, "the time step [s]", "10 ms"}, &Time::step,
                                 quantity(Dimension::time, above(0.0))),
                     field<Time>({"duration", optional, "the time at which the run ends [s]", "2 s"}, &Time::duration,
                                 quantity(Dimension::time, at_least(0.0)))}});
}

Type<int> iterations() {
  const Type<int> count = whole_number(1, 1000);
  const auto read = [=](const At& at) {
    if (at.is(Node::Kind::scalar) && at.node().text == "converged") return 0;
    if (!at.is(Node::Kind::scalar) || at.node().text.find_first_not_of("+-.0123456789") != std::string::npos) {
      at.refuse("must be `converged` or a number of linearisations");
    }
    return count.read(at);
  };
  return {read,
          [=] {
            return any_of({Json{{"const", "converged"}}, count.schema()});
          },
          [](const int& n) { return n == 0 ? Json("converged") : Json(n); }};
}

Type<Newton> newton() {
  const Type<int> count = iterations();
  const Type<Newton> full = map<Newton>(
      {"newton",
       {field<Newton>(
            {"iterations", optional, "`converged`, or the number of linearisations in every step", "converged"},
            &Newton::iterations, count),
        field<Newton>({"limit", optional, "the number of linearisations after which a step is halved", "25"},
                      &Newton::limit, whole_number(1, 1000)),
        field<Newton>({"tolerance", optional, "the relative residual at which a step is converged", "1e-9"},
                      &Newton::tolerance,
                      quantity(Dimension::number, {.lower = 0.0, .upper = 1.0, .above = true, .below = true}))}});
  const auto read = [=](const At& at) {
    if (at.is(Node::Kind::map)) return full.read(at);
    Newton value;
    value.iterations = count.read(at);
    return value;
  };
  return {read, [=] { return any_of({count.schema(), full.schema()}); }};
}

Type<View> view() {
  return map<View>({"view",
                    {field<View>({"interval", optional,
                                  "the time between views for ParaView [s], 0 for about 100 in a run", "20 ms"},
                                 &View::interval, quantity(Dimension::time, at_least(0.0)))}});
}

Type<Frame> frame() {
  return map<Frame>({"a frame",
                     {field<Frame>({"pose", optional, "where the frame stands at rest", "{translate: [0, 20 mm, 0]}"},
                                   &Frame::pose, pose()),
                      field<Frame>({"motion", optional, "how the frame moves over time",
                                    "{times: [0, 1], translate: [[0, 0, 0], [0, 20 mm, 0]]}"},
                                   &Frame::motion, frame_motion())}});
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
        field<Solid>({"frame", optional, "the frame that carries it and its pose", "hand"}, &Solid::frame, text()),
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

Type<Circle> section() {
  const Type<Circle> circle = map<Circle>({"a circle",
                                           {field<Circle>({"radius", required, "its radius [m]", "0.5 mm"},
                                                          &Circle::radius, quantity(Dimension::length, above(0.0)))}});
  const auto whole = [](Circle& c) -> Circle& { return c; };
  return map<Circle>(
      {"a section", {field<Circle>({"circle", required, "a full circle", "{radius: 0.5 mm}"}, whole, circle)}});
}

Type<RodMaterial> rod_material() {
  using M = RodMaterial;
  const Range poisson = {-1.0, 0.5, true, false, " in a rod", "use 0.5 for an incompressible rubber, 0.3 for steel"};
  return map<M>(
      {"a rod's material",
       {field<M>({"young", required, "Young's modulus [Pa]", "5 GPa"}, &M::young,
                 quantity(Dimension::pressure, above(0.0))),
        field<M>({"poisson", required, "Poisson's ratio", "0.4"}, &M::poisson, quantity(Dimension::number, poisson)),
        field<M>({"density", required, "its density [kg/m^3], 0 for a massless rod", "1100 kg/m^3"}, &M::density,
                 quantity(Dimension::density, at_least(0.0)))}});
}

Type<Rod> rod() {
  return map<Rod>(
      {"a rod",
       {field<Rod>({"path", required, "the points from base to tip [m]", "[[0, 0, 0], [100 mm, 0, 0]]"}, &Rod::path,
                   path()),
        field<Rod>({"in", optional, "where path is given, in the object before its pose or the world", "world"},
                   &Rod::path_in, in()),
        field<Rod>(
            {"up", optional, "the direction of the base's y axis; z, or y if the path starts along z", "[0, 0, 1]"},
            &Rod::up, direction()),
        field<Rod>({"pose", optional, "where the rod stands", "{translate: [0, 20 mm, 0]}"}, &Rod::pose, pose()),
        field<Rod>({"frame", optional, "the frame that carries its base", "hand"}, &Rod::frame, text()),
        field<Rod>({"cable", optional, "cosserat for a rod with stiffness, geometric for a massless cable without any",
                    "cosserat"},
                   &Rod::cable, word_of<Cable>({"cosserat", "geometric"})),
        field<Rod>({"sections", optional, "their number, or the ascending ends of all from 0 to the length [m]", "15"},
                   &Rod::sections, count_or_lengths(1, true)),
        field<Rod>({"strains", optional, "the strains that may vary", "[torsion, bending_y, bending_z]"}, &Rod::strains,
                   strains()),
        field<Rod>({"section", optional, "the shape across", "{circle: {radius: 0.5 mm}}"}, &Rod::section, section()),
        field<Rod>({"material", optional, "what it is made of", "{young: 5 GPa, poisson: 0.4, density: 1100}"},
                   &Rod::material, rod_material())},
       {wanted_unless("cable", "geometric", {"section", "material"})}});
}

Type<Slide> coupling() {
  const Type<Slide> slide = map<Slide>(
      {"a slide",
       {field<Slide>({"rod", required, "the rod that slides", "cable"}, &Slide::rod, text()),
        field<Slide>({"solid", required, "the solid it slides in", "finger"}, &Slide::solid, text()),
        field<Slide>({"points", optional, "their number from base to tip, or their ascending abscissae [m]", "15"},
                     &Slide::points, count_or_lengths(1, false)),
        field<Slide>({"anchor_tip", optional, "what holds the tip: its position, or none", "position"},
                     &Slide::anchor_tip, word_of<AnchorTip>({"none", "position"})),
        field<Slide>({"reach", optional, "how far outside the mesh a point may lie [m]", "2 mm"}, &Slide::reach,
                     quantity(Dimension::length, at_least(0.0)))}});
  const auto whole = [](Slide& s) -> Slide& { return s; };
  return map<Slide>({"a coupling",
                     {field<Slide>({"slide", required, "a rod that slides through a solid",
                                    "{rod: cable, solid: finger, points: 15}"},
                                   whole, slide)}});
}

Field<Actuator> driven(const std::string& name, const std::string& doc, const std::string& example, Motion motion,
                       Driven what, Dimension dimension) {
  const Type<Drive> type = drive(dimension);
  return {{name, optional, doc, example},
          [=](Actuator& actuator, const At& at) {
            actuator.motion = motion;
            actuator.driven = what;
            actuator.drive = type.read(at);
          },
          type.schema};
}

Type<Actuator> actuator() {
  using enum Motion;
  return map<Actuator>(
      {"an actuator",
       {field<Actuator>({"rod", required, "the rod whose base it moves", "cable"}, &Actuator::rod, text()),
        field<Actuator>({"motion", optional, "along the rod or about it; follows from what is driven", "translation"},
                        &Actuator::motion, word_of<Motion>({"translation", "rotation"})),
        driven("force", "the tension it exerts [N]: a value, a table over time or `external`", "3 N", translation,
               Driven::force, Dimension::force),
        driven("displacement", "how far it pulls the rod out [m]: a value, a table over time or `external`",
               "{times: [0, 1], values: [0, 20 mm]}", translation, Driven::displacement, Dimension::length),
        driven("torque", "the torque it exerts about the rod [N m]: a value, a table over time or `external`",
               "20 mN m", rotation, Driven::torque, Dimension::torque),
        driven("angle", "how far it turns the rod [rad]: a value, a table over time or `external`",
               "{times: [0, 1], values: [0, 90 deg]}", rotation, Driven::angle, Dimension::angle)},
       {exactly_one({"force", "displacement", "torque", "angle"}), only_with("force", "motion", "translation"),
        only_with("displacement", "motion", "translation"), only_with("torque", "motion", "rotation"),
        only_with("angle", "motion", "rotation")}});
}

Type<Output> output() {
  const auto x = [](Output& o) -> Vec3& { return o.point.x; };
  const auto where = [](Output& o) -> In& { return o.point.in; };
  return map<Output>(
      {"an output",
       {field<Output>({"solid", optional, "the solid whose point is recorded", "finger"}, &Output::solid, text()),
        field<Output>({"point", optional, "the point of the solid [m]", "[100 mm, 0, 0]"}, x, vec3(Dimension::length)),
        field<Output>({"in", optional, "where point is given, in the object before its pose or the world", "world"},
                      where, in()),
        field<Output>({"reach", optional, "how far outside the mesh the point may lie [m]", "2 mm"}, &Output::reach,
                      quantity(Dimension::length, at_least(0.0))),
        field<Output>({"rod", optional, "the rod whose point is recorded", "cable"}, &Output::rod, text()),
        field<Output>({"at", optional, "the abscissa of the point on the rod [m]", "100 mm"}, &Output::at,
                      quantity(Dimension::length, at_least(0.0)))},
       {exactly_one({"solid", "rod"}), needs("solid", "point"), needs("point", "solid"), needs("in", "solid"),
        needs("reach", "solid"), needs("rod", "at"), needs("at", "rod")}});
}

}  // namespace

const Type<Scene>& scene_type() {
  static const Type<Scene> type = map<Scene>(
      {"a scene",
       {field<Scene>({"title", optional, "what the scene shows, in a line", "A finger pulled by one cable"},
                     &Scene::title, text()),
        field<Scene>({"time", optional, "the time step and the duration", "{step: 10 ms, duration: 2 s}"}, &Scene::time,
                     time_of_run()),
        field<Scene>({"gravity", optional, "the acceleration of free fall [m/s^2]", "[0, -9.81, 0]"}, &Scene::gravity,
                     vec3(Dimension::acceleration)),
        field<Scene>(
            {"newton", optional,
             "how a step is solved: `converged`, a number of linearisations (1 is a linearised step), or a map",
             "converged"},
            &Scene::newton, newton()),
        field<Scene>({"view", optional, "what is written for ParaView", "{interval: 20 ms}"}, &Scene::view, view()),
        field<Scene>({"frames", optional, "frames by name, which may move and carry solids and rods",
                      "{hand: {pose: {translate: [0, 20 mm, 0]}}}"},
                     &Scene::frames, named<Frame>("a frame", frame())),
        field<Scene>({"solids", optional, "soft bodies by name",
                      "{finger: {mesh: finger.vtk, mass: 75 g, material: {young: 600 kPa, poisson: 0.45}}}"},
                     &Scene::solids, named<Solid>("a solid", solid())),
        field<Scene>({"rods", optional, "rods and cables by name",
                      "{cable: {path: [[0, 0, 0], [100 mm, 0, 0]], section: {circle: {radius: 0.5 mm}}, "
                      "material: {young: 5 GPa, poisson: 0.4, density: 1100}}}"},
                     &Scene::rods, named<Rod>("a rod", rod())),
        field<Scene>(
            {"couplings", optional, "what ties rods to solids", "[{slide: {rod: cable, solid: finger, points: 15}}]"},
            &Scene::couplings, list<Slide>("couplings", coupling(), {0})),
        field<Scene>({"actuators", optional, "what moves the bases of rods, by name",
                      "{pull: {rod: cable, displacement: 20 mm}}"},
                     &Scene::actuators, named<Actuator>("an actuator", actuator())),
        field<Scene>({"outputs", optional, "the points whose position is recorded, by name",
                      "{tip: {solid: finger, point: [100 mm, 0, 0]}}"},
                     &Scene::outputs, named<Output>("an output", output()))},
       {},
       check_names});
  return type;
}

}  // namespace sinew::io
