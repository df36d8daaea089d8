// Numbers over time from files and formulas.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "full_scene.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/csv_table.hpp"
#include "sinew/io/scene_file.hpp"

namespace sinew::io {
namespace {

using testing::HasSubstr;

class Samples : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("sinew_samples_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& text) {
    std::filesystem::path path = folder_ / "table.csv";
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  /// The scene with another place for its tip, or another drive of its first motor.
  Scene with_tip(const std::string& at) {
    const std::string old = "{times: [0, 1], values: [[0.1, 0, 0], [90 mm, 0, 3 cm]]}";
    std::string text = inverse_scene;
    return read(text.replace(text.find(old), old.size(), at));
  }
  Scene with_pull(const std::string& force) {
    const std::string old = "force: inverse\n";
    std::string text = inverse_scene;
    return read(text.replace(text.find(old), old.size(), "force: " + force + "\n"));
  }
  Scene read(const std::string& text) {
    file_ = parse_scene(text, "scene.yaml", folder_);
    return file_.scene;
  }
  std::string refused(const std::string& at) {
    try {
      with_tip(at);
    } catch (const InputError& error) {
      return error.what();
    }
    return "(accepted)";
  }
  std::string bad_table(const std::string& text) {
    write(text);
    return refused("{file: table.csv, columns: [x, y, z]}");
  }

  std::filesystem::path folder_;
  SceneFile file_;
};

TEST_F(Samples, ComeFromColumnsOfAFile) {
  // With the marks that spreadsheets leave: a byte order mark, CRLF, cells in quotes, empty lines.
  write(
      "\xEF\xBB\xBFt,\"a, b\",x,y,z,pull.force\r\n0,\"said \"\"no\"\", twice\r\nover\",0.1,0,-2e-2,1\r\n\r\n 0.5 ,, "
      "0.2,1,+0,2.5\r\n");
  EXPECT_THAT([&] { with_tip("{file: table.csv, columns: [x, y, z], time: t}"); },
              testing::Throws<InputError>(testing::Property(&InputError::what, HasSubstr("+0"))));
  write(
      "\xEF\xBB\xBFt,\"a, b\",x,y,z,pull.force\r\n0,\"said \"\"no\"\", twice\r\nover\",0.1,0,-2e-2,1\r\n\r\n 0.5 ,, "
      "0.2,1,0,2.5\r\n");
  const Scene scene = with_tip("{file: table.csv, columns: [x, y, z], time: t}");
  const Track& track = std::get<Track>(scene.targets[0].at);
  EXPECT_EQ(track.times, (std::vector<double>{0.0, 0.5}));
  EXPECT_EQ(track.values[0], Vec3(0.1, 0.0, -0.02));
  EXPECT_EQ(track.values[1], Vec3(0.2, 1.0, 0.0));
  EXPECT_EQ(file_.tables, std::vector{folder_ / "table.csv"});
  EXPECT_EQ(csv_columns(folder_ / "table.csv"), (std::vector<std::string>{"t", "a, b", "x", "y", "z", "pull.force"}));
  const Scene driven = with_pull("{file: table.csv, column: pull.force, time: t}");
  const Table& table = std::get<Table>(driven.actuators[0].second.drive);
  EXPECT_EQ(table.times, (std::vector<double>{0.0, 0.5}));
  EXPECT_EQ(table.values, (std::vector<double>{1.0, 2.5}));
}

TEST_F(Samples, ComeFromFormulas) {
  const Scene scene = with_tip("{formula: [0.1, 0.02 * sin(2 * pi * t), 't < 0.5 ? 0 : 1e-2']}");
  const Track& track = std::get<Track>(scene.targets[0].at);
  ASSERT_EQ(track.times.size(), 4 * static_cast<std::size_t>(std::lround(scene.time.duration / scene.time.step)) + 1);
  for (std::size_t i = 0; i < track.times.size(); ++i) {
    const double t = track.times[i];
    EXPECT_NEAR(t, 0.25 * static_cast<double>(i) * scene.time.step, 1e-12);
    if (const std::size_t step = i / 4; 4 * step == i) {
      EXPECT_EQ(t, static_cast<double>(step) * scene.time.step);
    }
    EXPECT_LT((track.values[i] - Vec3(0.1, 0.02 * std::sin(2 * std::numbers::pi * t), t < 0.5 ? 0.0 : 0.01)).norm(),
              1e-15);
  }
  const Scene driven = with_pull("{formula: '2 * min(t, 0.5)'}");
  EXPECT_NEAR(std::get<Table>(driven.actuators[0].second.drive).values.back(), std::min(1.0, 2 * scene.time.duration),
              1e-15);
  EXPECT_TRUE(file_.tables.empty());
}

TEST_F(Samples, SayWhatIsWrong) {
  EXPECT_THAT(refused("{file: none.csv, columns: [x, y, z]}"), HasSubstr("none.csv: does not exist"));
  EXPECT_THAT(bad_table(""), HasSubstr("is empty"));
  EXPECT_THAT(bad_table("time,x,y,zz\n0,1,2,3\n"),
              testing::AllOf(HasSubstr("table.csv:1"), HasSubstr("z: is not the name of a column"),
                             HasSubstr("did you mean `zz`")));
  EXPECT_THAT(bad_table("time,x,y,z\n0,1,2,3\n1,2,three,4\n"),
              testing::AllOf(HasSubstr("table.csv:3"), HasSubstr("three: is not a number, in column `y`")));
  EXPECT_THAT(bad_table("time,x,y,z\n0,1,2,3\n1,2\n"),
              testing::AllOf(HasSubstr("table.csv:3"), HasSubstr("has 2 cells")));
  EXPECT_THAT(bad_table("time,x,y,z\n0,1,2,inf\n"), HasSubstr("is not a number"));
  EXPECT_THAT(bad_table("time,x,y,z\n0,1,2,\"3\n"), HasSubstr("does not end"));
  EXPECT_THAT(bad_table("time,x,y,z\n"), HasSubstr("has no row of numbers"));
  EXPECT_THAT(bad_table("time,x,y,z\n0,1,2,3\n0,1,2,3\n"), HasSubstr("do not ascend: 0 s after 0 s, in row 2"));
  EXPECT_THAT(refused("{file: table.csv, columns: [x, y]}"), HasSubstr("3 of them, not 2"));
  EXPECT_THAT(refused("{file: table.csv, column: x}"), HasSubstr("`columns`"));
  EXPECT_THAT(refused("{formula: [1, 2]}"), HasSubstr("3 of them, not 2"));
  EXPECT_THAT(refused("{formula: [0, sin(t, 0]}"),
              testing::AllOf(HasSubstr("scene.yaml:26"), HasSubstr("targets.tip.at.formula"), HasSubstr("not")));
  EXPECT_THAT(refused("{formula: [0, 2 * u, 0]}"), HasSubstr("is not a formula of t"));
  EXPECT_THAT(refused("{formula: [0, 1 / t, 0]}"), HasSubstr("has no finite value at t = 0 s"));
}

}  // namespace
}  // namespace sinew::io
