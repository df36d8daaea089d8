// A folder with a short scene, runs of it, and what their outputs hold.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <regex>

#include "finger_scene.hpp"
#include "run_program.hpp"
#include "sinew/io/recording.hpp"

namespace sinew::test {

/// scene.yaml with its mesh. Recordings name the scene's folder, so only runs of one folder have equal bytes.
class SceneFolder {
 public:
  explicit SceneFolder(const std::string& scene = finger_scene) {
    write_file(folder_ / "scene.yaml", scene);
    write_file(folder_ / "meshes/finger.vtk", finger_mesh());
  }
  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  const std::filesystem::path& path() const { return folder_.path(); }

  /// `sinew run` into a folder of this name, with few files for ParaView.
  Arguments run(const std::string& out, const Arguments& more = {}) const {
    Arguments all = {"run", path_of("scene.yaml"), "-o", path_of(out), "--quiet", "--set", "view.interval=10 s"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Arguments resume(const std::string& out) const { return {"run", "--resume", path_of(out), "--quiet"}; }
  Arguments export_of(const std::string& out) const { return {"export", path_of(out)}; }
  std::string recording(const std::string& out) const { return read_file(folder_ / out / "run.sinew"); }
  std::string signals(const std::string& out) const { return read_file(folder_ / out / "signals.csv"); }
  std::string path_of(const std::string& name) const { return (folder_ / name).string(); }

 private:
  Folder folder_;
};

inline nlohmann::json report_of(const std::filesystem::path& out) {
  return nlohmann::json::parse(read_file(out / "report.json"));
}

inline bool holds_null(const nlohmann::json& json) {
  if (json.is_null()) return true;
  return json.is_structured() &&
         std::any_of(json.begin(), json.end(), [](const auto& part) { return holds_null(part); });
}

inline std::string from_base64(const std::string& text) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) continue;
    bits = (bits << 6) | static_cast<std::uint32_t>(digit);
    if ((have += 6) < 8) continue;
    have -= 8;
    bytes += static_cast<char>((bits >> have) & 0xFFu);
  }
  return bytes;
}

/// All numbers of type Float64 of a .vtu file with inline binary arrays (8 bytes of size before each).
inline std::vector<double> numbers_of_vtu(const std::string& text) {
  std::vector<double> numbers;
  const std::string mark = "<DataArray type=\"Float64\"";
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    const std::size_t begin = text.find('>', at) + 1;
    const std::string bytes = from_base64(text.substr(begin, text.find('<', begin) - begin));
    for (std::size_t i = 8; i + 8 <= bytes.size(); i += 8) {
      double number = 0.0;
      std::memcpy(&number, bytes.data() + i, 8);
      numbers.push_back(number);
    }
  }
  return numbers;
}

inline bool all_finite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

/// No NaN and no infinity in anything a run wrote.
inline void expect_numbers_only(const std::filesystem::path& out) {
  const io::Recording recording = io::read_recording(out / "run.sinew");
  EXPECT_FALSE(recording.torn);
  EXPECT_FALSE(recording.steps.empty());
  for (const io::RecordedStep& step : recording.steps) {
    EXPECT_TRUE(std::isfinite(step.time) && std::isfinite(step.residual) && std::isfinite(step.violation));
    EXPECT_TRUE(all_finite(step.signals));
    EXPECT_TRUE(all_finite(step.state));
  }
  const std::regex not_a_number("(^|[,\\s\"-])(nan|inf)", std::regex::icase);
  EXPECT_FALSE(std::regex_search(read_file(out / "signals.csv"), not_a_number));
  EXPECT_FALSE(holds_null(report_of(out))) << "JSON has no NaN; it is written as null";
  std::size_t files = 0;
  for (const std::string& file : files_below(out)) {
    if (!file.ends_with(".vtu")) continue;
    const std::vector<double> numbers = numbers_of_vtu(read_file(out / file));
    EXPECT_GT(numbers.size(), 10u) << file;
    EXPECT_TRUE(all_finite(numbers)) << file;
    ++files;
  }
  EXPECT_GE(files, 2u);
}

}  // namespace sinew::test
