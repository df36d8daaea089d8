// Tables over time and steps: steps see what is prescribed at their ends.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "sinew/error/digits.hpp"
#include "sinew/sim/building.hpp"
#include "sinew/sim/placement.hpp"

namespace sinew::building {

namespace {

/// Of its range over the run, by which a table may go beyond its values at the ends of a step within that step.
constexpr double kUnseen = 0.05;
/// [deg] by which a frame may turn in a step, and by which it does in one that is recommended.
constexpr double kMostTurn = 45.0, kGoodTurn = 20.0;

/// The time at which a table goes furthest beyond its values at both ends of a step, and by how much of its range.
struct Excursion {
  double time = 0.0, part = 0.0, lasts = INFINITY;
};

Excursion between_steps(const Time& time, const std::vector<double>& times,
                        const std::function<Eigen::VectorXd(double)>& at) {
  Excursion worst;
  const Eigen::VectorXd start = at(0.0);
  Eigen::VectorXd least = start, most = start;
  for (const double knot : times) {
    if (knot <= 0.0 || knot > time.duration) continue;
    least = least.cwiseMin(at(knot));
    most = most.cwiseMax(at(knot));
  }
  const double range = (most - least).maxCoeff();
  for (std::size_t i = 0; i < times.size() && range > 0.0; ++i) {
    const double knot = times[i];
    if (knot <= 0.0 || knot >= time.duration) continue;
    const double before = std::floor(knot / time.step + 1e-9) * time.step;
    const Eigen::VectorXd from = at(before), to = at(before + time.step), there = at(knot);
    const double beyond =
        std::max((there - from.cwiseMax(to)).maxCoeff(), (from.cwiseMin(to) - there).maxCoeff()) / range;
    if (beyond <= worst.part) continue;
    worst = {knot, beyond, INFINITY};
    if (i > 0) worst.lasts = std::min(worst.lasts, knot - times[i - 1]);
    if (i + 1 < times.size()) worst.lasts = std::min(worst.lasts, times[i + 1] - knot);
  }
  return worst;
}

}  // namespace

void warn_of_tables(Model& model) {
  const Scene& scene = model.scene;
  if (scene.analysis != Analysis::dynamic && scene.analysis != Analysis::quasi_static) return;
  const auto look = [&](const std::string& where, const std::vector<double>& times, const auto& at) {
    const Excursion worst = between_steps(scene.time, times, at);
    if (worst.part <= kUnseen) return;
    model.warnings.push_back(
        {.code = "between_steps",
         .where = where,
         .message = "what it does about t = " + three_digits(worst.time) +
                    " s lies between two steps, which see values at their ends: " + three_digits(100.0 * worst.part) +
                    " % of its range are lost",
         .remedy = std::isfinite(worst.lasts) ? "take steps of " + three_digits(worst.lasts) + " s at most"
                                              : "take shorter steps",
         .value = worst.part,
         .limit = kUnseen,
         .unit = "1"});
  };
  const auto look_at_drive = [&](const std::string& where, const Drive& drive) {
    if (const Table* table = std::get_if<Table>(&drive))
      look(where, table->times, [table](double t) { return Eigen::VectorXd::Constant(1, value_at(*table, t)); });
  };
  for (const auto& [name, actuator] : scene.actuators) look_at_drive("actuators." + name, actuator.drive);
  for (const auto& [name, load] : scene.loads)
    std::visit([&, where = "loads." + name](const auto& own) { look_at_drive(where, own.factor); }, load);
  for (const Target& target : scene.targets) {
    if (const Track* track = std::get_if<Track>(&target.at))
      look("targets." + target.output, track->times, [track](double t) { return value_at(*track, t); });
  }
  for (const auto& [name, frame] : scene.frames) {
    if (!frame.motion) continue;
    const std::vector<double>& times = frame.motion->times;
    const std::string where = "frames." + name;
    for (const bool turns : {true, false}) {
      const std::vector<Vec3>& values = turns ? frame.motion->rotate : frame.motion->translate;
      if (values.empty()) continue;
      look(where, times,
           [track = Track{times, {values.begin(), values.end()}}](double t) { return value_at(track, t); });
    }
    double most = 0.0;
    for (std::size_t i = 1; i < times.size() && !frame.motion->rotate.empty(); ++i) {
      const double turn = (frame.motion->rotate[i] - frame.motion->rotate[i - 1]).lpNorm<Eigen::Infinity>();
      if (times[i - 1] < scene.time.duration)
        most = std::max(most, turn * std::min(1.0, scene.time.step / (times[i] - times[i - 1])));
    }
    const double degrees = 180.0 / std::numbers::pi * most;
    if (degrees <= kMostTurn * (1.0 + 1e-9)) continue;
    model.warnings.push_back(
        {.code = "between_steps",
         .where = where,
         .message = "it turns by " + three_digits(degrees) + " degrees in a step, which sees where it is at its ends",
         .remedy = "take steps of " + three_digits(scene.time.step * kGoodTurn / degrees) + " s at most",
         .value = degrees,
         .limit = kMostTurn,
         .unit = "deg"});
  }
}

}  // namespace sinew::building
