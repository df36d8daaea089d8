// Bodies that let go: an equilibrium ends, and the run follows them to the next one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/recorded_run.hpp"

namespace sinew::test {
namespace {

RecordedRun arch(const std::string& name, const std::vector<std::string>& changes = {}) {
  return run_file(std::filesystem::path(SINEW_SOURCE_DIR) / "tests/validation/faults" / (name + ".yaml"), changes);
}

/// Where a force that grows leaves the path of equilibria, where on it the force is as large again, and the energy
/// between the two.
struct Limit {
  double force = 0.0, from = 0.0, to = 0.0, free = 0.0;
};
Limit limit_of(const RecordedRun& pressed) {
  const std::vector<double> z = pressed.signal("mid.z"), energy = pressed.signal("energy.elastic");
  const auto force = [&](std::size_t i) { return -(energy[i + 1] - energy[i - 1]) / (z[i + 1] - z[i - 1]); };
  std::size_t at = 1;
  while (force(at + 1) >= force(at)) ++at;
  std::size_t far = at + 1;
  while (force(far + 1) < force(far)) ++far;  // down to the least, and up again
  while (force(far) < force(at)) ++far;
  return {force(at), z[at], z[far], energy[at] - energy[far] + force(at) * (z[at] - z[far])};
}

TEST(Snap, an_arch_goes_over_to_the_other_side_and_says_what_that_sets_free) {
  const RecordedRun pressed = arch("arch_pressed");
  ASSERT_TRUE(pressed.done()) << pressed.why();
  const Limit limit = limit_of(pressed);
  const double load = 0.04;  // [N] at t = 1 s
  for (const double step : {0.02, 0.01, 0.005}) {
    SCOPED_TRACE(step);
    const RecordedRun run = arch("arch_snaps", {"time.step=" + std::to_string(step)});
    ASSERT_TRUE(run.done()) << run.why();
    const Warning* snapped = run.warning("snapped");
    ASSERT_TRUE(snapped);
    EXPECT_EQ(snapped->where, "rods.arch");
    EXPECT_GT(snapped->time, limit.force / load);
    EXPECT_LT(snapped->time, limit.force / load + step);
    const std::vector<double> z = run.signal("mid.z"), dissipated = run.signal("energy.dissipated");
    const auto after =
        static_cast<std::size_t>(std::find_if(z.begin(), z.end(), [](double own) { return own < 0.0; }) - z.begin());
    EXPECT_NEAR(z[after - 1], limit.from, 0.8e-3);  // (it falls ever faster towards the limit)
    EXPECT_NEAR(z[after], limit.to, 0.15e-3);       // at up to one step's load more
    EXPECT_NEAR(dissipated.back(), limit.free, 0.02 * limit.free);
  }
}

// The same by motion that is damped, pressed slowly enough.
TEST(Snap, the_energy_set_free_is_what_damped_motion_dissipates) {
  const RecordedRun run = arch("arch_snaps", {"analysis=dynamic", "time.step=50 ms", "time.duration=200 s",
                                              "rods.arch.material.damping=5 ms",
                                              "loads.push.factor={times: [0, 200], values: [0, 0.04]}"}),
                    rest = arch("arch_snaps");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_NEAR(rest.last("energy.dissipated"), run.last("energy.dissipated"), 0.03 * run.last("energy.dissipated"));
  EXPECT_NEAR(rest.last("mid.z"), run.last("mid.z"), 1e-5);
}

// A ball pushes an arch on hinges down, past its largest load, until that presses no longer: from there it goes on
// alone.
TEST(Snap, a_ball_pushes_an_arch_through) {
  const RecordedRun path = arch(
      "arch_pressed", {"rods.arch.base=[turn_z]", "couplings.0.tie.about=[]", "rods.arch.section.circle.radius=4 mm"});
  ASSERT_TRUE(path.done()) << path.why();
  const std::vector<double> z = path.signal("mid.z"), energy = path.signal("energy.elastic");
  const auto force = [&](std::size_t i) { return -(energy[i + 1] - energy[i - 1]) / (z[i + 1] - z[i - 1]); };
  double largest = 0.0;
  std::size_t free = 1;
  for (; force(free) > 0.0; ++free) largest = std::max(largest, force(free));
  const double lets_go = (8e-3 - z[free]) / 14e-3;  // [s], as the ball goes down by 14 mm/s
  std::size_t rests = free;
  while (force(rests) <= 0.0) ++rests;
  const double set_free = energy[free] - energy[rests];
  for (const double step : {0.005, 0.01}) {
    SCOPED_TRACE(step);
    const RecordedRun run = arch("arch_pushed", {"time.step=" + std::to_string(step)});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_NEAR(run.largest("f.normal"), largest, 2e-3 * largest);
    const Warning* told = run.warning("snapped");
    ASSERT_TRUE(told);
    EXPECT_EQ(told->where, "rods.arch");
    EXPECT_NEAR(told->time, lets_go, step);
    EXPECT_NEAR(told->value, set_free / energy[free], 0.03 * set_free / energy[free]);
    EXPECT_NEAR(run.last("energy.elastic"), energy[rests], 1e-5 * energy[rests]);
    EXPECT_EQ(run.last("f.contacts"), 0.0);
    EXPECT_FALSE(run.warning("unstable"));
  }
}

// A higher arch sways to a side on its way. The ball goes on along equilibria that do not, and from there on it is said
// that they are unstable: what presses holds the arch from above alone.
TEST(Snap, an_arch_that_would_sway_under_a_ball_is_told) {
  const std::string radius = "rods.arch.section.circle.radius=3.6 mm";
  const RecordedRun path = arch("arch_pressed", {"rods.arch.base=[turn_z]", "couplings.0.tie.about=[]", radius}),
                    run = arch("arch_pushed", {radius, "obstacles.ball.pose.translate=[0, 0, 16.6 mm]"});
  ASSERT_TRUE(path.done()) << path.why();
  ASSERT_TRUE(run.done()) << run.why();
  const Warning* told = run.warning("unstable");
  ASSERT_TRUE(told);
  // Which side it sways to is decided by rounding; that it does shows in the energy that it takes to come as far.
  const std::vector<double> sways = path.signal("energy.elastic"), straight = run.signal("energy.elastic");
  std::size_t apart = 0;  // both go down by 14 mm/s, in steps of 2 and 5 ms
  while (std::abs(sways[5 * apart] - straight[2 * apart]) < 1e-3 * straight[2 * apart] + 1e-9) ++apart;
  EXPECT_NEAR(told->time, 0.01 * static_cast<double>(apart), 0.03);
}

const std::vector<std::string> no_floor = {"obstacles={}", "outputs={mid: {rod: arch, at: 0.1}}"};

std::vector<std::string> and_no_floor(std::vector<std::string> changes) {
  changes.insert(changes.end(), no_floor.begin(), no_floor.end());
  return changes;
}

TEST(Snap, an_arch_that_nothing_can_touch_goes_over_as_well) {
  const RecordedRun alone = arch("arch_snaps", no_floor), beside = arch("arch_snaps");
  ASSERT_TRUE(alone.done()) << alone.why();
  const Warning *told = alone.warning("snapped"), *other = beside.warning("snapped");
  ASSERT_TRUE(told && other);
  EXPECT_EQ(told->where, "rods.arch");
  EXPECT_NEAR(told->time, other->time, 0.5 * alone.loaded.model.scene.time.step);
  EXPECT_NEAR(alone.last("mid.z"), beside.last("mid.z"), 1e-8);
  EXPECT_NEAR(alone.last("energy.dissipated"), beside.last("energy.dissipated"),
              0.02 * beside.last("energy.dissipated"));
  for (const char* step : {"200 ms", "500 ms"}) {  // Newton finds the other side at once
    const RecordedRun coarse = arch("arch_snaps", and_no_floor({std::string("time.step=") + step}));
    EXPECT_TRUE(coarse.warning("snapped")) << step;
    EXPECT_NEAR(coarse.last("mid.z"), alone.last("mid.z"), 1e-8);
  }
  const RecordedRun stopped = arch("arch_snaps", and_no_floor({"snap=stop"}));
  EXPECT_EQ(stopped.failure().status, Status::path_lost);
  EXPECT_EQ(stopped.failure().detail.find("rods.arch: no equilibrium goes on"), 0U) << stopped.failure().detail;
}

// Gravity is brought on at the first point of a run, as loads are: it sets free what the same load does.
TEST(Snap, weight_at_the_start_sets_free_what_a_load_does) {
  const double area = M_PI * 2e-3 * 2e-3, weight = 1000.0 * 9.81 * area;  // [N/m]
  const std::vector<std::string> once = {"time.duration=20 ms"};
  for (const bool floor : {true, false}) {
    SCOPED_TRACE(floor);
    const auto with = [&](const std::vector<std::string>& changes) {
      std::vector<std::string> all = floor ? once : and_no_floor(once);
      all.insert(all.end(), changes.begin(), changes.end());
      return arch("arch_snaps", all);
    };
    const RecordedRun weighs = with({"gravity=[0, 0, -29.43]", "loads={}"}),
                      loaded = with({"loads={push: {rod: arch, from: 0, to: 0.2, force: [0, 0, " +
                                     std::to_string(-3.0 * weight) + "]}}"});
    ASSERT_TRUE(weighs.done()) << weighs.why();
    ASSERT_TRUE(loaded.done()) << loaded.why();
    EXPECT_LT(weighs.last("mid.z"), 0.0);
    EXPECT_NEAR(weighs.last("mid.z"), loaded.last("mid.z"), 1e-4);
    const Warning *told = weighs.warning("snapped"), *other = loaded.warning("snapped");
    ASSERT_TRUE(told && other);
    EXPECT_NEAR(told->value, other->value, 0.05 * other->value);
  }
}

TEST(Snap, a_run_ends_there_if_it_is_told_to_stop) {
  const RecordedRun run = arch("arch_snaps", {"snap=stop"}), followed = arch("arch_snaps");
  EXPECT_FALSE(run.done());
  EXPECT_EQ(run.failure().status, Status::path_lost);
  EXPECT_EQ(run.failure().detail.find("rods.arch: no equilibrium goes on"), 0U) << run.failure().detail;
  EXPECT_GT(run.last("mid.z"), 0.0);  // before the snap
  const Warning* told = followed.warning("snapped");
  ASSERT_TRUE(told);
  EXPECT_LE(run.steps.back().time, told->time);
  EXPECT_GT(run.steps.back().time, told->time - 0.05);
}

// However soon the work that a step may take is spent: what has gone over to the other side is told, and what ends
// `converged` is at the equilibrium there.
TEST(Snap, nothing_goes_over_unsaid_where_little_work_is_allowed) {
  const double other_side = arch("arch_snaps").last("mid.z");
  int done = 0, stopped = 0;
  for (const bool floor : {true, false}) {
    for (const char* step : {"20 ms", "200 ms", "500 ms"}) {
      for (int limit = 1; limit <= 10; ++limit) {
        std::vector<std::string> changes = {std::string("time.step=") + step,
                                            "newton={limit: " + std::to_string(limit) + "}"};
        if (!floor) changes = and_no_floor(changes);
        SCOPED_TRACE(testing::Message() << floor << ", " << step << ", " << limit);
        const RecordedRun run = arch("arch_snaps", changes);
        const std::vector<double> z = run.signal("mid.z");
        if (*std::min_element(z.begin(), z.end()) < 0.0) {
          EXPECT_TRUE(run.warning("snapped"));
        }
        run.done() ? ++done : ++stopped;
        if (run.done()) {
          EXPECT_NEAR(run.last("mid.z"), other_side, 1e-6);
        }
        changes.push_back("snap=stop");
        const RecordedRun ends = arch("arch_snaps", changes);
        EXPECT_FALSE(ends.done());
        EXPECT_GT(ends.last("mid.z"), 0.0);
      }
    }
  }
  EXPECT_GT(done, 20);
  EXPECT_GT(stopped, 2);
}

// From 0.75 s to 0.8 s, Newton's method goes over to another equilibrium, which nothing could have lifted the beam to:
// it has 4 thousandths of the elastic energy more than the ball has put in. Shorter parts of the step do not.
TEST(Snap, a_long_step_goes_on_along_the_path) {
  const std::vector<std::string> changes = {"obstacles.ball.pose.translate=[50 mm, 3 mm, 30 mm]"};
  std::vector<std::string> in_long_steps = changes;
  in_long_steps.push_back("time.step=50 ms");
  const RecordedRun fine = arch("press_on_beam", changes), run = arch("press_on_beam", in_long_steps);
  ASSERT_TRUE(fine.done()) << fine.why();
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_NEAR(run.last("tip.y"), fine.last("tip.y"), 1e-5);
  EXPECT_NEAR(run.last("tip.z"), fine.last("tip.z"), 1e-5);
}

TEST(Snap, nothing_is_told_where_nothing_lets_go) {
  const RecordedRun run = arch("arch_snaps", {"loads.push.factor={times: [0, 1], values: [0, 0.02]}"});
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_EQ(run.warning("snapped"), nullptr);
}

}  // namespace
}  // namespace sinew::test
