// Programs that are asked to end in the middle of a long step, whose results folder goes away or whose streams are
// closed.
#include <gtest/gtest.h>

#include <random>

#include "run_folder.hpp"

namespace sinew::test {
namespace {

/// Balls that lie in one another's way on a floor: hundreds of contacts with friction, steps of seconds.
std::string heap() {
  std::string scene =
      "time: {step: 5 ms, duration: 1 s}\ngravity: [0, 0, -9.81]\ncontact: {friction: 0.4}\nobstacles:\n"
      "  floor: {plane: {normal: [0, 0, 1]}}\nbodies:\n";
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-0.3, 0.3);
  const auto number = [](double value) { return std::to_string(value) + " mm"; };
  for (int i = 0; i < 150; ++i) {
    const double x = 19.9 * (i % 5) + off(random), y = 19.9 * (i / 5 % 5) + off(random), z = 10.0 + 19.7 * (i / 25);
    scene += "  b" + std::to_string(i) + ": {sphere: {radius: 10 mm}, density: 1000, pose: {translate: [" + number(x) +
             ", " + number(y) + ", " + number(z) + "]}}\n";
  }
  return scene;
}

/// Until then a signal ends the program as usual.
void wait_for_recording(Process& run, const std::filesystem::path& out) {
  while (run.running() && !std::filesystem::exists(out / "run.sinew"))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(Interrupted, AStepOfSecondsEndsAtOnceAndTheRecordingIsReadable) {
  const SceneFolder scene(heap());
  for (const int signal : {SIGINT, SIGTERM}) {
    for (const double after : {0.3, 1.2}) {
      SCOPED_TRACE(std::to_string(signal) + " after " + std::to_string(after) + " s");
      std::filesystem::remove_all(scene / "out");
      Process run({"run", scene.path_of("scene.yaml"), "-o", scene.path_of("out"), "--quiet"});
      wait_for_recording(run, scene / "out");
      std::this_thread::sleep_for(std::chrono::duration<double>(after * kSlower));
      ASSERT_TRUE(run.running()) << said(run.wait(1.0));
      const auto asked = std::chrono::steady_clock::now();
      run.send(signal);
      const Finished done = run.wait(60.0 * kSlower);
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - asked;
      EXPECT_EQ(done.code, 130) << said(done);
      EXPECT_LT(took.count(), 2.0 * kSlower);  // (0.2 s where the machine has nothing else to do)
      EXPECT_FALSE(io::read_recording(scene / "out" / "run.sinew").torn);
    }
  }
}

TEST(Interrupted, WorkspaceKeepsTheRowsThatItFound) {
  const SceneFolder scene(replaced(replaced(finger_scene, "displacement: {times: [0 s, 1 s], values: [0 mm, 10 mm]}",
                                            "force: inverse, limits: {force: [0 N, 5 N]}"),
                                   "outputs:", "targets: {tip: {at: [95 mm, 0 mm, 5 mm]}}\noutputs:"));
  Process run({"workspace", scene.path_of("scene.yaml"), "-o", scene.path_of("out"), "--samples", "100000"});
  while (run.running() && !std::filesystem::exists(scene / "out" / "workspace.csv"))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::duration<double>(0.5 * kSlower));
  run.send(SIGTERM);
  const Finished done = run.wait(60.0 * kSlower);
  EXPECT_EQ(done.code, 130) << said(done);
  EXPECT_GE(lines_of(read_file(scene / "out" / "workspace.csv")).size(), 1u);
  EXPECT_FALSE(std::filesystem::exists(scene / "out" / "workspace.png"));
}

TEST(Run, WhoseFolderIsDeletedEndsSoonAndSaysSo) {
  const SceneFolder scene(replaced(finger_scene, "duration: 200 ms", "duration: 1000 s"));
  Process run(scene.run("out"));
  wait_for_recording(run, scene / "out");
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  std::filesystem::remove_all(scene / "out");
  const Finished done = run.wait(60.0 * kSlower);
  EXPECT_FALSE(done.timed_out);
  EXPECT_EQ(done.code, 2) << said(done);
  EXPECT_NE(done.err.find("was deleted, moved or replaced"), std::string::npos) << said(done);
}

TEST(Run, WithClosedStreamsLeavesTheSameRecording) {
  const SceneFolder scene;
  ASSERT_EQ(sinew(scene.run("open")).code, 0);
  const std::string recording = scene.recording("open");
  for (const char* closed : {"0<&-", "1>&-", "2>&-", "0<&- 1>&- 2>&-"}) {
    SCOPED_TRACE(closed);
    const std::string command = "'" + program() + "' run '" + scene.path_of("scene.yaml") + "' -o '" +
                                scene.path_of("closed") + "' --force --set view.interval='10 s' " + closed;
    const std::string quiet = std::string(closed).find("1>&-") == std::string::npos ? " >/dev/null" : "";
    EXPECT_EQ(std::system((command + quiet).c_str()), 0);
    EXPECT_TRUE(scene.recording("closed") == recording);
  }
}

}  // namespace
}  // namespace sinew::test
