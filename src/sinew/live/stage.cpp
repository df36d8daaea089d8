#include "sinew/live/stage.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sinew/error/input_error.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew::live {

using Json = nlohmann::ordered_json;

namespace {

constexpr double kFrames = 120.0;        ///< at most so many a second
constexpr double kHand = 1.0;            ///< [s] in which a motor is moved over its whole range
constexpr double kQuick = 12.0;          ///< [1/s] of the spring by which a hand leads a target
constexpr double kArm = 1.0;             ///< sizes of the scene a second that a target is moved by
constexpr double kPatience = 0.25;       ///< [s] behind the wall's time after which that is given up
constexpr std::size_t kPlotted = 20000;  ///< times of a run that plots have, about
constexpr double kCalm = 1.0;            ///< [s] after which a body that was pulled at has found its way back

/// The model with motors no quicker than a hand, and two linearisations a step where the scene has one: of twenty
/// seconds of targets that are thrown about, a trunk of thin cables survives one or two with one, and all with two. (A
/// body that is pulled at and let go needs converged steps: `advance_once`.)
Model paced(Model model) {
  for (ActuatorModel& own : model.actuators) {
    const Span span = slider_span(model, own);
    double& rate = own.told_force() ? own.force_rate : own.speed;
    rate = std::min(rate, (span.most - span.least) / kHand);
  }
  int& iterations = model.scene.newton.iterations;
  if (iterations == 1) iterations = 2;
  return model;
}

/// Moves a value towards another by at most so much.
double towards(double from, double to, double most) { return from + std::clamp(to - from, -most, most); }

/// Without the pace, which may be the page's own, where other limits are in the way as well.
sinew::Aim without_pace(sinew::Aim aim) {
  const auto paces = [](const Bound& bound) { return bound.limit == Limit::speed || bound.limit == Limit::force_rate; };
  if (!std::all_of(aim.binding.begin(), aim.binding.end(), paces)) std::erase_if(aim.binding, paces);
  return aim;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

void take(const Request& request, Wishes& wishes) {
  struct Take {
    Wishes& own;
    void operator()(const Play&) const { own.playing = true; }
    void operator()(const Pause&) const { own.playing = false; }
    void operator()(const Step&) const { own.playing = false, own.steps = std::min(own.steps + 1, 100); }
    void operator()(const Reset&) const {
      own.reset = true;
      own.told.clear();
      own.aimed.clear();
      own.grip.reset();
    }
    void operator()(const Speed& speed) const { own.speed = speed.value; }
    void operator()(const Tell& tell) const {
      if (tell.value)
        own.told[tell.actuator] = *tell.value;
      else
        own.told.erase(tell.actuator);
    }
    void operator()(const Aim& aim) const {
      if (aim.at)
        own.aimed[aim.effector] = *aim.at;
      else
        own.aimed.erase(aim.effector);
    }
    void operator()(const Grab& grab) const { own.grip = grab.grip; }
    void operator()(const Release&) const { own.grip.reset(); }
    void operator()(const Seek& seek) const { own.sought = seek.frame; }
    void operator()(const Show& show) const { own.show = show; }
    void operator()(const Ack&) const {}
  };
  std::visit(Take{wishes}, request);
  wishes.changed = wishes.changed || !std::holds_alternative<Ack>(request);
}

// Simulation.

Simulation::Simulation(const Model& model, int threads, OnFrame on_frame)
    : model_(paced(model)), on_frame_(std::move(on_frame)), scenery_(model_), workspace_(model_, threads) {
  if (model.scene.analysis == Analysis::statics || model.scene.analysis == Analysis::modal)
    throw InputError({.path = "analysis",
                      .rule = "cannot be watched live: a static or modal analysis does not go on in time",
                      .remedy = "run it and look at the results, `sinew run SCENE -o out`, `sinew view out`; or set "
                                "--set analysis=quasi_static"});
  begin();
  thread_ = std::thread([this] { work(); });
}

Simulation::~Simulation() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

std::string Simulation::scene() {
  Scenery own(model_);  // the other is at work
  return own.scene({{"mode", "live"}});
}

void Simulation::take(const Request& request) {
  {
    const std::lock_guard lock(mutex_);
    live::take(request, wishes_);
  }
  wake_.notify_all();
}

void Simulation::begin() {
  state_ = initial_state(model_);
  lead_.goal = goal_at(model_, 0.0);
  lead_.speed.setZero(lead_.goal.at.size());
  lead_.hands.assign(model_.effectors.size(), false);
  report_ = {};
  trouble_.clear();
  calm_ = 0.0;
}

/// Where the scene, or a hand, wants effectors: what is dragged goes there like a damped spring, so that motors are
/// asked for nothing sudden, and back again when it is let go.
Simulation::Lead Simulation::led(Goal goal, const Wishes& wishes) const {
  const double h = model_.scene.time.step;
  Lead next{std::move(goal), lead_.speed, lead_.hands};
  for (std::size_t i = 0; i < model_.effectors.size(); ++i) {
    const EffectorModel& own = model_.effectors[i];
    const auto wish = wishes.aimed.find(static_cast<int>(i));
    if (wish != wishes.aimed.end()) next.hands[i] = true;
    if (!next.hands[i]) continue;
    auto at = next.goal.at.segment(own.first, own.size);
    auto speed = next.speed.segment(own.first, own.size);
    const Eigen::VectorXd to = wish == wishes.aimed.end() ? Eigen::VectorXd(at) : wish->second;
    const Eigen::VectorXd from = lead_.goal.at.segment(own.first, own.size);
    const double per_metre = measure_of(model_, own).unit / 1e-3, most = kArm * model_.size * per_metre;
    // Implicit in the speed: no step is too long.
    speed = (speed + h * kQuick * kQuick * (to - from)) / (1.0 + 2.0 * h * kQuick + h * h * kQuick * kQuick);
    if (speed.norm() > most) speed *= most / speed.norm();
    at = from + h * speed;
    if (wish == wishes.aimed.end() && (to - at).norm() < 1e-4 * per_metre) {
      next.hands[i] = false;
      speed.setZero();
    }
  }
  return next;
}

/// One step to the next point of the time grid, or none.
bool Simulation::advance_once(const Wishes& wishes) {
  const double h = model_.scene.time.step, time = static_cast<double>(state_.grid + 1) * h;
  const Command now = command_of(model_, state_);
  Command told = command_at(model_, time);
  bool forward = false;
  for (std::size_t i = 0; i < model_.actuators.size(); ++i) {
    const ActuatorModel& own = model_.actuators[i];
    const auto wish = wishes.told.find(static_cast<int>(i));
    forward = forward || (own.sought() && wish != wishes.told.end());
    if (wish != wishes.told.end()) {
      const Span span = slider_span(model_, own);
      const double wanted = std::clamp(wish->second, span.least, span.most);
      told.actuators[i] = towards(now.actuators[i], wanted, (span.most - span.least) * h / kHand);
    } else if (!std::holds_alternative<Table>(own.drive)) {
      told.actuators[i] = now.actuators[i];
    }
  }
  for (std::size_t i = 0; i < model_.loads.size(); ++i) {
    if (std::holds_alternative<External>(model_.loads[i].factor)) told.loads[i] = now.loads[i];
  }
  if (wishes.grip) {
    told.grips = {*wishes.grip};
    calm_ = state_.time + kCalm;
  }
  const Effort effort{.converged = state_.time < calm_};
  Lead next = led(goal_at(model_, time), wishes);
  const Told by{&told, model_.effectors.empty() ? nullptr : &next.goal, forward};
  const long before = state_.grid;
  std::vector<Warning> warnings;  // of all parts of a halved step
  do {
    try {
      report_ = advance(model_, workspace_, state_, effort, by);
      merge(report_.warnings, warnings);
    } catch (const threads::Interrupted&) {
      return false;
    } catch (const std::exception& error) {  // memory, say: people still look on
      trouble_ = error.what();
      return false;
    }
    if (!accepted(report_.status)) {
      trouble_ = std::string(to_string(report_.status)) + (report_.detail.empty() ? "" : ": " + report_.detail) + ". " +
                 std::string(explain(report_.status));
      return false;
    }
  } while (state_.grid == before);
  report_.warnings = std::move(warnings);
  lead_ = std::move(next);
  trouble_.clear();
  return true;
}

void Simulation::publish(const Wishes& wishes) {
  const Clock::time_point start = Clock::now();
  Json more = {{"frame", ++frame_},
               {"playing", wishes.playing},
               {"speed", wishes.speed},
               {"status", to_string(report_.status)},
               {"targets", describe(model_, without_pace(report_.aim))},
               {"newton", report_.newton},
               {"halvings", report_.halvings},
               {"warnings", to_strings(report_.warnings)},
               {"contacts", report_.contact.contacts},
               {"step_ms", 1e3 * step_seconds_},
               {"frame_ms", 1e3 * frame_seconds_},
               {"realtime", realtime_},
               {"trouble", trouble_}};
  Json& told = more["mine"] = Json::object();
  for (const auto& [number, value] : wishes.told) told[model_.actuators[static_cast<std::size_t>(number)].name] = value;
  auto bytes = std::make_shared<const std::string>(scenery_.frame(state_, wishes.show, lead_.goal, more));
  frame_seconds_ = 0.9 * frame_seconds_ + 0.1 * seconds_since(start);
  on_frame_(std::move(bytes), frame_);
}

void Simulation::work() {
  const threads::Interruption interruption([this] { return end_.load(); });
  const double h = model_.scene.time.step;
  const auto per_frame = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / kFrames));
  Clock::time_point due = Clock::now(), shown = due - per_frame, counted = due;
  double simulated = 0.0, speed = 1.0;
  bool playing = false, untold = true;  // something has changed that no frame has told yet
  const auto after = [&] {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(h / speed));
  };
  for (;;) {
    Wishes wishes;
    {
      std::unique_lock lock(mutex_);
      const auto stirred = [this] { return end_ || wishes_.changed || wishes_.steps > 0; };
      if (playing || untold) {
        const Clock::time_point next = shown + per_frame;
        wake_.wait_until(lock, !playing ? next : untold ? std::min(due, next) : due, stirred);
      } else {
        wake_.wait(lock, stirred);
      }
      if (end_) return;
      wishes = wishes_;
      wishes_.steps = std::max(wishes_.steps - 1, 0);
      wishes_.reset = false;
      wishes_.changed = false;
    }
    untold = untold || wishes.changed;
    if (wishes.reset) begin();
    if (wishes.playing && !playing) {  // from now on: what stood still is not made up for
      due = counted = Clock::now();
      simulated = 0.0;
    }
    playing = wishes.playing;
    if (std::exchange(speed, wishes.speed) != wishes.speed) due = std::min(due, Clock::now() + after());
    if (wishes.steps > 0 || (playing && Clock::now() >= due)) {
      const Clock::time_point start = Clock::now();
      if (advance_once(wishes)) {
        simulated += h;
      } else {
        const std::lock_guard lock(mutex_);
        playing = wishes.playing = wishes_.playing = false;
        wishes_.steps = 0;
      }
      step_seconds_ = 0.9 * step_seconds_ + 0.1 * seconds_since(start);
      due += after();
      if (seconds_since(due) > kPatience) due = Clock::now();
      untold = true;
    }
    if (const double wall = seconds_since(counted); playing && wall > 0.5) {
      realtime_ = simulated / wall;
      simulated = 0.0;
      counted = Clock::now();
    }
    if (untold && Clock::now() >= shown + per_frame) {
      publish(wishes);
      shown = Clock::now();
      untold = false;
    }
  }
}

// Replay.

Replay::Replay(const Model& model, io::Recording recording, OnFrame on_frame)
    : model_(model), recording_(std::move(recording)), on_frame_(std::move(on_frame)), scenery_(model) {
  if (on_frame_) thread_ = std::thread([this] { work(); });
}

Replay::~Replay() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::string Replay::scene() {
  Scenery own(model_);
  Json times = Json::array();
  for (const io::RecordedStep& step : recording_.steps) times.push_back(step.time);
  Scenery::History history;
  if (recording_.header.signal_names == signal_names(model_)) {
    for (std::size_t i = 0, every = 1 + recording_.steps.size() / kPlotted; i < recording_.steps.size(); i += every) {
      const io::RecordedStep& step = recording_.steps[i];
      history.times.push_back(step.time);
      history.values.insert(history.values.end(), step.signals.begin(), step.signals.end());
    }
  }
  return own.scene({{"mode", "replay"}, {"times", std::move(times)}}, history);
}

void Replay::take(const Request& request) {
  {
    const std::lock_guard lock(mutex_);
    live::take(request, wishes_);
  }
  wake_.notify_all();
}

std::string Replay::frame(long number, const Wishes& wishes) {
  const io::RecordedStep& step = recording_.steps[static_cast<std::size_t>(number)];
  State state;
  std::string trouble;
  try {
    state = unpack(model_, step.state);
  } catch (const std::invalid_argument& error) {
    state = initial_state(model_);
    trouble = error.what();
  }
  if (trouble.empty() && number == frames() - 1 && !run_whole(model_.scene, step.time))
    trouble = "The recording ends here, before the end of the run.";
  const auto acts = [](const ContactState& own) { return !own.force.isZero(); };
  const auto contacts = std::count_if(state.contacts.begin(), state.contacts.end(), acts);
  return scenery_.frame(state, wishes.show, goal_at(model_, step.time),
                        {{"frame", number},
                         {"status", step.status},
                         {"targets", step.targets},
                         {"newton", step.newton},
                         {"warnings", to_strings(step.warnings)},
                         {"contacts", contacts},
                         {"trouble", trouble},
                         {"playing", wishes.playing},
                         {"speed", wishes.speed}});
}

void Replay::work() {
  using Clock = std::chrono::steady_clock;
  long number = 0;
  bool played = false;
  const long last = frames() - 1;
  double time = recording_.steps.front().time;
  Clock::time_point before = Clock::now();
  for (;;) {
    Wishes wishes;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return end_ || wishes_.playing || wishes_.steps > 0 || wishes_.changed; });
      if (end_) return;
      wishes = wishes_;
      wishes_.steps = 0;
      wishes_.reset = wishes_.changed = false;
      wishes_.sought.reset();
    }
    const double passed = played ? seconds_since(before) : 0.0;
    before = Clock::now();
    const long shown = number;
    if (wishes.reset || (wishes.playing && !played && number == last)) {
      number = 0;
      time = recording_.steps.front().time;
    }
    if (wishes.sought) number = std::min(*wishes.sought, last);
    number = std::min(number + wishes.steps, last);
    if (wishes.sought || wishes.steps > 0) {
      time = recording_.steps[static_cast<std::size_t>(number)].time;
    } else if (wishes.playing) {
      time += std::min(passed, 0.1) * wishes.speed;
      while (number < last && recording_.steps[static_cast<std::size_t>(number) + 1].time <= time) ++number;
      if (number == last) {
        const std::lock_guard lock(mutex_);
        wishes.playing = wishes_.playing = false;
        wishes.changed = true;
      }
    }
    if (number != shown || wishes.changed)
      on_frame_(std::make_shared<const std::string>(frame(number, wishes)), number);
    played = wishes.playing;
    if (!wishes.playing) continue;
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, std::chrono::duration<double>(1.0 / kFrames), [this] { return end_ || wishes_.changed; });
  }
}

}  // namespace sinew::live
