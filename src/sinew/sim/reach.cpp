#include "sinew/sim/reach.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/error/input_error.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/statics.hpp"

namespace sinew {

namespace {

/// The digits of a number behind the point, mirrored: van der Corput's sequence.
double mirrored(int number, int base) {
  double value = 0.0, part = 1.0 / base;
  for (; number > 0; number /= base, part /= base) value += part * (number % base);
  return value;
}

bool keeps(const Span& span, double value) {
  const double room = 1e-9 * std::max(std::abs(value), 1e-9);
  return value >= span.least - room && value <= span.most + room;
}

/// From an equilibrium to that under other commands; the way is halved where it is too far for one step.
StepReport go(const Model& model, Workspace& workspace, const Command& command, State& state) {
  constexpr int kHalvings = 5;
  const Command start = command_of(model, state);
  StepReport report;
  double done = 0.0, part = 1.0;
  for (int attempt = 0; done < 1.0 && attempt < (1 << kHalvings) + kHalvings; ++attempt) {
    const double to = std::min(1.0, done + part);
    const Command next = to == 1.0 ? command : between(start, command, to);
    StepResult result = equilibrium_step(model, workspace, next, state, state.time);
    report = result.report;
    if (accepted(report.status)) {
      state = std::move(result.next);
      done = to;
    } else if ((part *= 0.5) < std::ldexp(1.0, -kHalvings)) {
      break;
    }
  }
  return report;
}

}  // namespace

std::vector<std::vector<double>> spread_commands(const Model& model, int count) {
  constexpr int kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53};
  const std::size_t n = model.sought.size();
  if (n == 0 || n > std::size(kPrimes))
    throw InputError({"", 0, "actuators", "", n == 0 ? "none is `inverse`" : "more than 16 are `inverse`",
                      "write `force: inverse` or `displacement: inverse` for those that are to be moved"});
  std::vector<Span> spans;
  for (const int sought : model.sought) {
    const ActuatorModel& own = model.actuators[sought];
    spans.push_back(told_span(own));
    const MotorWords words = words_of(own);
    const char* const what = own.told_force() ? words.force : words.position;
    if (!std::isfinite(spans.back().least) || !std::isfinite(spans.back().most))
      throw InputError(
          {"", 0, "actuators." + own.name + ".limits", "", std::string("say nothing of its least or most ") + what,
           std::string("a map of what can be reached needs both: `limits: {") + what + ": [least, most]}`"});
  }
  std::vector<std::vector<double>> all;
  const auto add = [&](const auto& part_of) {
    std::vector<double>& own = all.emplace_back(n);
    for (std::size_t a = 0; a < n; ++a) own[a] = std::lerp(spans[a].least, spans[a].most, part_of(a));
  };
  if (n == 1) {
    for (int i = 0; i < count; ++i)
      add([&](std::size_t) { return count > 1 ? static_cast<double>(i) / (count - 1) : 1.0; });
    return all;
  }
  const int corners = n < 31 && (1 << n) <= count / 2 ? 1 << n : 0;
  for (int i = 0; i < corners; ++i) add([&](std::size_t a) { return static_cast<double>(i >> a & 1); });
  for (int i = 1; i <= count - corners; ++i) add([&](std::size_t a) { return mirrored(i, kPrimes[a]); });
  return all;
}

void sample_reach(const Model& model, const std::vector<std::vector<double>>& commands,
                  const std::function<bool(const ReachSample&)>& visit, int threads) {
  Workspace workspace = make_workspace(model, threads);
  const State start = initial_state(model);
  struct Known {
    std::vector<double> commands;
    State state;
  };
  std::vector<double> scale;
  for (const int sought : model.sought) {
    const Span& span = told_span(model.actuators[sought]);
    scale.push_back(std::max(span.most - span.least, 1e-300));
  }
  const auto apart = [&](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow((a[i] - b[i]) / scale[i], 2);
    return sum;
  };
  const Command told = command_at(model, 0.0);
  Command first = told;
  for (const int sought : model.sought) first.actuators[sought] = told_to(model, start, sought);
  std::vector<Known> known;
  State rest = start;
  if (accepted(go(model, workspace, first, rest).status)) {
    Known own{{}, rest};
    for (const int sought : model.sought) own.commands.push_back(first.actuators[sought]);
    known.push_back(std::move(own));
  }
  for (const std::vector<double>& wanted : commands) {
    ReachSample sample;
    sample.commands = wanted;
    Command command = told;
    for (std::size_t a = 0; a < wanted.size(); ++a) command.actuators[model.sought[a]] = wanted[a];
    const auto nearest = std::min_element(known.begin(), known.end(), [&](const Known& a, const Known& b) {
      return apart(a.commands, wanted) < apart(b.commands, wanted);
    });
    sample.state = nearest == known.end() ? start : nearest->state;
    sample.status = go(model, workspace, command, sample.state).status;
    if (accepted(sample.status)) {
      known.push_back({wanted, sample.state});
      const std::vector<double> places = motor_positions(model, sample.state);
      sample.within = true;
      for (const int sought : model.sought) {
        const ActuatorModel& own = model.actuators[sought];
        sample.forces.push_back(sample.state.actuators[sought]);
        sample.positions.push_back(places[sought]);
        sample.within &= keeps(own.force, sample.forces.back()) && keeps(own.position, sample.positions.back());
      }
    }
    if (!visit(sample)) return;
  }
}

}  // namespace sinew
