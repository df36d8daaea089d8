// `sinew check` on broken scenes: exit code 2, quickly, with file, line, value, rule and remedy on stderr, and nothing
// else. Every row of the table is a test of its own.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <limits>
#include <ostream>
#include <random>
#include <sstream>

#include "finger_scene.hpp"
#include "run_program.hpp"

namespace sinew::test {
namespace {

/// What `sinew check` is run on; a row of the table breaks one thing of it.
struct Trial {
  std::string scene = finger_scene;
  std::string mesh = finger_mesh();
  Arguments arguments;               ///< after the name of the scene
  std::string given = "scene.yaml";  ///< the scene's name on the command line
};

struct Broken {
  std::string name;
  std::function<void(Trial&)> breaks;
  std::string where;  ///< the file at the start of the message, as in "scene.yaml" or "finger.vtk"
  int line;           ///< after it; 0: none, or not pinned
  std::string value;  ///< in the first line of the message
  std::string rule;   ///< in the first line of the message
  std::string remedy;
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.name; }

using Change = std::function<void(Trial&)>;

Change scene(const std::string& from, const std::string& to) {
  return [=](Trial& trial) { trial.scene = replaced(trial.scene, from, to); };
}

Change whole_scene(const std::string& text) {
  return [=](Trial& trial) { trial.scene = text; };
}

Change set(const std::string& assignment) {
  return [=](Trial& trial) { trial.arguments = {"--set", assignment}; };
}

Change mesh_line(const std::string& from, const std::string& to) {
  return [=](Trial& trial) { trial.mesh = replaced(trial.mesh, "\n" + from + "\n", "\n" + to + "\n"); };
}

template <class Number>
std::string big_endian(Number number) {
  auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if constexpr (std::endian::native == std::endian::little) std::reverse(raw.begin(), raw.end());
  return {raw.data(), raw.size()};
}

/// The same legacy VTK file with binary numbers. `first` replaces the first coordinate.
std::string binary_mesh(const std::string& text, double first = 0.0) {
  std::istringstream in(text);
  std::string line, word, bytes;
  std::getline(in, line);
  bytes = line + "\n";
  std::getline(in, line);
  bytes += line + "\nBINARY\nDATASET UNSTRUCTURED_GRID\n";
  std::size_t points = 0, cells = 0, size = 0;
  in >> word >> word >> word >> word >> points >> word;  // ASCII DATASET UNSTRUCTURED_GRID POINTS n double
  bytes += "POINTS " + std::to_string(points) + " double\n";
  for (std::size_t i = 0; i < 3 * points; ++i) {
    double x = 0.0;
    in >> x;
    bytes += big_endian(i == 0 && first != 0.0 ? first : x);
  }
  in >> word >> cells >> size;
  bytes += "\nCELLS " + std::to_string(cells) + " " + std::to_string(size) + "\n";
  for (std::size_t i = 0; i < size; ++i) {
    std::int32_t node = 0;
    in >> node;
    bytes += big_endian(node);
  }
  bytes += "\nCELL_TYPES " + std::to_string(cells) + "\n";
  for (std::size_t i = 0; i < cells; ++i) bytes += big_endian(std::int32_t{10});
  return bytes + "\n";
}

Change binary(const std::function<std::string(const std::string&)>& change) {
  return [=](Trial& trial) { trial.mesh = change(trial.mesh); };
}

std::string random_bytes(std::size_t size) {
  std::mt19937_64 random(7);
  std::string bytes;
  bytes.reserve(size + 8);
  while (bytes.size() < size) {
    const std::uint64_t next = random();
    for (int i = 0; i < 8; ++i) bytes += static_cast<char>(next >> (8 * i));
  }
  bytes.resize(size);
  return bytes;
}

constexpr std::size_t kTenMegabytes = 10 << 20;

/// Ten levels of ten aliases each: 10^10 words for a parser that follows them.
std::string alias_bomb() {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int level = 1; level < 10; ++level) {
    const std::string before = "*a" + std::to_string(level - 1), own = "a" + std::to_string(level);
    text += own + ": &" + own + " [" + before;
    for (int i = 0; i < 9; ++i) text += ", " + before;
    text += "]\n";
  }
  return text;
}

const std::string a_box = "fixed: {box: [[-1 mm, -8 mm, -8 mm], [1 mm, 8 mm, 8 mm]]}";
const std::string a_pull =
    "pull: {rod: cable, motion: translation, displacement: {times: [0 s, 1 s], values: [0 mm, 10 mm]}}";

const std::vector<Broken> kBroken = {
    // The mesh.
    {"MeshMissing", scene("finger.vtk", "nope.vtk"), "", 6, "nope.vtk", "does not exist", "relative to the scene file"},
    {"RodNothingHolds", whole_scene(R"(analysis: static
time: {step: 1, duration: 1}
gravity: [0, 0, -9.81]
rods:
  arm:
    path: [[0, 0, 0], [0.1, 0, 0]]
    base: [y]
    section: {circle: {radius: 1 mm}}
    material: {young: 1 MPa, poisson: 0.4, density: 1000}
)"),
     "scene.yaml", 7, "rods.arm.base", "at rest nothing resists motions of rods.arm (y)", "leave them out of `base`"},
    {"MeshIsAFolder", scene("meshes/finger.vtk", "meshes"), "", 6, "meshes", "is a folder", ".vtk, .vtu, .msh or .inp"},
    {"MeshEmpty", binary([](const std::string&) { return std::string(); }), "finger.vtk", 0, "", "is empty",
     "legacy VTK"},
    {"MeshOfAnotherKind", binary([](const std::string&) { return "ply\n"; }), "finger.vtk", 0, "\"ply\"",
     "must begin with", "Sinew reads legacy VTK"},
    {"MeshIsASurface", binary([](const std::string&) { return "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"; }), "", 6,
     "finger.vtk", "is a surface without elements", "Gmsh"},
    {"MeshIsHalfASurface", binary([](const std::string&) { return "solid stl\nfacet normal 0 0 1\n"; }), "finger.vtk",
     3, "end of file", "outer must follow", "cut short"},
    {"MeshBinaryCutInPoints", binary([](const std::string& mesh) { return binary_mesh(mesh).substr(0, 3000); }),
     "finger.vtk", 0, "852", "do not fit into the", "cut short"},
    {"MeshBinaryCutInCells", binary([](const std::string& mesh) { return binary_mesh(mesh).substr(0, 15000); }),
     "finger.vtk", 0, "4280", "do not fit into the", "cut short"},
    {"MeshBinaryCutInTypes",
     binary([](const std::string& mesh) { return binary_mesh(mesh).substr(0, binary_mesh(mesh).size() - 9); }),
     "finger.vtk", 0, "856", "do not fit into the", "cut short"},
    {"MeshTextCut", binary([](const std::string& mesh) { return mesh.substr(0, mesh.find("CELL_TYPES")); }),
     "finger.vtk", 0, "", "must have a section CELL_TYPES", "cut short"},
    {"MeshNotANumber", mesh_line("0 -7.5 -7.5", "0 nan -7.5"), "finger.vtk", 6, "nan", "must be finite",
     "program that wrote the mesh"},
    {"MeshBinaryNotANumber",
     binary([](const std::string& mesh) { return binary_mesh(mesh, std::numeric_limits<double>::quiet_NaN()); }),
     "finger.vtk", 0, "node 0", "must be finite", "program that wrote the mesh"},
    {"MeshBinaryInfinite",
     binary([](const std::string& mesh) { return binary_mesh(mesh, -std::numeric_limits<double>::infinity()); }),
     "finger.vtk", 0, "inf", "must be finite", "program that wrote the mesh"},
    {"TetrahedronInverted", mesh_line("4 269 205 43 106", "4 205 269 43 106"), "finger.vtk", 0, "tetrahedron 0",
     "must have a positive volume", "reorder the nodes"},
    {"TetrahedronFlat", mesh_line("4 269 205 43 106", "4 269 269 43 106"), "finger.vtk", 0, "node 269 twice",
     "cell 0 (0-based, counting used cells only), a 4-node tetrahedron, must all be different", "remove the cell"},
    {"TetrahedronOfMissingNode", mesh_line("4 269 205 43 106", "4 284 205 43 106"), "finger.vtk", 291, "284", "node",
     "numbered from 0"},
    {"MeshWithoutTetrahedra", binary([](const std::string&) {
       return "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n"
              "0 0 0 1 0 0 0 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n";
     }),
     "finger.vtk", 0, "1 triangle", "at least one tetrahedron with 4 or 10 nodes", "mesh the volume"},
    // Keys and structure.
    {"KeyUnknown", scene("scale: 0.001", "skale: 0.001"), "scene.yaml", 7, "solids.finger.skale",
     "is not a key of a solid", "did you mean `scale`?"},
    {"KeyMissing", scene("young: 600 kPa, ", ""), "scene.yaml", 8, "solids.finger.material.young", "is missing",
     "for example `young: 600 kPa`"},
    {"KeyTwice", scene("    scale: 0.001\n", "    scale: 0.001\n    scale: 1\n"), "scene.yaml", 8, "scale",
     "is given twice", "keep one of the two"},
    {"KeyWithoutValue", scene("scale: 0.001", "scale:"), "scene.yaml", 7, "solids.finger.scale", "has no value",
     "for example `scale: 0.001`"},
    {"ListTooShort", scene("[0, 0, -9.81]", "[0, -9.81]"), "scene.yaml", 3, "[0, -9.81]", "3 of them, not 2",
     "for example `gravity: [0, -9.81, 0]`"},
    {"Tab", scene("    mesh:", "\tmesh:"), "scene.yaml", 6, "tab", "", "indent"},
    {"BracketLeftOpen", scene("[0, 0, -9.81]", "[0, 0, -9.81"), "scene.yaml", 0, "", "is not valid YAML", "brackets"},
    {"QuoteLeftOpen", scene("title: Finger", "title: \"Finger"), "scene.yaml", 1, "", "a quote",
     "check indentation, colons, quotes"},
    {"NotUtf8", scene("Finger\n", "Fing\xE9r\n"), "scene.yaml", 1, "0xE9", "is not text in UTF-8", "saved as UTF-8"},
    {"FileEmpty", whole_scene(""), "scene.yaml", 0, "", "is empty", "describe a scene"},
    {"FileOfBlanks", whole_scene("  \n\n   \n"), "scene.yaml", 0, "", "is empty", "describe a scene"},
    {"FileOfAWord", whole_scene("finger\n"), "scene.yaml", 1, "finger", "must be a map", "begin with a line like"},
    {"FileOfGarbage", [](Trial& trial) { trial.scene = random_bytes(kTenMegabytes); }, "scene.yaml", 0, "",
     "is larger than 1 MiB", "give a YAML scene file"},
    {"FileOfSomeGarbage", [](Trial& trial) { trial.scene = random_bytes(1000000); }, "scene.yaml", 1, "byte 0x",
     "is not text in UTF-8", "give a YAML scene file"},
    {"FileOfBrackets", [](Trial& trial) { trial.scene.assign(kTenMegabytes, '['); }, "scene.yaml", 0, "",
     "is larger than 1 MiB", "give a YAML scene file"},
    {"FileOfSomeBrackets", [](Trial& trial) { trial.scene.assign(1000000, '['); }, "scene.yaml", 1, "", "", "bracket"},
    {"FileOfSomeNestedLists",
     [](Trial& trial) {
       trial.scene = "gravity: ";
       for (int i = 0; i < 300000; ++i) trial.scene += "[0,";
     },
     "scene.yaml", 1, "", "", "bracket"},
    {"AliasBomb", [](Trial& trial) { trial.scene += alias_bomb(); }, "scene.yaml", 25, "&a0",
     "anchors and aliases are not supported", "write the value out"},
    {"TwoScenes", [](Trial& trial) { trial.scene += "---\n" + finger_scene; }, "scene.yaml", 0, "",
     "more than one document", "keep one scene"},
    {"NothingInTheScene", whole_scene("time: {step: 10 ms}\n"), "scene.yaml", 1, "",
     "at least one solid, rod or rigid body", "`solids:`, `rods:` or `bodies:`"},
    // Numbers.
    {"UnitOfAnotherKind", scene("600 kPa", "600 mm"), "scene.yaml", 8, "600 mm",
     "must be a pressure, but 'mm' is a unit of a length", "Pa, kPa, MPa, GPa"},
    {"UnitUnknown", scene("600 kPa", "600 kpa"), "scene.yaml", 8, "600 kpa", "'kpa' is not a unit known here",
     "did you mean `kPa`?"},
    {"ModulusNegative", scene("600 kPa", "-600 kPa"), "scene.yaml", 8, "-600 kPa", "must be greater than 0 Pa",
     "for example `young: 600 kPa`"},
    {"ModulusNotANumber", scene("600 kPa", ".nan"), "scene.yaml", 8, "young = .nan", "must be a pressure",
     "write a plain number"},
    {"ModulusInfinite", scene("600 kPa", ".inf"), "scene.yaml", 8, "young = .inf", "must be a pressure",
     "write a plain number"},
    {"ModulusTooLarge", scene("600 kPa", "1e999"), "scene.yaml", 8, "young = 1e999", "is too large",
     "write a plain number"},
    {"PoissonOfHalfInSolid", scene("poisson: 0.45", "poisson: 0.5"), "scene.yaml", 8, "poisson = 0.5",
     "must be below 0.5 in a solid", "use 0.49"},
    {"PoissonAboveHalfInRod", scene("poisson: 0.4,", "poisson: 0.51,"), "scene.yaml", 18, "poisson = 0.51",
     "must be at most 0.5 in a rod", "use 0.5"},
    {"StepOfZero", scene("step: 10 ms", "step: 0"), "scene.yaml", 2, "time.step = 0", "must be greater than 0 s",
     "10 ms"},
    {"MoreStepsThanCanBeCounted", scene("duration: 200 ms", "duration: 1e300"), "scene.yaml", 2, "1e+300", "step",
     "step"},
    {"StepTooShortToCount", scene("step: 10 ms", "step: 1e-300"), "scene.yaml", 2, "1e-300", "step", "step"},
    {"AnalysisUnknown", scene("gravity:", "analysis: statik\ngravity:"), "scene.yaml", 3, "analysis = statik",
     "must be one of dynamic, quasi_static, static, modal", "did you mean `static`?"},
    // Solids.
    {"BoxWithoutNode", scene(a_box, "fixed: {box: [[1, 1, 1], [2, 2, 2]]}"), "scene.yaml", 11,
     "[1, 1, 1] .. [2, 2, 2] m", "no node of the mesh lies in this region",
     "the nodes span [0, -0.0075, -0.0075] .. [0.095, 0.0075, 0.0075] m"},
    {"BoxAroundAll", scene(a_box, "fixed: {box: [[-1, -1, -1], [1, 1, 1]]}"), "scene.yaml", 11, "all nodes",
     "some node must be free", "make the region smaller"},
    {"BoxUpsideDown", scene("[[-1 mm, -8 mm", "[[2 mm, -8 mm"), "scene.yaml", 11, "[[2 mm", "lower corner first",
     "swap"},
    {"MassAndDensity", scene("    density: 1070 kg/m^3\n", "    density: 1070 kg/m^3\n    mass: 75 g\n"), "scene.yaml",
     0, "density", "together with mass", "remove one"},
    {"NoMassAndNoDensity", scene("    density: 1070 kg/m^3\n", ""), "scene.yaml", 5, "", "exactly one of mass, density",
     "mass: 75 g"},
    {"FrameUnknown", scene("    scale: 0.001\n", "    scale: 0.001\n    frame: hand\n"), "scene.yaml", 8, "hand",
     "is not a frame of this scene", "describe it under `frames:`"},
    {"ScaleNextToNothing", scene("scale: 0.001", "scale: 1e-300"), "scene.yaml", 7, "1e-300", "", "scale"},
    {"ScaleBeyondAllBounds", scene("scale: 0.001", "scale: 1e200"), "scene.yaml", 7, "1e+200", "", "scale"},
    // Rods.
    {"NoSections", scene("sections: 6", "sections: 0"), "scene.yaml", 15, "sections = 0", "must be at least 1",
     "sections: 15"},
    {"SectionsNotToTheTip", scene("sections: 6", "sections: [0, 80 mm]"), "scene.yaml", 15, "0.08 m",
     "must run from 0 to the rod's length, 0.09 m", "list every section end"},
    {"PathOfOnePoint", scene(", [90 mm, 0 mm, 2 mm]]", "]"), "scene.yaml", 14, "[[0 mm, 0 mm, 2 mm]]",
     "at least 2, not 1", "for example `path:"},
    {"PathWithNotANumber", scene("[90 mm, 0 mm, 2 mm]", "[nan, 0 mm, 2 mm]"), "scene.yaml", 14, "nan",
     "must be a length", "um, mm, cm, m"},
    {"PathBeyondAllBounds", scene("[90 mm, 0 mm, 2 mm]", "[1e200, 0 mm, 2 mm]"), "scene.yaml", 14, "1e+200", "",
     "path"},
    {"StrainUnknown", scene("[torsion, bending_y", "[torsion, bendingy"), "scene.yaml", 16, "bendingy",
     "must be one of torsion", "did you mean `bending_y`?"},
    {"OrderOfAFixedStrain", scene("sections: 6", "sections: 6\n    order: {elongation: 1}"), "scene.yaml", 16,
     "rods.cable.order.elongation", "does not vary", "add elongation to `strains`"},
    {"RestWithoutAbscissae", scene("sections: 6", "sections: 6\n    rest: {bending_z: [0, 20 1/m]}"), "scene.yaml", 16,
     "[0, 20 1/m]", "without the abscissae", "add `at: [...]`"},
    {"BaseOfAnUnknownMotion", scene("sections: 6", "sections: 6\n    base: [trun_x]"), "scene.yaml", 16, "trun_x",
     "must be one of x, y, z, turn_x", "did you mean `turn_x`?"},
    {"SectionUnknown", scene("section: {circle:", "section: {cercle:"), "scene.yaml", 17, "cercle",
     "is not a key of a section", "did you mean `circle`? known here: circle, tube"},
    {"TubeInsideOut", scene("circle: {radius: 0.5 mm}", "tube: {outer: 1 mm, inner: [0.5 mm, 2 mm]}"), "scene.yaml", 17,
     "[0.5 mm, 2 mm]", "must be smaller than `outer`", "the two radii of the wall"},
    {"StiffnessNotSymmetric",
     scene("circle: {radius: 0.5 mm}}\n    material: {young: 5 GPa, poisson: 0.4, density: 1100 kg/m^3}",
           "stiffness: {matrix: [[1, 0, 0, 0, 0, 0], [0, 1, 0.5, 0, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], "
           "[0, 0, 0, 0, 1, 0], [0, 0, 0, 0, 0, 1]], line_density: 0, radius: 1 mm}}"),
     "scene.yaml", 17, "matrix.2.1 = 0", "must be the same as entry 2 of row 1, 0.5", "same value"},
    {"ViscosityOfAnotherUnit", scene("poisson: 0.4,", "poisson: 0.4, viscosity: 1 Pa,"), "scene.yaml", 18, "1 Pa",
     "must be a viscosity, but 'Pa' is a unit of a pressure", "mPa s, Pa s, kPa s"},
    {"PartsAndASection", scene("sections: 6", "sections: 6\n    parts: [{to: 90 mm}]"), "scene.yaml", 18,
     "rods.cable.section", "cannot be given together with parts", "remove one"},
    // Couplings.
    {"CableAwayFromTheBody", scene("[[0 mm, 0 mm, 2 mm], [90 mm, 0 mm, 2 mm]]", "[[0, 1 m, 0], [90 mm, 1 m, 0]]"),
     "scene.yaml", 20, "[0.029, 1, 0] m (world)", "outside solids.finger, beyond the reach of", "raise `reach`"},
    {"RodUnknown", scene("slide: {rod: cable", "slide: {rod: cabel"), "scene.yaml", 20, "cabel",
     "is not a rod of this scene", "did you mean `cable`?"},
    {"SolidUnknown", scene("rod: cable, solid: finger, points", "rod: cable, solid: thumb, points"), "scene.yaml", 20,
     "thumb", "is not a solid of this scene", "the solids are finger"},
    {"AnchorNotAtTheTip", scene("57 mm, 90 mm]", "57 mm, 80 mm]"), "scene.yaml", 20, "0.08 m",
     "must be the rod's length, 0.09 m", "anchor_tip: none"},
    {"PointOffTheRod", scene("57 mm, 90 mm], anchor_tip: position", "57 mm, 95 mm], anchor_tip: none"), "scene.yaml",
     20, "0.095 m", "must lie on the rod, from 0 to 0.09 m", "measure along the rod"},
    {"NoPoints", scene("points: [29 mm, 57 mm, 90 mm]", "points: 0"), "scene.yaml", 20, "points = 0",
     "must be at least 1", "for example `points: 15`"},
    {"CouplingOfUnknownKind", scene("- slide:", "- slyde:"), "scene.yaml", 20, "slyde", "is not a key of a coupling",
     "did you mean `slide`? known here: slide, tie"},
    {"CouplingOfTwoKinds",
     scene("actuators:\n", "  - {slide: {rod: cable, solid: finger}, tie: {rod: cable}}\nactuators:\n"), "scene.yaml",
     21, "couplings.1.tie", "exactly one of slide, tie", "remove one of slide and tie"},
    {"PointsAndChannel", scene("points: [29 mm", "channel: [[29 mm, 0, 0]], points: [29 mm"), "scene.yaml", 20,
     "channel", "cannot be given together with points", "remove one of points and channel"},
    {"TieToAnUnknownRod", scene("actuators:\n", "  - tie: {rod: cable, other: spine}\nactuators:\n"), "scene.yaml", 21,
     "spine", "is not a rod of this scene", "the rods are cable"},
    {"TieToTwoThings", scene("actuators:\n", "  - tie: {rod: cable, other: cable, solid: finger}\nactuators:\n"),
     "scene.yaml", 21, "couplings.1.tie.other", "at most one of frame, solid, body, other",
     "remove one of solid and other"},
    {"TieThatHoldsNothing", scene("actuators:\n", "  - tie: {rod: cable, along: []}\nactuators:\n"), "scene.yaml", 21,
     "[]", "the tie would hold nothing", "`about`"},
    {"FrictionBelowZero", scene("anchor_tip: position", "friction: -0.1, anchor_tip: position"), "scene.yaml", 20,
     "-0.1", "must be at least 0", "friction: 0.1"},
    // Bodies and contact.
    {"BodyWithoutAShape", scene("outputs:\n", "bodies: {cube: {mass: 30 g}}\noutputs:\n"), "scene.yaml", 23, "",
     "exactly one of box, sphere, cylinder, capsule", "box"},
    {"BodyOfTwoShapes",
     scene("outputs:\n", "bodies: {cube: {mass: 30 g, sphere: {radius: 1}, box: {size: [1, 1, 1]}}}\noutputs:\n"),
     "scene.yaml", 23, "", "exactly one of box, sphere", "remove one"},
    {"BodyWithoutMass", scene("outputs:\n", "bodies: {cube: {box: {size: [1, 1, 1]}}}\noutputs:\n"), "scene.yaml", 23,
     "", "exactly one of mass, density", "mass: 30 g"},
    {"BoxThatIsFlat", scene("outputs:\n", "bodies: {cube: {mass: 1, box: {size: [1, 0, 1]}}}\noutputs:\n"),
     "scene.yaml", 23, "", "must be greater than 0", "size"},
    {"PlaneThatMoves", scene("outputs:\n", "bodies: {floor: {mass: 1, plane: {normal: [0, 0, 1]}}}\noutputs:\n"),
     "scene.yaml", 23, "plane", "is not a key of a rigid body", "known here"},
    {"PlaneWithoutADirection", scene("outputs:\n", "obstacles: {floor: {plane: {normal: [0, 0, 0]}}}\noutputs:\n"),
     "scene.yaml", 23, "[0, 0, 0]", "must not be zero", "normal"},
    {"ContactOfNobody", scene("outputs:\n", "contact: {pairs: [{between: [finger, flor]}]}\noutputs:\n"), "scene.yaml",
     23, "flor", "nothing of this name can be touched", "finger"},
    {"ContactOfThree", scene("outputs:\n", "contact: {pairs: [{between: [a, b, c]}]}\noutputs:\n"), "scene.yaml", 23,
     "", "not 3", "between"},
    {"BounceHigherThanTheFall", scene("outputs:\n", "contact: {restitution: 1.2}\noutputs:\n"), "scene.yaml", 23, "1.2",
     "must be", "restitution: 0.3"},
    {"ContactWithoutMotion",
     scene("outputs:\n", "analysis: static\nobstacles: {floor: {plane: {normal: [0, 0, 1]}}}\noutputs:\n"),
     "scene.yaml", 0, "", "in dynamic and quasi-static scenes alone", "analysis: dynamic"},
    // Actuators and outputs.
    {"TimesNotAscending", scene("times: [0 s, 1 s]", "times: [1 s, 0 s]"), "scene.yaml", 22, "times.1 = 0 s",
     "must be greater than the value before it", "ascending"},
    {"ValuesNotOnePerTime", scene("values: [0 mm, 10 mm]", "values: [0 mm]"), "scene.yaml", 22, "[0 mm]",
     "one entry per time, 2, not 1", "one entry for each"},
    {"TwoActuatorsOfOneMotion", scene(a_pull, a_pull + "\n  push: {rod: cable, force: 1 N}"), "scene.yaml", 23, "push",
     "already has an actuator of this motion", "drive each motion of a base once"},
    {"AxisNegative", scene("motion: translation,", "motion: translation, axis: -x,"), "scene.yaml", 22, "-x",
     "must be one of x, y, z, the positive axes", "leave `axis` out to pull along -x"},
    {"TendonWithAnAxis", scene("motion: translation,", "axis: x, tendon: {distance: 1 mm},"), "scene.yaml", 22, "axis",
     "cannot be given together with tendon", "remove one of tendon and axis"},
    {"TensionWithoutATendon", scene("outputs:\n", "  tighten: {rod: cable, tension: 1 N}\noutputs:\n"), "scene.yaml",
     23, "tension", "is given without `tendon`", "add `tendon`"},
    {"LoadOfNothing", scene("outputs:\n", "loads: {weight: {rod: cable}}\noutputs:\n"), "scene.yaml", 23,
     "loads.weight.force", "at least one of force, moment", "force: [0, 0, -1 N]"},
    {"LoadOnAnUnknownRod", scene("outputs:\n", "loads: {weight: {rod: cabel, force: [0, 0, 1]}}\noutputs:\n"),
     "scene.yaml", 23, "cabel", "is not a rod of this scene", "did you mean `cable`?"},
    {"LoadPerLengthWithoutALength",
     scene("outputs:\n", "loads: {weight: {rod: cable, force: [0, 0, 1 N/m]}}\noutputs:\n"), "scene.yaml", 23, "1 N/m",
     "must be a force, but 'N/m' is a unit of a line load", "mN, N, kN"},
    {"ForceInASolid", scene("point: [95 mm, 0 mm, 0 mm]", "point: [95 mm, 0 mm, 0 mm], quantity: force"), "scene.yaml",
     24, "outputs.tip.quantity", "is not known of solids", "`reaction`"},
    {"QuantityOfAPair", scene("outputs:\n", "outputs:\n  both: {between: [finger, cable], quantity: orientation}\n"),
     "scene.yaml", 24, "outputs.both.quantity", "", "remove"},
    {"OutputFarFromTheBody", scene("point: [95 mm, 0 mm, 0 mm]", "point: [95, 0, 0]"), "scene.yaml", 24, "[95, 0, 0] m",
     "outside solids.finger, beyond the reach of", "raise `reach`"},
    // The command line.
    {"SetOfUnknownSolid", set("solids.fingr.scale=1"), "--set", 0, "solids.fingr", "does not exist in this scene",
     "did you mean `finger`?"},
    {"SetOfUnknownLoad", set("loads.weight.factor=2"), "--set", 0, "loads.weight", "does not exist in this scene",
     "loads is empty"},
    {"SetOfUnknownKey", set("solids.finger.skale=1"), "--set", 0, "solids.finger.skale", "is not a key of a solid",
     "did you mean `scale`?"},
    {"SetWithoutValue", set("time.step"), "--set", 0, "time.step", "must be path=value", "for example"},
    {"SetBeyondTheList", set("couplings.3.slide.points=5"), "--set", 0, "couplings", "has no element '3'",
     "elements 0 to 0"},
    {"SetBelowAValue", set("time.step.size=5"), "--set", 0, "time.step.size", "is a single value", "time.step="},
    {"SetOfBadValue", set("solids.finger.material.young=-5 kPa"), "--set", 0, "-5 kPa", "must be greater than 0 Pa",
     "600 kPa"},
    {"SceneMissing", [](Trial& trial) { trial.given = "nope.yaml"; }, "nope.yaml", 0, "", "does not exist",
     "check the path"},
    {"SceneIsAFolder", [](Trial& trial) { trial.given = "meshes"; }, "meshes", 0, "", "is a folder", "scene file"},
    {"SceneIsAMesh", [](Trial& trial) { trial.given = "meshes/finger.vtk"; }, "finger.vtk", 0, "", "must be a map",
     "begin with a line like"},
};

class BrokenScene : public testing::TestWithParam<Broken> {};

/// Only characters that a terminal shows.
bool printable(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == '\n' || (byte >= 0x20 && byte != 0x7F);
  });
}

TEST_P(BrokenScene, IsRefusedWithFileLineValueRuleAndRemedy) {
  const Broken& broken = GetParam();
  Trial trial;
  broken.breaks(trial);
  const Folder folder;
  write_file(folder / "scene.yaml", trial.scene);
  write_file(folder / "meshes/finger.vtk", trial.mesh);

  Arguments arguments = {"check", (folder / trial.given).string()};
  arguments.insert(arguments.end(), trial.arguments.begin(), trial.arguments.end());
  const Finished done = sinew(arguments, folder.path(), 10.0);

  SCOPED_TRACE(said(done));
  ASSERT_FALSE(done.timed_out);
  ASSERT_FALSE(crashed(done));
  EXPECT_EQ(done.code, 2);
  EXPECT_EQ(done.out, "");
  EXPECT_LT(done.err.size(), 2000u) << "nobody reads so much";
  EXPECT_TRUE(printable(done.err));

  const std::vector<std::string> lines = lines_of(done.err);
  ASSERT_EQ(lines.size(), 2u) << "one line for the fault, one for the remedy";
  // The file first; a fault of a scene that is not in the scene's text (a mesh, an override) names its own place.
  const std::string where = broken.where.empty() ? "scene.yaml" : broken.where;
  const std::string place = where + (broken.line > 0 ? ":" + std::to_string(broken.line) + ":" : ":");
  const std::size_t found = lines[0].find(broken.line > 0 ? place : where);
  EXPECT_NE(found, std::string::npos) << "place: " << place;
  if (found != std::string::npos && where != "--set") {
    EXPECT_EQ(lines[0].substr(0, found).find(": "), std::string::npos) << "the place comes first: " << place;
  }
  const std::string after = found == std::string::npos ? lines[0] : lines[0].substr(found + where.size());
  EXPECT_NE(after.find(broken.rule), std::string::npos) << "rule: " << broken.rule;
  EXPECT_NE(broken.where.empty() ? lines[0].find(broken.value) : after.find(broken.value), std::string::npos)
      << "value: " << broken.value;
  EXPECT_EQ(lines[1].substr(0, 4), "    ") << "the remedy is indented";
  EXPECT_GT(lines[1].size(), 12u);
  EXPECT_NE(lines[1].find(broken.remedy), std::string::npos) << "remedy: " << broken.remedy;
}

INSTANTIATE_TEST_SUITE_P(Check, BrokenScene, testing::ValuesIn(kBroken),
                         [](const testing::TestParamInfo<Broken>& row) { return row.param.name; });

TEST(BrokenScenes, AreMany) { EXPECT_GE(kBroken.size(), 35u); }

/// What the rows above are broken from, and what is close to them and right.
TEST(SoundScene, IsAccepted) {
  const std::vector<std::pair<std::string, Change>> sound = {
      {"as it is", [](Trial&) {}},
      {"poisson 0.5 in a rod", scene("poisson: 0.4,", "poisson: 0.5,")},
      {"binary mesh", binary([](const std::string& mesh) { return binary_mesh(mesh); })},
      {"a rod of no density", scene("density: 1100 kg/m^3", "density: 0")},
      {"override", set("solids.finger.material.young=500 kPa")},
      {"two actuators of two motions", scene(a_pull, a_pull + "\n  twist: {rod: cable, angle: 10 deg}")},
      {"point outside, within reach", scene("point: [95 mm, 0 mm, 0 mm]", "point: [96 mm, 0 mm, 0 mm]")},
      {"mass", scene("density: 1070 kg/m^3", "mass: 20 g")},
      {"line ends of Windows",
       [](Trial& trial) {
         std::string text;
         for (const std::string& line : lines_of(trial.scene)) text += line + "\r\n";
         trial.scene = text;
       }},
      {"one section, one point", [](Trial& trial) {
         trial.scene = replaced(trial.scene, "sections: 6", "sections: 1");
         trial.scene = replaced(trial.scene, "points: [29 mm, 57 mm, 90 mm]", "points: 1");
       }}};
  for (const auto& [name, change] : sound) {
    Trial trial;
    change(trial);
    const Folder folder;
    write_file(folder / "scene.yaml", trial.scene);
    write_file(folder / "meshes/finger.vtk", trial.mesh);
    Arguments arguments = {"check", (folder / trial.given).string()};
    arguments.insert(arguments.end(), trial.arguments.begin(), trial.arguments.end());
    const Finished done = sinew(arguments, {}, 10.0);
    SCOPED_TRACE(name + ": " + said(done));
    EXPECT_EQ(done.code, 0);
    EXPECT_EQ(done.err, "");
    EXPECT_NE(done.out.find("The scene is sound"), std::string::npos);
    EXPECT_EQ(done.out.find("nan"), std::string::npos);
  }
}

}  // namespace
}  // namespace sinew::test
