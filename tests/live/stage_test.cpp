// Simulations and recorded runs as pages see them.
#include "sinew/live/stage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <nlohmann/json.hpp>

#include "sinew/error/input_error.hpp"
#include "sinew/live/export_page.hpp"
#include "sinew/runs/record.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/signals.hpp"

namespace sinew::live {
namespace {

using Json = nlohmann::json;

/// A message taken apart again.
struct Taken {
  Json head;
  std::string data;
  explicit Taken(const std::string& bytes) {
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + 4, 4);
    EXPECT_EQ(size % 8, 0u);
    head = Json::parse(bytes.substr(8, size));
    data = bytes.substr(8 + size);
  }
  template <class T>
  std::vector<T> numbers(const std::string& name) const {
    for (const Json& own : head["arrays"]) {
      if (own["name"] != name) continue;
      EXPECT_EQ(own["at"].get<std::size_t>() % 8, 0u);
      std::vector<T> all(own["count"].get<std::size_t>());
      std::memcpy(all.data(), data.data() + own["at"].get<std::size_t>(), all.size() * sizeof(T));
      return all;
    }
    ADD_FAILURE() << "no array " << name;
    return {};
  }
};

runs::LoadedScene scene_of(const std::string& name, const std::vector<std::string>& changes = {}) {
  return runs::load(io::read_scene(SINEW_SOURCE_DIR "/examples/" + name + ".yaml", changes));
}

/// Frames as they come.
class Audience {
 public:
  void take(Bytes frame) {
    {
      const std::lock_guard lock(mutex_);
      frames_.push_back(std::move(frame));
    }
    wake_.notify_all();
  }
  /// The first frame, of those that have not been waited for, for which this holds; fails after a minute.
  template <class Holds>
  Taken wait_for(const Holds& holds) {
    std::unique_lock lock(mutex_);
    for (;;) {
      if (!wake_.wait_for(lock, std::chrono::seconds(60), [&] { return frames_.size() > seen_; }))
        throw std::runtime_error("no such frame came");
      while (seen_ < frames_.size()) {
        Taken own(*frames_[seen_++]);
        if (holds(own)) return own;
      }
    }
  }
  OnFrame listener() {
    return [this](Bytes frame, long) { take(std::move(frame)); };
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Bytes> frames_;
  std::size_t seen_ = 0;
};

TEST(Scenery, FramesAreWhereTheStateIs) {
  const runs::LoadedScene loaded = scene_of("finger", {"time.duration=0.3 s"});
  const Model& model = loaded.model;
  Workspace workspace(model);
  State state = initial_state(model);
  while (state.grid < 20) advance(model, workspace, state);
  Scenery scenery(model);
  const Taken scene(scenery.scene({}));
  const Taken frame(scenery.frame(state, {{"von_mises", "volume_ratio"}, {"bending"}, true}, {}, {{"frame", 1}}));
  const auto rest = scene.numbers<float>("solid0.rest");
  const auto nodes = scene.numbers<std::uint32_t>("solid0.nodes");
  const auto moved = frame.numbers<std::int16_t>("solid0");
  const double scale = frame.head["scales"][0];
  ASSERT_EQ(rest.size(), 3 * nodes.size());
  ASSERT_EQ(moved.size(), rest.size());
  double worst = 0.0, farthest = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = state.solids[0].x(static_cast<Eigen::Index>(axis), nodes[i]);
      worst = std::max(worst, std::abs(rest[3 * i + axis] + scale * moved[3 * i + axis] - x));
      farthest = std::max(farthest, std::abs(scale * moved[3 * i + axis]));
    }
  }
  EXPECT_GT(farthest, 1e-4);
  EXPECT_LT(worst, 0.51 * scale + 1e-8);
  const auto signals = frame.numbers<double>("signals");
  EXPECT_EQ(signals, signal_values(model, state));
  EXPECT_EQ(scene.head["signals"].size(), signals.size());
  const auto rod = frame.numbers<float>("rod0");
  EXPECT_EQ(rod.size(), 3 * scene.head["rods"][0]["samples"].get<std::size_t>());
  EXPECT_EQ(frame.numbers<float>("rod0.bending").size(), rod.size() / 3);
  const auto stress = frame.numbers<float>("solid0.von_mises"), volume = frame.numbers<float>("solid0.volume_ratio");
  EXPECT_EQ(stress.size(), nodes.size());
  ASSERT_EQ(volume.size(), nodes.size());
  EXPECT_GT(*std::max_element(stress.begin(), stress.end()), 100.0f);  // [Pa]
  for (const float own : volume) EXPECT_NEAR(own, 1.0, 0.3);
  EXPECT_EQ(frame.head["time"], state.time);
}

TEST(Scenery, ASceneOfOneThingIsEnough) {
  for (const char* const text : {"rods: {arm: {path: [[0, 0, 0], [1, 0, 0]], sections: 2, section: {circle: {radius: 5 "
                                 "mm}}, material: {young: 1 "
                                 "MPa, poisson: 0.4, density: 1100}}}\n",
                                 "bodies: {ball: {sphere: {radius: 10 mm}, mass: 1 kg}}\n"}) {
    const runs::LoadedScene loaded = runs::load(io::parse_scene(text, "one.yaml", "."));
    const State state = initial_state(loaded.model);
    Scenery scenery(loaded.model);
    const Taken scene(scenery.scene({})), frame(scenery.frame(state, {}, {}, {}));
    EXPECT_EQ(scene.head["signals"].size(), frame.numbers<double>("signals").size());
    EXPECT_TRUE(std::isnan(frame.numbers<double>("signals").back()));
  }
}

TEST(Scenery, BodiesAreWhereTheyAreAndTurned) {
  const runs::LoadedScene loaded = runs::load(io::parse_scene(
      "bodies: {ball: {sphere: {radius: 10 mm}, mass: 1 kg, spin: [3 rad/s, 0, 1 rad/s]}}\n", "one.yaml", "."));
  Workspace workspace(loaded.model);
  State state = initial_state(loaded.model);
  while (state.grid < 20) advance(loaded.model, workspace, state);
  Scenery scenery(loaded.model);
  const Taken frame(scenery.frame(state, {}, {}, {}));
  const auto pose = frame.numbers<float>("bodies");
  ASSERT_EQ(pose.size(), 7u);
  const Vec3 p(pose[0], pose[1], pose[2]);
  const Eigen::Quaterniond turn(pose[6], pose[3], pose[4], pose[5]);
  EXPECT_GT(turn.vec().norm(), 0.1);
  EXPECT_LT((p - state.bodies[0].p).norm(), 1e-6);
  EXPECT_LT((turn.toRotationMatrix() - state.bodies[0].R).norm(), 1e-6);
}

TEST(Scenery, SlidersGoWhereMotorsCan) {
  const runs::LoadedScene reach = scene_of("reach"), finger = scene_of("finger");
  const Span limited = slider_span(reach.model, reach.model.actuators[0]);
  EXPECT_EQ(limited.least, 0.0);
  EXPECT_EQ(limited.most, told_span(reach.model.actuators[0]).most);
  const Span table = slider_span(finger.model, finger.model.actuators[0]);
  EXPECT_EQ(table.least, 0.0);
  EXPECT_DOUBLE_EQ(table.most, 0.015);  // half as much again as the scene's 10 mm
}

TEST(Simulation, StepsAsARunDoesUntilSomebodyTellsItOtherwise) {
  const runs::LoadedScene loaded = scene_of("finger");
  Workspace workspace(loaded.model);
  State state = initial_state(loaded.model);
  Audience audience;
  Simulation simulation(loaded.model, 1, audience.listener());
  simulation.take(Speed{1000.0});
  simulation.take(Show{{}, {}, true});
  simulation.take(Reset{});
  const Taken later = audience.wait_for([](const Taken& own) { return own.head["time"].get<double>() > 0.3; });
  while (state.time < later.head["time"].get<double>() - 1e-9) advance(loaded.model, workspace, state);
  EXPECT_EQ(later.numbers<double>("signals"), signal_values(loaded.model, state));
}

TEST(Simulation, ASliderMovesTheMotorAtThePaceOfAHand) {
  const runs::LoadedScene loaded = scene_of("finger");
  Audience audience;
  Simulation simulation(loaded.model, 1, audience.listener());
  simulation.take(Speed{100.0});
  simulation.take(Tell{0, 8e-3});
  const double pace = slider_span(loaded.model, loaded.model.actuators[0]).most;  // a second for all of it
  const Taken there = audience.wait_for([&](const Taken& own) {
    const double told = own.numbers<double>("told")[0];
    EXPECT_LE(told, pace * own.head["time"].get<double>() + 1e-9);
    EXPECT_LE(told, 8e-3 + 1e-9);
    return std::abs(told - 8e-3) < 1e-9;
  });
  EXPECT_EQ(there.head["mine"]["pull"], 8e-3);
  simulation.take(Tell{0, 1e12});  // no further than its slider
  audience.wait_for([&](const Taken& own) { return std::abs(own.numbers<double>("told")[0] - pace) < 1e-9; });
  for (int i = 0; i < 20; ++i)
    audience.wait_for([&](const Taken& own) { return own.numbers<double>("told")[0] <= pace + 1e-9; });
  simulation.take(Tell{0, {}});
  audience.wait_for([](const Taken& own) { return own.head["mine"].empty(); });
}

TEST(Simulation, TargetsFollowTheHandAndMotorsCanBeTold) {
  const runs::LoadedScene loaded = scene_of("reach");
  Audience audience;
  Simulation simulation(loaded.model, 2, audience.listener());
  simulation.take(Speed{100.0});
  simulation.take(Aim{0, Eigen::Vector3d(0.02, 0.01, 0.19)});
  const Taken there = audience.wait_for([](const Taken& own) {
    const auto tip = own.numbers<float>("outputs");
    return std::abs(tip[0] - 0.02) < 1e-5 && std::abs(tip[1] - 0.01) < 1e-5;
  });
  EXPECT_NEAR(there.numbers<double>("goals")[0], 0.02, 1e-4);
  const Json columns = Taken(simulation.scene()).head["signals"];
  const auto signals = there.numbers<double>("signals");
  int found = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (columns[i]["name"] == "tip.target.x") {
      ++found;
      EXPECT_NEAR(signals[i], 0.02, 1e-4);
    } else if (columns[i]["name"] == "tip.error") {
      ++found;
      EXPECT_LT(signals[i], 2e-4);
    }
  }
  EXPECT_EQ(found, 2);
  EXPECT_THAT(there.head["targets"].get<std::string>(), testing::StartsWith("reached"));
  simulation.take(Tell{2, 0.7});
  const Taken told =
      audience.wait_for([](const Taken& own) { return std::abs(own.numbers<double>("told")[2] - 0.7) < 1e-12; });
  EXPECT_EQ(told.head["targets"], "");  // not looked for while motors are told
}

TEST(Simulation, AHandPullsAtABody) {
  const runs::LoadedScene loaded =
      scene_of("reach", {"targets={}", "actuators.pull_right.force=0 N", "actuators.pull_left.force=0 N",
                         "actuators.pull_back.force=0 N", "actuators.pull_front.force=0 N"});
  Audience audience;
  Simulation simulation(loaded.model, 2, audience.listener());
  const Taken scene(simulation.scene());
  const auto rest = scene.numbers<float>("solid0.rest");
  std::size_t top = 0;
  for (std::size_t i = 0; i < rest.size() / 3; ++i) {
    if (rest[3 * i + 2] > rest[3 * top + 2]) top = i;
  }
  const int node = static_cast<int>(scene.numbers<std::uint32_t>("solid0.nodes")[top]);
  simulation.take(Speed{100.0});
  const Vec3 at(rest[3 * top], rest[3 * top + 1], rest[3 * top + 2]);
  simulation.take(Grab{{0, node, 200.0, at + Vec3(0.02, 0, 0)}});
  const auto drawn = [&](const Taken& own) {
    return own.numbers<std::int16_t>("solid0")[3 * top] * own.head["scales"][0].get<double>();
  };
  audience.wait_for([&](const Taken& own) { return drawn(own) > 0.012; });
  simulation.take(Release{});
  audience.wait_for([&](const Taken& own) { return drawn(own) < 0.004; });
}

/// A trunk that is pulled at for a time, and let go for another.
void survives_a_hand(const Vec3& way, double pulled, double free) {
  const runs::LoadedScene loaded = scene_of("reach");
  const Model& model = loaded.model;
  Audience audience;
  Simulation simulation(model, 2, audience.listener());
  int node = 0;  // at the middle of its length, outside
  const Eigen::Matrix3Xd& rest = model.solids[0].body.rest;
  for (int i = 0; i < rest.cols(); ++i) {
    const auto off = [&](int k) { return std::abs(rest(2, k) - 0.1) - rest.col(k).head<2>().dot(way.head<2>()); };
    if (off(i) < off(node)) node = i;
  }
  simulation.take(Speed{1000.0});
  const auto go_on_for = [&](double seconds) {
    double begin = -1.0;
    const Taken last = audience.wait_for([&](const Taken& own) {
      if (begin < 0.0) begin = own.head["time"];
      return own.head["trouble"] != "" || own.head["time"].get<double>() > begin + seconds;
    });
    EXPECT_EQ(last.head["trouble"], "") << "pulled by " << way.transpose();
  };
  simulation.take(Grab{{0, node, 2500.0 * model.size * model.size, rest.col(node) + way}});
  go_on_for(pulled);
  simulation.take(Release{});
  go_on_for(free);
}

TEST(Simulation, ATrunkSurvivesAHandThatPullsAtItAndLetsGo) { survives_a_hand(Vec3(0.15, 0, 0), 0.3, 0.3); }

TEST(Simulation, ATrunkSurvivesHandsThatPullAtItForLong_slow) {
  for (const Vec3& way : {Vec3(0.15, 0, 0), Vec3(-0.1, 0.1, 0), Vec3(0, -0.15, 0.05)}) survives_a_hand(way, 2.0, 3.0);
}

TEST(Simulation, AStepThatCannotBeMadePausesAndSaysWhy) {
  const runs::LoadedScene loaded = scene_of("finger", {"newton={limit: 1, tolerance: 1e-12}"});
  Audience audience;
  Simulation simulation(loaded.model, 1, audience.listener());
  simulation.take(Tell{0, 0.05});
  const Taken stopped = audience.wait_for([](const Taken& own) { return own.head["trouble"] != ""; });
  EXPECT_FALSE(stopped.head["playing"].get<bool>());
  EXPECT_THAT(stopped.head["trouble"].get<std::string>(), testing::HasSubstr("max_iterations"));
  simulation.take(Reset{});
  audience.wait_for([](const Taken& own) { return own.head["time"] == 0.0 && own.head["trouble"] == ""; });
}

TEST(Simulation, PausedItMakesOneStepAtATime) {
  const runs::LoadedScene loaded = scene_of("finger");
  Audience audience;
  Simulation simulation(loaded.model, 1, audience.listener());
  simulation.take(Pause{});
  const double before =
      audience.wait_for([](const Taken& own) { return !own.head["playing"].get<bool>(); }).head["time"];
  simulation.take(Step{});
  const Taken next = audience.wait_for([&](const Taken& own) { return own.head["time"].get<double>() > before; });
  EXPECT_NEAR(next.head["time"].get<double>() - before, loaded.model.scene.time.step, 1e-12);
}

TEST(Simulation, PausesAtOnceHoweverSlowItIs) {
  const runs::LoadedScene loaded = scene_of("finger");
  Audience audience;
  Simulation simulation(loaded.model, 1, audience.listener());
  simulation.take(Speed{0.001});  // ten seconds a step
  audience.wait_for([](const Taken& own) { return own.head["speed"] == 0.001; });
  const auto begin = std::chrono::steady_clock::now();
  simulation.take(Pause{});
  audience.wait_for([](const Taken& own) { return !own.head["playing"].get<bool>(); });
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST(Simulation, RequestsAreNoFramesOfTheirOwn) {
  const runs::LoadedScene loaded = scene_of("finger");
  std::atomic<int> frames = 0;
  Simulation simulation(loaded.model, 1, [&](const Bytes&, long) { ++frames; });
  const auto begin = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(500))
    simulation.take(Grab{{0, 0, 1.0, Vec3::Zero()}});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_LE(frames, 120 * seconds + 2);
}

TEST(Simulation, WhatDoesNotGoOnInTimeIsRefused) {
  const runs::LoadedScene loaded = scene_of("finger", {"analysis=static"});
  EXPECT_THROW(Simulation(loaded.model, 1, [](const Bytes&, long) {}), InputError);
}

io::Recording recording_of(const runs::LoadedScene& loaded) {
  io::Recording recording{runs::header_of(loaded), {}};
  const State start = initial_state(loaded.model);
  recording.steps.push_back(runs::recorded(loaded.model, start, {}));
  runs::record(
      loaded.model, start, [&](io::RecordedStep step) { recording.steps.push_back(std::move(step)); },
      [](const State&, const StepReport&) { return true; }, 1);
  return recording;
}

TEST(Replay, PlaysSeeksAndStartsAgain) {
  const runs::LoadedScene loaded = scene_of("finger", {"time.duration=0.2 s"});
  Audience audience;
  Replay replay(loaded.model, recording_of(loaded), audience.listener());
  const Taken scene(replay.scene());
  EXPECT_EQ(scene.head["times"].size(), 21u);
  EXPECT_EQ(scene.numbers<double>("history.times").size(), 21u);
  EXPECT_EQ(scene.numbers<double>("history.values").size(), 21u * signal_names(loaded.model).size());
  replay.take(Seek{7});
  replay.take(Pause{});
  const Taken seventh = audience.wait_for([](const Taken& own) { return own.head["frame"] == 7; });
  EXPECT_NEAR(seventh.head["time"].get<double>(), 0.07, 1e-12);
  replay.take(Seek{1000000});
  audience.wait_for([](const Taken& own) { return own.head["frame"] == 20; });
  std::this_thread::sleep_for(std::chrono::milliseconds(150));  // no part of what is played
  replay.take(Play{});
  const Taken first = audience.wait_for([](const Taken& own) { return own.head["playing"].get<bool>(); });
  EXPECT_EQ(first.head["frame"], 0);
  audience.wait_for([](const Taken& own) { return own.head["frame"] == 20 && !own.head["playing"].get<bool>(); });
}

TEST(Replay, StepsOfAnotherModelAreTold) {
  const runs::LoadedScene loaded = scene_of("finger", {"time.duration=0.05 s"});
  io::Recording recording = recording_of(loaded);
  recording.steps[2].state.pop_back();
  Audience audience;
  Replay replay(loaded.model, std::move(recording), audience.listener());
  replay.take(Seek{2});
  const Taken broken = audience.wait_for([](const Taken& own) { return own.head["frame"] == 2; });
  EXPECT_THAT(broken.head["trouble"].get<std::string>(), testing::HasSubstr("does not belong"));
  audience.wait_for([](const Taken& own) { return own.head["frame"] == 5 && own.head["trouble"] == ""; });
}

TEST(Replay, RunsThatEndedEarlySaySo) {
  const runs::LoadedScene loaded = scene_of("finger", {"time.duration=0.05 s"});
  const auto trouble = [&](std::size_t left_out) {
    io::Recording recording = recording_of(loaded);
    recording.steps.resize(recording.steps.size() - left_out);
    Replay replay(loaded.model, std::move(recording), nullptr);
    std::vector<std::string> told;
    for (long i = 0; i < replay.frames(); ++i) told.push_back(Taken(replay.frame(i, {})).head["trouble"]);
    return told;
  };
  EXPECT_THAT(trouble(0), testing::Each(""));
  std::vector<std::string> expected(5);
  expected.back() = "The recording ends here, before the end of the run.";
  EXPECT_EQ(trouble(1), expected);
}

TEST(Replay, AsAFileItIsAllThere) {
  const runs::LoadedScene loaded = scene_of("finger", {"time.duration=0.2 s"});
  Replay replay(loaded.model, recording_of(loaded), nullptr);
  const std::string html = standalone_page(replay, 5);
  EXPECT_THAT(html, testing::HasSubstr("<script id=\"run\" type=\"text/plain\">H4sI"));  // gzip's magic in base64
  EXPECT_THAT(html, testing::Not(testing::HasSubstr("<!--run-->")));
  EXPECT_THAT(html, testing::Not(testing::ContainsRegex("(src|href)=\"http")));
}

}  // namespace
}  // namespace sinew::live
