// One line of table for each key: name, needed or not, meaning with unit, example, place in the scene, type. Here the
// scene and its run; each kind of object in it has its own file (scene_objects.hpp).
#include "sinew/io/scene_fields.hpp"

#include <algorithm>

#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_values.hpp"

namespace sinew::io {
namespace {

using enum Need;

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
                      quantity(Dimension::number, {.lower = 0.0, .upper = 1.0, .above = true, .below = true})),
        field<Newton>({"precision", optional,
                       "the precision of factors of solids: `single` takes half the memory, and less time from some "
                       "100 000 elements on; solutions are refined to double precision all the same",
                       "double"},
                      &Newton::precision,
                      word_of<linalg::Precision>(
                          {{"double", linalg::Precision::float64}, {"single", linalg::Precision::float32}}))}});
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

/// There is something to simulate.
Rule some_body() {
  const auto check = [](const At& at, const std::vector<Key>&) {
    if (at.names_in("solids").empty() && at.names_in("rods").empty() && at.names_in("bodies").empty()) {
      at.refuse("needs at least one solid, rod or rigid body", "describe one under `solids:`, `rods:` or `bodies:`");
    }
  };
  return {check, at_least_one({"solids", "rods", "bodies"}).schema};
}

/// No name under the one key is also one under the other.
Rule names_apart(const std::string& first, const std::string& second, const std::string& rule) {
  const auto check = [=](const At& at, const std::vector<Key>&) {
    const std::vector<std::string> taken = at.names_in(first);
    for (const std::string& name : at.names_in(second)) {
      if (std::find(taken.begin(), taken.end(), name) == taken.end()) continue;
      at.child(second).refuse_key(name, rule, "rename one of the two");
    }
  };
  return {check};
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
        field<Scene>({"analysis", optional,
                      "what is computed: the motion (dynamic), equilibria over time (quasi_static) or at the end "
                      "(static), or natural frequencies at the start (modal)",
                      "static"},
                     &Scene::analysis,
                     word_of<Analysis>({{"dynamic", Analysis::dynamic},
                                        {"quasi_static", Analysis::quasi_static},
                                        {"static", Analysis::statics},
                                        {"modal", Analysis::modal}})),
        field<Scene>({"snap", optional,
                      "where a quasi_static run finds no equilibrium that goes on from the one before: "
                      "follow what lets go to the next one, with a warning, or stop",
                      "stop"},
                     &Scene::snap, word_of<Snap>({{"follow", Snap::follow}, {"stop", Snap::stop}})),
        field<Scene>({"modes", optional, "the number of modes of a modal analysis", "6"}, &Scene::modes,
                     whole_number(1, 1000)),
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
            {"bodies", optional, "rigid bodies by name", "{cube: {box: {size: [20 mm, 20 mm, 20 mm]}, mass: 30 g}}"},
            &Scene::bodies, named<RigidBody>("a rigid body", rigid_body())),
        field<Scene>({"obstacles", optional, "what stands still or is carried by a frame, by name",
                      "{floor: {plane: {normal: [0, 0, 1]}}}"},
                     &Scene::obstacles, named<Obstacle>("an obstacle", obstacle())),
        field<Scene>({"contact", optional,
                      "how bodies and obstacles meet each other, solids and rods; friction is 0.5 if left out",
                      "{friction: 0.3}"},
                     &Scene::contact, contact()),
        field<Scene>({"couplings", optional, "what ties rods to solids, frames, the ground and each other",
                      "[{slide: {rod: cable, solid: finger, points: 15}}]"},
                     &Scene::couplings, list<Coupling>("couplings", coupling(), {0})),
        field<Scene>({"actuators", optional, "what moves rods: their bases or tendons in them, by name",
                      "{pull: {rod: cable, displacement: 20 mm}}"},
                     &Scene::actuators, named<Actuator>("an actuator", actuator())),
        field<Scene>(
            {"loads", optional, "forces and moments on rods, by name", "{weight: {rod: cable, force: [0, 0, -1 N]}}"},
            &Scene::loads, named<Load>("a load", load())),
        field<Scene>({"outputs", optional, "what is recorded of points of solids and rods, by name",
                      "{tip: {solid: finger, point: [100 mm, 0, 0]}}"},
                     &Scene::outputs, named<Output>("an output", output())),
        field<Scene>(
            {"targets", optional,
             "where outputs are to be brought by the actuators that are `inverse`, by the names of the outputs",
             "{tip: {at: [120 mm, 0, 30 mm]}}"},
            &Scene::targets, targets())},
       {some_body(), names_apart("solids", "rods", "is the name of a solid, and results are named after it"),
        names_apart("solids", "bodies", "is the name of a solid, and results are named after it"),
        names_apart("rods", "bodies", "is the name of a rod, and results are named after it"),
        names_apart("solids", "obstacles", "is the name of a solid, and results are named after it"),
        names_apart("rods", "obstacles", "is the name of a rod, and results are named after it"),
        names_apart("bodies", "obstacles", "is the name of a body, and results are named after it"),
        names_apart("actuators", "outputs", "is the name of an actuator, and both name columns of signals.csv")}});
  return type;
}

}  // namespace sinew::io
