// What a user reads when a scene file is wrong: line, field, rule and remedy for each kind of fault.
#include "broken_scene.hpp"

#include <gtest/gtest.h>

#include "full_scene.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/scene_file.hpp"

namespace sinew::io {
namespace {

const std::vector<Broken> kBroken = {
    // Keys.
    {"title:", "titel:", 2, "titel", "", "is not a key of a scene", "did you mean `title`?"},
    {"gravity:", "colour:", 4, "colour", "", "is not a key of a scene", "known here: title, time"},
    {"law: corotational, young", "yung", 17, "solids.finger.material.yung", "", "is not a key of a solid's material",
     "did you mean `young`?"},
    {"young: 600 kPa, ", "", 17, "solids.finger.material.young", "", "is missing",
     "add it: `young` is Young's modulus [Pa]; for example `young: 600 kPa`"},
    {"    mesh: finger.vtk\n", "", 12, "solids.finger.mesh", "", "is missing", "mesh: finger.vtk"},
    {"    mesh: finger.vtk\n", "    mesh:\n", 13, "solids.finger.mesh", "", "has no value", "mesh: finger.vtk"},
    {"mass: 75 g\n", "mass: 75 g\n    mass: 75 g\n", 19, "", "mass", "is given twice", "keep one"},
    {"    mass: 75 g\n", "", 12, "solids.finger.mass", "", "exactly one of mass, density", "mass: 75 g"},
    {"mass: 75 g\n", "mass: 75 g\n    density: 1\n", 19, "solids.finger.density", "", "together with mass",
     "remove one of mass and density"},
    {"  finger:\n", "  Finger:\n", 12, "solids.Finger", "", "is not a name", "small letters"},
    {"section: {circle: {radius: 0.5 mm}}", "up: [0, 0, 1]", 39, "", "up", "is given twice", "keep one"},
    // Numbers.
    {"poisson: 0.45", "poisson: 0.5", 17, "solids.finger.material.poisson", "0.5", "must be below 0.5 in a solid",
     "use 0.49 for a nearly incompressible silicone"},
    {"poisson: 0.45", "poisson: -1", 17, "solids.finger.material.poisson", "-1", "must be greater than -1 in a solid",
     "poisson: 0.45"},
    {"poisson: 0.5,", "poisson: 0.51,", 40, "rods.cable.material.poisson", "0.51", "must be at most 0.5 in a rod",
     "use 0.5"},
    {"young: 600 kPa", "young: -5 kPa", 17, "solids.finger.material.young", "-5 kPa", "must be greater than 0 Pa",
     "for example `young: 600 kPa`"},
    {"young: 600 kPa", "young: 600 mm", 17, "solids.finger.material.young", "600 mm",
     "must be a pressure, but 'mm' is a unit of a length", "units Pa, kPa, MPa, GPa"},
    {"young: 600 kPa", "young: 600 kpa", 17, "solids.finger.material.young", "600 kpa", "not a unit known here",
     "did you mean `kPa`?"},
    {"young: 600 kPa", "young: .nan", 17, "solids.finger.material.young", ".nan", "must be a pressure", "Pa"},
    {"young: 600 kPa", "young: {a: 1}", 17, "solids.finger.material.young", "{a: 1}", "must be a pressure", "600 kPa"},
    {"young: 600 kPa", "young: [600 kPa]", 17, "solids.finger.material.young", "[600 kPa]", "must be a pressure", "Pa"},
    {"mass: 75 g", "mass: 0", 18, "solids.finger.mass", "0", "must be greater than 0 kg", "75 g"},
    {"density: 1100 kg/m^3", "density: 0 kg/m^3", 24, "solids.block.density", "0 kg/m^3", "must be greater than 0", ""},
    {"density: 1100}", "density: -1}", 40, "rods.cable.material.density", "-1", "must be at least 0 kg/m^3",
     "massless"},
    {"scale: 0.001", "scale: 1 mm", 14, "solids.finger.scale", "1 mm", "must be a number", "plain number"},
    {"scale: 0.001", "scale: 0", 14, "solids.finger.scale", "0", "must be greater than 0", "0.001"},
    {"rayleigh: {mass: 0.1", "rayleigh: {mass: -0.1", 19, "solids.finger.rayleigh.mass", "-0.1", "at least 0 1/s",
     "damping"},
    {"step: 10 ms", "step: 0", 3, "time.step", "0", "must be greater than 0 s", "10 ms"},
    {"duration: 2 s", "duration: -2 s", 3, "time.duration", "-2 s", "must be at least 0 s", "2 s"},
    {"tolerance: 1e-10", "tolerance: 0", 5, "newton.tolerance", "0", "must be greater than 0", "1e-9"},
    {"limit: 20", "limit: 0", 5, "newton.limit", "0", "must be at least 1", "25"},
    {"limit: 20", "limit: 1.5", 5, "newton.limit", "1.5", "must be a whole number", "25"},
    {"precision: single", "precision: half", 5, "newton.precision", "half", "must be one of double, single", "double"},
    {"iterations: converged", "iterations: 0", 5, "newton.iterations", "0", "must be at least 1", "converged"},
    {"{iterations: converged, limit: 20, tolerance: 1e-10, precision: single}", "convergd", 5, "newton", "convergd",
     "must be `converged` or", "converged"},
    {"interval: 20 ms", "interval: -1", 6, "view.interval", "-1", "must be at least 0 s", "20 ms"},
    {"radius: 0.5 mm", "radius: 0 mm", 39, "rods.cable.section.circle.radius", "0 mm", "must be greater than 0 m",
     "0.5 mm"},
    // Vectors and lists.
    {"gravity: [0, -9.81, 0]", "gravity: [0, -9.81]", 4, "gravity", "[0, -9.81]", "3 of them, not 2", "[0, -9.81, 0]"},
    {"gravity: [0, -9.81, 0]", "gravity: -9.81", 4, "gravity", "-9.81", "must be a list", "[0, -9.81, 0]"},
    {"gravity: [0, -9.81, 0]", "gravity: [0, -9.81, inf]", 4, "gravity.2", "inf", "must be an acceleration", "m/s^2"},
    {"up: [0, 0, 1]", "up: [0, 0, 0]", 33, "rods.cable.up", "[0, 0, 0]", "must not be zero", "[0, 0, 1]"},
    {"path: [[0, 0, 0], [10 cm, 0, 0]]", "path: [[0, 0, 0]]", 42, "rods.thread.path", "", "at least 2, not 1", "path:"},
    {"[50 mm, 5 mm, 7 mm]", "[0, 5 mm, 7 mm]", 31, "rods.cable.path.1", "", "same point", "remove one"},
    {"[[-15 mm, 0 mm, 0 mm], [5 mm", "[[15 mm, 0 mm, 0 mm], [5 mm", 20, "solids.finger.fixed.box", "",
     "lower corner first: 0.015 > 0.005 m along x", "swap"},
    {"[0, 1 mm, 1 mm]]", "[0, 0, 0]]", 28, "solids.block.fixed.1.box", "", "must not be empty", "enlarge"},
    {"fixed: {box:", "fixed: {bax:", 20, "solids.finger.fixed.bax", "", "is not a key of a region",
     "did you mean `box`?"},
    {"        in: world\n", "        in: wrld\n", 27, "solids.block.fixed.0.in", "wrld", "must be one of object, world",
     "did you mean `world`?"},
    {"sections: 15", "sections: 0", 37, "rods.cable.sections", "0", "must be at least 1", "sections: 15"},
    {"sections: 15", "sections: 99999999999999", 37, "rods.cable.sections", "", "must be at most 10000", "15"},
    {"sections: [0, 4 cm, 10 cm]", "sections: [0, 4 cm, 3 cm]", 44, "rods.thread.sections.2", "3 cm",
     "must be greater than the value before it", "ascending"},
    {"sections: [0, 4 cm, 10 cm]", "sections: [1 cm, 4 cm]", 44, "rods.thread.sections.0", "1 cm", "must be 0", "0"},
    {"strains: [bending_y, torsion", "strains: [bending_z, torsion", 38, "rods.cable.strains.2", "bending_z",
     "listed twice", "keep one"},
    {"strains: [bending_y", "strains: [bendingy", 38, "rods.cable.strains.0", "bendingy",
     "must be one of torsion, bending_y", "did you mean `bending_y`?"},
    {"strains: [bending_y, torsion, bending_z]", "strains: []", 38, "rods.cable.strains", "[]", "at least 1",
     "strains:"},
    {"    section: {circle: {radius: 0.5 mm}}\n", "", 30, "rods.cable.section", "", "is missing", "radius: 0.5 mm"},
    {"cable: geometric", "cable: cosserat", 41, "rods.thread.section", "", "is missing", "or write `cable: geometric`"},
    {"points: 15", "points: 0", 46, "couplings.0.slide.points", "0", "must be at least 1", "points: 15"},
    {"points: [0, 30 mm]", "points: [-1 mm]", 47, "couplings.1.slide.points.0", "-1 mm", "must be at least 0 m", ""},
    {"points: [0, 30 mm]", "points: []", 47, "couplings.1.slide.points", "[]", "at least 1, not 0", "15"},
    {"reach: 2 mm", "reach: -2 mm", 46, "couplings.0.slide.reach", "-2 mm", "must be at least 0 m", "2 mm"},
    // Over time.
    {"values: [0, 20 mm]", "values: [0]", 49, "actuators.pull.displacement.values", "[0]",
     "must have one entry per time, 2, not 1", "one entry for each"},
    {"displacement: {times: [0, 1]", "displacement: {times: [1, 1]", 49, "actuators.pull.displacement.times.1", "1",
     "must be greater than the value before it", "ascending"},
    {"displacement: {times", "force: {times", 49, "actuators.pull.force.values.1", "20 mm", "must be a force", "N"},
    {"motion: translation, displacement", "motion: rotation, displacement", 49, "actuators.pull.motion", "rotation",
     "must be translation for displacement", "leave it out"},
    {"angle: 90 deg", "motion: translation, angle: 90 deg", 50, "actuators.twist.motion", "translation",
     "must be rotation for angle", "rotation"},
    {"angle: 90 deg", "angle: 90 deg, torque: 1", 50, "actuators.twist.angle", "", "together with torque",
     "remove one"},
    {", angle: 90 deg", "", 50, "actuators.twist.force", "", "exactly one of force, displacement, torque, angle",
     "3 N"},
    {"force: external", "force: extern", 51, "actuators.motor.force", "extern",
     "must be a force, {times, values}, {formula}, {file, column}, `inverse` or `external`", "`external`?"},
    {"rotate: [[0, 0, 0], [0, 0, 0.5]]", "rotate: [[0, 0, 0]]", 10, "frames.hand.motion.rotate", "",
     "must have one entry per time, 2, not 1", "one entry for each"},
    {", rotate: [[0, 0, 0], [0, 0, 0.5]], translate: [[0, 0, 0], [0, 20 mm, 0]]", "", 10,
     "frames.hand.motion.translate", "", "needs rotate, translate or both", "add one"},
    {"rotate: [0, 0, 90 deg]", "rotate: [0, 0, 90]", 9, "frames.hand.pose.rotate.2", "90", "must be within one turn",
     "90 deg"},
    // Names.
    {"slide: {rod: cable", "slide: {rod: cabel", 46, "couplings.0.slide.rod", "cabel", "is not a rod of this scene",
     "did you mean `cable`?"},
    {"solid: block", "solid: brick", 47, "couplings.1.slide.solid", "brick", "is not a solid of this scene",
     "the solids are finger, block"},
    {"    frame: hand\n    material", "    frame: arm\n    material", 16, "solids.finger.frame", "arm",
     "is not a frame of this scene", "the frames are hand"},
    {"twist: {rod: cable", "twist: {rod: finger", 50, "actuators.twist.rod", "finger", "is not a rod", "cable, thread"},
    {"tip: {solid: finger", "tip: {solid: fingr", 54, "outputs.tip.solid", "fingr", "is not a solid", "`finger`"},
    {"end: {rod: cable", "end: {rod: able", 55, "outputs.end.rod", "able", "is not a rod", "did you mean `cable`?"},
    {"  end: {rod", "  pull: {rod", 55, "outputs.pull", "", "is the name of an actuator", "rename"},
    {"  thread:", "  block:", 41, "rods.block", "", "is the name of a solid", "rename"},
    {"at: 100 mm", "at: top", 55, "outputs.end.at", "top", "must be a length", "in m"},
    {"end: {rod: cable, at: 100 mm}", "end: {}", 55, "outputs.end.solid", "", "exactly one of solid, rod", "finger"},
    {"point: [100 mm, 5 mm, 7 mm], ", "", 54, "outputs.tip.solid", "", "is given without `point`", "add `point`"},
    // Structure.
    {"couplings:\n  - slide: {rod: cable, solid: finger, points: 15, anchor_tip: position, reach: 2 mm}\n"
     "  - slide: {rod: thread, solid: block, points: [0, 30 mm], anchor_tip: none, friction: 0.1}\n",
     "couplings: 3\n", 45, "couplings", "3", "must be a list of couplings", "slide"},
    {"view: {interval: 20 ms}", "view: 20 ms", 6, "view", "20 ms", "must be a map with the keys interval", "interval"},
    {"gravity: [0, -9.81, 0]", "gravity: &g [0, -9.81, 0]", 4, "", "&g", "anchors and aliases", "write the value out"},
    {"gravity: [0, -9.81, 0]", "gravity: [0, -9.81, 0", 5, "", "", "is not valid YAML", "brackets"},
    {"title: A finger pulled by one cable", "title: \"\\e[31m\"", 2, "title", "?[31m", "control characters", "title:"},
};

TEST(BrokenScene, IsRefusedWithLineFieldRuleAndRemedy) {
  EXPECT_GE(kBroken.size(), 40u);
  for (const Broken& broken : kBroken) expect_refused(full_scene, broken);
}

TEST(BrokenScene, WithoutBodiesOrWithoutAMapIsRefused) {
  for (const char* text : {"title: nothing\n", "solids: {}\nrods: {}\n", "hello\n", "[1, 2]\n", "{}\n", "rods:\n"}) {
    try {
      parse_scene(text, "a.yaml", "");
      ADD_FAILURE() << "accepted " << text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.fault().line, 1) << error.what();
      EXPECT_FALSE(error.fault().remedy.empty()) << error.what();
    }
  }
}

TEST(BrokenScene, ReadsAsOneSentenceAndOneHint) {
  try {
    std::string text = full_scene;
    text.replace(text.find("poisson: 0.45"), 13, "poisson: 0.5");
    parse_scene(text, "finger.yaml", "");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "finger.yaml:17: solids.finger.material.poisson = 0.5: must be below 0.5 in a solid\n"
                 "    use 0.49 for a nearly incompressible silicone");
  }
}

}  // namespace
}  // namespace sinew::io
