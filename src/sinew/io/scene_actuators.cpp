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
  const Type<Drive> type = motor_drive(dimension);
  return {{name, optional, doc, example},
          [=](Actuator& actuator, const At& at) {
            actuator.motion = motion;
            actuator.driven = what;
            actuator.drive = type.read(at);
          },
          type.schema};
}

Type<Limits> limits() {
  const Type<Span> force = span(Dimension::force), torque = span(Dimension::torque);
  const auto speed = [](Limits& own) -> std::optional<double>& { return own.speed; };
  return map<Limits>(
      {"limits",
       {field<Limits>({"force", optional, "the least and most force [N]; of what pulls the least is 0 if left out",
                       "[0.5 N, 20 N]"},
                      &Limits::force, force),
        field<Limits>({"tension", optional, "the least and most tension of a tendon [N], another word for its force",
                       "[0.5 N, 20 N]"},
                      &Limits::force, force),
        field<Limits>({"torque", optional, "the least and most torque of what turns [N m]", "[-20 mN m, 20 mN m]"},
                      &Limits::force, torque),
        field<Limits>({"displacement", optional, "the least and most displacement [m]", "[0 mm, 30 mm]"},
                      &Limits::displacement, span(Dimension::length)),
        field<Limits>({"angle", optional, "the least and most angle of what turns [rad]", "[-90 deg, 90 deg]"},
                      &Limits::displacement, span(Dimension::angle)),
        field<Limits>({"speed", optional, "how fast it moves at most [m/s]", "50 mm/s"}, speed,
                      quantity(Dimension::velocity, above(0.0))),
        field<Limits>({"turning_speed", optional, "how fast it turns at most [rad/s]", "90 deg/s"}, speed,
                      quantity(Dimension::turning, above(0.0))),
        field<Limits>({"force_rate", optional, "how fast its force changes at most [N/s]", "20 N/s"},
                      &Limits::force_rate, quantity(Dimension::force_rate, above(0.0)))},
       {at_most_one({"force", "tension"})}});
}

/// What turns has torques and angles, what moves forces and displacements.
void check_limits(const At& at) {
  if (!at.has("limits")) return;
  const At given = at.child("limits");
  const bool turns = at.has("torque") || at.has("angle");
  for (const char* key : {"force", "tension", "displacement", "speed", "force_rate"}) {
    if (turns && given.has(key))
      given.refuse_key(key, "has no meaning for what turns", "give `torque`, `angle` or `turning_speed`");
  }
  if (given.has("tension") && !at.has("tendon"))
    given.refuse_key("tension", "is of a tendon, and this is none", "give `force`");
  for (const char* key : {"torque", "angle", "turning_speed"}) {
    if (!turns && given.has(key))
      given.refuse_key(key, "has no meaning for what does not turn", "give `force`, `displacement` or `speed`");
  }
}

}  // namespace

Type<Actuator> actuator() {
  using enum Motion;
  return map<Actuator>(
      {"an actuator",
       {field<Actuator>({"rod", required, "the rod that it moves", "cable"}, &Actuator::rod, name_of("rod")),
        field<Actuator>({"motion", optional, "along the axis or about it; follows from what is driven", "translation"},
                        &Actuator::motion,
                        word_of<Motion>({{"translation", Motion::translation}, {"rotation", Motion::rotation}})),
        field<Actuator>({"axis", optional,
                         "the axis of the base along or about which it moves; along -x or about x if left out", "y"},
                        &Actuator::axis, axis()),
        field<Actuator>({"tendon", optional, "the tendon in the rod that it pulls, instead of moving the base",
                         "{distance: 10 mm, angle: 90 deg}"},
                        &Actuator::tendon, tendon()),
        driven("force",
               "the force that it exerts [N], pulling if there is no axis: a value, a table over time, "
               "`external` or `inverse`",
               "3 N", translation, Driven::force, Dimension::force),
        driven("displacement", "how far it pulls or moves [m]: a value, a table over time, `external` or `inverse`",
               "{times: [0, 1], values: [0, 20 mm]}", translation, Driven::displacement, Dimension::length),
        driven("torque",
               "the torque it exerts about the axis [N m]: a value, a table over time, `external` or `inverse`",
               "20 mN m", rotation, Driven::torque, Dimension::torque),
        driven("angle", "how far it turns the base [rad]: a value, a table over time, `external` or `inverse`",
               "{times: [0, 1], values: [0, 90 deg]}", rotation, Driven::angle, Dimension::angle),
        driven("tension",
               "the tension of the tendon [N], another word for its force: a value, a table over time, "
               "`external` or `inverse`",
               "3 N", translation, Driven::force, Dimension::force),
        field<Actuator>({"limits", optional, "what it can do, to which the inverse keeps", "{force: [0 N, 20 N]}"},
                        &Actuator::limits, limits()),
        field<Actuator>(
            {"preferred", optional,
             "the force that it takes where targets leave a choice [N]; as little as possible if left out", "1 N"},
            &Actuator::preferred, quantity(Dimension::force))},
       {exactly_one({"force", "displacement", "torque", "angle", "tension"}),
        only_with("force", "motion", "translation"), only_with("displacement", "motion", "translation"),
        only_with("torque", "motion", "rotation"), only_with("angle", "motion", "rotation"),
        excludes("tendon", {"motion", "axis", "torque", "angle"}), needs("tension", "tendon")},
       [](const Actuator&, const At& at) { check_limits(at); }});
}

}  // namespace sinew::io
