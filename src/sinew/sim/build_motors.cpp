#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/sim/building.hpp"
#include "sinew/sim/motors.hpp"

namespace sinew::building {

namespace {

/// Its length is integrated over each radian that it winds.
constexpr double kMostTurns = 1000.0;

rod::Tendon make_tendon(const Model& model, int rod, const Tendon& tendon, const std::string& path) {
  const double length = model.rods[rod].rod.length();
  rod::Tendon own;
  const Stretch runs = stretch_on(model, rod, tendon.from, tendon.to, path, "a tendon runs towards the tip");
  own.from = runs.from;
  own.to = runs.to;
  for (const double distance : {tendon.distance.start, tendon.distance.end}) {
    if (!(distance >= 0.0 && distance <= length))
      reject(path + ".distance", text(distance) + " m", "must lie between 0 and the length of the rod",
             "give the distance of the tendon from the centreline");
  }
  own.start_distance = tendon.distance.start;
  own.end_distance = tendon.distance.end;
  if (const double turns = std::abs(tendon.angle.end - tendon.angle.start) / (2.0 * std::numbers::pi);
      !(turns <= kMostTurns))
    reject(path + ".angle", text(turns) + " turns", "must wind about the rod at most 1000 times",
           "angles without a unit are radians; `720 deg` are two turns");
  own.start_angle = tendon.angle.start;
  own.end_angle = tendon.angle.end;
  return own;
}

void check_span(const Span& span, const std::string& path, const char* unit) {
  if (!(span.least <= span.most))
    reject(path, "[" + text(span.least) + ", " + text(span.most) + "] " + unit, "the least is above the most",
           "give the least first");
}

/// What a motor can do, and where it is sought that it can do something.
void set_limits(Model& model, const Actuator& actuator, const std::string& path, ActuatorModel& own) {
  const Limits& limits = actuator.limits;
  const bool turns = own.turns();
  // A cable that would have to push goes slack instead.
  const bool pulls = actuator.tendon || (!turns && !actuator.axis);
  own.force = limits.force.value_or(Span{pulls ? 0.0 : -INFINITY, INFINITY});
  if (pulls && own.force.least == -INFINITY) {  // only the most was given
    if (own.force.most < 0.0)
      reject(path + ".limits.force", text(own.force.most) + " N", "a cable cannot push", "give a most above 0");
    own.force.least = 0.0;
  }
  own.position = limits.displacement;
  const MotorWords words = words_of(own);
  check_span(own.force, path + ".limits." + words.force, words.force_unit);
  check_span(own.position, path + ".limits." + words.position, words.position_unit);
  own.speed = limits.speed.value_or(INFINITY);
  own.force_rate = limits.force_rate.value_or(INFINITY);
  for (const double rate : {own.speed, own.force_rate}) {
    if (!(rate > 0.0))
      reject(path + ".limits." + (rate == own.speed ? "speed" : "force_rate"), text(rate), "must be greater than 0",
             "leave it out where nothing limits it");
  }
  if (actuator.preferred && (*actuator.preferred < own.force.least || *actuator.preferred > own.force.most))
    reject(path + ".preferred", text(*actuator.preferred) + " " + words.force_unit,
           "is outside the limits of the " + std::string(words.force), "prefer what the motor can do");
  const bool limited = limits.force || limits.speed || limits.force_rate || std::isfinite(own.position.least) ||
                       std::isfinite(own.position.most) || actuator.preferred;
  if (limited && !model.scene.targets.empty() && !std::holds_alternative<Sought>(actuator.drive))
    model.warnings.push_back({.code = "limits_unused",
                              .where = path,
                              .message = "limits and what is preferred are for actuators that are `inverse`; this one "
                                         "does what it is told",
                              .remedy = "leave them out, or write `inverse` as its command"});
  own.preferred = actuator.preferred.value_or(std::clamp(0.0, own.force.least, own.force.most));
}

/// Told to draw more of a rod out of a body, or to push it in, than there is of it.
void warn_of_travel(Model& model, const std::string& path, const ActuatorModel& own) {
  const Table* const table = std::get_if<Table>(&own.drive);
  if (!table || own.told_force() || own.turns()) return;
  double most = 0.0;
  for (const double value : table->values) most = std::max(most, std::abs(value));
  if (const double length = length_of(model, own.line); most > length)
    model.warnings.push_back({.code = "unit_of_displacement",
                              .where = path + ".displacement",
                              .message = text(most) + " m is more than the rod's length of " + text(length) + " m",
                              .remedy = "numbers without a unit are metres",
                              .value = most,
                              .limit = length,
                              .unit = "m"});
}

}  // namespace

void build_actuator(Model& model, const std::string& name, const Actuator& actuator) {
  const std::string path = "actuators." + name;
  ActuatorModel own;
  own.name = name;
  own.line = find_line(model, actuator.rod, path + ".rod");
  own.driven = actuator.driven;
  own.drive = actuator.drive;
  const bool turns = own.turns();
  if (turns != (actuator.motion == Motion::rotation)) {
    reject(path + ".motion", turns ? "translation" : "rotation", "does not fit what drives it",
           "force and displacement translate, torque and angle rotate");
  }
  check_drive(actuator.drive, path);
  set_limits(model, actuator, path, own);
  if (!actuator.axis) warn_of_travel(model, path, own);
  if (actuator.tendon) {
    if (own.line.rod < 0 || turns)
      reject(path + ".tendon", name, "a tendon pulls inside a Cosserat rod",
             "use `cable: cosserat`, and a force or displacement");
    own.tendon = make_tendon(model, own.line.rod, *actuator.tendon, path + ".tendon");
    const RodModel& rod = model.rods[own.line.rod];
    own.tendon_length = rod::tendon_length(rod.rod, *own.tendon, rod.start).value;
    model.actuators.push_back(own);
    return;
  }
  if (own.line.cable >= 0) {
    if (turns || actuator.axis)
      reject(path + ".motion", turns ? "rotation" : "axis", "a geometric cable can only be pulled",
             "use `cable: cosserat`");
    for (const ActuatorModel& other : model.actuators) {
      if (other.line == own.line)
        reject(path, name, "the rod already has an actuator of this motion", "drive each motion of a base once");
    }
    model.actuators.push_back(own);
    return;
  }
  RodModel& rod = model.rods[own.line.rod];
  const rod::BaseMotion motion{turns, actuator.axis.value_or(0), !turns && !actuator.axis ? -1.0 : 1.0};
  if (!add_base_motion(rod, motion)) {
    const auto same = std::find_if(rod.rod.base.begin(), rod.rod.base.end(), [&](const rod::BaseMotion& b) {
      return b.turns == motion.turns && b.axis == motion.axis;
    });
    const bool driven = std::any_of(model.actuators.begin(), model.actuators.end(), [&](const ActuatorModel& other) {
      return other.line == own.line && !other.tendon && other.turns() == turns && other.axis == motion.axis;
    });
    if (driven)
      reject(path, name, "the rod already has an actuator of this motion", "drive each motion of a base once");
    same->sign = motion.sign;
  }
  own.axis = motion.axis;
  model.actuators.push_back(own);
}

}  // namespace sinew::building
