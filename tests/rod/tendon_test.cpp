#include "sinew/rod/tendon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rod/random_rods.hpp"
#include "sinew/rod/kinematics.hpp"
#include "support/difference.hpp"

namespace sinew::rod {
namespace {

using test::difference;

const Tendon kHelix{0.1, 1.0, 0.03, 0.02, 0.3, 5.0};

class EveryTendon : public testing::TestWithParam<std::tuple<std::size_t, int, double>> {};

TEST_P(EveryTendon, length_is_that_of_its_points_and_has_its_derivatives) {
  const auto [basis, order, size] = GetParam();
  const Rod rod = random_rod(kBases[basis], order, size, {});
  const Eigen::VectorXd q = make_coordinates(rod, size);
  const TendonLength length = tendon_length(rod, kHelix, q);
  EXPECT_LT((length.gradient - difference(
                                   [&](const Eigen::VectorXd& x) {
                                     return Eigen::VectorXd::Constant(1, tendon_length(rod, kHelix, x).value);
                                   },
                                   q, 1e-6)
                                   .transpose())
                .norm(),
            1e-9);
  EXPECT_GT(length.gradient.norm(), 1e-3);
  const Eigen::MatrixXd H =
      difference([&](const Eigen::VectorXd& x) { return tendon_length(rod, kHelix, x).gradient; }, q, 1e-6);
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(q.size(), q.size());
  for (int i = 0; i < rod.count(); ++i) {
    const int at = rod.first[i], m = rod.first[i + 1] - at;
    blocks.block(at, at, m, m) = length.hessian.block(0, at, m, m);
  }
  EXPECT_LT((H - blocks).norm(), 1e-8);

  if (order > 0) return;  // the curve itself has no integration error with constant strains
  const Configuration shape = configure(rod, kBase, q);
  double polyline = 0.0;
  for (const Section& section : rod.sections) {  // no chord across an edge, where the tendon kinks
    const double from = std::max(section.begin, kHelix.from), to = std::min(section.end, kHelix.to);
    constexpr int kPieces = 2000;
    Vec3 last = position(shape, from, kHelix.offset(from));
    for (int i = 1; i <= kPieces; ++i) {
      const double s = from + (to - from) * (i - 1e-12) / kPieces;
      const Vec3 next = position(shape, s, kHelix.offset(s));
      polyline += (next - last).norm();
      last = next;
    }
  }
  EXPECT_NEAR(length.value, polyline, 1e-6);
}

TEST(Tendon, that_winds_many_times_in_a_section_does_not_bend_the_rod) {
  for (const int turns : {1, 6, 20}) {
    Discretisation cut;
    cut.ends = {0.0, 1.0};
    cut.modes = modes_of({1, 2});
    const Rod rod = make_rod(cut, {{0.0, 1.0, SolidPart{Circle{0.01}, Circle{0.01}, 1e6, 0.4}}});
    const Tendon helix{0.0, 1.0, 0.01, 0.01, 0.0, 2.0 * std::numbers::pi * turns};
    EXPECT_LT(tendon_length(rod, helix, Eigen::VectorXd::Zero(2)).gradient.norm(), 1e-9) << turns;
  }
}

INSTANTIATE_TEST_SUITE_P(Rod, EveryTendon,
                         testing::Combine(testing::Range<std::size_t>(0, kBases.size()), testing::Values(0, 2),
                                          testing::ValuesIn(kSizes)));

}  // namespace
}  // namespace sinew::rod
