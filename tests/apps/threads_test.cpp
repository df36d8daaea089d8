// The same run on any number of threads, and with registers of any width; what `--profile` says.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "run_folder.hpp"
#include "sinew/linalg/kernels.hpp"

namespace sinew::test {
namespace {

TEST(Threads, ChangeNoBitOfTheRecording) {
  const SceneFolder scene;
  for (const char* count : {"1", "2", "3"}) {
    const Finished done = sinew(scene.run(count, {"--threads", count}));
    ASSERT_EQ(done.code, 0) << said(done);
    EXPECT_TRUE(scene.recording(count) == scene.recording("1")) << count;
    EXPECT_EQ(report_of(scene / count)["time_per_step"]["threads"], std::stoi(count));
  }
  EXPECT_EQ(sinew(scene.run("none", {"--threads", "0"})).code, 2);
}

std::vector<std::vector<double>> numbers_of(const std::string& csv) {
  std::vector<std::vector<double>> rows;
  std::istringstream stream(csv);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) {
      char* end = nullptr;
      const double value = std::strtod(cell.c_str(), &end);
      if (end != cell.c_str()) rows.back().push_back(value);
    }
  }
  return rows;
}

TEST(Registers, OfAnyWidthGiveTheSameStepsToRounding) {
  const SceneFolder scene;
  std::vector<std::vector<std::vector<double>>> all;
  std::string recorded;
  for (const char* name : {"portable", "avx2", "avx512"}) {
    ASSERT_EQ(setenv("SINEW_REGISTERS", name, 1), 0);
    const Finished done = sinew(scene.run(name, {"--set", "newton=1"}));
    unsetenv("SINEW_REGISTERS");
    ASSERT_EQ(done.code, 0) << said(done);
    all.push_back(numbers_of(scene.signals(name)));
    if (recorded.empty()) {
      recorded = scene.recording(name);
    } else if (linalg::kernels(name)) {
      EXPECT_FALSE(scene.recording(name) == recorded) << name << ": nothing was switched";
    }
  }
  const auto& portable = all[0];
  ASSERT_GT(portable.size(), 20u);
  for (std::size_t c = 0; c < portable[0].size(); ++c) {
    double largest = 0.0, apart = 0.0;
    for (std::size_t i = 0; i < portable.size(); ++i) {
      ASSERT_EQ(portable[i].size(), portable[0].size());
      largest = std::max(largest, std::abs(portable[i][c]));
      for (const auto& other : all) apart = std::max(apart, std::abs(other[i][c] - portable[i][c]));
    }
    EXPECT_LE(apart, 1e-10 * largest) << "column " << c;
  }
}

TEST(Registers, OfNoNameAreRefused) {
  const SceneFolder scene;
  setenv("SINEW_REGISTERS", "mmx", 1);
  const Finished done = sinew(scene.run("out"));
  unsetenv("SINEW_REGISTERS");
  EXPECT_EQ(done.code, 1);
  EXPECT_NE(done.err.find("SINEW_REGISTERS=mmx"), std::string::npos) << said(done);
}

TEST(Profile, ShowsEveryStage) {
  const SceneFolder scene;
  const Finished done = sinew(scene.run("out", {"--profile"}));
  ASSERT_EQ(done.code, 0) << said(done);
  for (const char* part :
       {"20 steps", "forces", "assembly", "factor", "compliance", "rods", "solve", "contact", "whole step"})
    EXPECT_NE(done.out.find(part), std::string::npos) << part << "\n" << done.out;
}

}  // namespace
}  // namespace sinew::test
