// The program `sinew` as its user meets it: what the commands say, the files of a run, and that equal runs are equal.
#include <gtest/gtest.h>

#include "run_folder.hpp"

namespace sinew::test {
namespace {

void expect_holds(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
}

TEST(Program, HelpShowsCommandsExamplesAndExitCodes) {
  for (const char* flag : {"--help", "-h"}) {
    const Finished done = sinew({flag});
    EXPECT_EQ(done.code, 0) << said(done);
    EXPECT_EQ(done.err, "");
    expect_holds(done.out,
                 {"run", "check", "info", "export", "schema", "Examples:", "sinew run examples/finger.yaml -o", "--set",
                  "--resume", "130 interrupted", "3 numerical stop", "2 bad input"});
  }
  for (const char* command : {"run", "workspace", "check", "info", "export", "schema"}) {
    const Finished done = sinew({command, "--help"});
    EXPECT_EQ(done.code, 0) << said(done);
    EXPECT_GT(done.out.size(), 50u) << command;
  }
}

TEST(Program, TellsItsVersion) {
  const Finished done = sinew({"--version"});
  EXPECT_EQ(done.code, 0);
  EXPECT_TRUE(std::regex_match(done.out, std::regex("sinew \\d+\\.\\d+\\.\\d+\n"))) << said(done);
}

TEST(Program, RefusesWhatIsNoCommand) {
  const std::vector<Arguments> wrong = {{},
                                        {"frobnicate"},
                                        {"run"},
                                        {"check"},
                                        {"info"},
                                        {"export"},
                                        {"check", "a.yaml", "b.yaml"},
                                        {"schema", "--bogus"},
                                        {"run", "a.yaml", "--set"},
                                        {"--bogus"}};
  for (const Arguments& arguments : wrong) {
    const Finished done = sinew(arguments);
    SCOPED_TRACE((arguments.empty() ? "nothing" : arguments[0]) + ": " + said(done));
    EXPECT_EQ(done.code, 2);
    EXPECT_EQ(done.out, "");
    EXPECT_GT(done.err.size(), 20u);
  }
}

TEST(Program, NamesTheWordThatIsNoCommand) {
  const Finished done = sinew({"frobnicate"});
  EXPECT_NE(done.err.find("frobnicate"), std::string::npos) << said(done);
}

TEST(Program, PrintsAJsonSchema) {
  const Finished done = sinew({"schema"});
  ASSERT_EQ(done.code, 0) << said(done);
  EXPECT_EQ(done.err, "");
  const nlohmann::json schema = nlohmann::json::parse(done.out);
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema["additionalProperties"], false);
  for (const char* key :
       {"title", "time", "gravity", "newton", "view", "frames", "solids", "rods", "couplings", "actuators", "outputs"})
    EXPECT_TRUE(schema["properties"].contains(key)) << key;
}

TEST(Program, DescribesTheExampleMeshes) {
  const Finished finger = sinew({"info", (examples() / "meshes/finger.vtk").string()});
  EXPECT_EQ(finger.code, 0) << said(finger);
  expect_holds(finger.out,
               {"284 nodes, 856 tetrahedra", "from [0, -7.5, -7.5] to [95, 7.5, 7.5]", "volume", "`scale: 0.001`"});
  const Finished trunk = sinew({"info", (examples() / "meshes/trunk.vtk").string()});
  EXPECT_EQ(trunk.code, 0) << said(trunk);
  expect_holds(trunk.out, {"633 nodes, 1834 tetrahedra", "from [-16, -16, 0] to [16, 16, 195]", "worst shape"});
  const Finished none = sinew({"info", "no_such_mesh.vtk"});
  EXPECT_EQ(none.code, 2) << said(none);
  expect_holds(none.err, {"no_such_mesh.vtk", "does not exist"});
}

TEST(Program, ChecksTheExample) {
  const Finished done = sinew({"check", (examples() / "finger.yaml").string()});
  EXPECT_EQ(done.code, 0) << said(done);
  EXPECT_EQ(done.err, "");
  // Stiffnesses by hand: radius r = 0.5 mm, E = 5 GPa, nu = 0.4: E pi r^4 / 4 and E / (2 (1 + nu)) pi r^4 / 2.
  expect_holds(done.out,
               {"200 steps of 10 ms", "284 nodes, 856 tetrahedra", "12 nodes fixed", "95 x 15 x 15 mm", "cm^3",
                "1070 kg/m^3", "rod cable: 90 mm, 15 sections", "torsion    stiffness 0.0001753 N m^2",
                "bending_y  stiffness 0.0002454 N m^2", "bending_z  stiffness 0.0002454 N m^2", "7 of 7 points kept",
                "actuator pull: translation of rod cable, driven by displacement", "The scene is sound"});
}

TEST(Program, ChecksWithoutWritingAnything) {
  const SceneFolder scene;
  const std::vector<std::string> before = files_below(scene.path());
  EXPECT_EQ(sinew({"check", "scene.yaml"}, scene.path()).code, 0);
  EXPECT_EQ(files_below(scene.path()), before);
}

const Arguments short_run = {"--set", "time.duration=50 ms"};

TEST(Run, WritesAllItsFiles) {
  const SceneFolder scene;
  const Finished done =
      sinew({"run", scene.path_of("scene.yaml"), "-o", scene.path_of("out/deep"), "--set", "time.duration=50 ms"});
  ASSERT_EQ(done.code, 0) << said(done);
  expect_holds(done.out, {"Results in " + scene.path_of("out/deep"), "picture.png", "signals.csv", "paraview/run.pvd",
                          "report.json", "run.sinew"});

  const std::filesystem::path out = scene / "out/deep";
  const std::vector<std::string> rows = lines_of(read_file(out / "signals.csv"));
  ASSERT_EQ(rows.size(), 7u) << "a header, t = 0 and five steps";
  EXPECT_EQ(
      rows[0],
      "time,status,newton,tip.x,tip.y,tip.z,pull.displacement,pull.force,energy.kinetic,energy.elastic,energy.weight,"
      "energy.work,energy.dissipated,energy.work_bound");
  EXPECT_EQ(rows[1].substr(0, 9), "0,rest,0,");
  for (std::size_t i = 2; i < rows.size(); ++i) EXPECT_NE(rows[i].find(",converged,"), std::string::npos) << rows[i];
  EXPECT_EQ(std::stod(rows.back()), 0.05);
  EXPECT_EQ(rows.back().substr(0, rows.back().find(',')), "0.050000000000000003") << "17 significant digits";

  const std::string picture = read_file(out / "picture.png");
  ASSERT_GT(picture.size(), 10000u);
  EXPECT_EQ(picture.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(picture.substr(12, 4), "IHDR");
  EXPECT_NE(picture.substr(picture.size() - 12).find("IEND"), std::string::npos);

  const std::string series = read_file(out / "paraview/run.pvd");
  expect_holds(series, {"<VTKFile type=\"Collection\"", "finger_0000.vtu", "cable_0000.vtu", "finger_0005.vtu"});
  for (const char* file : {"paraview/finger_0000.vtu", "paraview/cable_0005.vtu"})
    EXPECT_TRUE(std::filesystem::exists(out / file)) << file;
  expect_holds(read_file(out / "paraview/finger_0005.vtu"), {"displacement", "von_mises"});
  expect_numbers_only(out);
}

/// On what is no terminal: plain lines, one per tenth at most, each with the part that is done.
TEST(Run, ShowsProgressInPlainLines) {
  const SceneFolder scene;
  const Finished done =
      sinew({"run", scene.path_of("scene.yaml"), "-o", scene.path_of("out"), "--set", "time.duration=50 ms"});
  ASSERT_EQ(done.code, 0) << said(done);
  EXPECT_EQ(done.err.find('\r'), std::string::npos);
  EXPECT_EQ(done.err.find('\033'), std::string::npos);
  expect_holds(done.err, {" 20 %  t = 0.01 s", " 40 %  t = 0.02 s", " 60 %  t = 0.03 s", " 80 %  t = 0.04 s",
                          "100 %  t = 0.05 s", "left\n"});
}

TEST(Run, ReportsWhatItDid) {
  const SceneFolder scene;
  ASSERT_EQ(sinew(scene.run("out", short_run)).code, 0);
  const nlohmann::json report = report_of(scene / "out");
  EXPECT_EQ("sinew " + std::string("0"), report["program"].get<std::string>().substr(0, 7));
  EXPECT_EQ(report["scene"], "scene.yaml");
  EXPECT_EQ(report["inputs_hash"].get<std::string>().size(), 32u);
  ASSERT_EQ(report["inputs"].size(), 2u);
  EXPECT_EQ(report["inputs"][1]["file"], "finger.vtk");
  EXPECT_EQ(report["inputs"][1]["xxh3_128"].get<std::string>().size(), 32u);
  EXPECT_EQ(report["sizes"]["solids"]["finger"]["nodes"], 284);
  EXPECT_EQ(report["sizes"]["solids"]["finger"]["cells"], 856);
  EXPECT_EQ(report["sizes"]["solids"]["finger"]["unknowns"], 816);
  EXPECT_EQ(report["sizes"]["rods"]["cable"]["sections"], 6);
  EXPECT_NEAR(report["sizes"]["rods"]["cable"]["length_m"].get<double>(), 0.09, 1e-15);
  EXPECT_EQ(report["sizes"]["sliding_points"], 3);
  EXPECT_EQ(report["units"]["tip.x"], "m");
  EXPECT_EQ(report["units"]["pull.force"], "N");
  EXPECT_TRUE(report["warnings"].is_array());
  EXPECT_EQ(report["end"]["how"], "done");
  EXPECT_EQ(report["end"]["time_s"], 0.05);
  EXPECT_EQ(report["summary"]["steps"]["converged"], 5);
  EXPECT_EQ(report["summary"]["steps"]["rest"], 1);
  EXPECT_LT(report["summary"]["largest_violation_m"].get<double>(), 1e-9);
  EXPECT_LT(report["summary"]["largest_residual"].get<double>(), 1e-9);
  EXPECT_GE(report["summary"]["largest_newton"].get<int>(), 1);
  for (const char* stage : {"forces", "assembly", "factor", "compliance", "rods", "solve", "contact"}) {
    const nlohmann::json& times = report["time_per_step"][stage];
    EXPECT_GE(times["median_ms"].get<double>(), 0.0) << stage;
    EXPECT_GE(times["max_ms"].get<double>(), times["median_ms"].get<double>()) << stage;
  }
  ASSERT_EQ(report["steps"].size(), 6u);
  for (const nlohmann::json& step : report["steps"]) {
    for (const char* key : {"time_s", "status", "newton", "residual", "violation_m"})
      EXPECT_TRUE(step.contains(key)) << key;
  }
  EXPECT_EQ(report["steps"][0]["status"], "rest");
  EXPECT_EQ(report["steps"][5]["status"], "converged");
}

/// A rod with two opposite tendons that are told opposite lengths: one pushes, and both are one constraint.
const char* const two_tendons = R"(time: {step: 10 ms, duration: 100 ms}
rods: {arm: {path: [[0,0,0],[0.2,0,0]], section: {circle: {radius: 8 mm}}, material: {young: 1 MPa, poisson: 0.5, density: 1100, damping: 20 ms}}}
actuators:
  a: {rod: arm, tendon: {distance: 6 mm}, displacement: {times: [0, 0.1], values: [0, 1 mm]}}
  b: {rod: arm, tendon: {distance: 6 mm, angle: 180 deg}, displacement: {times: [0, 0.1], values: [0, -1 mm]}}
)";

TEST(Run, WarningsAreDataAndWithStrictAnExitCode) {
  const SceneFolder scene;
  write_file(scene / "two.yaml", two_tendons);
  const std::string file = (scene / "two.yaml").string();
  const Finished checked = sinew({"check", file});
  EXPECT_EQ(checked.code, 0);
  EXPECT_NE(checked.out.find("warning: actuators.a, actuators.b: 2 constraint rows depend on each other"),
            std::string::npos);
  EXPECT_EQ(sinew({"check", file, "--strict"}).code, 4);
  EXPECT_EQ(sinew({"run", file, "-o", (scene / "out").string()}).code, 0);
  EXPECT_EQ(sinew({"run", file, "-o", (scene / "strict").string(), "--strict"}).code, 4);
  const nlohmann::json warnings = report_of(scene / "out")["warnings"];
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0]["code"], "redundant_constraints");
  EXPECT_FALSE(warnings[0].contains("first_time_s"));
  EXPECT_EQ(warnings[1]["code"], "tendon_pushes");
  EXPECT_EQ(warnings[1]["where"], "actuators.b");
  EXPECT_EQ(warnings[1]["unit"], "N");
  EXPECT_NEAR(warnings[1]["first_time_s"].get<double>(), 0.01, 1e-12);
  EXPECT_EQ(warnings[1]["steps"], 10);
  EXPECT_GT(warnings[1]["worst"].get<double>(), warnings[1]["limit"].get<double>());
  // Made again from the recording they are the same.
  std::filesystem::remove(scene / "out" / "report.json");
  EXPECT_EQ(sinew({"export", (scene / "out").string()}).code, 0);
  EXPECT_EQ(report_of(scene / "out")["warnings"], warnings);
}

TEST(Run, TwiceGivesTheSameBytes) {
  const SceneFolder scene;
  ASSERT_EQ(sinew(scene.run("first", short_run)).code, 0);
  ASSERT_EQ(sinew(scene.run("second", short_run)).code, 0);
  EXPECT_TRUE(scene.recording("first") == scene.recording("second"));
  EXPECT_EQ(scene.signals("first"), scene.signals("second"));
  for (const char* file : {"picture.png", "paraview/finger_0000.vtu", "paraview/cable_0001.vtu", "paraview/run.pvd"}) {
    if (!std::filesystem::exists(scene / "first" / file)) continue;
    EXPECT_TRUE(read_file(scene / "first" / file) == read_file(scene / "second" / file)) << file;
  }
  // Without the folder of the scene the rows are the same as well.
  const SceneFolder elsewhere;
  ASSERT_EQ(sinew(elsewhere.run("third", short_run)).code, 0);
  EXPECT_EQ(elsewhere.signals("third"), scene.signals("first"));
}

TEST(Run, SetChangesTheResultsAsTheFileWould) {
  const SceneFolder scene;
  const Arguments softer = {"--set", "time.duration=50 ms", "--set", "solids.finger.material.young=300 kPa"};
  ASSERT_EQ(sinew(scene.run("plain", short_run)).code, 0);
  ASSERT_EQ(sinew(scene.run("set", softer)).code, 0);
  EXPECT_NE(scene.signals("plain"), scene.signals("set"));
  const SceneFolder edited(replaced(replaced(finger_scene, "600 kPa", "300 kPa"), "200 ms", "50 ms"));
  ASSERT_EQ(sinew(edited.run("file")).code, 0);
  EXPECT_EQ(edited.signals("file"), scene.signals("set"));
}

/// In the scene's own folder it is called by its bare name, and results go to "out".
TEST(Run, WorksInTheScenesOwnFolder) {
  const SceneFolder scene;
  const Finished done = sinew({"run", "scene.yaml", "--set", "time.duration=20 ms"}, scene.path());
  EXPECT_EQ(done.code, 0) << said(done);
  ASSERT_TRUE(std::filesystem::exists(scene / "out/signals.csv"));
  EXPECT_EQ(lines_of(scene.signals("out")).size(), 4u);
  // And is resumed from anywhere.
  const Finished resumed = sinew(scene.resume("out"), std::filesystem::temp_directory_path());
  EXPECT_EQ(resumed.code, 0) << said(resumed);
}

TEST(Run, OfNoDurationHasTheStateAtRest) {
  const SceneFolder scene;
  const Finished done = sinew(scene.run("out", {"--set", "time.duration=0"}));
  EXPECT_EQ(done.code, 0) << said(done);
  EXPECT_EQ(lines_of(scene.signals("out")).size(), 2u);
  expect_numbers_only(scene / "out");
}

TEST(Run, QuietSaysNothing) {
  const SceneFolder scene;
  const Finished done = sinew(scene.run("out", {"--set", "time.duration=20 ms"}));
  EXPECT_EQ(done.code, 0) << said(done);
  EXPECT_EQ(done.out, "");
  EXPECT_EQ(done.err.find("scene.yaml"), std::string::npos) << done.err;
}

TEST(Run, RefusesAFolderThatCannotBeMade) {
  const SceneFolder scene;
  write_file(scene / "taken", "a file\n");
  const Finished done = sinew(scene.run("taken", short_run));
  EXPECT_EQ(done.code, 2) << said(done);
  expect_holds(done.err, {"taken", "cannot be made", "-o"});
  EXPECT_EQ(read_file(scene / "taken"), "a file\n");
}

TEST(Export, WritesTheViewsAgain) {
  const SceneFolder scene;
  ASSERT_EQ(sinew(scene.run("out", short_run)).code, 0);
  std::vector<std::string> files = files_below(scene / "out"), before;
  for (const std::string& file : files) before.push_back(read_file(scene / "out" / file));
  for (const std::string& file : files) {
    if (file != "run.sinew") std::filesystem::remove(scene / "out" / file);
  }
  const Finished done = sinew(scene.export_of("out"));
  EXPECT_EQ(done.code, 0) << said(done);
  expect_holds(done.out, {"6 steps up to t = 0.05 s", "signals.csv"});
  ASSERT_EQ(files_below(scene / "out"), files);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (files[i] != "report.json") {
      EXPECT_TRUE(read_file(scene / "out" / files[i]) == before[i]) << files[i];
    }
  }
}

/// The example of the README, whole, as everyone will run it first.
TEST(Run, TheExampleToItsEnd_slow) {
  const Folder folder;
  const Finished done =
      sinew({"run", (examples() / "finger.yaml").string(), "-o", (folder / "out").string(), "--quiet"}, {}, 120.0);
  ASSERT_EQ(done.code, 0) << said(done);
  const std::vector<std::string> rows = lines_of(read_file(folder / "out/signals.csv"));
  EXPECT_EQ(rows.size(), 202u);
  expect_numbers_only(folder / "out");
}

/// What was found for the motors leads the tip along the same way, without targets.
TEST(Inverse, CommandsOfARunDriveItAgain) {
  const Folder folder;
  const std::string scene = (examples() / "reach.yaml").string(), out = (folder / "out").string(),
                    again = (folder / "again").string(), table = out + "/commands.csv";
  const Finished found = sinew({"run", scene, "-o", out, "--set", "time.duration=0.5 s"});
  ASSERT_EQ(found.code, 0) << said(found);
  EXPECT_NE(found.out.find("Targets reached in 50 of 50 steps; at the end reached"), std::string::npos) << said(found);
  EXPECT_NE(found.out.find("commands.csv"), std::string::npos);
  const std::vector<std::string> commands = lines_of(read_file(table));
  ASSERT_EQ(commands.size(), 52u);
  EXPECT_EQ(commands[0], "time,pull_right.force,pull_back.force,pull_left.force,pull_front.force");
  const Finished driven = sinew({"run", scene, "-o", again, "-q", "--set", "time.duration=0.5 s", "--commands", table});
  ASSERT_EQ(driven.code, 0) << said(driven);
  EXPECT_FALSE(std::filesystem::exists(again + "/commands.csv"));
  const auto last = [](const std::string& file) {
    std::vector<double> tip;
    const std::vector<std::string> rows = lines_of(read_file(file));
    std::vector<std::string> names, cells;
    for (auto [text, into] : {std::pair(rows.front(), &names), {rows.back(), &cells}}) {
      std::istringstream stream(text);
      for (std::string cell; std::getline(stream, cell, ',');) into->push_back(cell);
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == "tip.x" || names[i] == "tip.y" || names[i] == "tip.z") tip.push_back(std::stod(cells.at(i)));
    }
    return tip;
  };
  const std::vector<double> one = last(out + "/signals.csv"), other = last(again + "/signals.csv");
  ASSERT_EQ(one.size(), 3u);
  EXPECT_GT(std::abs(one[1]), 1e-3);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(one[i], other.at(i), 1e-9);
  // The recording goes on by itself, and knows when its table has changed.
  EXPECT_EQ(sinew({"run", "--resume", again}).code, 0);
  std::ofstream(table, std::ios::app) << "9,0,0,0,0\n";
  EXPECT_EQ(sinew({"run", "--resume", again}).code, 2);
  const Finished wrong = sinew({"run", scene, "-o", again, "--force", "--commands", out + "/signals.csv"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.err.find("signals.csv:1: status: is no command of an actuator"), std::string::npos) << said(wrong);
}

TEST(Inverse, TheWorkspaceIsMapped) {
  const Folder folder;
  const std::string scene = (examples() / "reach.yaml").string(), out = (folder / "out").string();
  const Finished done =
      sinew({"workspace", scene, "-o", out, "--samples", "8", "--set", "actuators.pull_left.limits.force=[0 N, 1 N]"});
  ASSERT_EQ(done.code, 0) << said(done);
  EXPECT_NE(done.out.find("workspace.csv"), std::string::npos);
  const std::vector<std::string> rows = lines_of(read_file(folder / "out/workspace.csv"));
  ASSERT_EQ(rows.size(), 9u);
  EXPECT_TRUE(rows[0].starts_with("status,within,pull_right.displacement,pull_right.force,")) << rows[0];
  EXPECT_TRUE(rows[0].ends_with(",tip.x,tip.y,tip.z")) << rows[0];
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_TRUE(rows[i].starts_with("converged,1,")) << rows[i];
    EXPECT_EQ(std::count(rows[i].begin(), rows[i].end(), ','), std::count(rows[0].begin(), rows[0].end(), ','));
  }
  EXPECT_GT(std::filesystem::file_size(folder / "out/workspace.png"), 10000u);
  const Finished open = sinew({"workspace", scene, "-o", out, "--set", "actuators.pull_left.limits={speed: 1 m/s}"});
  EXPECT_EQ(open.code, 2);
  EXPECT_NE(open.err.find("actuators.pull_left.limits"), std::string::npos) << said(open);
  EXPECT_EQ(sinew({"workspace", (examples() / "finger.yaml").string(), "-o", out}).code, 2);
}

TEST(Examples, AllRunAndLeaveTheirResults) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(examples())) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    const Folder folder;
    const Finished done = sinew(
        {"run", entry.path().string(), "-o", (folder / "out").string(), "--quiet", "--set", "time.duration=0.1 s"}, {},
        120.0);
    EXPECT_EQ(done.code, 0) << entry.path() << said(done);
    EXPECT_TRUE(std::filesystem::exists(folder / "out/picture.png")) << entry.path();
  }
  EXPECT_GE(count, 3);
}

}  // namespace
}  // namespace sinew::test
