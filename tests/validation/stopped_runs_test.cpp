// Scenes that once stopped where they should go through. What is right stands beside each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/faults.hpp"
#include "support/scenes.hpp"

namespace sinew::test {
namespace {

using testing::HasSubstr;

// A ball pressed on a soft beam at rest: without the contacts' curvature in the tangent it stopped half-way.
TEST(StoppedRuns, press_on_beam) {
  for (const auto& [friction, tip] : {std::pair{"0", -35.9e-3}, {"0.5", -36.3e-3}}) {
    for (const char* step : {"10 ms", "50 ms"}) {
      SCOPED_TRACE(std::string("friction ") + friction + ", " + step);
      const RecordedRun run =
          fault("press_on_beam", {std::string("contact.friction=") + friction, std::string("time.step=") + step});
      ASSERT_TRUE(run.done()) << run.why();
      EXPECT_NEAR(run.last("tip.z"), tip, 0.2e-3);
    }
  }
}

// The ball presses beyond the beam's end: it ended at other equilibria, at 5 ms without a word.
TEST(StoppedRuns, press_on_beam_beyond_its_end) {
  for (const char* step : {"5 ms", "10 ms", "50 ms"}) {
    SCOPED_TRACE(step);
    const RecordedRun run = fault("press_on_beam", {"contact.friction=0.3", std::string("time.step=") + step,
                                                    "obstacles.ball.pose.translate=[108 mm, 3 mm, 30 mm]"});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_NEAR(run.last("tip.z"), -31.805e-3, 0.02e-3);
    EXPECT_FALSE(run.warning("snapped"));
  }
}

// The ball stands 2 mm inside the beam when the run begins. That this is pushed out was taken for a jump to another
// equilibrium: by 70 iterations, and by a thousand of finer meshes.
TEST(StoppedRuns, what_overlaps_at_the_start_is_pushed_out_at_once) {
  for (const char* step : {"10 ms", "100 ms"}) {
    SCOPED_TRACE(step);
    const RecordedRun run = fault("press_on_beam", {std::string("time.step=") + step, "time.duration=100 ms",
                                                    "obstacles.ball.pose.translate=[100 mm, 3 mm, 25 mm]"});
    ASSERT_TRUE(run.done()) << run.why();
    for (const io::RecordedStep& made : run.steps) EXPECT_LE(made.newton, 10U) << made.time;
    EXPECT_FALSE(run.warning("snapped"));
  }
}

// A ball slips off the end, and the beam comes to lie against its side: when, where and with what energy does not
// depend on the step.
TEST(StoppedRuns, ball_slips_off_the_end) {
  for (const char* step : {"20 ms", "50 ms"}) {
    SCOPED_TRACE(step);
    const RecordedRun run = fault(
        "press_on_beam", {std::string("time.step=") + step, "obstacles.ball.pose.translate=[110 mm, 3 mm, 30 mm]"});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_NEAR(run.last("tip.z"), -2.4798e-3, 1e-7);
    const Warning* told = run.warning("snapped");
    ASSERT_TRUE(told);
    EXPECT_EQ(told->where, "solids.beam");
    EXPECT_NEAR(told->time, 0.8965, 0.003);  // (at steps of 5 ms, which are made in parts)
    EXPECT_NEAR(told->value, 0.89, 0.01);    // 46.9 of 52.9 mJ: 6.1 mJ are left
  }
}

// A stretched loop lies round a peg: a point of it and the piece beside it touched at one place, two rows that were
// nearly the same. Newton contracted by 0.8 an iteration, if at all, and 0.034 s took 145 parts of steps.
TEST(StoppedRuns, loop_lies_round_its_peg) {
  const auto pulled = [](const char* step) {
    return fault("contact_loop_pulled",
                 {std::string("time.step=") + step, "time.duration=0.2", "rods.band.material.young=1.7255e6",
                  "obstacles.peg.cylinder.radius=5.345 mm", "contact.friction=0.3",
                  "frames.left.motion.translate=[[0, 0, 0], [-27.025 mm, 0, 0]]"});
  };
  const RecordedRun run = pulled("2 ms"), other = pulled("5 ms");
  ASSERT_TRUE(run.done()) << run.why();
  ASSERT_TRUE(other.done()) << other.why();
  EXPECT_LE(run.signal("mid.x").size(), 105u);
  EXPECT_NEAR(run.last("f.x"), other.last("f.x"), 2e-3 * other.last("f.x"));
}

// A post lies along edges of a finger: they touched it where their ends did, forces went to and fro between the two,
// and the run stopped at t = 0.65.
TEST(StoppedRuns, post_lies_along_edges) {
  for (const char* step : {"50 ms", "10 ms"}) {
    SCOPED_TRACE(step);
    const RecordedRun run = fault("finger_on_post", {std::string("time.step=") + step});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_NEAR(run.last("tip.x"), 92.5697e-3, 1e-6);
    EXPECT_NEAR(run.last("tip.z"), -24.4469e-3, 2e-6);
    EXPECT_NEAR(run.last("press.normal"), 0.10276, 1e-4);
    EXPECT_LT(run.last("press.contacts"), 4);
  }
}

// At rest, a rod that sags beside a post: "moves further in a step than contacts are looked for".
TEST(StoppedRuns, sag_beside_post) {
  const RecordedRun run = fault("sag_beside_post");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_NEAR(run.last("tip.x"), 20.387e-3, 1e-6);
  EXPECT_NEAR(run.last("tip.z"), 77.897e-3, 1e-6);
}

// A softer one, which bends by 80 degrees at the first point: a post anywhere in the scene stopped it at t = 0.
TEST(StoppedRuns, soft_rod_beside_post) {
  Vec3 without = Vec3::Zero();
  for (const bool post : {false, true}) {
    Scene scene = test::lone_rod(1700.0, 12);
    scene.analysis = Analysis::quasi_static;
    scene.time = {0.02, 0.1};
    scene.gravity = Vec3(0, 0, -9.81);
    Rod& rod = scene.rods[0].second;
    rod.path = {Vec3::Zero(), Vec3(0.0689, 0, 0)};
    rod.strains = {Strain::torsion, Strain::bending_y, Strain::bending_z};
    rod.section = Circle{0.53e-3};
    rod.material.young = 2e6;
    scene.outputs[0].second.at = 0.0689;
    if (post) {
      Obstacle far;
      far.shape = SphereShape{0.01};
      far.pose = {{}, {0.09, -0.2, -0.05}};
      scene.obstacles.emplace_back("post", far);
      ContactPair pair;
      pair.first = "rod";
      pair.second = "post";
      scene.contact.pairs.push_back(pair);
    }
    const Model model = build(scene, test::read_block);
    const test::Trace trace = test::run_all(model);
    ASSERT_EQ(trace.end, RunEnd::done) << trace.failure.detail;
    const Vec3 tip = test::tip(model, trace.states.back());
    if (!post) without = tip;
    EXPECT_LT((tip - without).norm(), 1e-9);
  }
}

// A cable that slides over a post as it bends: without the curvature of their contact in the tangent 16 000 iterations
// came 0.59 s far.
TEST(StoppedRuns, cable_on_post) {
  for (const char* friction : {"0", "0.5"}) {
    SCOPED_TRACE(friction);
    const RecordedRun run = fault("cable_on_post", {std::string("contact.friction=") + friction});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_GT(run.last("press.normal"), 0.02);
    EXPECT_LT(iterations_of(run), friction[1] ? 800 : 300);
  }
}

// Points of rods pass the planes of triangles that are far away, which was taken for an overlap as deep as they are
// far: steps of hundreds of iterations, and no end on the ring.
TEST(StoppedRuns, rods_pass_planes_of_far_triangles) {
  const RecordedRun on_ring = fault("cable_on_ring"), on_block = fault("rod_on_block");
  ASSERT_TRUE(on_ring.done()) << on_ring.why();
  EXPECT_LT(iterations_of(on_ring), 600);
  ASSERT_TRUE(on_block.done()) << on_block.why();
  EXPECT_LT(iterations_of(on_block), 250);
  EXPECT_FALSE(on_block.warning("snapped"));
}

// Where a rod lies all but along an edge, the place at which it is nearest was looked for in turn on the two, and given
// up after 20 turns: an edge seemed 2 um away that was 6 um deep, until a step stopped at 0.39 s. And corners were met
// only where its chord, not the rod, was nearest to them: they went 0.05 to 0.12 mm in.
TEST(StoppedRuns, arm_under_ring) {
  for (const char* step : {"5 ms", "9 ms", "10 ms", "11 ms"}) {
    SCOPED_TRACE(step);
    const RecordedRun run = fault("arm_under_ring", {std::string("time.step=") + step});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_FALSE(run.warning("penetration"));
  }
}

// A step corrected for what contacts do beyond their tangent ended where it had begun, with a force that was not
// balanced, in every iteration: at rest at 0.35 s, and in the damped motion that was to go on from there.
TEST(StoppedRuns, stuck_on_ring) {
  for (const char* step : {"10 ms", "50 ms"}) {
    SCOPED_TRACE(step);
    const RecordedRun run = fault("stuck_on_ring", {std::string("time.step=") + step});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_TRUE(run.warning("snapped"));
  }
}

// Let fall on the ring at once, it is moved down by damped motion. That ended where it had come 0.03 mm into an edge:
// each step that moved it out of there was refused, since contact had added energy.
TEST(StoppedRuns, let_fall_on_ring) {
  const RecordedRun run =
      fault("stuck_on_ring",
            {"gravity=[0, 0, -9.81]", "frames.base.motion.translate=[[0, 0, 0], [0, 0, 0]]", "time.duration=20 ms"});
  ASSERT_TRUE(run.done()) << run.why();
}

// The corner of a cube is pressed into a soft beam: it slid to and fro between both sides of a valley until the run
// stopped, `passed_through`.
TEST(StoppedRuns, corner_in_valley) {
  for (const char* y : {"1 mm", "2 mm", "2.5 mm", "3 mm"}) {
    SCOPED_TRACE(y);
    const RecordedRun run =
        fault("corner_in_valley", {"obstacles.cube.pose.translate=[85 mm, " + std::string(y) + ", 34 mm]"});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_LT(iterations_of(run), 400);
    EXPECT_FALSE(run.warning("snapped"));
  }
}

// Without friction the sides of what slides stopped at nodes of a soft block, and nodes at the side of a second floor:
// momentum has nowhere to go.
TEST(StoppedRuns, seams_stop_nothing) {
  const RecordedRun brick = fault("brick_on_slab"), cube = fault("cube_over_seam");
  ASSERT_TRUE(brick.done()) << brick.why();
  EXPECT_NEAR(brick.last("brick.x"), 24e-3 + 0.3 * 0.2, 0.1e-3);
  EXPECT_NEAR(brick.last("brick.y"), 3e-3, 0.1e-3);
  ASSERT_TRUE(cube.done()) << cube.why();
  const std::vector<double> way = cube.signal("cube.x");
  const std::size_t last = way.size() - 1;
  EXPECT_NEAR(way[last] - way[last - 50], way[100] - way[50], 1e-3 * (way[100] - way[50]));
}

// A capsule is thrown at a thin rod, which folds round it: it runs at any step, or says what does not converge.
TEST(StoppedRuns, thin_rod_struck) {
  for (const char* step : {"2.2 ms", "1.1 ms", "0.22 ms"}) {
    SCOPED_TRACE(step);
    const RecordedRun run = fault("thin_rod_struck", {std::string("time.step=") + step});
    if (run.done()) continue;
    EXPECT_THAT(run.failure().detail, HasSubstr("capsule and rod")) << run.why();
    EXPECT_LT(run.largest("energy.kinetic"), 3e-3);  // (2.3e-3 J were put in)
  }
}

// Soft rods side by side are pressed on each other at rest: what they feel of each other's motion is beyond the
// tangent, and by itself that iteration does not contract. It went no further than one step.
TEST(StoppedRuns, soft_bundle) {
  for (const char* step : {"1 ms", "0.5 ms"}) {
    SCOPED_TRACE(step);
    const RecordedRun run = fault("soft_bundle", {std::string("time.step=") + step});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_EQ(run.halved(), 0);
    EXPECT_NEAR(run.last("tip.z"), 6.696e-3, 0.001e-3);  // (6.6954, 6.6959, and 6.6963 in steps of 0.2 ms)
  }
}

// At rest the first linearisation of a soft rod under its weight bends a section by more than a radian; halving the
// step changes nothing of that, and the run ended before its first step. It is made until it converges, the others are
// linearised there.
TEST(StoppedRuns, linearised_steps_that_go_too_far_converge) {
  const RecordedRun run = fault("linearised_sag"), converged = fault("linearised_sag", {"newton={limit: 25}"});
  ASSERT_TRUE(run.done()) << run.why();
  ASSERT_TRUE(converged.done()) << converged.why();
  ASSERT_EQ(run.steps.size(), 6U);
  for (std::size_t i = 1; i < run.steps.size(); ++i)
    EXPECT_EQ(run.steps[i].status, i == 1 ? "converged" : "linearized") << run.steps[i].time;
  EXPECT_NEAR(run.last("tip.z"), converged.last("tip.z"), 1e-10);
  EXPECT_NEAR(run.last("tip.x"), converged.last("tip.x"), 1e-10);
  EXPECT_LT(run.last("tip.z"), -0.09);  // of 0.1 m: it hangs
}

// A step of `newton: n` whose contacts add energy is made again until it converges. It was only halved, and the
// run stopped in the second step of the impact.
TEST(StoppedRuns, linearised_steps_that_gain_energy_converge) {
  const RecordedRun run = fault("rod_impact_gain", {"newton=1", "time.duration=0.09"});
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_EQ(run.halved(), 0);
  const std::vector<double> kinetic = run.signal("energy.kinetic"), elastic = run.signal("energy.elastic"),
                            weight = run.signal("energy.weight");
  ASSERT_EQ(run.steps.size(), 46U);
  for (std::size_t i = 1; i < run.steps.size(); ++i) {
    EXPECT_EQ(run.steps[i].status, i < 45 ? "linearized" : "converged") << run.steps[i].time;
  }
  EXPECT_LT(kinetic[45] + elastic[45] + weight[45], kinetic[44] + elastic[44] + weight[44]);
  EXPECT_LE(run.steps.back().residual, 1e-9);
  EXPECT_LT(kinetic[44], 0.1 * kinetic[43]);  // the impact

  // The same where the last evaluation of linearised steps is left out.
  const Model& model = run.loaded.model;
  Workspace whole = make_workspace(model), half = make_workspace(model);
  State full = initial_state(model), motion = full;
  for (int i = 1; i <= 45; ++i) {
    State same = full;
    const StepReport report = advance(model, whole, full), other = advance(model, half, motion, {Evaluation::motion});
    ASSERT_TRUE(accepted(report.status)) << report.detail;
    EXPECT_EQ(other.status, report.status) << full.time;
    if (i < 45) continue;
    Workspace another = make_workspace(model);
    EXPECT_EQ(report.newton, 1 + advance(model, another, same, {.converged = true}).newton);  // both are counted
  }
  EXPECT_LT((motion.rods[0].q - full.rods[0].q).norm(), 1e-7 * full.rods[0].q.norm());
}

// A tie that leaves one turn free stopped at 90 degrees of it.
TEST(StoppedRuns, tie_free_turn) {
  for (const char* turn : {"200 deg", "-200 deg", "800 deg"}) {
    SCOPED_TRACE(turn);
    const RecordedRun run =
        fault("tie_free_turn", {"frames.two.motion.rotate=[[0, 0, 0], [" + std::string(turn) + ", 0, 0]]"});
    ASSERT_TRUE(run.done()) << run.why();
    for (const char axis : {'x', 'y', 'z'}) {
      const double there = axis == 'x' ? 145.12e-3 : axis == 'y' ? 0.0 : -79.20e-3;
      EXPECT_NEAR(run.last(std::string("mid.") + axis), there, 0.01e-3);
    }
  }
}

}  // namespace
}  // namespace sinew::test
