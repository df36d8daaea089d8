// Contact problems of many scenes: the engine's solver beside plain block Gauss-Seidel, as a table.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "support/contact_problems.hpp"

namespace {

using namespace sinew;

struct Row {
  std::string scene;
  int problems = 0, least = 1 << 30, most = 0;
  std::vector<double> sweeps{}, newton{}, seconds{}, plain_sweeps{}, plain_seconds{};
  int solved = 0, plain_solved = 0, worse = 0;
  double residual = 0.0, plain_residual = 0.0;
};

double median(std::vector<double> numbers) {
  std::nth_element(numbers.begin(), numbers.begin() + numbers.size() / 2, numbers.end());
  return numbers[numbers.size() / 2];
}

template <class Work>
double seconds_of(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

int main() {
  constexpr double kTolerance = 1e-8;
  constexpr int kMostSweeps = 1000;
  std::vector<Row> rows;
  Row all{.scene = "all"};
  solve::Coulomb solver;
  for (const test::ContactProblem& own : test::contact_problems()) {
    if (rows.empty() || rows.back().scene != own.scene) {
      const auto same = std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.scene == own.scene; });
      if (same == rows.end()) {
        rows.push_back({.scene = own.scene});
      } else {
        std::rotate(same, same + 1, rows.end());
      }
    }
    Eigen::VectorXd lambda = Eigen::VectorXd::Zero(own.problem.b.size()), plain;
    solve::CoulombReport report;
    int sweeps = 0;
    const double ours = seconds_of([&] { report = solver.solve(own.problem, kTolerance, lambda); }),
                 theirs = seconds_of([&] { sweeps = test::plain_sweeps(own.problem, kTolerance, kMostSweeps, plain); });
    const double left = report.residual.largest(), plain_left = solve::residual(own.problem, plain).largest();
    for (Row* row : {&rows.back(), &all}) {
      ++row->problems;
      row->least = std::min(row->least, own.problem.contacts());
      row->most = std::max(row->most, own.problem.contacts());
      row->sweeps.push_back(report.sweeps);
      row->newton.push_back(report.newton);
      row->seconds.push_back(ours);
      row->plain_sweeps.push_back(sweeps);
      row->plain_seconds.push_back(theirs);
      row->solved += left <= kTolerance ? 1 : 0;
      row->plain_solved += plain_left <= kTolerance ? 1 : 0;
      row->worse += left > std::max(kTolerance, plain_left) ? 1 : 0;
      row->residual = std::max(row->residual, left);
      row->plain_residual = std::max(row->plain_residual, plain_left);
    }
  }
  rows.push_back(all);
  fmt::print(
      "| scene | problems | contacts | solved | sweeps | Newton | time [ms] | worst residual | plain: solved | sweeps "
      "| "
      "time [ms] | worst residual | we are worse |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    fmt::print("| {} | {} | {} to {} | {} | {:.0f} | {:.0f} | {:.3f} | {:.0e} | {} | {:.0f} | {:.3f} | {:.0e} | {} |\n",
               row.scene, row.problems, row.least, row.most, row.solved, median(row.sweeps), median(row.newton),
               1e3 * median(row.seconds), row.residual, row.plain_solved, median(row.plain_sweeps),
               1e3 * median(row.plain_seconds), row.plain_residual, row.worse);
  }
  const bool met = all.solved >= 0.95 * all.problems && all.worse == 0;
  return met ? 0 : 1;
}
