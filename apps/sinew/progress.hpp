// Progress on long work: a bar with the time left on a terminal, a line at every tenth otherwise.
#pragma once

#include <chrono>
#include <string>

namespace sinew::app {

class Progress {
 public:
  Progress(std::string label, double total, bool quiet);
  /// `done` of the total, and a short note (simulated time, iterations).
  void update(double done, const std::string& note);
  void finish(const std::string& note);

 private:
  std::string label_;
  double total_;
  bool quiet_, terminal_;
  std::chrono::steady_clock::time_point start_, shown_;
  int tenth_ = 0;
};

}  // namespace sinew::app
