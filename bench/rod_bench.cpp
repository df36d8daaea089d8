// What a rod costs in a step, stage by stage, against one dense Cholesky factorisation of 300 x 300 in the same run.
// README.md of this folder says how to run it and what was measured.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sinew/linalg/chain.hpp"
#include "sinew/rod/forces.hpp"
#include "sinew/rod/kinematics.hpp"
#include "sinew/rod/rod.hpp"

namespace sinew {
namespace {

using rod::Vec3;

constexpr int kPoints = 100;     ///< tied to something, two rows each, and one more at the tip
constexpr double kRate = 100.0;  ///< [1/s] steps of 10 ms
const Vec3 kGravity(-9.81, 0.0, 0.0);
constexpr double kLimit = 1.5;  ///< of all stages at 100 sections of three strains, in Cholesky factorisations
constexpr double kAimedAt = 0.5;

/// A tendon of 1 m that bends and twists, what it did before, and where it is held.
struct Tendon {
  rod::Rod rod;
  Eigen::VectorXd q, start;
  Eigen::Matrix3Xd masses;  ///< where the mass points were
  std::vector<double> points;

  Tendon(int sections, const std::vector<int>& strains, int order) {
    rod::Discretisation cut;
    for (int i = 0; i <= sections; ++i) cut.ends.push_back(static_cast<double>(i) / sections);
    std::array<int, 6> orders{};
    orders.fill(order);
    cut.modes = rod::modes_of(strains, orders);
    rod =
        rod::make_rod(cut, {{0.0, 1.0, rod::SolidPart{rod::Circle{4e-3}, rod::Circle{3e-3}, 1e8, 0.4, 1100.0, 10.0}}});
    q.resize(rod.coordinates());
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = std::sin(1.0 + 0.7 * static_cast<double>(i));
    for (int i = 0; i < rod.count(); ++i) {
      const rod::Section& section = rod.sections[i];
      for (std::size_t c = 0; c < section.modes.size(); ++c)
        if (section.modes[c].strain >= 3) q[rod.first[i] + static_cast<int>(c)] *= 0.01;
    }
    start = 0.9999 * q;
    const rod::Configuration shape = configure(start);
    masses = rod::mass_positions(shape);
    for (int i = 0; i < kPoints; ++i) points.push_back((i + 0.37) / kPoints);  // away from Gauss points
  }

  rod::Configuration configure(const Eigen::VectorXd& x) const { return rod::configure(rod, rod::Placement{}, x); }
  rod::Configuration configure() const { return configure(q); }

  /// As sim/rod_rows does: inertia of the mass points by backward Euler, their weight, and a force at each tied point.
  struct Loads {
    std::vector<rod::PointLoad> forces;
    std::vector<rod::StationInertia> stations;
  };
  Loads loads(const rod::Configuration& shape) const {
    Loads loads;
    double sign = 1.0;  // forces that nearly balance, as those of a body do
    for (const double s : points) loads.forces.push_back({s, Vec3::Zero(), (sign = -sign) * Vec3(0.003, -0.01, 0.005)});
    rod::station_inertia(rod, masses, Eigen::Matrix3Xd::Zero(3, masses.cols()), kRate, kGravity, shape.origin,
                         loads.stations);
    return loads;
  }

  rod::Equations equations(const rod::Configuration& shape, const Loads& loads) const {
    rod::Equations equations = rod::make_equations(shape, rod::conservative(loads.forces));
    rod::add_loads(shape, loads.forces, {loads.stations, kGravity}, equations);
    rod::add_elasticity(rod, q, start, kRate, equations);
    return equations;
  }

  std::vector<linalg::Attachment> rows(const rod::Configuration& shape) const {
    std::vector<linalg::Attachment> rows;
    const auto attach = [&](const rod::CurvePoint& point, const Vec3& f) {
      linalg::Attachment own;
      own.link = point.section;
      own.g << (point.position - shape.origin).cross(f), f;
      own.b = point.twists.transpose() * own.g;
      rows.push_back(std::move(own));
    };
    for (const double s : points) {
      const rod::CurvePoint point = rod::curve_point(shape, s);
      for (int i = 1; i < 3; ++i) attach(point, point.R.col(i));
    }
    attach(rod::curve_point(shape, 1.0), Vec3::UnitX());
    return rows;
  }
};

/// Median times [us] by name and arguments.
std::map<std::string, double> medians;

class Collect : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.error_occurred) fmt::print(stderr, "{}: {}\n", run.benchmark_name(), run.error_message);
      if (run.aggregate_name == "median") medians[run.run_name.function_name] = run.GetAdjustedRealTime();
    }
  }
};

struct Case {
  int sections;
  const char* name;
  std::vector<int> strains;
  int order;
};

const std::vector<Case> kCases = {{10, "3 strains", {0, 1, 2}, 0},
                                  {100, "3 strains", {0, 1, 2}, 0},
                                  {1000, "3 strains", {0, 1, 2}, 0},
                                  {100, "6 strains", {0, 1, 2, 3, 4, 5}, 0},
                                  {100, "3 strains, linear", {0, 1, 2}, 1}};
const std::vector<std::string> kStages = {"configure", "rows", "loads", "A_q", "factor", "W"};

std::string name_of(const Case& own, const std::string& stage) {
  return fmt::format("{} x {}: {}", own.sections, own.name, stage);
}

/// What the stages of a case start from.
struct Ready {
  Tendon tendon;
  rod::Configuration shape;
  Tendon::Loads loads;
  std::vector<linalg::Attachment> rows;
  rod::Equations equations;
  linalg::ChainFactor factor;

  explicit Ready(const Case& own)
      : tendon(own.sections, own.strains, own.order),
        shape(tendon.configure()),
        loads(tendon.loads(shape)),
        rows(tendon.rows(shape)),
        equations(tendon.equations(shape, loads)) {
    if (!factor.factor(equations.chain)) throw std::runtime_error("singular");
    if (factor.negative() > 0) fmt::print(stderr, "A_q has {} negative eigenvalues\n", factor.negative());
  }

  void whole() const {
    const rod::Configuration now = tendon.configure();
    const auto attachments = tendon.rows(now);
    const rod::Equations all = tendon.equations(now, tendon.loads(now));
    linalg::ChainFactor factored;
    benchmark::DoNotOptimize(factored.factor(all.chain));
    linalg::ChainFactor::Condensed condensed;
    factored.condense(attachments, condensed);
    benchmark::DoNotOptimize(condensed.W.data());
  }
};

template <class F>
void measure(const std::string& name, const F& run) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [run](benchmark::State& state) {
                                 for (auto _ : state) benchmark::DoNotOptimize(run());
                               })
      ->Unit(benchmark::kMicrosecond)
      ->MinTime(0.01)
      ->Repetitions(25);
}

void register_case(const Case& own) {
  const auto ready = std::make_shared<Ready>(own);
  measure(name_of(own, "configure"), [ready] { return ready->tendon.configure(); });
  measure(name_of(own, "rows"), [ready] { return ready->tendon.rows(ready->shape); });
  measure(name_of(own, "loads"), [ready] { return ready->tendon.loads(ready->shape); });
  measure(name_of(own, "A_q"), [ready] { return ready->tendon.equations(ready->shape, ready->loads); });
  measure(name_of(own, "factor"), [ready] {
    linalg::ChainFactor factor;
    return factor.factor(ready->equations.chain);
  });
  measure(name_of(own, "W"), [ready, condensed = std::make_shared<linalg::ChainFactor::Condensed>()] {
    ready->factor.condense(ready->rows, *condensed);
    return condensed->W(0, 0);
  });
  measure(name_of(own, "all in one"), [ready] {
    ready->whole();
    return 0;
  });
}

void register_cholesky() {
  Eigen::MatrixXd A = Eigen::MatrixXd::Random(300, 300);
  A = (A * A.transpose() + 300.0 * Eigen::MatrixXd::Identity(300, 300)).eval();
  measure("Cholesky", [A, llt = std::make_shared<Eigen::LLT<Eigen::MatrixXd>>(300)] {
    llt->compute(A);
    return llt->matrixLLT()(299, 299);
  });
}

/// Prints the table; false where the limit is broken.
bool report() {
  if (!medians.contains("Cholesky")) {
    fmt::print(stderr, "Nothing to compare with: let --benchmark_filter keep \"Cholesky\" and whole cases.\n");
    return false;
  }
  const double cholesky = medians.at("Cholesky");
  fmt::print("Cholesky of 300 x 300: {:.0f} us. Rows: {}. Compiled with {} {}\n\n", cholesky, 2 * kPoints + 1,
             SINEW_BENCH_COMPILER, SINEW_BENCH_FLAGS);
  fmt::print("{:>8}  {:<18} {:<16} {:>12} {:>14} {:>12}\n", "sections", "each of", "stage", "median, us",
             "us a section", "/ Cholesky");
  bool met = true;
  for (const Case& own : kCases) {
    if (!medians.contains(name_of(own, "all in one"))) continue;  // left out by --benchmark_filter
    double sum = 0.0;
    const auto line = [&](const std::string& stage, double time) {
      fmt::print("{:>8}  {:<18} {:<16} {:>12.1f} {:>14.3f} {:>12.3f}\n", own.sections, own.name, stage, time,
                 time / own.sections, time / cholesky);
    };
    for (const std::string& stage : kStages) {
      const double time = medians[name_of(own, stage)];
      sum += time;
      line(stage, time);
    }
    line("sum", sum);
    line("all in one", medians.at(name_of(own, "all in one")));
    fmt::print("\n");
    if (own.sections == 100 && own.strains.size() == 3 && own.order == 0) {
      met = sum <= kLimit * cholesky;
    }
  }
  fmt::print("100 sections of 3 strains: at most {} Cholesky factorisations {}, aimed at {}\n", kLimit,
             met ? "kept" : "BROKEN", kAimedAt);
  return met;
}

}  // namespace
}  // namespace sinew

int main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  std::string interleaved = "--benchmark_enable_random_interleaving=true";  // stages and Cholesky take turns
  arguments.insert(arguments.begin() + 1, interleaved.data());
  auto count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  sinew::register_cholesky();
  for (const sinew::Case& own : sinew::kCases) sinew::register_case(own);
  sinew::Collect collect;
  benchmark::RunSpecifiedBenchmarks(&collect);
  return sinew::report() ? 0 : 1;
}
