#include "sinew/io/signals_csv.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <clocale>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <locale>
#include <random>
#include <sstream>

namespace sinew::io {
namespace {

class SignalsCsv : public testing::Test {
 protected:
  SignalsCsv() {
    char name[] = "/tmp/sinew_csv_XXXXXX";
    folder_ = mkdtemp(name);
    path_ = folder_ / "signals.csv";
  }
  ~SignalsCsv() override { std::filesystem::remove_all(folder_); }

  std::string text() const {
    std::ifstream stream(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::filesystem::path folder_, path_;
};

RecordedStep row(double time, std::vector<double> signals, std::string status = "converged") {
  return {.time = time,
          .status = std::move(status),
          .targets = {},
          .newton = 3,
          .residual = 0,
          .violation = 0,
          .signals = std::move(signals),
          .state = {}};
}

Recording recording_of(std::vector<std::string> names, std::vector<RecordedStep> steps) {
  Recording recording;
  recording.header.signal_names = std::move(names);
  recording.steps = std::move(steps);
  return recording;
}

void write_signals_csv(const std::filesystem::path& path, const Recording& recording) {
  const auto tells = [](const RecordedStep& step) { return !step.targets.empty(); };
  SignalsTable table(path, recording.header, std::any_of(recording.steps.begin(), recording.steps.end(), tells));
  for (const RecordedStep& step : recording.steps) table.add(step);
  table.finish();
}

TEST_F(SignalsCsv, has_the_stated_columns_and_digits) {
  const std::vector<RecordedStep> steps = {row(0.0, {0.1, -0.0}), row(0.01, {1e-300, 12345678.0}, "odd, \"status\"")};
  write_signals_csv(path_, recording_of({"tip.x", "pull.force"}, steps));
  const std::string first = "time,status,newton,tip.x,pull.force\n0,converged,3,0.10000000000000001,-0\n";
  EXPECT_EQ(text(), first + "0.01,\"odd, \"\"status\"\"\",3,1e-300,12345678\n");
  write_signals_csv(path_, recording_of({"tip.x", "pull.force"}, {steps[0]}));  // leaves nothing of the longer one
  EXPECT_EQ(text(), first);
}

TEST_F(SignalsCsv, runs_with_targets_say_what_came_of_them) {
  std::vector<RecordedStep> steps = {row(0.0, {0.1}), row(0.01, {0.2})};
  steps[1].targets = "limited by actuators.pull: force at most 3 N";
  write_signals_csv(path_, recording_of({"tip.x"}, steps));
  EXPECT_EQ(text(),
            "time,status,newton,targets,tip.x\n0,converged,3,,0.10000000000000001\n"
            "0.01,converged,3,limited by actuators.pull: force at most 3 N,0.20000000000000001\n");
}

TEST_F(SignalsCsv, every_double_is_read_back_exactly) {
  std::mt19937_64 random(7);
  std::vector<double> values = {std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max(), -0.0};
  while (values.size() < 2000) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) values.push_back(value);
  }
  std::vector<RecordedStep> steps;
  for (const double value : values) steps.push_back(row(value, {value}));
  write_signals_csv(path_, recording_of({"v"}, steps));
  std::istringstream lines(text());
  std::string line;
  std::getline(lines, line);
  for (const double value : values) {
    ASSERT_TRUE(std::getline(lines, line));
    for (const std::string& number : {line.substr(0, line.find(',')), line.substr(line.rfind(',') + 1)})
      EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(number.c_str(), nullptr)),
                std::bit_cast<std::uint64_t>(value));
  }
}

struct Comma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST_F(SignalsCsv, has_a_point_whatever_the_locale) {
  const std::string old = std::setlocale(LC_ALL, nullptr);
  const std::locale old_cpp = std::locale::global(std::locale(std::locale::classic(), new Comma));
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"})
    if (std::setlocale(LC_ALL, name)) break;  // (the C library's, where one is installed)
  write_signals_csv(path_, recording_of({"v"}, {row(0.5, {1234.5})}));
  std::locale::global(old_cpp);
  std::setlocale(LC_ALL, old.c_str());
  EXPECT_EQ(text(), "time,status,newton,v\n0.5,converged,3,1234.5\n");
}

TEST_F(SignalsCsv, says_where_it_cannot_write) {
  EXPECT_THROW(write_signals_csv(folder_ / "no" / "where", recording_of({}, {})), WriteError);
}

}  // namespace
}  // namespace sinew::io
