// What a user reads when a rod of a scene file, or what acts on it, is wrong.
#include "broken_scene.hpp"
#include "full_scene.hpp"

namespace sinew::io {
namespace {

/// Breaks of `rods_scene`.
const std::vector<Broken> kBrokenRods = {
    // What is computed.
    {"analysis: static", "analysis: statics", 2, "analysis", "statics",
     "must be one of dynamic, quasi_static, static, modal", "did you mean `static`?"},
    {"modes: 4", "modes: 0", 3, "modes", "0", "must be at least 1", "`modes: 6`"},
    // Discretisation.
    {"order: 2", "order: 6", 32, "rods.tube.order", "6", "must be at most 5", "order"},
    {"order: 2", "order: [1, 2]", 32, "rods.tube.order", "[1, 2]", "must be a whole number, or a map", "torsion: 1"},
    {"order: 2", "order: {}", 32, "rods.tube.order.torsion", "", "at least one of torsion, bending_y", "add one"},
    {"order: 2", "order: {torsion: 1, shear_y: 1}", 32, "rods.tube.order.shear_y", "",
     "is the order of a strain that does not vary", "add shear_y to `strains`"},
    {"shear_y: 5, shear_z: 0}", "shear_x: 5}", 10, "rods.spine.order.shear_x", "", "is not a key of an order",
     "did you mean `shear_y`?"},
    {"elongation: 4,", "elongation: 7,", 10, "rods.spine.order.elongation", "7", "must be at most 5", "order"},
    // Rest shape and start.
    {"rest: straight", "rest: strait", 33, "rods.tube.rest", "strait", "must be one of path, straight",
     "did you mean `straight`?"},
    {"rest: straight", "rest: [straight]", 33, "rods.tube.rest", "[straight]", "path, straight or a map", "bending_z"},
    {"rest: {bending_z: 20 1/m}", "rest: {bending_z: 20 mm}", 40, "rods.blade.rest.bending_z", "20 mm",
     "must be a curvature, but 'mm' is a unit of a length", "1/m, 1/cm, 1/mm"},
    {"rest: {bending_z: 20 1/m}", "rest: {bending_z: [20 1/m, 0]}", 40, "rods.blade.rest.bending_z", "[20 1/m, 0]",
     "is a list without the abscissae", "add `at: [...]`"},
    {"rest: {bending_z: 20 1/m}", "rest: {at: [0, 1]}", 40, "rods.blade.rest.torsion", "", "at least one of torsion",
     "torsion: 20 1/m"},
    {"bending_y: [1, 2]", "bending_y: [1, 2, 3]", 14, "rods.spine.rest.bending_y", "[1, 2, 3]",
     "must have one value per abscissa, 2, not 3", "for each of `at`"},
    {"      at: [0, 50 mm]", "      at: [50 mm, 0]", 12, "rods.spine.rest.at.1", "0",
     "must be greater than the value before it", "ascending"},
    {"elongation: [0, 0.1]", "elongation: [0, -1]", 16, "rods.spine.rest.elongation.1", "-1", "must be greater than -1",
     "0.01"},
    {"start: rest", "start: straight", 34, "rods.tube.start", "straight", "must be one of path, rest", "start: rest"},
    // Base.
    {"base: free", "base: fre", 35, "rods.tube.base", "fre", "must be clamped, free or a list", "did you mean `free`?"},
    {"base: [turn_z, x]", "base: [turn_z, trun_x]", 20, "rods.spine.base.1", "trun_x", "must be one of x, y, z, turn_x",
     "did you mean `turn_x`?"},
    {"base: [turn_z, x]", "base: [x, turn_z, x]", 20, "rods.spine.base.2", "x", "is listed twice", "keep one"},
    // Sections and materials.
    {"section: {tube: {outer: 5 mm, inner: 4 mm}}", "section: {tub: {outer: 5 mm, inner: 4 mm}}", 36,
     "rods.tube.section.tub", "", "is not a key of a section",
     "did you mean `tube`? known here: circle, tube, ellipse, rectangle, stiffness"},
    {"outer: 5 mm, inner: 4 mm}}", "outer: 5 mm, inner: 4 mm}, circle: {radius: 1 mm}}", 36, "rods.tube.section.tube",
     "", "cannot be given together with circle: exactly one of circle, tube", "remove one of circle and tube"},
    {"section: {tube: {outer: 5 mm, inner: 4 mm}}", "section: {}", 36, "rods.tube.section.circle", "",
     "exactly one of circle, tube, ellipse, rectangle, stiffness", "radius: 0.5 mm"},
    {"outer: 5 mm, inner: 4 mm", "outer: 5 mm, inner: 5 mm", 36, "rods.tube.section.tube.inner", "5 mm",
     "must be smaller than `outer`, but at the start it is 0.005 m and outer 0.005 m", "circle"},
    {"inner: 3 mm", "inner: [3 mm, 4.5 mm]", 24, "rods.spine.parts.1.section.tube.inner", "[3 mm, 4.5 mm]",
     "must be smaller than `outer`, but at the end it is 0.0045 m and outer 0.004 m", "wall"},
    {"radius: [2 mm, 1 mm]", "radius: [2 mm, 1 mm, 1 mm]", 22, "rods.spine.parts.0.section.circle.radius",
     "[2 mm, 1 mm, 1 mm]", "[start, end], 2 of them, not 3", "0.5 mm"},
    {"radius: [2 mm, 1 mm]", "radius: [2 mm, 0]", 22, "rods.spine.parts.0.section.circle.radius.1", "0",
     "must be greater than 0 m", "0.5 mm"},
    {"y: [2 mm, 1 mm], z: 1 mm", "y: {start: 1 mm}, z: 1 mm", 47, "rods.oval.section.ellipse.y", "{start: 1 mm}",
     "must be a length, or a pair [start, end]", "2 mm"},
    {"y: 4 mm, z: 2 mm", "y: 4 mm, x: 2 mm", 42, "rods.blade.section.rectangle.x", "", "is not a key of a rectangle",
     "known here: y, z"},
    {"viscosity: 2,", "viscosity: 2 Pa,", 37, "rods.tube.material.viscosity", "2 Pa",
     "must be a viscosity, but 'Pa' is a unit of a pressure", "mPa s, Pa s, kPa s"},
    {"damping: 1 s", "damping: -1 s", 37, "rods.tube.material.damping", "-1 s", "must be at least 0 s", "10 ms"},
    {"    section: {rectangle: {y: 4 mm, z: 2 mm}}\n    material: {young: 1 MPa, poisson: 0.4, density: 1100}\n",
     "    section: {rectangle: {y: 4 mm, z: 2 mm}}\n", 38, "rods.blade.material", "", "is missing",
     "add it: `material` is what it is made of"},
    {"poisson: 0.4, density: 1100, viscosity: 2", "poisson: 0.4, viscosity: 2", 37, "rods.tube.material.density", "",
     "is missing", "massless"},
    {"          - [1, 0, 0, 0, 0, 0]\n", "", 53, "rods.given.section.stiffness.matrix", "", "6 of them, not 5",
     "its diagonal or its six rows"},
    {"[0, 1, 3, 0, 0, 10]", "[0, 1, 3, 0, 10]", 56, "rods.given.section.stiffness.matrix.2", "[0, 1, 3, 0, 10]",
     "must be a list of numbers, a row, 6 of them, not 5", "rows"},
    {"[0, 1, 3, 0, 0, 10]", "[0, 1.1, 3, 0, 0, 10]", 56, "rods.given.section.stiffness.matrix.2.1", "1.1",
     "must be the same as entry 2 of row 1, 1", "same value"},
    {"[0, 2, 1, 0, 0, 0]", "[0, -2, 1, 0, 0, 0]", 55, "rods.given.section.stiffness.matrix.1.1", "-2",
     "must be greater than 0: it is on the diagonal", "[4e-4"},
    {"- [0, 2, 1, 0, 0, 0]\n          - [0, 1, 3, 0, 0, 10]", "- [0, 2, 3, 0, 0, 0]\n          - [0, 3, 3, 0, 0, 10]",
     53, "rods.given.section.stiffness.matrix", "", "must be positive definite", "check their signs"},
    {"matrix: [1, 2, 3, 4e3, 5e3, 6e3]", "matrix: [1, 2, 3, 4e3, 0, 6e3]", 29,
     "rods.spine.parts.4.section.stiffness.matrix.4", "0", "must be greater than 0", "matrix"},
    {"matrix: [1, 2, 3, 4e3, 5e3, 6e3]", "matrix: 5", 29, "rods.spine.parts.4.section.stiffness.matrix", "5",
     "6 numbers, the diagonal, or of 6 rows", "matrix"},
    {"material: {damping: 20 ms}", "material: {young: 1 GPa, damping: 20 ms}", 62, "rods.given.material.young", "",
     "has no meaning beside a given stiffness", "remove it: `matrix` and `line_density` say all"},
    {"line_density: 0.1 kg/m", "line_density: 0.1 kg/m^3", 60, "rods.given.section.stiffness.line_density",
     "0.1 kg/m^3", "must be a line density, but 'kg/m^3' is a unit of a density", "g/m, kg/m"},
    // Parts.
    {"to: 60 mm", "to: 40 mm", 26, "rods.spine.parts.2.to", "40 mm",
     "must be beyond the end of the part before it, 0.04", "from base to tip"},
    {"      - to: 40 mm\n        section:", "      - section:", 23, "rods.spine.parts.1.to", "", "is missing",
     "the rod's length"},
    {"    parts:\n", "    section: {circle: {radius: 1 mm}}\n    parts:\n", 21, "rods.spine.section", "",
     "cannot be given together with parts", "remove one of parts and section"},
    {"section: {ellipse: {y: 2 mm, z: 1 mm}}, material: {young: 3 MPa, poisson: 0.4, density: 1}",
     "section: {ellipse: {y: 2 mm, z: 1 mm}}", 26, "rods.spine.parts.2.material", "", "is missing", "young: 5 GPa"},
    // Couplings.
    {"- tie: {rod: oval}", "- tye: {rod: oval}", 68, "couplings.4.tye", "", "is not a key of a coupling",
     "did you mean `tie`? known here: slide, tie"},
    {"- tie: {rod: oval}", "- pin: {rod: oval}", 68, "couplings.4.pin", "", "is not a key of a coupling",
     "known here: slide, tie"},
    {"- tie: {rod: oval}", "- {tie: {rod: oval}, slide: {rod: oval, solid: finger}}", 68, "couplings.4.tie", "",
     "cannot be given together with slide: exactly one of slide, tie, glue is needed", "remove one of slide and tie"},
    {"- tie: {rod: oval}", "- {}", 68, "couplings.4.slide", "", "is missing: exactly one of slide, tie", "add one"},
    {"- tie: {rod: oval}", "- oval", 68, "couplings.4", "oval", "must be a map with the keys slide, tie, glue",
     "couplings"},
    {"channel: [[", "points: 3, channel: [[", 64, "couplings.0.slide.channel", "",
     "cannot be given together with points: at most one of points, channel", "remove one of points and channel"},
    {"channel: [[1 mm, 2 mm, 3 mm], [4 mm, 5 mm, 6 mm]]", "channel: [[1 mm, 2 mm, 3 mm], [1 mm, 2 mm, 3 mm]]", 64,
     "couplings.0.slide.channel.1", "", "is the same point as the one before it", "remove one"},
    {"anchor_tip: pose", "anchor_tip: poes", 64, "couplings.0.slide.anchor_tip", "poes",
     "must be one of none, position, pose", "did you mean `pose`?"},
    {"frame: hand, along", "frame: hand, solid: finger, along", 65, "couplings.1.tie.solid", "",
     "cannot be given together with frame: at most one of frame, solid, body, other", "remove one of frame and solid"},
    {"along: [z, x], about: [y]", "along: [z, w], about: [y]", 65, "couplings.1.tie.along.1", "w",
     "must be one of x, y, z", "along: [x, y, z]"},
    {"along: [], about: [x, y, z]", "along: [], about: []", 66, "couplings.2.tie.along", "[]",
     "must not be empty: the tie would hold nothing", "`about`"},
    {"other: blade, other_at: 20 mm", "other_at: 20 mm", 67, "couplings.3.tie.other_at", "", "is given without `other`",
     "add `other`"},
    {"other: blade, other_at: 20 mm", "other: tube, other_at: 10 mm", 67, "couplings.3.tie.other", "tube",
     "is the very point that is tied", "another rod"},
    {"solid: finger, along: []", "frame: hand, along: []", 66, "couplings.2.tie.reach", "", "is given without `solid`",
     "add `solid`"},
    // Names of other objects.
    {"other: blade", "other: blad", 67, "couplings.3.tie.other", "blad", "is not a rod of this scene",
     "did you mean `blade`? the rods are spine, tube, blade, oval, given"},
    {"frame: hand, along", "frame: arm, along", 65, "couplings.1.tie.frame", "arm", "is not a frame of this scene",
     "the frames are hand"},
    {"rod: tube, solid: finger, along", "rod: tube, solid: tube, along", 66, "couplings.2.tie.solid", "tube",
     "is not a solid of this scene", "the solids are finger"},
    {"frames: {hand: {pose: {translate: [0, 1 cm, 0]}}}\n", "title: x\n", 65, "couplings.1.tie.frame", "hand",
     "is not a frame of this scene", "the scene has no frames; describe it under `frames:`"},
    {"lift: {rod: blade", "lift: {rod: blad", 70, "actuators.lift.rod", "blad", "is not a rod of this scene",
     "did you mean `blade`?"},
    {"weight: {rod: spine", "weight: {rod: finger", 79, "loads.weight.rod", "finger", "is not a rod of this scene",
     "the rods are spine"},
    {"root: {rod: spine", "root: {rod: [spine]", 91, "outputs.root.rod", "[spine]", "must be text", "cable"},
    // Actuators.
    {"axis: z", "axis: -x", 70, "actuators.lift.axis", "-x", "must be one of x, y, z, the positive axes",
     "leave `axis` out to pull along -x"},
    {"axis: z", "axis: 2", 70, "actuators.lift.axis", "2", "must be one of x, y, z", "axis: y"},
    {"tendon: {distance: 10 mm}, displacement", "axis: x, tendon: {distance: 10 mm}, displacement", 76,
     "actuators.reel.axis", "", "cannot be given together with tendon", "remove one of tendon and axis"},
    {"tendon: {distance: 10 mm}, displacement", "tendon: {distance: 10 mm}, motion: translation, displacement", 76,
     "actuators.reel.motion", "", "cannot be given together with tendon", "remove one of tendon and motion"},
    {"tendon: {distance: 10 mm}, displacement: 5 mm", "tendon: {distance: 10 mm}, angle: 5 deg", 76,
     "actuators.reel.angle", "", "cannot be given together with tendon", "remove one of tendon and angle"},
    {"axis: z, displacement: 1 mm", "tension: 1 N", 70, "actuators.lift.tension", "", "is given without `tendon`",
     "add `tendon`"},
    {"force: external", "force: external, tension: 1", 77, "actuators.hook.tension", "",
     "cannot be given together with force: exactly one of force, displacement, torque, angle, tension",
     "remove one of force and tension"},
    {"to: 90 mm, distance: [10 mm", "to: 10 mm, distance: [10 mm", 74, "actuators.wire.tendon.to", "10 mm",
     "must be beyond `from`, 0.01 m", "from the base"},
    {"distance: [10 mm, 5 mm]", "distance: [10 mm, -5 mm]", 74, "actuators.wire.tendon.distance.1", "-5 mm",
     "must be at least 0 m", "10 mm"},
    {"angle: [0 deg, 360 deg]", "angle: [0 deg, 360 mm]", 74, "actuators.wire.tendon.angle.1", "360 mm",
     "must be an angle, but 'mm' is a unit of a length", "deg"},
    {"tendon: {distance: 10 mm}, displacement", "tendon: {angle: 0}, displacement", 76,
     "actuators.reel.tendon.distance", "", "is missing", "centreline"},
    {"values: [0, 2 N]", "values: [0, 2 mm]", 75, "actuators.wire.tension.values.1", "2 mm", "must be a force", "mN"},
    // Loads.
    {"weight: {rod: spine, force: [0, 0, -1 N]}", "weight: {rod: spine}", 79, "loads.weight.force", "",
     "is missing: at least one of force, moment is needed", "force: [0, 0, -1 N]"},
    {"at: 50 mm, moment", "at: 50 mm, from: 0, to: 1 mm, moment", 87, "loads.screw.from", "",
     "cannot be given together with at", "remove one of at and from"},
    {"    to: 50 mm\n", "", 82, "loads.wind.from", "", "is given without `to`", "add `to`"},
    {"    to: 50 mm\n", "    to: 5 mm\n", 83, "loads.wind.to", "5 mm", "must be beyond `from`, 0.01 m", "base"},
    {"force: [0, 0, -1 N]", "force: [0, 0, -1 N/m]", 79, "loads.weight.force.2", "-1 N/m",
     "must be a force, but 'N/m' is a unit of a line load", "mN, N, kN"},
    {"force: [0, 2 N/m, 0]", "force: [0, 2 N, 0]", 84, "loads.wind.force.1", "2 N",
     "must be a line load, but 'N' is a unit of a force", "mN/m, N/m, kN/m"},
    {"moment: [1 N, 0, 0]", "moment: [1 N m, 0, 0]", 85, "loads.wind.moment.0", "1 N m",
     "must be a force, but 'N m' is a unit of a torque", "N"},
    {"follower: true", "follower: yes", 87, "loads.screw.follower", "yes", "must be true or false", "follower: true"},
    {"factor: external", "factor: extrenal", 87, "loads.screw.factor", "extrenal",
     "must be a number, {times, values}, {formula}, {file, column}, or `external`", "`external`?"},
    {"factor: -2.5", "factor: 2 N", 88, "loads.push.factor", "2 N", "must be a number, but 'N' is a unit", "plain"},
    {"  push: {rod: tube, force: [1, 0, 0], follower: false, factor: -2.5}", "  push: 3", 88, "loads.push", "3",
     "must be a map with the keys rod, at, from", "`loads` is forces and moments on rods, by name"},
    {"  push: {rod: tube, force: [1, 0, 0], follower: false, factor: -2.5}", "  weight_2:", 88, "loads.weight_2", "",
     "must be a map with the keys rod, at, from", "for example `loads: {weight:"},
    // Outputs.
    {"quantity: moment", "quantity: momet", 91, "outputs.root.quantity", "momet",
     "must be one of position, displacement, orientation, strain, force, moment, stress, reaction",
     "did you mean `moment`?"},
};

TEST(BrokenRods, AreRefusedWithLineFieldRuleAndRemedy) {
  EXPECT_GE(kBrokenRods.size(), 80u);
  for (const Broken& broken : kBrokenRods) expect_refused(rods_scene, broken);
}

/// What is close to these faults and right.
TEST(BrokenRods, AreNotSoundRods) {
  for (const char* assignment :
       {"rods.given={path: [[0, 0, 0], [1, 0, 0]], section: {stiffness: {matrix: [1, 1, 1, 1, 1, 1], line_density: 0, "
        "radius: 1}}}",
        "rods.given={path: [[0, 0, 0], [1, 0, 0]], cable: geometric, section: {circle: {radius: 1 mm}}}",
        "couplings.3.tie.other=tube", "couplings.1.tie.along=[]", "rods.tube.order={bending_y: 0}",
        "actuators.lift={rod: blade, axis: x, motion: rotation, torque: 1}",
        "loads.weight={rod: spine, moment: [0, 0, 1 N m]}",
        "outputs.tip={solid: finger, point: [0, 0, 0], quantity: position}"}) {
    try {
      parse_scene(rods_scene, "rods.yaml", "", {assignment});
    } catch (const InputError& error) {
      ADD_FAILURE() << assignment << ": " << error.what();
    }
  }
}

/// A wrong name among very many gets a message that one can read.
TEST(BrokenRods, ListOnlySomeOfManyNames) {
  std::string text = "rods:\n";
  for (int i = 0; i < 500; ++i) {
    text += "  rod_" + std::to_string(i) + ": {path: [[0, 0, 0], [1, 0, 0]], cable: geometric}\n";
  }
  try {
    parse_scene(text + "loads: {a: {rod: blade, force: [1, 0, 0]}}\n", "rods.yaml", "");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_LT(error.fault().remedy.size(), 200u);
    EXPECT_TRUE(error.fault().remedy.ends_with("rod_10, rod_11, ...")) << error.fault().remedy;
  }
}

}  // namespace
}  // namespace sinew::io
