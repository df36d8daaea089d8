#include "sinew/sim/targets.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "sinew/lie/rotation.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"

namespace sinew {

namespace {

const OutputModel& output_of(const Model& model, const EffectorModel& own) { return model.outputs[own.output]; }

rod::Mat3 turned_to(const Vec3& turn, const OutputModel& output) { return lie::exp(turn) * output.upright; }

}  // namespace

Measure measure_of(const Model& model, const EffectorModel& effector) {
  switch (output_of(model, effector).quantity) {
    case Quantity::orientation:
      return {std::numbers::pi / 180.0, "deg", std::numbers::pi / 180.0, "rad"};
    case Quantity::strain:
      return effector.strain < 3 ? Measure{1.0, "1/m", 1.0, "1/m"} : Measure{0.01, "%", 0.01, "1"};
    case Quantity::touching:
      return {0.1, "N", 1.0, "N"};
    default:
      return {};
  }
}

std::vector<Column> effector_columns(const Model& model, const EffectorModel& effector) {
  const OutputModel& output = output_of(model, effector);
  const std::string name = output.name + ".", unit = measure_of(model, effector).si;
  if (output.quantity == Quantity::touching) return {{name + "normal", unit}};
  if (output.quantity == Quantity::strain)
    return {{name + rod::kStrainNames[static_cast<std::size_t>(effector.strain)], unit}};
  return {{name + "x", unit}, {name + "y", unit}, {name + "z", unit}};
}

int effector_size(const Model& model) {
  return model.effectors.empty() ? 0 : model.effectors.back().first + model.effectors.back().size;
}

Eigen::VectorXd effector_value(const Model& model, const State& state, const EffectorModel& effector) {
  const OutputModel& output = output_of(model, effector);
  if (output.quantity == Quantity::orientation) return output_turn(model, state, output);
  if (output.quantity == Quantity::strain)
    return Eigen::VectorXd::Constant(
        1, rod::strain(model.rods[output.rod].rod, state.rods[output.rod].q, output.abscissa)[effector.strain]);
  if (output.pair >= 0) return Eigen::VectorXd::Constant(1, pressing_of(state, output.pair).force);
  return output_position(model, state, output);
}

void goal_at(const Model& model, double time, Goal& goal) {
  goal.at.resize(effector_size(model));
  for (std::size_t k = 0; k < model.effectors.size(); ++k) {
    const EffectorModel& own = model.effectors[k];
    const Track* track = std::get_if<Track>(&model.scene.targets[k].at);
    goal.at.segment(own.first, own.size) = track ? value_at(*track, time) : own.start;
  }
}

Goal goal_at(const Model& model, double time) {
  Goal goal;
  goal_at(model, time, goal);
  return goal;
}

void effector_errors(const Model& model, const State& state, const Goal& goal, Eigen::VectorXd& errors) {
  errors.resize(effector_size(model));
  for (const EffectorModel& own : model.effectors) {
    const OutputModel& output = output_of(model, own);
    const auto wanted = goal.at.segment(own.first, own.size);
    if (output.quantity == Quantity::orientation) {
      const rod::Mat3 aim = turned_to(wanted, output);
      errors.segment<3>(own.first) = lie::log(output_axes(model, state, output) * aim.transpose());
    } else if (output.pair >= 0) {
      const Pressing now = pressing_of(state, output.pair);
      const bool apart = now.force == 0.0 && wanted[0] > 0.0 && std::isfinite(now.gap);
      errors[own.first] = now.force - wanted[0] - (apart ? kPerGap * std::max(0.0, now.gap) : 0.0);
    } else if (own.size == 3) {
      errors.segment<3>(own.first) = output_position(model, state, output) - wanted;
    } else {
      errors.segment(own.first, own.size) = effector_value(model, state, own) - wanted;
    }
  }
}

Goal part_of_goal(const Model& model, const State& from, const Goal& goal, double part) {
  Goal there = goal;
  for (const EffectorModel& own : model.effectors) {
    const OutputModel& output = output_of(model, own);
    auto at = there.at.segment(own.first, own.size);
    const Eigen::VectorXd now = effector_value(model, from, own);
    if (output.quantity == Quantity::orientation) {
      const rod::Mat3 turned = lie::exp(Vec3(now));
      at = lie::log(lie::exp(part * lie::log(lie::exp(Vec3(at)) * turned.transpose())) * turned);
    } else {
      at = now + part * (at - now);
    }
  }
  return there;
}

double error_of(const EffectorModel& own, const Eigen::VectorXd& errors) {
  double sum = 0.0;
  for (int i = 0; i < own.size; ++i) {
    if (own.weights[i] > 0.0) sum += errors[own.first + i] * errors[own.first + i];
  }
  return std::sqrt(sum);
}

double farthest(const Model& model, const Eigen::VectorXd& errors) {
  double most = 0.0;
  for (const EffectorModel& own : model.effectors) {
    const double off = error_of(own, errors) / own.tolerance;
    most = off <= most ? most : off;  // (NaN stays)
  }
  return most;
}

std::string describe(const Model& model, const Bound& bound) {
  const ActuatorModel& own = model.actuators[bound.actuator];
  const MotorWords words = words_of(own);
  const std::string force = words.force, place = words.position;
  const std::string newton = words.force_unit, metre = words.position_unit;
  const auto say = [&](const std::string& what, double value, const std::string& unit) {
    char number[32];
    std::snprintf(number, sizeof number, "%.6g", value);
    return "actuators." + own.name + ": " + what + " " + number + " " + unit;
  };
  switch (bound.limit) {
    case Limit::least_force:
      return say(force + " at least", own.force.least, newton);
    case Limit::most_force:
      return say(force + " at most", own.force.most, newton);
    case Limit::least_position:
      return say(place + " at least", own.position.least, metre);
    case Limit::most_position:
      return say(place + " at most", own.position.most, metre);
    case Limit::speed:
      return say("speed at most", own.speed, metre + "/s");
    case Limit::force_rate:
      return say(force + " rate at most", own.force_rate, newton + "/s");
  }
  return own.name;
}

std::string describe(const Model& model, const Aim& aim) {
  std::string text;
  const auto list = [&](const char* what, const std::vector<Bound>& bounds) {
    for (std::size_t i = 0; i < bounds.size(); ++i)
      text += (i > 0 ? "; " : text.empty() ? what : std::string("; ") + what) + describe(model, bounds[i]);
  };
  switch (aim.outcome) {
    case Aim::Outcome::none:
      return "";
    case Aim::Outcome::reached:
      text = "reached";
      if (std::isinf(aim.off)) {
        text += " by a linearisation, beside which no converged step was found";
      } else if (aim.off > 0.0) {
        char off[64];
        std::snprintf(off, sizeof off, " by a linearisation that is %.2g %% off", 100.0 * aim.off);
        text += off;
      }
      break;
    case Aim::Outcome::limited:
      list("limited by ", aim.binding);
      break;
    case Aim::Outcome::nearest:
      text = "nearest";
      break;
    case Aim::Outcome::on_the_way:
      text = "on the way";
      break;
  }
  list("dropped ", aim.dropped);
  list("not kept ", aim.broken);
  if (aim.short_of) text += "; this step goes no further";
  if (aim.apart >= 0)
    text += "; outputs." + model.outputs[model.effectors[aim.apart].output].name + ": the two are not near each other";
  return text;
}

}  // namespace sinew
