// Actuators: what moves a rod, at its base or by a tendon in it.
#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_values.hpp"

namespace sinew::io {
namespace {

using enum Need;

Type<Tendon> tendon() {
  const auto check = [](const Tendon& tendon, const At& at) {
    if (tendon.to) check_from_to(tendon.from, *tendon.to, at);
  };
  return map<Tendon>(
      {"a tendon",
       {field<Tendon>({"from", optional, "the abscissa where it enters the rod [m]", "10 mm"}, &Tendon::from,
                      quantity(Dimension::length, at_least(0.0))),
        field<Tendon>({"to", optional, "the abscissa where it ends [m]; the tip if left out", "90 mm"}, &Tendon::to,
                      quantity(Dimension::length, at_least(0.0))),
        field<Tendon>({"distance", required, "its distance from the centreline [m], or a pair [start, end]", "10 mm"},
                      &Tendon::distance, taper(Dimension::length, at_least(0.0))),
        field<Tendon>({"angle", optional,
                       "its angle in the cross-section from y towards z [rad], or a pair [start, end]", "30 deg"},
                      &Tendon::angle, taper(Dimension::angle, {}))},
       {},
       check});
}

/// One of x, y, z. Who writes `-x` means the motor's usual direction, which has no name.
Type<int> axis() {
  const Type<int> positive = word({"x", "y", "z"});
  const auto read = [=](const At& at) {
    if (at.is(Node::Kind::scalar) && at.node().text.starts_with('-')) {
      at.refuse("must be one of x, y, z, the positive axes",
                "change the sign of what is driven instead, or leave `axis` out to pull along -x");
    }
    return positive.read(at);
  };
  return {read, positive.schema, positive.show};
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

}  // namespace

Type<Actuator> actuator() {
  using enum Motion;
  return map<Actuator>(
      {"an actuator",
       {field<Actuator>({"rod", required, "the rod that it moves", "cable"}, &Actuator::rod, name_of("rod")),
        field<Actuator>({"motion", optional, "along the axis or about it; follows from what is driven", "translation"},
                        &Actuator::motion, word_of<Motion>({"translation", "rotation"})),
        field<Actuator>({"axis", optional,
                         "the axis of the base along or about which it moves; along -x or about x if left out", "y"},
                        &Actuator::axis, axis()),
        field<Actuator>({"tendon", optional, "the tendon in the rod that it pulls, instead of moving the base",
                         "{distance: 10 mm, angle: 90 deg}"},
                        &Actuator::tendon, tendon()),
        driven("force",
               "the force that it exerts [N], pulling if there is no axis: a value, a table over time or "
               "`external`",
               "3 N", translation, Driven::force, Dimension::force),
        driven("displacement", "how far it pulls or moves [m]: a value, a table over time or `external`",
               "{times: [0, 1], values: [0, 20 mm]}", translation, Driven::displacement, Dimension::length),
        driven("torque", "the torque it exerts about the axis [N m]: a value, a table over time or `external`",
               "20 mN m", rotation, Driven::torque, Dimension::torque),
        driven("angle", "how far it turns the base [rad]: a value, a table over time or `external`",
               "{times: [0, 1], values: [0, 90 deg]}", rotation, Driven::angle, Dimension::angle),
        driven("tension",
               "the tension of the tendon [N], another word for its force: a value, a table over time or "
               "`external`",
               "3 N", translation, Driven::force, Dimension::force)},
       {exactly_one({"force", "displacement", "torque", "angle", "tension"}),
        only_with("force", "motion", "translation"), only_with("displacement", "motion", "translation"),
        only_with("torque", "motion", "rotation"), only_with("angle", "motion", "rotation"),
        excludes("tendon", {"motion", "axis", "torque", "angle"}), needs("tension", "tendon")}});
}

}  // namespace sinew::io
