// What is told, refused or accepted before anything moves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew/error/input_error.hpp"
#include "sinew/sim/first_step.hpp"
#include "support/faults.hpp"

namespace sinew::test {
namespace {

using testing::HasSubstr;

std::vector<Warning> warned(const std::string& scene, const std::vector<std::string>& changes) {
  return runs::load(io::read_scene(std::filesystem::path(SINEW_SOURCE_DIR) / scene, changes)).model.warnings;
}

struct Slip {
  std::string change, code, where;
};

void expect_told(const std::string& scene, const std::vector<Slip>& slips) {
  EXPECT_TRUE(warned(scene, {}).empty()) << warned(scene, {}).front().message;
  for (const Slip& slip : slips) {
    const std::vector<Warning> warnings = warned(scene, {slip.change});
    ASSERT_EQ(warnings.size(), 1u) << slip.change;
    EXPECT_EQ(warnings[0].code, slip.code) << slip.change;
    EXPECT_EQ(warnings[0].where, slip.where) << slip.change;
    EXPECT_FALSE(warnings[0].remedy.empty());
  }
}

TEST(Checks, UnitsOfRodsAndBodies) {
  expect_told("tests/validation/faults/plain_rod.yaml",
              {{"rods.arm.material.young=0.6 kPa", "unit_of_modulus", "rods.arm"},
               {"rods.arm.material.young=2000 GPa", "unit_of_modulus", "rods.arm"},
               {"rods.arm.material.density=1.1", "unit_of_density", "rods.arm"},
               {"rods.arm.material.density=1100 g/cm^3", "unit_of_density", "rods.arm"},
               {"bodies.ball.density=1.2", "unit_of_density", "bodies.ball"},
               {"gravity=[0, 0, -9810]", "unit_of_gravity", "gravity"}});
}

TEST(Checks, UnitsOfSolids) {
  expect_told("examples/finger.yaml", {{"solids.finger.density=1.07", "unit_of_density", "solids.finger"},
                                       {"solids.finger.density=1070 g/cm^3", "unit_of_density", "solids.finger"},
                                       {"solids.finger.material.young=0.6 kPa", "unit_of_modulus", "solids.finger"},
                                       {"solids.finger.material.young=1e-300", "unit_of_modulus", "solids.finger"}});
}

/// Real, and at the limits of what there is.
TEST(Checks, UnitsOfRareMaterialsAreNotTold) {
  const std::string scene = "tests/validation/faults/plain_rod.yaml";
  for (const std::string change :
       {"rods.arm.material.young=1 kPa", "rods.arm.material.young=1200 GPa", "rods.arm.material.density=0",
        "rods.arm.material.density=22590", "bodies.ball.density=8",
        "bodies.ball={sphere: {radius: 5 mm}, mass: 6, pose: {translate: [0.2, 0, 0]}}", "gravity=[0, 0, -24.8]"})
    EXPECT_TRUE(warned(scene, {change}).empty()) << change << ": " << warned(scene, {change}).front().message;
}

runs::LoadedScene load_fault(const std::string& name, const std::vector<std::string>& changes = {}) {
  return runs::load(
      io::read_scene(std::filesystem::path(SINEW_SOURCE_DIR) / "tests/validation/faults" / (name + ".yaml"), changes));
}

InputFault fault_in(const std::string& name, const std::vector<std::string>& changes = {}) {
  try {
    load_fault(name, changes);
  } catch (const InputError& error) {
    return error.fault();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

/// Two bars end to end, of which one is held.
TEST(Checks, ThePieceThatNothingHoldsIsNamed) {
  const InputFault fault = fault_in("pieces_touching");
  EXPECT_EQ(fault.path, "solids.a.fixed");
  EXPECT_THAT(fault.rule, HasSubstr("its piece of 96 cells about"));
  EXPECT_THAT(fault.rule, HasSubstr("is free to move and turn every way; 9 nodes of the mesh are at the place"));
  EXPECT_THAT(fault.remedy, HasSubstr("join the nodes"));
}

TEST(Checks, PiecesThatMeetAreToldInMotion) {
  const runs::LoadedScene loaded =
      load_fault("pieces_touching", {"analysis=dynamic", "time={step: 0.01, duration: 0.02}"});
  const std::vector<Warning>& warnings = loaded.model.warnings;
  const Warning* const same = find_warning(warnings, "nodes_coincide", "solids.a.mesh");
  ASSERT_TRUE(same);
  EXPECT_EQ(same->value, 9.0);
  const Warning* const pieces = find_warning(warnings, "mesh_pieces", "solids.a.mesh");
  ASSERT_TRUE(pieces);
  EXPECT_EQ(pieces->value, 2.0);
  const Warning* const free = find_warning(warnings, "solid_free", "solids.a");
  ASSERT_TRUE(free);
  EXPECT_THAT(free->message, HasSubstr("its piece of 96 cells about"));
}

/// Both held: nothing falls, and the two are told to be two.
TEST(Checks, TwoPiecesMayBothBeHeld) {
  const runs::LoadedScene loaded =
      load_fault("pieces_touching", {"solids.a.fixed=[{plane: {point: [0, 0, 0], normal: [1, 0, 0]}}, "
                                     "{plane: {point: [40 mm, 0, 0], normal: [1, 0, 0]}}]"});
  EXPECT_TRUE(find_warning(loaded.model.warnings, "mesh_pieces", "solids.a.mesh"));
  EXPECT_FALSE(find_warning(loaded.model.warnings, "solid_free", "solids.a"));
}

TEST(Checks, HangingNodesAreRefused) {
  const InputFault fault = fault_in("pieces_hanging");
  EXPECT_EQ(fault.path, "solids.a.mesh");
  EXPECT_THAT(fault.rule, HasSubstr("lies on a face of a cell that does not have it"));
  EXPECT_THAT(fault.value, HasSubstr("(0-based) at [20"));
}

struct AtRest {
  std::vector<std::string> changes;
  std::string free;  ///< what nothing resists; empty: the run can begin
};

/// What the first step at rest cannot solve for is named before the run, by the code that makes it.
TEST(Checks, WhatNothingResistsAtRestIsNamed) {
  const std::vector<AtRest> all = {
      {{"analysis=static"}, ""},
      {{"analysis=static", "couplings=[]", "contact={pairs: [{between: [arm, ball], off: true}]}"},
       "bodies.ball (x, y, z, turn_x, turn_y, turn_z)"},
      {{"couplings=[]", "bodies={}", "rods.arm.base=free"}, "rods.arm (x, y, z"},
      {{"couplings=[]", "bodies={}", "actuators={push: {rod: arm, force: 1}}"}, "rods.arm (x)"},
      {{"couplings=[]", "bodies={}", "actuators={push: {rod: arm, displacement: 1 mm}}"}, ""},
      // Level, its weight does nothing about the hinge at first; it swings down, which a path cannot begin with.
      {{"couplings=[]", "bodies={}", "rods.arm.base=[turn_z]"}, ""},
      {{"analysis=static", "couplings=[]", "bodies={}", "rods.arm.base=[turn_z]"}, "rods.arm (turn_z)"},
      {{"analysis=static", "couplings=[]", "bodies={}", "rods.arm.base=[turn_z]", "gravity=[1, 3, -9]"},
       "rods.arm (turn_z)"},
      // By rounding the tangent at the start is no more than huge.
      {{"analysis=static", "rods.arm.base=[turn_z]", "gravity=[-4.594410227149668, 4.89418297771451, -0.1]",
        "bodies.ball.pose.translate=[-0.1, 0.07, -0.07]", "rods.arm.path=[[0.1, 0.07, -0.07], [-0.1, 0.07, -0.07]]"},
       "rods.arm (turn_z)"},
      {{"analysis=static", "couplings=[{tie: {rod: arm}}]", "bodies={}", "rods.arm.base=[turn_z]"}, ""},
      // What hangs from a massless rod by a joint in its middle may turn: its modes there have frequency 0.
      {{"analysis=modal", "modes=1", "rods.arm.path=[[0, 0, 0], [0, 0, -0.2]]", "rods.arm.material.density=0",
        "gravity=[9.81, 0, 0]", "bodies.ball.pose.translate=[0, 0, -0.2]",
        "couplings=[{tie: {rod: arm, body: ball, about: []}}]"},
       ""},
  };
  for (const AtRest& trial : all) {
    const runs::LoadedScene loaded = load_fault("plain_rod", trial.changes);
    Workspace workspace(loaded.model);
    const FirstSolve first = begin_run(loaded.model, workspace);
    EXPECT_EQ(first.report.status == Status::singular, !trial.free.empty()) << trial.changes[0] << trial.changes.back();
    EXPECT_THAT(in_words(first.free), HasSubstr(trial.free)) << trial.changes.back();
  }
}

/// Files of Abaqus: a node set holds the bar, and elements of a hybrid kind are the plain ones.
TEST(Checks, SetsAndHybridElementsOfAbaqusAreRead) {
  const runs::LoadedScene plain = load_fault("node_sets", {}),
                          hybrid = load_fault("node_sets", {"solids.bar.mesh=hybrid_tets.inp"});
  const SolidModel& bar = plain.model.solids.at(0);
  EXPECT_EQ(bar.mesh.groups.at("root").nodes.size(), 9u);
  EXPECT_EQ(bar.mesh.groups.at("body").cells.size(), 144u);
  EXPECT_FALSE(find_warning(plain.model.warnings, "elements_simplified", "solids.bar.mesh"));
  const Warning* const told = find_warning(hybrid.model.warnings, "elements_simplified", "solids.bar.mesh");
  ASSERT_TRUE(told);
  EXPECT_THAT(told->message, HasSubstr("144 of type C3D4H"));
  EXPECT_EQ(hybrid.model.solids.at(0).mesh.object, bar.mesh.object);
}

/// Long, and wound about a bar: its sections stay as far off its path as that is large.
TEST(Checks, ARodFarOffItsPathIsRefusedWithTheSectionsThatDo) {
  std::string path;
  for (int i = 0; i <= 60; ++i) {
    const double turn = 0.5 * std::numbers::pi * i;
    path += (i ? ", [" : "[") + std::to_string(0.001 * i) + ", " + std::to_string(0.01 * std::cos(turn)) + ", " +
            std::to_string(0.01 * std::sin(turn)) + "]";
  }
  const std::string rod = "rods.arm={path: [" + path +
                          "], sections: 8, section: {circle: {radius: 0.1 mm}}, "
                          "material: {young: 2 GPa, poisson: 0.3, density: 1100}";
  const InputFault fault = fault_in("plain_rod", {"couplings=[]", "bodies={}", rod + "}"});
  EXPECT_EQ(fault.path, "rods.arm");
  EXPECT_THAT(fault.value, HasSubstr("off its path"));
  ASSERT_THAT(fault.remedy, HasSubstr("`sections: "));
  const std::string told = fault.remedy.substr(11, fault.remedy.find('`', 1) - 11);
  std::string finer = rod + "}";
  finer.replace(finer.find("sections: 8"), 11, "sections: " + told);
  EXPECT_FALSE(find_warning(load_fault("plain_rod", {"couplings=[]", "bodies={}", finer}).model.warnings,
                            "rod_off_path", "rods.arm"));
  EXPECT_NO_THROW(load_fault("plain_rod", {"couplings=[]", "bodies={}", rod + ", start: rest, rest: straight}"}));
}

TEST(Checks, TheTipIsWhereNothingIsSaid) {
  for (const std::string tip :
       {"{rod: arm}", "{rod: arm, at: tip}", "{rod: arm, at: 0.2}", "{rod: arm, at: 0.20000001}"}) {
    const runs::LoadedScene loaded = load_fault("plain_rod", {"outputs={tip: " + tip + "}"});
    EXPECT_DOUBLE_EQ(loaded.model.outputs[0].abscissa, loaded.model.rods[0].rod.length()) << tip;
  }
  EXPECT_THAT(fault_in("plain_rod", {"outputs={tip: {rod: arm, at: 0.2001}}"}).rule, HasSubstr("must lie on the rod"));
  EXPECT_NO_THROW(load_fault("tip_at"));
}

/// Counts that take forever are refused, as others are.
TEST(Checks, WhatNoStarHasIsRefused) {
  for (const auto& [change, path] : {std::pair("gravity=[0, 1e300, 0]", "gravity"),
                                     std::pair("rods.arm.material.density=1e300", "rods.arm.material.density"),
                                     std::pair("bodies.ball.density=1e300", "bodies.ball.density")}) {
    const InputFault fault = fault_in("plain_rod", {change});
    EXPECT_EQ(fault.path, path);
    EXPECT_EQ(fault.rule, "is more than that of a neutron star");
  }
  const InputFault stiff = fault_in("plain_rod", {"rods.arm.material.young=1e300"});
  EXPECT_EQ(stiff.path, "rods.arm.material");
  EXPECT_EQ(stiff.rule, "is more than Young's modulus of a neutron star");
}

TEST(Checks, ATendonWindsAtMostAThousandTimes) {
  const std::string tendon = "actuators={helix: {rod: arm, tendon: {distance: 2 mm, angle: [0, ";
  EXPECT_THAT(fault_in("plain_rod", {tendon + "1e15]}, tension: 1 N}}"}).rule, HasSubstr("at most 1000 times"));
  EXPECT_EQ(fault_in("plain_rod", {tendon + "1e15]}, tension: 1 N}}"}).path, "actuators.helix.tendon.angle");
  EXPECT_NO_THROW(load_fault("plain_rod", {tendon + "6283]}, tension: 1 N}}"}));
}

TEST(Checks, ATendonHasLimitsOfItsTension) {
  const std::string start = "actuators={side: {rod: arm, tension: 1 N, limits: {tension: [0.5 N, 2 N]}";
  const runs::LoadedScene loaded = load_fault("plain_rod", {start + ", tendon: {distance: 2 mm}}}"});
  EXPECT_EQ(loaded.model.actuators[0].force.least, 0.5);
  EXPECT_EQ(loaded.model.actuators[0].force.most, 2.0);
  EXPECT_THAT(fault_in("plain_rod", {"actuators={side: {rod: arm, force: 1 N, limits: {tension: [0, 2 N]}}}"}).rule,
              HasSubstr("is of a tendon"));
}

/// Held along y and z by the ground, along x by a frame that pulls.
TEST(Checks, FramesMayHoldANodeAlongDifferentAxes) {
  const RecordedRun run = fault("two_frames", {"outputs={end: {solid: c, point: [1, 0, 0]}}"});
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_NEAR(run.last("end.x"), 2.0, 1e-12);
  EXPECT_EQ(run.last("end.y"), 0.0);
}

}  // namespace
}  // namespace sinew::test
