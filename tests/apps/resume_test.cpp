// Runs that are killed, interrupted, damaged or stopped by the numbers: what was finished stays readable, and
// `--resume` goes on to the very bytes of a run that nothing disturbed.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "run_folder.hpp"
#include "sinew/io/recording.hpp"

namespace sinew::test {
namespace {

class Resume : public testing::Test {
 protected:
  /// The undisturbed run, in "reference".
  void SetUp() override {
    const Finished done = sinew(scene.run("reference"));
    ASSERT_EQ(done.code, 0) << said(done);
    recording = scene.recording("reference");
    signals = scene.signals("reference");
    ASSERT_EQ(lines_of(signals).size(), 22u) << "a header, t = 0 and 20 steps";
  }

  /// Starts a run and waits until its recording has `part` of the reference's bytes.
  void reach(Process& run, const std::string& out, double part) const {
    const auto enough = static_cast<std::uintmax_t>(part * static_cast<double>(recording.size()));
    std::error_code none_yet;
    while (run.running()) {
      const std::uintmax_t size = std::filesystem::file_size(scene / out / "run.sinew", none_yet);
      if (!none_yet && size >= enough) return;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }

  /// `sinew export` reads what is there: the first rows of the reference. Returns how many steps.
  std::size_t expect_first_rows(const std::string& out) const {
    const Finished done = sinew(scene.export_of(out));
    EXPECT_EQ(done.code, 0) << said(done);
    const std::string rows = scene.signals(out);
    EXPECT_TRUE(rows.ends_with('\n'));
    EXPECT_EQ(rows, signals.substr(0, rows.size())) << "not the first rows of the undisturbed run";
    return lines_of(rows).size() - 1;
  }

  void expect_resumed_to_reference(const std::string& out) const {
    const Finished done = sinew(scene.resume(out));
    EXPECT_EQ(done.code, 0) << said(done);
    EXPECT_FALSE(crashed(done));
    EXPECT_TRUE(scene.recording(out) == recording) << "run.sinew differs from that of the undisturbed run";
    EXPECT_EQ(scene.signals(out), signals);
    EXPECT_EQ(files_below(scene / out), files_below(scene / "reference"));
    EXPECT_TRUE(read_file(scene / out / "picture.png") == read_file(scene / "reference" / "picture.png"));
    EXPECT_EQ(report_of(scene / out)["end"]["how"], "done");
  }

  /// A copy of the reference whose recording was changed.
  void damage(const std::string& out, const std::string& bytes) const {
    std::filesystem::remove_all(scene / out);
    write_file(scene / out / "run.sinew", bytes);
  }

  const SceneFolder scene;
  std::string recording, signals;
};

TEST_F(Resume, AfterBeingKilledGoesOnToTheSameBytes) {
  std::mt19937 random(20240917);
  const int trials = kSlower > 1.0 ? 2 : 4;
  int killed = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const double part = std::uniform_real_distribution<double>(0.05, 0.9)(random);
    SCOPED_TRACE("killed at " + std::to_string(part) + " of the recording");
    const std::string out = "killed" + std::to_string(trial);
    Process run(scene.run(out));
    reach(run, out, part);
    run.send(SIGKILL);
    if (run.wait(60.0 * kSlower).signal == SIGKILL) ++killed;
    if (trial % 2 == 0) {
      EXPECT_GE(expect_first_rows(out), static_cast<std::size_t>(part * 20.0));
    }
    expect_resumed_to_reference(out);
  }
  EXPECT_GE(killed, trials - 1) << "the runs were over before they could be killed";
}

TEST_F(Resume, OfARunKilledTwiceGoesOnToTheSameBytes) {
  const std::string out = "twice";
  for (const double part : {0.3, 0.6}) {
    Process run(part < 0.5 ? scene.run(out) : scene.resume(out));
    reach(run, out, part);
    run.send(SIGKILL);
    run.wait(60.0 * kSlower);
  }
  expect_resumed_to_reference(out);
}

TEST_F(Resume, AfterAnInterruptKeepsResultsAndGoesOnToTheSameBytes) {
  for (const int signal : {SIGINT, SIGTERM}) {
    SCOPED_TRACE(signal);
    const std::string out = "interrupted" + std::to_string(signal);
    Process run(scene.run(out));
    reach(run, out, 0.3);
    run.send(signal);
    const Finished done = run.wait(60.0 * kSlower);
    EXPECT_EQ(done.code, 130) << said(done);
    EXPECT_NE(done.err.find("sinew run --resume " + scene.path_of(out)), std::string::npos) << said(done);
    EXPECT_NE(done.err.find("sinew export " + scene.path_of(out)), std::string::npos) << said(done);
    const std::vector<std::string> tables = {"report.json", "run.sinew", "signals.csv"};
    EXPECT_EQ(files_below(scene / out), tables) << "pictures are left out";
    EXPECT_EQ(report_of(scene / out)["end"]["how"], "interrupted");
    const std::string rows = scene.signals(out);
    EXPECT_LT(rows.size(), signals.size());
    EXPECT_EQ(rows, signals.substr(0, rows.size()));
    EXPECT_EQ(sinew(scene.export_of(out)).code, 0);
    expect_numbers_only(scene / out);
    expect_resumed_to_reference(out);
  }
}

TEST_F(Resume, FinishesAFolderWhoseViewsAreMissingOrTorn) {
  const nlohmann::json report = report_of(scene / "reference");
  const auto without_times = [](nlohmann::json json) {
    json.erase("time_per_step");
    return json;
  };
  for (const char* file : {"report.json", "picture.png", "signals.csv", "paraview", "paraview/finger_0000.vtu"}) {
    for (const bool torn : {false, true}) {
      SCOPED_TRACE(std::string(file) + (torn ? " torn" : " missing"));
      if (torn && std::string(file) == "paraview") continue;
      const std::string whole = torn ? read_file(scene / "reference" / file) : "";
      std::filesystem::remove_all(scene / "reference" / file);
      if (torn) write_file(scene / "reference" / file, whole.substr(0, whole.size() / 2));
      expect_resumed_to_reference("reference");
      EXPECT_EQ(without_times(report_of(scene / "reference")), without_times(report));
    }
  }
}

TEST_F(Resume, GivesTheReportOfTheUnbrokenRun) {
  damage("half", recording.substr(0, recording.size() / 2));
  expect_resumed_to_reference("half");
  nlohmann::json whole = report_of(scene / "reference"), half = report_of(scene / "half");
  for (nlohmann::json* report : {&whole, &half}) report->erase("time_per_step");
  EXPECT_EQ(half, whole);
}

TEST_F(Resume, OfARunThatWasKilledBeforeItsFirstStepBegins) {
  // A preamble of 16 bytes, a frame of 16, of which the last 8 are the size of the header.
  std::uint64_t header = 0;
  std::memcpy(&header, recording.data() + 24, 8);
  damage("early", recording.substr(0, 32 + header));
  expect_resumed_to_reference("early");
  damage("earlier", "");
  const Finished done = sinew(scene.resume("earlier"));
  EXPECT_EQ(done.code, 2) << said(done);
  EXPECT_NE(done.err.find("run the scene again"), std::string::npos) << said(done);
}

TEST_F(Resume, OfAFinishedRunChangesNothing) {
  std::vector<std::string> before;
  const std::vector<std::string> files = files_below(scene / "reference");
  for (const std::string& file : files) before.push_back(read_file(scene / "reference" / file));
  const nlohmann::json report = report_of(scene / "reference");

  const Finished done = sinew(scene.resume("reference"));
  EXPECT_EQ(done.code, 0) << said(done);
  ASSERT_EQ(files_below(scene / "reference"), files);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (files[i] == "report.json") continue;
    EXPECT_TRUE(read_file(scene / "reference" / files[i]) == before[i]) << files[i];
  }
  // All but the times, which no recording holds.
  nlohmann::json now = report_of(scene / "reference"), then = report;
  now.erase("time_per_step");
  then.erase("time_per_step");
  EXPECT_EQ(now, then);
}

TEST_F(Resume, SurvivesATornTail) {
  const std::size_t step = (recording.size() - recording.size() / 2) / 12;  // (less than a record of the 21)
  const std::string flipped = [&] {
    std::string bytes = recording;
    bytes[bytes.size() - step] ^= 0x10;
    return bytes;
  }();
  const std::vector<std::pair<std::string, std::string>> torn = {
      {"a byte cut", recording.substr(0, recording.size() - 1)},
      {"half of it cut", recording.substr(0, recording.size() / 2)},
      {"garbage appended", recording.substr(0, recording.size() / 3) + std::string(5000, '\x7F')},
      {"zeros appended", recording + std::string(4096, '\0')},
      {"a bit flipped", flipped}};
  for (const auto& [name, bytes] : torn) {
    SCOPED_TRACE(name);
    damage("torn", bytes);
    const std::size_t steps = expect_first_rows("torn");
    EXPECT_GE(steps, 5u);
    EXPECT_LE(steps, 21u);
    expect_resumed_to_reference("torn");
  }
}

TEST_F(Resume, OfWhatIsNoRecordingIsRefused) {
  const std::vector<std::pair<std::string, std::string>> broken = {{"empty", ""},
                                                                   {"cut in its header", recording.substr(0, 100)},
                                                                   {"another file", finger_mesh()},
                                                                   {"bit of the magic", "x" + recording.substr(1)}};
  for (const auto& [name, bytes] : broken) {
    damage("broken", bytes);
    for (const Arguments& command : {scene.resume("broken"), scene.export_of("broken")}) {
      const Finished done = sinew(command);
      SCOPED_TRACE(name + ": " + said(done));
      EXPECT_EQ(done.code, 2);
      EXPECT_FALSE(crashed(done));
      EXPECT_NE(done.err.find("run.sinew"), std::string::npos);
      EXPECT_NE(done.err.find("\n    "), std::string::npos) << "no remedy";
      EXPECT_EQ(scene.recording("broken"), bytes) << "it must be left as it is";
    }
  }
}

TEST_F(Resume, OfNothingIsRefusedWithARemedy) {
  for (const Arguments& command : {scene.resume("nowhere"), scene.export_of("nowhere")}) {
    const Finished done = sinew(command);
    SCOPED_TRACE(said(done));
    EXPECT_EQ(done.code, 2);
    EXPECT_NE(done.err.find("nowhere"), std::string::npos);
    EXPECT_NE(done.err.find("\n    "), std::string::npos) << "no remedy";
    EXPECT_FALSE(std::filesystem::exists(scene / "nowhere"));
  }
}

TEST_F(Resume, AfterTheMeshChangedIsRefused) {
  damage("changed", recording.substr(0, recording.size() / 2));
  const std::string before = scene.recording("changed");
  // (The same shape in other bytes: the title is another.)
  write_file(scene / "meshes/finger.vtk", replaced(finger_mesh(), "Sinew soft finger, mm", "Sinew soft thumb, mm"));
  for (const Arguments& command : {scene.resume("changed"), scene.export_of("changed")}) {
    const Finished done = sinew(command);
    SCOPED_TRACE(said(done));
    EXPECT_EQ(done.code, 2);
    EXPECT_NE(done.err.find("mesh files are not the ones this run was made with"), std::string::npos);
    EXPECT_NE(done.err.find("restore them"), std::string::npos);
    EXPECT_EQ(scene.recording("changed"), before);
  }
  std::filesystem::remove(scene / "meshes/finger.vtk");
  EXPECT_EQ(sinew(scene.resume("changed")).code, 2) << "no mesh at all";
  write_file(scene / "meshes/finger.vtk", finger_mesh());
  expect_resumed_to_reference("changed");
}

TEST_F(Resume, OfStatesLaidOutOtherwiseIsRefused) {
  std::filesystem::create_directories(scene / "other");
  const io::Recording whole = io::read_recording(scene / "reference/run.sinew");
  io::RecordingHeader header = whole.header;
  ++header.state_layout;
  io::RecordingWriter::create(scene / "other/run.sinew", header).append(whole.steps[0]);
  for (const Arguments& command : {scene.resume("other"), scene.export_of("other")}) {
    const Finished done = sinew(command);
    SCOPED_TRACE(said(done));
    EXPECT_EQ(done.code, 2);
    EXPECT_NE(done.err.find("holds states of another version of the engine"), std::string::npos);
    EXPECT_NE(done.err.find("run the scene again"), std::string::npos);
  }
}

TEST_F(Resume, UsesTheSceneOfTheRecordingNotTheFile) {
  damage("edited", recording.substr(0, recording.size() / 2));
  write_file(scene / "scene.yaml", replaced(finger_scene, "600 kPa", "100 kPa"));
  expect_resumed_to_reference("edited");
}

TEST_F(Resume, MakesOnlyTheStepsThatAreMissing) {
  damage("half", recording.substr(0, recording.size() / 2));
  const Finished done = sinew({"run", "--resume", scene.path_of("half")});  // (not quiet: progress has the times)
  EXPECT_EQ(done.code, 0) << said(done);
  EXPECT_NE(done.err.find("t = 0.2 s"), std::string::npos) << said(done);
  for (const char* early : {"t = 0.01 s", "t = 0.02 s", "t = 0.04 s", "t = 0.06 s", "t = 0.08 s"})
    EXPECT_EQ(done.err.find(early), std::string::npos) << said(done);
  EXPECT_TRUE(scene.recording("half") == recording);
}

TEST_F(Resume, OfARunThatIsStillRunningIsRefusedAndHarmsNothing) {
  Process run(scene.run("running"));
  reach(run, "running", 0.2);
  run.send(SIGSTOP);
  const Finished second = sinew(scene.resume("running"));
  const Finished third = sinew(scene.run("running", {"--force"}));
  run.send(SIGCONT);
  const Finished first = run.wait(60.0 * kSlower);
  for (const Finished& done : {second, third}) {
    EXPECT_NE(done.code, 0) << said(done);
    EXPECT_FALSE(crashed(done));
    EXPECT_NE(done.err.find("another run is writing it"), std::string::npos) << said(done);
  }
  EXPECT_EQ(first.code, 0) << said(first);
  EXPECT_TRUE(scene.recording("running") == recording);
  EXPECT_EQ(scene.signals("running"), signals);
}

TEST_F(Resume, IsNotMixedUpWithANewRun) {
  const Finished refused = sinew(scene.run("reference", {"--set", "time.duration=50 ms"}));
  EXPECT_EQ(refused.code, 2) << said(refused);
  EXPECT_NE(refused.err.find("already holds the results of a run"), std::string::npos) << said(refused);
  for (const char* remedy : {"-o", "--force", "--resume"})
    EXPECT_NE(refused.err.find(remedy), std::string::npos) << said(refused);
  EXPECT_EQ(refused.out, "");
  EXPECT_TRUE(scene.recording("reference") == recording) << "a refused run changed the results there";
  EXPECT_EQ(scene.signals("reference"), signals);

  // A broken scene does not cost the old results either.
  const Finished bad = sinew(scene.run("reference", {"--force", "--set", "time.step=-1 s"}));
  EXPECT_EQ(bad.code, 2) << said(bad);
  EXPECT_TRUE(scene.recording("reference") == recording);

  const Finished forced = sinew(scene.run("reference", {"--force", "--set", "time.duration=50 ms"}));
  EXPECT_EQ(forced.code, 0) << said(forced);
  EXPECT_EQ(lines_of(scene.signals("reference")).size(), 7u);

  const Finished both = sinew({"run", scene.path_of("scene.yaml"), "--resume", scene.path_of("reference")});
  EXPECT_EQ(both.code, 2) << said(both);
}

class NumericalStop : public testing::Test {
 protected:
  /// Ends with exit code 3, results up to there, and says so everywhere.
  void expect_stop(const SceneFolder& scene, const Arguments& more, const std::vector<std::string>& statuses) {
    Arguments all = {"--set", "newton={limit: 6}"};
    all.insert(all.end(), more.begin(), more.end());
    const Finished done = sinew(scene.run("out", all));
    SCOPED_TRACE(said(done));
    EXPECT_EQ(done.code, 3);
    EXPECT_FALSE(crashed(done));
    EXPECT_NE(done.err.find("Stopped at t = "), std::string::npos);
    const std::vector<std::string> files = files_below(scene / "out");
    for (const char* file : {"signals.csv", "run.sinew", "report.json", "picture.png", "paraview/run.pvd"})
      EXPECT_NE(std::find(files.begin(), files.end(), file), files.end()) << file;

    const nlohmann::json report = report_of(scene / "out");
    EXPECT_EQ(report["end"]["how"], "numerical_stop");
    const std::string status = report["end"]["status"], meaning = report["end"]["meaning"];
    EXPECT_NE(std::find(statuses.begin(), statuses.end(), status), statuses.end()) << status;
    EXPECT_GT(meaning.size(), 30u);
    EXPECT_NE(done.err.find(status), std::string::npos);
    EXPECT_NE(done.err.find(meaning), std::string::npos);
    const std::vector<std::string> rows = lines_of(scene.signals("out"));
    ASSERT_GE(rows.size(), 2u);
    EXPECT_EQ(report["end"]["time_s"].get<double>(), std::stod(rows.back()));
    EXPECT_EQ(report["steps"].size(), rows.size() - 1);
    EXPECT_EQ(report["steps"].back()["time_s"], report["end"]["time_s"]);
    expect_numbers_only(scene / "out");
  }
};

TEST_F(NumericalStop, ForceBeyondAllMeasureKeepsWhatWasReached) {
  const SceneFolder scene;
  // (In smaller parts it goes on until elements are inside out, whose stress is none.)
  expect_stop(scene,
              {"--set", "time.smallest=150 us", "--set",
               "actuators.pull={rod: cable, force: {times: [0, 30 ms, 40 ms], values: [0, 0.1 N, 1e6 N]}}"},
              {"max_iterations", "diverged", "singular", "rod_exhausted"});
  EXPECT_GE(lines_of(scene.signals("out")).size(), 5u) << "header, t = 0, and the three good steps";
}

TEST_F(NumericalStop, PullInOneStepKeepsTheStart) {
  const SceneFolder scene;
  expect_stop(scene, {"--set", "actuators.pull.displacement=1e5 m"},
              {"max_iterations", "diverged", "singular", "rod_exhausted"});
}

/// Legal, and more than the numbers of a step can hold.
const std::string kForceBeyondNumbers =
    "loads={blow: {solid: finger, box: [[80 mm, -1, -1], [1, 1, 1]], force: [0, 0, 1e300]}}";

TEST_F(NumericalStop, NumbersOutOfRangeKeepTheStart) {
  const SceneFolder scene;
  expect_stop(scene, {"--set", kForceBeyondNumbers}, {"diverged"});
}

TEST_F(NumericalStop, IsStillKnownAfterAnExport) {
  const SceneFolder scene;
  ASSERT_EQ(sinew(scene.run("out", {"--set", kForceBeyondNumbers})).code, 3);
  const nlohmann::json before = report_of(scene / "out");
  ASSERT_EQ(sinew(scene.export_of("out")).code, 0);
  EXPECT_EQ(report_of(scene / "out")["end"], before["end"]);
}

TEST(Views, ParaViewFramesFollowTheTimeAndOldOnesGo) {
  const SceneFolder scene;
  const auto frames = [&scene] {
    int count = 0;
    for (const std::string& file : files_below(scene / "out")) count += file.find("paraview/finger_") == 0 ? 1 : 0;
    return count;
  };
  ASSERT_EQ(sinew(scene.run("out", {"--set", "view.interval=20 ms"})).code, 0);
  EXPECT_EQ(frames(), 11);  // 0, 20, .. 200 ms
  ASSERT_EQ(sinew(scene.run("out", {"--force", "--set", "view.interval=20 ms", "--set", "time.duration=70 ms"})).code,
            0);
  EXPECT_EQ(frames(), 5);  // 0, 20, 40, 60 and the last, 70 ms
}

TEST_F(NumericalStop, IsTheSameWhenResumed) {
  const SceneFolder scene;
  const Arguments pull = {"--set", "newton={limit: 6}", "--set",
                          "actuators.pull={rod: cable, displacement: {times: [0, 30 ms, 40 ms], values: [0, 0, 1 m]}}"};
  ASSERT_EQ(sinew(scene.run("out", pull)).code, 3);
  const std::string recording = scene.recording("out"), signals = scene.signals("out");
  const Finished again = sinew(scene.resume("out"));
  EXPECT_EQ(again.code, 3) << said(again);
  EXPECT_TRUE(scene.recording("out") == recording);
  EXPECT_EQ(scene.signals("out"), signals);
}

}  // namespace
}  // namespace sinew::test
