#include "sinew/constraint/sliding.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/constraint/independent.hpp"
#include "support/difference.hpp"

namespace sinew::constraint {
namespace {

rod::Rod bent_rod(const std::vector<int>& basis, int sections = 5, double length = 0.1) {
  rod::Discretisation cut;
  for (int i = 0; i <= sections; ++i) cut.ends.push_back(length * i / sections);
  cut.modes = rod::modes_of(basis);
  rod::Rod rod = rod::make_rod(cut, {{0.0, length, rod::SolidPart{}}});
  rod.base = {{false, 0, -1.0}};
  return rod;
}

const rod::Placement kBase{lie::exp(Vec3(0.3, -0.4, 0.8)), Vec3(0.1, 0.2, -0.1)};

Eigen::VectorXd coordinates(const rod::Rod& rod, double size) {
  Eigen::VectorXd q(rod.coordinates());
  for (int i = 0; i < q.size(); ++i) q[i] = i == 0 ? 0.004 : size * std::cos(1.3 * i);
  for (int i = 1; i < q.size(); ++i) {
    const auto& modes = rod.sections[0].modes;
    if (modes[static_cast<std::size_t>(i - 1) % modes.size()].strain >= 3) q[i] *= 0.1;
  }
  return q;
}

class EveryStrain : public testing::TestWithParam<std::tuple<std::vector<int>, double>> {};

// The rows as the paper has them: delta after projecting anew, its derivative with respect to q and to the point.
TEST_P(EveryStrain, sliding_rows_match_finite_differences_with_projection) {
  const auto& [basis, scale] = GetParam();
  const rod::Rod rod = bent_rod(basis);
  const Eigen::VectorXd q = coordinates(rod, scale == 1.0 ? 10.0 : scale);
  const rod::Configuration shape = rod::configure(rod, kBase, q);
  for (double s : {0.013, 0.055, 0.093}) {
    const Vec3 P = rod::position(shape, s);  // on the rod: the gap is zero, as after every converged step
    const double projected = project(shape, s + 0.004, P);
    EXPECT_NEAR(projected, s, 1e-12);
    const SlidingRows rows = sliding_rows(shape, projected, P);
    EXPECT_LT(rows.delta.norm(), 1e-15);
    const auto gap = [&](const Eigen::VectorXd& y, const Vec3& point) -> Eigen::VectorXd {
      const rod::Configuration moved = rod::configure(rod, kBase, y);
      const double at = project(moved, projected, point);
      return rows.N.transpose() * (point - rod::position(moved, at));
    };
    const Eigen::MatrixXd D = test::difference([&](const Eigen::VectorXd& y) { return gap(y, P); }, q, 1e-6);
    const Eigen::MatrixXd Dx = test::difference([&](const Eigen::VectorXd& x) { return gap(q, x); }, P, 1e-6);
    EXPECT_LT((rows.J - D).norm(), 1e-8) << s;
    EXPECT_LT((Eigen::MatrixXd(rows.N.transpose()) - Dx).norm(), 1e-8) << s;
    EXPECT_GT(Dx.norm(), 1.0);
    if (basis.size() >= 3) {
      EXPECT_GT(rows.J.norm(), 1e-4);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sliding, EveryStrain,
                         testing::Combine(testing::Values(std::vector<int>{0, 1, 2}, std::vector<int>{1},
                                                          std::vector<int>{0, 1, 2, 3, 4, 5}, std::vector<int>{2, 3}),
                                          testing::Values(0.0, 1e-8, 1e-5, 1.0)));

TEST(Sliding, lambda_does_the_work_of_the_rows) {
  // +J^T lambda on the rod is minus what the force does at the point of the curve.
  const rod::Rod rod = bent_rod({0, 1, 2});
  const rod::Configuration shape = rod::configure(rod, kBase, coordinates(rod, 8.0));
  const SlidingRows rows = sliding_rows(shape, 0.06, rod::position(shape, 0.06));
  const Eigen::Vector2d lambda(1.5, -0.7);
  const Eigen::VectorXd on_rod = rows.J.transpose() * lambda;
  const Eigen::VectorXd opposite = rod::position_jacobian(shape, 0.06).transpose() * (rows.N * lambda);
  EXPECT_GT(on_rod.norm(), 1e-3);
  EXPECT_LT((on_rod + opposite).norm(), 1e-15);
}

TEST(Sliding, projection_stays_on_its_branch_of_a_cable_that_folds_back) {
  // A hairpin: two straight legs 4 mm apart. Points near one leg are nearest to the other when they are pushed towards
  // it.
  rod::Rod rod = bent_rod({2}, 100, 0.1);
  rod.base.clear();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(100);
  for (int i = 47; i < 53; ++i) q[i] = std::numbers::pi / 0.006;  // half a turn within 6 mm
  const rod::Configuration shape = rod::configure(rod, rod::Placement{}, q);
  const double s = 0.02;
  const Vec3 here = rod::position(shape, s);
  const double across = rod::position(shape, 0.08).y() - here.y();
  ASSERT_NEAR(across, 2 * 0.006 / std::numbers::pi, 1e-4);
  for (double part : {0.0, 0.3, 0.6, 0.9, 1.1}) {
    EXPECT_NEAR(project(shape, s, here + Vec3(0, part * across, 0)), s, 1e-9) << part;
  }
}

TEST(Sliding, projection_follows_a_point_around_the_bend_and_past_both_ends) {
  rod::Rod rod = bent_rod({2}, 10, 0.1);
  rod.base.clear();
  const rod::Configuration shape = rod::configure(rod, rod::Placement{}, Eigen::VectorXd::Constant(10, 25.0));
  double s = 0.0;
  for (double t = -0.01; t <= 0.11; t += 0.002) {
    const rod::CurvePoint tip = rod::curve_point(shape, 0.1);  // beyond it, straight on
    s = project(shape, s, t <= 0.1 ? rod::position(shape, t) : Vec3(tip.position + (t - 0.1) * tip.derivative));
    EXPECT_NEAR(s, t, 1e-10);
  }
}

// From near and far, for points on the rod and some way off; across the tip, where the rod goes on straight.
TEST(Sliding, projection_is_exact_to_rounding) {
  for (const std::vector<int>& basis : {std::vector{2}, std::vector{0, 1, 2}, std::vector{0, 1, 2, 3, 4, 5}}) {
    const rod::Rod rod = bent_rod(basis);
    const rod::Configuration shape = rod::configure(rod, kBase, coordinates(rod, 10.0));
    const auto expect = [&](double s, double off, double before) {
      const rod::CurvePoint at = rod::curve_point(shape, std::min(s, rod.length()));
      const Vec3 across = at.derivative.cross(Vec3(0.3, -0.5, 0.8)).normalized();
      const Vec3 P = at.position + std::max(0.0, s - rod.length()) * at.derivative + off * across;
      EXPECT_NEAR(project(shape, s + before, P), s, 4e-15) << basis.size() << " " << s << " " << off << " " << before;
    };
    for (const double off : {0.0, 1e-6, 1e-3, 1e-2}) {
      for (const double before : {0.0, 1e-12, 1e-9, 1e-6, 1e-4, 4e-3, -4e-3}) {
        for (const double s : {0.013, 0.055, 0.093}) expect(s, off, before);
        for (const double past : {1e-12, 1e-10, 1e-6, 1e-3}) expect(rod.length() + past, off, -past - std::abs(before));
      }
    }
  }
}

TEST(Sliding, a_rigid_motion_changes_nothing) {
  const rod::Rod rod = bent_rod({0, 1, 2});
  const Eigen::VectorXd q = coordinates(rod, 9.0);
  const rod::Mat3 Q = lie::exp(Vec3(1.0, 2.0, -0.5));
  const Vec3 shift(3.0, -2.0, 5.0);
  const rod::Configuration a = rod::configure(rod, kBase, q),
                           b = rod::configure(rod, rod::Placement{Q * kBase.R, Q * kBase.p + shift}, q);
  const Vec3 P = rod::position(a, 0.05) + Vec3(1e-3, 2e-3, -1e-3);
  const double sa = project(a, 0.05, P), sb = project(b, 0.05, Q * P + shift);
  EXPECT_NEAR(sa, sb, 1e-14);
  EXPECT_LT((sliding_rows(a, sa, P).delta - sliding_rows(b, sb, Q * P + shift).delta).norm(), 1e-14);
  EXPECT_LT((sliding_rows(a, sa, P).J - sliding_rows(b, sb, Q * P + shift).J).norm(), 1e-14);
}

TEST(Independent, keeps_a_spanning_set_and_takes_the_first_first) {
  Eigen::MatrixXd A(4, 3);
  A << 1, 0, 0, 0, 1, 0, 0.5, 0.5, 0, 0, 0, 2;  // the third is the mean of the first two
  auto kept = independent_rows(A * A.transpose(), 1e-6);
  std::sort(kept.begin(), kept.end());
  EXPECT_EQ(kept, (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(independent_rows(A * A.transpose(), 1e-6, 3).size(), 4u);  // forced ones stay even if they repeat others
  EXPECT_TRUE(independent_rows(Eigen::MatrixXd::Zero(2, 2), 1e-6).empty());
  EXPECT_EQ(independent_rows(Eigen::MatrixXd::Zero(2, 2), 1e-6, 1), std::vector<int>{0});
}

}  // namespace
}  // namespace sinew::constraint
