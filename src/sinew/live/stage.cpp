#include "sinew/live/stage.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sinew/error/input_error.hpp"
#include "sinew/sim/motors.hpp"

namespace sinew::live {

using Json = nlohmann::ordered_json;

namespace {

constexpr double kFrames = 120.0;   ///< at most so many a second
constexpr double kHand = 1.0;       ///< [s] in which a motor is moved over its whole range
constexpr double kQuick = 12.0;     ///< [1/s] of the spring by which a hand leads a target
constexpr double kArm = 1.0;        ///< sizes of the scene a second that a target is moved by
constexpr double kPatience = 0.25;  ///< [s] behind the wall's time after which that is given up

/// The model with motors no quicker than a hand, and two linearisations a step where the scene has one: of twenty
/// seconds of targets that are thrown about, a trunk of thin cables survives one or two with one, and all with two.
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
  command_ = command_of(model_, state_);
  goal_ = goal_at(model_, 0.0);
  goal_speed_.setZero(goal_.at.size());
  led_.assign(model_.effectors.size(), false);
  report_ = {};
  trouble_.clear();
}

/// Where the scene, or a hand, wants effectors: what is dragged goes there like a damped spring, so that motors are
/// asked for nothing sudden, and back again when it is let go.
Goal Simulation::led(Goal goal, const Wishes& wishes) {
  const double h = model_.scene.time.step;
  for (std::size_t i = 0; i < model_.effectors.size(); ++i) {
    const EffectorModel& own = model_.effectors[i];
    const auto wish = wishes.aimed.find(static_cast<int>(i));
    if (wish != wishes.aimed.end()) led_[i] = true;
    if (!led_[i]) continue;
    auto at = goal.at.segment(own.first, own.size);
    auto speed = goal_speed_.segment(own.first, own.size);
    const Eigen::VectorXd to = wish == wishes.aimed.end() ? Eigen::VectorXd(at) : wish->second;
    const Eigen::VectorXd from = goal_.at.segment(own.first, own.size);
    const double metre = measure_of(model_, own).unit / 1e-3, most = kArm * model_.size * metre;
    // Implicit in the speed: no step is too long.
    speed = (speed + h * kQuick * kQuick * (to - from)) / (1.0 + 2.0 * h * kQuick + h * h * kQuick * kQuick);
    if (speed.norm() > most) speed *= most / speed.norm();
    at = from + h * speed;
    if (wish == wishes.aimed.end() && (to - at).norm() < 1e-4 * metre) {
      led_[i] = false;
      speed.setZero();
    }
  }
  return goal;
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
      told.actuators[i] = towards(now.actuators[i], wish->second, (span.most - span.least) * h / kHand);
    } else if (!std::holds_alternative<Table>(own.drive)) {
      told.actuators[i] = now.actuators[i];
    }
  }
  for (std::size_t i = 0; i < model_.loads.size(); ++i) {
    if (std::holds_alternative<External>(model_.loads[i].factor)) told.loads[i] = now.loads[i];
  }
  if (wishes.grip) told.grips = {*wishes.grip};
  const Goal goal = led(goal_at(model_, time), wishes);
  const Told by{&told, model_.effectors.empty() ? nullptr : &goal, forward};
  const long before = state_.grid;
  do {
    report_ = advance(model_, workspace_, state_, Evaluation::full, by);
    if (!accepted(report_.status)) {
      trouble_ = std::string(to_string(report_.status)) + (report_.detail.empty() ? "" : ": " + report_.detail) + ". " +
                 std::string(explain(report_.status));
      return false;
    }
  } while (state_.grid == before);
  goal_ = goal;
  trouble_.clear();
  return true;
}

void Simulation::publish(const Wishes& wishes) {
  const Clock::time_point start = Clock::now();
  Json more = {{"frame", ++frame_},
               {"playing", wishes.playing},
               {"speed", wishes.speed},
               {"status", to_string(report_.status)},
               {"targets", describe(model_, report_.aim)},
               {"newton", report_.newton},
               {"halvings", report_.halvings},
               {"contacts", report_.contact.contacts},
               {"step_ms", 1e3 * step_seconds_},
               {"frame_ms", 1e3 * frame_seconds_},
               {"realtime", realtime_},
               {"trouble", trouble_}};
  Json& told = more["mine"] = Json::object();
  for (const auto& [number, value] : wishes.told) told[model_.actuators[static_cast<std::size_t>(number)].name] = value;
  auto bytes = std::make_shared<const std::string>(scenery_.frame(state_, wishes.show, goal_, more));
  frame_seconds_ = 0.9 * frame_seconds_ + 0.1 * seconds_since(start);
  on_frame_(std::move(bytes));
}

void Simulation::work() {
  const double h = model_.scene.time.step;
  Clock::time_point due = Clock::now(), shown = due - std::chrono::seconds(1), counted = due;
  double simulated = 0.0;
  for (;;) {
    Wishes wishes;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock,
                 [this] { return end_ || wishes_.playing || wishes_.steps > 0 || wishes_.reset || wishes_.changed; });
      if (end_) return;
      wishes = wishes_;
      wishes_.steps = std::max(wishes_.steps - 1, 0);
      wishes_.reset = false;
      wishes_.changed = false;
    }
    if (wishes.reset) begin();
    const bool goes = wishes.playing || wishes.steps > 0;
    if (goes) {
      const Clock::time_point start = Clock::now();
      if (advance_once(wishes)) {
        simulated += h;
      } else {
        const std::lock_guard lock(mutex_);
        wishes.playing = wishes_.playing = false;
        wishes_.steps = 0;
      }
      step_seconds_ = 0.9 * step_seconds_ + 0.1 * seconds_since(start);
    }
    const double wall = seconds_since(counted);
    if (wall > 0.5) {
      realtime_ = simulated / wall;
      simulated = 0.0;
      counted = Clock::now();
    }
    if (!wishes.playing || wishes.changed || seconds_since(shown) > 1.0 / kFrames) {
      publish(wishes);
      shown = Clock::now();
    }
    if (!wishes.playing) {
      due = Clock::now();
      continue;
    }
    due += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(h / wishes.speed));
    if (seconds_since(due) > kPatience) due = Clock::now();
    std::unique_lock lock(mutex_);
    wake_.wait_until(lock, due, [this] { return end_; });
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
  return own.scene({{"mode", "replay"}, {"times", std::move(times)}});
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
  return scenery_.frame(unpack(model_, step.state), wishes.show, goal_at(model_, step.time),
                        {{"frame", number},
                         {"status", step.status},
                         {"targets", step.targets},
                         {"newton", step.newton},
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
    const double passed = seconds_since(before);
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
    if (number != shown || wishes.changed) on_frame_(std::make_shared<const std::string>(frame(number, wishes)));
    played = wishes.playing;
    if (!wishes.playing) continue;
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, std::chrono::duration<double>(1.0 / kFrames), [this] { return end_ || wishes_.changed; });
  }
}

}  // namespace sinew::live
