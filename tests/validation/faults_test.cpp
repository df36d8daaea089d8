// Scenes that once ended `converged` and wrong, as small as they could be made. What is right stands beside each.
#include "support/faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/scenes.hpp"

namespace sinew::test {
namespace {

using testing::HasSubstr;

// Opposite tendons that are told opposite lengths: forces of +-5e4 N, and `singular`.
TEST(Faults, tendons_antagonist) {
  for (const char* analysis : {"dynamic", "quasi_static", "static"}) {
    SCOPED_TRACE(analysis);
    const RecordedRun run = fault("tendons_antagonist", {std::string("analysis=") + analysis});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_NEAR(run.last("tip.x"), 0.16829, 5e-6);
    EXPECT_NEAR(run.last("tip.z"), 0.09194, 5e-6);
    EXPECT_NEAR(run.last("a.force"), 1.3404, 1e-4);
    EXPECT_NEAR(run.last("b.force"), -1.3404, 1e-4);
    ASSERT_TRUE(run.warning("redundant_constraints"));
    EXPECT_EQ(run.warning("redundant_constraints")->where, "actuators.a, actuators.b");
    EXPECT_TRUE(run.warning("tendon_pushes", "actuators.b"));
  }
}

// Four tendons at right angles: 3e17 N, `converged`.
TEST(Faults, tendons_four) {
  const RecordedRun run = fault("tendons_four");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_NEAR(run.last("tip.x"), 0.168, 1e-3);
  EXPECT_NEAR(run.last("tip.y"), 0.0, 1e-9);
  EXPECT_NEAR(run.last("tip.z"), 0.092, 1e-3);
  EXPECT_NEAR(run.last("t0.force"), -run.last("t2.force"), 1e-9);
  EXPECT_LT(run.largest("t0.force"), 2.0);
  EXPECT_NEAR(run.last("t1.force"), 0.0, 1e-9);
  EXPECT_TRUE(run.warning("redundant_constraints", "actuators.t0, actuators.t2"));
  EXPECT_TRUE(run.warning("redundant_constraints", "actuators.t1, actuators.t3"));
}

// Three pairs of opposite tendons contradict each other by little in a short part of a step: Newton went anywhere, and
// `max_iterations` was what the run said.
TEST(Faults, tendons_contradict) {
  for (const char* name : {"tendons_contradict", "tendons_contradict_on_the_path"}) {
    const RecordedRun run = fault(name);
    ASSERT_FALSE(run.done());
    EXPECT_EQ(run.failure().status, Status::inconsistent) << run.why();
    EXPECT_THAT(run.failure().detail, HasSubstr("actuators.t00"));
  }
}

// Three rods welded side by side, without shear: `singular` without a place.
TEST(Faults, rods_welded_along_slow) {
  const RecordedRun run = fault("rods_welded_along");
  ASSERT_TRUE(run.done()) << run.why();
  const Warning* told = run.warning("redundant_constraints");
  ASSERT_TRUE(told);
  EXPECT_THAT(told->where, HasSubstr("couplings.0"));
  EXPECT_THAT(told->remedy, HasSubstr("`shear_y`, `shear_z` to the strains of rods.r0, rods.r1"));
  EXPECT_NEAR(run.last("t0.z"), run.last("t2.z"), 1e-6);
}

// A rod that cannot stretch is pushed straight into a ball: 1.4e288 N.
TEST(Faults, rod_endwise) {
  const RecordedRun run = fault("rod_endwise");
  EXPECT_EQ(run.failure().status, Status::inconsistent);
  EXPECT_THAT(run.failure().detail, HasSubstr("add `elongation` to the strains of rods.r"));
  EXPECT_LT(run.largest("f.normal"), 1.0);
  const RecordedRun gives = fault("rod_endwise", {"rods.r.strains=[torsion, bending_y, bending_z, elongation]"});
  EXPECT_NE(gives.failure().status, Status::inconsistent) << gives.why();
  EXPECT_GT(gives.largest("f.normal"), 0.0);
}

// A frame starts to move a rod sideways: it passed through a peg at 10 ms.
TEST(Faults, contact_frame_moves) {
  for (const char* step : {"10 ms", "5 ms", "2 ms"}) {
    SCOPED_TRACE(step);
    const RecordedRun run = fault("contact_frame_moves", {std::string("time.step=") + step});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_GT(run.largest("f.contacts"), 0.0);
    // It hooks on the peg: the tip stays behind and swings in to the base.
    EXPECT_LT(run.last("tip.x"), 0.0);
  }
}

// 1 N on a light rod: 0.27 m inside a half-space.
TEST(Faults, contact_rod_pushed) {
  for (const char* step : {"20 ms", "10 ms", "1 ms"}) {
    SCOPED_TRACE(step);
    const RecordedRun run = fault("contact_rod_pushed", {std::string("time.step=") + step});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_NEAR(run.last("tip.x"), 0.109, 1e-6);
    EXPECT_NEAR(run.last("f.normal"), 1.0, 1e-6);
  }
}

// A loop is pulled over a peg of 8 mm, which it passed through at 10 and 20 ms.
void loop_is_held(const char* step) {
  // (Where friction lets the loop rest depends on the way there: 5.578 to 5.606 N along x, in steps of 2 to 20 ms.
  // Chords of 32 sections had 5.80.)
  const RecordedRun run = fault("contact_loop_pulled", {std::string("time.step=") + step}),
                    smooth = fault("contact_loop_pulled", {std::string("time.step=") + step, "contact.friction=0"});
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_NEAR(run.last("f.x"), 5.59, 0.03);
  EXPECT_NEAR(run.last("f.normal"), 6.4, 0.5);
  ASSERT_TRUE(smooth.done()) << smooth.why();
  EXPECT_NEAR(smooth.last("f.x"), 5.4828, 1e-4);
  EXPECT_NEAR(smooth.last("f.normal"), 8.57, 0.01);
}
TEST(Faults, contact_loop_pulled) { loop_is_held("20 ms"); }
TEST(Faults, contact_loop_pulled_in_other_steps_slow) {
  for (const char* step : {"10 ms", "5 ms", "2 ms"}) {
    SCOPED_TRACE(step);
    loop_is_held(step);
  }
}

// A ball on a rod, between the points by which the rod touched: it fell through.
TEST(Faults, ball_between_points) {
  const RecordedRun run = fault("ball_between_points");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_NEAR(run.last("f.normal"), 4.0 / 3.0 * std::numbers::pi * std::pow(2e-3, 3) * 2000.0 * 9.81, 2e-6);
  EXPECT_NEAR(run.last("b.z"), 3e-3, 1e-3);
}

// At rest a rod that touches a pin of 2 mm passed through it.
TEST(Faults, tunnel) {
  const RecordedRun run = fault("tunnel");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_EQ(run.last("c0.contacts"), 1.0);
  EXPECT_GT(run.last("c0.normal"), 1.0);
  EXPECT_EQ(run.warning("penetration"), nullptr);
}

// A free rod is crushed on a floor and folds within a section: between the places that were looked at it came in deeper
// than a quarter of its thickness, 0.61 mm.
TEST(Faults, rod_folds_on_floor) {
  const RecordedRun run = fault("rod_folds_on_floor");
  ASSERT_FALSE(run.done());
  EXPECT_EQ(run.failure().status, Status::passed_through) << run.why();
  const double radius = 1.2168519047374338e-3;
  for (int i = 0; i <= 30; ++i) {
    for (const double z : run.signal("p" + std::to_string(i) + ".z")) EXPECT_GT(z, radius - 1.02 * 0.25 * 2.0 * radius);
  }
}

// Normals of chords: the force along the rod was 84 % and 15 % too large.
TEST(Faults, contact_two_pins) {
  const RecordedRun run = fault("contact_two_pins");
  ASSERT_TRUE(run.done()) << run.why();
  const double along = 0.2 * std::numbers::pi * std::sin(-run.last("turn.y"));
  EXPECT_NEAR(along, 0.462, 1e-3);
  EXPECT_NEAR(run.last("basef.x"), along, 5e-3 * along);
}

// Two bodies in free flight that never come nearer than 20 mm: 0.0038 J became 0.495 J.
TEST(Faults, phantom_capsule_box) {
  for (const char* step : {"0.125 ms", "1 ms"}) {
    const RecordedRun run = fault("phantom_capsule_box", {std::string("time.step=") + step});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_NEAR(run.last("energy.kinetic"), run.signal("energy.kinetic").front(),
                1e-3 * run.signal("energy.kinetic").front());
    EXPECT_TRUE(run.warnings.empty());
  }
}

// Within a step things pass from above a face to beside it. They stay apart, and were stopped by the plane of the face,
// or what an edge had for a normal: up to 46 % of the kinetic energy was gone.
TEST(Faults, phantom_beside_face) {
  for (const char* name : {"phantom_beside_face", "phantom_beside_face_cylinder", "phantom_beside_edge"}) {
    SCOPED_TRACE(name);
    const RecordedRun run = fault(name);
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_NEAR(run.last("energy.kinetic"), run.signal("energy.kinetic").front(),
                1e-5 * run.signal("energy.kinetic").front());
    for (const char* axis : {"box.x", "box.y", "box.z"}) EXPECT_EQ(run.last(axis), 0.0);
  }
  for (const char* name : {"phantom_beside_face_rod", "phantom_beside_face_mesh"}) {
    SCOPED_TRACE(name);
    const RecordedRun run = fault(name);
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_LT(run.largest("energy.kinetic"), 1e-25);
    EXPECT_LT(run.largest("energy.work"), 1e-25);
  }
}

// A steel block that nothing meets makes a billionth of the largest force more than an arm weighs.
TEST(Faults, light_beside_heavy) {
  const auto beside = [](const char* size, const char* tolerance, bool told) {
    SCOPED_TRACE(size);
    const RecordedRun run = fault("light_beside_heavy", {std::string("bodies.rock.box.size=") + size,
                                                         std::string("newton.tolerance=") + tolerance});
    EXPECT_EQ(find_warning(run.loaded.model.warnings, "light_beside_heavy", "rods.arm") != nullptr, told);
    return run.last("tip.x");
  };
  const double right = beside("[0.2, 0.2, 0.2]", "1e-9", false);
  EXPECT_NEAR(beside("[2, 2, 2]", "1e-11", false), right, 1e-4);
  EXPECT_GT(std::abs(beside("[2, 2, 2]", "1e-9", true) - right), 5e-4);
  EXPECT_GT(std::abs(beside("[20, 20, 2]", "1e-9", true) - right), 5e-3);
  beside("[20, 20, 2]", "1e-12", true);  // (rounding alone)
}

// A capsule and a box that overlap by 1.2 mm at the start.
TEST(Faults, overlap_not_told) {
  const RecordedRun run = fault("overlap_not_told");
  ASSERT_TRUE(run.done()) << run.why();
  const Warning* told = run.warning("overlap_at_start");
  ASSERT_TRUE(told);
  EXPECT_NEAR(told->value, 1.2e-3, 0.1e-3);
}

// A spinning cylinder on a floor gained energy and sank in.
TEST(Faults, cylinder_gains) {
  const RecordedRun run = fault("cylinder_gains");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_EQ(run.warning("energy_gain"), nullptr);
  EXPECT_EQ(run.warning("penetration"), nullptr);
  const double z = run.last("o.z");
  EXPECT_TRUE(std::abs(z - 0.03) < 1e-4 || std::abs(z - 0.02) < 1e-4) << z;
  EXPECT_LT(run.last("energy.kinetic"), 1e-3);
}

/// That nothing comes from nowhere, beyond this much [J] of what there was at the start.
void energy_only_goes(const RecordedRun& run, double beyond) {
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_EQ(run.warning("energy_gain"), nullptr);
  const std::vector<double> kinetic = run.signal("energy.kinetic"), elastic = run.signal("energy.elastic"),
                            weight = run.signal("energy.weight");
  double least = INFINITY;
  for (std::size_t i = 0; i < kinetic.size(); ++i) {
    const double total = kinetic[i] + elastic[i] + weight[i];
    EXPECT_LT(total - least, beyond) << i;
    least = std::min(least, total);
  }
}

// A cylinder that overlapped the floor by 14 micrometres at the start sank in by 130 mm.
TEST(Faults, cylinder_sinks) {
  const RecordedRun run = fault("cylinder_sinks");
  for (const double z : run.signal("wheel.z")) EXPECT_GT(z, 5e-3);
  if (run.done()) {
    EXPECT_GT(run.last("wheel.z"), 9.9e-3);
    EXPECT_LT(run.last("wheel.x"), 0.29);
  }
}

// A rod that falls on a cylinder left with 2.6 times the energy of its fall.
TEST(Faults, rod_impact_gain) { energy_only_goes(fault("rod_impact_gain"), 1e-6); }

// What contacts added for a step went into bending, or weight, and was not looked for there: 0.2 and 0.4 % of the most.
TEST(Faults, rod_impact_stores) {
  for (const char* name : {"rod_impact_bends", "rod_impact_rises"}) energy_only_goes(fault(name), 2e-7);
}

// A rod had 0.48 mJ more for one step, 72 % of the most that it ever had.
TEST(Faults, rod_spun_round) { energy_only_goes(fault("rod_spun_round"), 1e-6); }

// Two tubes of rest curvature, one in the other by four ties: "unstable", coming and going with the step.
TEST(Faults, false_unstable) {
  for (const char* step : {"0.1", "0.05", "0.02"}) {
    const RecordedRun run = fault("false_unstable", {std::string("time.step=") + step});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_EQ(run.warning("unstable"), nullptr) << step;
  }
}

// The spin of a weight that hangs from a joint, which nothing resists: "unstable" by the sign of rounding.
TEST(Faults, weight_hangs) {
  for (const char* analysis : {"static", "quasi_static", "modal"}) {
    for (const char* young : {"1 GPa", "100 MPa", "10 MPa"}) {
      const RecordedRun run =
          fault("weight_hangs", {std::string("analysis=") + analysis, std::string("rods.arm.material.young=") + young});
      ASSERT_TRUE(run.done()) << run.why();
      EXPECT_EQ(run.warning("unstable"), nullptr) << analysis << ", " << young;
      EXPECT_TRUE(run.warning("free_motion", "bodies.weight")) << analysis << ", " << young;
    }
  }
}

// A cable pulled by a told displacement, its tip held twice: "nothing resists a motion of its base".
TEST(Faults, anchored_and_tied) {
  for (const char* analysis : {"static", "quasi_static"}) {
    const RecordedRun run = fault("anchored_and_tied", {std::string("analysis=") + analysis});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_TRUE(run.warning("redundant_constraints"));
    EXPECT_EQ(run.warning("free_motion"), nullptr);
  }
}

// Two cables on one path told different lengths: `max_iterations`, "try smaller steps".
TEST(Faults, cables_contradict) {
  for (const char* analysis : {"static", "quasi_static", "dynamic"}) {
    const RecordedRun run = fault("cables_contradict", {std::string("analysis=") + analysis});
    ASSERT_FALSE(run.done());
    EXPECT_THAT(run.failure().detail, HasSubstr("contradict")) << analysis << ": " << to_string(run.failure().status);
    EXPECT_THAT(run.failure().detail,
                testing::StartsWith("couplings.0, couplings.1, actuators.first, actuators.second contradict"))
        << analysis;
  }
}

// Modes of a massless beam with a ball at its tip: -2.9e19 Hz.
TEST(Faults, massless_rod_carries_body) {
  const RecordedRun run = fault("massless_rod_carries_body");
  ASSERT_TRUE(run.done()) << run.why();
  // 3 EI / L^3, 6 EI / L^2 and 4 EI / L at the centre of the ball, and G J / L.
  constexpr double kLength = 0.3, kRadius = 5e-3, kYoung = 1e6, kMass = 0.1, kBall = 0.01;
  constexpr double kSecondMoment = std::numbers::pi * kRadius * kRadius * kRadius * kRadius / 4.0;
  constexpr double kInertia = 0.4 * kMass * kBall * kBall, kBending = kYoung * kSecondMoment;
  Eigen::Matrix2d stiffness, mass;
  stiffness << 12.0, -6.0 * kLength, -6.0 * kLength, 4.0 * kLength * kLength;
  stiffness *= kBending / (kLength * kLength * kLength);
  mass << kMass, 0.0, 0.0, kInertia;
  const Eigen::Vector2d squares =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d>(stiffness, mass).eigenvalues();
  const double twist = std::sqrt(kYoung / 3.0 * 2.0 * kSecondMoment / kLength / kInertia);
  const std::vector<double> frequencies = run.signal("mode.frequency");
  ASSERT_EQ(frequencies.size(), 6u);
  const double expected[] = {std::sqrt(squares[0]), std::sqrt(squares[0]), twist, std::sqrt(squares[1]),
                             std::sqrt(squares[1])};
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR(frequencies[static_cast<std::size_t>(i) + 1] * 2.0 * std::numbers::pi, expected[i], 1e-6 * expected[i]);
  const RecordedRun free = fault("massless_rod_carries_body", {"rods.beam.base=free", "modes=8"});
  EXPECT_THAT(free.failure().detail, HasSubstr("6 modes only"));
}

// "The path turned back, there is no equilibrium", after 3000 steps at 73 % of the load.
TEST(Faults, path_limit_slow) {
  const RecordedRun run = fault("path_limit");
  EXPECT_EQ(run.failure().status, Status::path_unfinished);
  EXPECT_THAT(run.failure().detail, HasSubstr("73.3 % of the load in 300"));
}

// Normals of chords, and of faces beside an edge: axial force +84 %.
TEST(Faults, contact_sleeve) {
  const RecordedRun run = fault("contact_sleeve");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_NEAR(std::abs(run.last("pull.force")), 0.4475, 0.001);
  EXPECT_NEAR(std::abs(run.last("pull.force")), 0.6283185307 * std::sin(std::abs(run.last("turn.y"))), 1e-3);
}

// Where the mouth of the sleeve lies within a section the force is off by up to 140 %. It is told, and by how much.
TEST(Faults, contact_sleeve_within_a_section) {
  for (const auto& [sections, order] :
       {std::pair{9, 0}, {23, 0}, {37, 0}, {60, 0}, {90, 0}, {23, 1}, {37, 1}, {23, 2}}) {
    SCOPED_TRACE(std::to_string(sections) + " sections of order " + std::to_string(order));
    const RecordedRun run = fault(
        "contact_sleeve", {"rods.rod.sections=" + std::to_string(sections), "rods.rod.order=" + std::to_string(order)});
    ASSERT_TRUE(run.done()) << run.why();
    const std::vector<double> turn = run.signal("turn.y"), force = run.signal("pull.force");
    double most = 0.0;  // beside the exact P sin(theta_tip)
    for (std::size_t i = 1; i < run.steps.size(); ++i) {
      const double exact = 0.6283185307 * std::min(1.0, run.steps[i].time / 0.5) * std::sin(-turn[i]);
      most = std::max(most, std::abs(force[i] - exact) / std::abs(force[i]));
    }
    const Warning* const warning = run.warning("touched_force_off", "rods.rod");
    EXPECT_EQ(warning != nullptr, most > 0.1) << most;
    if (warning) EXPECT_NEAR(warning->value, most, 0.05 * most);
  }
}

// A peg beyond the tip held a rod whose last section is short.
TEST(Faults, nothing_beyond_the_tip) {
  for (const bool short_end : {false, true}) {
    Scene scene = test::lone_rod(1000.0, 10);
    scene.analysis = Analysis::quasi_static;
    scene.time = {0.1, 1.0};
    Rod& rod = scene.rods[0].second;
    rod.path = {Vec3::Zero(), Vec3(0.1, 0, 0)};
    if (short_end) rod.sections = std::vector<double>{0.0, 0.099, 0.1};
    rod.section = Circle{1e-3};
    rod.material.young = 1e8;
    RodLoad push;
    push.rod = "rod";
    push.force = Vec3(0, 0, -0.0015);
    push.factor = Table{{0.0, 1.0}, {0.0, 1.0}};
    scene.loads.emplace_back("push", push);
    Obstacle peg;
    peg.shape = CapsuleShape{1e-3, 0.04};
    peg.pose = {{std::numbers::pi / 2.0, 0, 0}, {0.105, 0, -0.005}};
    scene.obstacles.emplace_back("peg", peg);
    ContactPair pair;
    pair.first = "rod";
    pair.second = "peg";
    scene.contact.pairs.push_back(pair);
    scene.outputs[0].second.at = 0.1;
    const Model model = build(scene, test::read_block);
    const test::Trace trace = test::run_all(model);
    ASSERT_EQ(trace.end, RunEnd::done) << trace.failure.detail;
    const State& end = trace.states.back();
    EXPECT_LT(test::tip(model, end).z(), short_end ? -0.0045 : -0.006);
    EXPECT_FALSE(is_pressed(end, {Collider::Kind::rod, 0}));
  }
}

// A bent rod that slides: the configurational force M^2 / 2 B is a sawtooth of 0.08 to 0.77 N.
TEST(Faults, sleeve_ripple) {
  const auto ripple = [](const std::string& sections, const std::string& order, const std::string& couplings = "") {
    std::vector<std::string> changes = {"rods.rod.sections=" + sections, "rods.rod.order=" + order};
    if (!couplings.empty()) changes.push_back("couplings=" + couplings);
    const RecordedRun run = fault("sleeve_ripple", changes);
    EXPECT_TRUE(run.done()) << run.why();
    const std::vector<double> turn = run.signal("turn.y"), force = run.signal("base.x");
    double most = 0.0;  // beside the exact P sin(theta_tip)
    for (std::size_t i = 0; i < run.steps.size(); ++i) {
      if (run.steps[i].time > 0.201)
        most = std::max(most, std::abs(std::abs(force[i] / (0.6283185307 * std::sin(turn[i]))) - 1.0));
    }
    // Told wherever it is beyond a tenth, and only there.
    EXPECT_EQ(run.warning("sliding_force_ripples", "rods.rod") != nullptr, most > 0.1) << sections << ' ' << order;
    return most;
  };
  // Points of several couplings are as far apart as those of one; sections that are drawn in count as those within.
  std::string apart, fine = "[0";
  for (int i = 0; i <= 20; ++i) {
    apart += (i == 0 ? "[" : ", ") +
             ("{slide: {rod: rod, solid: block, anchor_tip: none, points: [" + std::to_string(0.3 + 0.01 * i) + "]}}");
  }
  for (int i = 1; i <= 200; ++i) fine += ", " + std::to_string(0.0025 * i);
  for (int i = 1; i <= 10; ++i) fine += ", " + std::to_string(0.5 + 0.02 * i);
  EXPECT_GT(ripple("70", "0", apart + "]"), 0.5);
  EXPECT_GT(ripple(fine + "]", "0"), 0.5);
  EXPECT_GT(ripple("70", "0"), 0.5);
  EXPECT_LT(ripple("140", "0"), 0.1);
  EXPECT_LT(ripple("280", "0"), 0.02);
  EXPECT_LT(ripple("140", "1"), 0.02);
  EXPECT_LT(ripple("70", "2"), 0.02);
  // (The order of the other bending does not help.)
  EXPECT_GT(ripple("70", "{bending_y: 2, bending_z: 0}"), 0.5);
  EXPECT_LT(ripple("70", "{bending_y: 0, bending_z: 2}"), 0.02);
}

// Friction of a rod with bending stiffness in a channel of points grows as 1 / spacing.
TEST(Faults, sleeve_friction) {
  const RecordedRun run = fault("sleeve_friction", {"time.duration=1.1"});
  ASSERT_TRUE(run.done()) << run.why();
  ASSERT_TRUE(run.warning("friction_of_points", "couplings.0"));
  EXPECT_THAT(run.warning("friction_of_points")->message, HasSubstr("(5 mm)"));
}

// The finger's cable is pulled by 60 mm: the body passes through itself, the thread pushes.
TEST(Faults, passes_through_itself) {
  const RecordedRun run = fault("passes_through_itself");
  ASSERT_TRUE(run.done()) << run.why();
  ASSERT_TRUE(run.warning("solid_crosses_itself", "solids.finger"));
  EXPECT_THAT(run.warning("solid_crosses_itself")->remedy, HasSubstr("between: [finger, finger]"));
  EXPECT_TRUE(run.warning("thread_pushes", "actuators.pull"));
  // Whichever way its motor counts.
  const RecordedRun along =
      fault("passes_through_itself", {"actuators.pull.axis=x", "actuators.pull.displacement.values=[0, -60 mm]"});
  EXPECT_TRUE(along.warning("thread_pushes", "actuators.pull"));
  const RecordedRun less =
      fault("passes_through_itself", {"actuators.pull.displacement.values=[0 mm, 10 mm]", "time.duration=1 s"});
  EXPECT_TRUE(less.warnings.empty());
}

// Work of frames that move a rod's base, an attachment or an obstacle was left out of the balance.
TEST(Faults, frame_lifts) {
  for (const char* name : {"frame_lifts_rod", "frame_lifts_tie", "frame_lifts_floor"}) {
    SCOPED_TRACE(name);
    const RecordedRun run = fault(name);
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_EQ(run.warning("energy_gain"), nullptr);
    // All but what its weight has gained is motion that was damped.
    EXPECT_GT(run.last("energy.dissipated"), 0.0);
    EXPECT_LT(run.last("energy.dissipated"), 0.05 * run.last("energy.weight"));
  }
  // A body of 30 g that is set in motion, at 5 cm/s, and stopped within a step each: m v^2 is lost.
  EXPECT_NEAR(fault("frame_lifts_floor").last("energy.dissipated"), 0.03 * 0.05 * 0.05, 1e-9);
}

// By the mean of the forces at the ends of its first two steps of 10 ms, a rod that a frame sets in motion within the
// first and then buckles has lost 2.1e-4 and 3.3e-4 J less than nothing, of the 1.1e-2 J that it stores. That is the
// mean's error: forces jump, and buckling rods push back less and less.
TEST(Faults, frame_buckles_rod) {
  const RecordedRun run = fault("frame_buckles_rod");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_EQ(run.warning("energy_gain"), nullptr);
  const std::vector<double> dissipated = run.signal("energy.dissipated");
  EXPECT_LT(*std::min_element(dissipated.begin(), dissipated.end()), -3e-4);
}

// A frame lifts an almost rigid rod through the horizontal: within a step the moment of its weight is larger than at
// both ends, by theta^2 / 8, and its work by theta^2 / 12.
TEST(Faults, frame_turns_rod) {
  const RecordedRun run = fault("frame_turns_rod");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_EQ(run.warning("energy_gain"), nullptr);
  EXPECT_GT(run.last("energy.work"), 1e3 * run.largest("energy.kinetic"));
}

// What lies still rolls by rounding: `coarse_rolling` told of 11 %.
TEST(Faults, box_rests_on_rods) {
  const RecordedRun run = fault("box_rests_on_rods");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_NEAR(run.last("ta.normal"), 9.81e-3, 1e-4);
  EXPECT_NEAR(run.last("tb.normal"), 9.81e-3, 1e-4);
  const Warning* told = run.warning("coarse_rolling");
  EXPECT_FALSE(told) << to_string(*told);
}

// A capsule that turns on the floor in long steps gains energy, and says so.
TEST(Faults, body_gains) {
  const RecordedRun run = fault("body_gains");
  ASSERT_TRUE(run.done()) << run.why();
  ASSERT_TRUE(run.warning("energy_gain"));
  EXPECT_NEAR(run.warning("energy_gain")->value, 2e-3, 0.5e-3);
  EXPECT_EQ(fault("body_gains", {"time.step=1 ms"}).warning("energy_gain"), nullptr);
}

// A disc that presses with its rim is held as a broad one is, also where the corners of its prism stand out by more
// than a fiftieth of its thickness. How deep its edges lie in the block between nodes is told, and no step comes deeper
// than a quarter.
TEST(Faults, disc_cuts_block) {
  for (const char* analysis : {"quasi_static", "dynamic"}) {
    const std::string how = std::string("analysis=") + analysis;
    const RecordedRun thin = fault("disc_cuts_block", {how}),
                      broad = fault("disc_cuts_block", {how, "obstacles.disc.cylinder.length=10 mm"});
    ASSERT_TRUE(thin.done() && broad.done()) << thin.why() << broad.why();
    const std::vector<double> force = thin.signal("f.normal"), expected = broad.signal("f.normal");
    for (std::size_t i = 10; i < std::min(force.size(), expected.size()); ++i)
      EXPECT_NEAR(force[i], expected[i], 0.06 * expected[i]) << analysis << " " << i;
    EXPECT_EQ(thin.warning("penetration"), nullptr);
  }
  const auto above_nodes = [](const std::string& length) {
    return fault("disc_cuts_block",
                 {"obstacles.disc.cylinder.length=" + length, "obstacles.disc.pose.translate=[100 mm, 7 mm, 80.1 mm]",
                  "frames.hand.motion.translate=[[0, 0, 0], [0, 0, -8 mm]]"});
  };
  const RecordedRun deep = above_nodes("2 mm");
  ASSERT_TRUE(deep.done()) << deep.why();
  const Warning* told = deep.warning("penetration");
  ASSERT_TRUE(told);
  EXPECT_NE(told->remedy.find("smaller triangles"), std::string::npos);
  EXPECT_GT(told->value, 0.2e-3);
  EXPECT_LT(told->value, 0.5e-3);
  const RecordedRun cut = above_nodes("0.8 mm");
  EXPECT_EQ(cut.failure().status, Status::passed_through);
  EXPECT_EQ(cut.failure().detail.find("disc and block: an edge lies"), 0U) << cut.why();
}

// Rods are braked by the time step as they spin, by T = J omega^3 h: told beside the moment f R of friction. With m a =
// m g - f and J a / R = f R - T of a solid cylinder, T = 1.5 (f - m g / 3) R.
TEST(Faults, rod_spins_on_floor) {
  const RecordedRun run = fault("rod_spins_on_floor");
  ASSERT_TRUE(run.done()) << run.why();
  const Warning* told = run.warning("spin_damped");
  ASSERT_TRUE(told);
  EXPECT_EQ(told->where, "rods.r");
  const double mass = 1100.0 * std::numbers::pi * 0.02 * 0.02 * 0.1, friction = -run.last("f.y");
  const double drag = 1.5 * (friction - mass * 2.5 / 3.0);
  EXPECT_NEAR(told->value, drag / (drag + friction), 0.01);
  EXPECT_GT(told->value, 0.25);
  EXPECT_EQ(run.warning("coarse_rolling"), nullptr);
  const std::string shorter = "time.duration=0.2 s";
  const RecordedRun begins = fault("rod_spins_on_floor", {shorter});
  ASSERT_TRUE(begins.warning("spin_damped"));
  const std::string remedy = begins.warning("spin_damped")->remedy;  // "take steps of ... ms or less, ..."
  const std::size_t at = remedy.find("steps of ") + 9;
  const std::string step = "time.step=" + remedy.substr(at, remedy.find(" or less") - at);
  EXPECT_EQ(fault("rod_spins_on_floor", {shorter, step}).warning("spin_damped"), nullptr) << step;
}

TEST(Faults, nothing_acts) {
  const RecordedRun run = fault("nothing_acts");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_EQ(run.warning("snapped"), nullptr);
  EXPECT_LE(iterations_of(run), 20);
  EXPECT_LT(run.largest("energy.work"), 1e-20);
  EXPECT_NEAR(run.last("tip.x"), 0.204, 1e-12);
}

}  // namespace
}  // namespace sinew::test
