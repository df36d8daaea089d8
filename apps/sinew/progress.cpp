#include "sinew/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sinew/error/printable.hpp"

namespace sinew::app {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string duration_text(double seconds) {
  if (seconds < 60.0) return fmt::format("{:.0f} s", seconds);
  return fmt::format("{:.0f} min {:02.0f} s", std::floor(seconds / 60.0), std::fmod(seconds, 60.0));
}

void show(const std::string& line) {
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

Progress::Progress(std::string label, double total, bool quiet)
    : label_(printable(label)),
      total_(total),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()) {}

void Progress::update(double done, const std::string& note) {
  if (quiet_) return;
  const double part = total_ > 0.0 ? std::clamp(done / total_, 0.0, 1.0) : 1.0;
  const double left = part > 0.0 ? seconds_since(start_) * (1.0 - part) / part : 0.0;
  if (terminal_) {
    if (part < 1.0 && seconds_since(shown_) < 0.1) return;
    shown_ = std::chrono::steady_clock::now();
    constexpr int kWidth = 30;
    const int full = static_cast<int>(part * kWidth);
    show(fmt::format("\r{} [{}{}] {:3.0f} %  {}  {} left\033[K", label_, std::string(full, '#'),
                     std::string(kWidth - full, '.'), 100.0 * part, printable(note), duration_text(left)));
  } else if (static_cast<int>(10.0 * part + 1e-9) > tenth_) {
    tenth_ = static_cast<int>(10.0 * part + 1e-9);
    show(fmt::format("{} {:3d} %  {}  {} left\n", label_, 10 * tenth_, printable(note), duration_text(left)));
  }
}

void Progress::finish(const std::string& note) {
  if (quiet_) return;
  show(fmt::format("{}{}: {} in {:.1f} s\n", terminal_ ? "\r\033[K" : "", label_, printable(note),
                   seconds_since(start_)));
}

}  // namespace sinew::app
