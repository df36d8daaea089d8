#include "sinew/solid/principal.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "solid/sample_laws.hpp"

namespace sinew::solid {
namespace {

TEST(Principal, stretches_and_axes_give_the_deformation_back) {
  std::vector<SampleDeformation> all = upright();
  all.push_back({"thin", kTurn * Vec3(1e3, 1.0, 1e-6).asDiagonal() * kOther, 1.0});
  for (const SampleDeformation& d : all) {
    const auto [U, V, l] = principal(d.F);
    EXPECT_LT((U * l.asDiagonal() * V.transpose() - d.F).norm(), 3e-15 * d.F.norm()) << d.name;
    EXPECT_LT((U.transpose() * U - Mat3::Identity()).norm(), 3e-15) << d.name;
    EXPECT_LT((V.transpose() * V - Mat3::Identity()).norm(), 3e-15) << d.name;
  }
}

TEST(PositiveSemidefinite, keeps_what_is_and_drops_what_is_not) {
  const Law law = corotational(kYoung, kPoisson);
  const Mat9 good = density(law, kTurn, kSecond).second;
  EXPECT_LT((positive_semidefinite(good) - good).norm(), 1e-14 * good.norm());
  const Mat9 bad = density(law, Mat3(Vec3(0.2, 1.0, 1.0).asDiagonal()), kSecond).second;
  const Mat9 mended = positive_semidefinite(bad), lost = mended - bad;
  const auto least = [](const Mat9& K) { return Eigen::SelfAdjointEigenSolver<Mat9>(K).eigenvalues()[0]; };
  EXPECT_GT(least(mended), -1e-14 * bad.norm());
  EXPECT_GT(least(lost), -1e-14 * bad.norm());
  EXPECT_GT(lost.norm(), 0.01 * kYoung);
  EXPECT_LT((mended * lost).norm(), 1e-13 * bad.norm() * bad.norm());
}

TEST(PositiveSemidefinite, leaves_nothing_where_all_is_negative) {
  const Mat3 F = kTurn * Vec3(0.40, 0.45, 0.42).asDiagonal() * kOther;
  const Mat9 C = density(Law(saint_venant_kirchhoff(kYoung, kPoisson)), F, kSecond).second;
  ASSERT_LT(Eigen::SelfAdjointEigenSolver<Mat9>(C).eigenvalues()[8], -1e-3 * C.norm());
  EXPECT_EQ(positive_semidefinite(C, F).norm(), 0.0);
}

TEST(PositiveSemidefinite, knows_the_frame_of_a_thread_and_of_a_speck) {
  const Mat3 U = lie::exp(Vec3(0.7, 0.0, 0.0)), V = lie::exp(Vec3(-1.1, 0.0, 0.0));  // about the axis of the thread
  Mat9 Q, kept = Mat9::Zero(), C = Mat9::Zero();
  int column = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Mat3 ij = U.col(i) * V.col(j).transpose(), ji = U.col(j) * V.col(i).transpose();
    Q.col(column++) = (U.col(k) * V.col(k).transpose()).reshaped();
    Q.col(column++) = std::sqrt(0.5) * (ij + ji).reshaped();
    Q.col(column++) = std::sqrt(0.5) * (ij - ji).reshaped();
  }
  for (int k = 0; k < 9; ++k) {
    const Mat9 own = Q.col(k) * Q.col(k).transpose();
    C += (k % 2 == 0 ? k + 1.0 : -k) * own;
    if (k % 2 == 0) kept += (k + 1.0) * own;
  }
  for (const Vec3& l :
       {Vec3(1.0, 1e-40, 2e-40), Vec3(1.0, 1e-90, 2e-90), Vec3(1e-90, 3e-90, 2e-90), Vec3(1e99, 3e99, 2e99)})
    EXPECT_LT((positive_semidefinite(C, U * l.asDiagonal() * V.transpose()) - kept).norm(), 1e-14 * C.norm())
        << l.transpose();
}

class MadeDefinite : public testing::TestWithParam<NamedLaw> {};
INSTANTIATE_TEST_SUITE_P(Laws, MadeDefinite, testing::ValuesIn(kLaws), [](const auto& i) { return i.param.name; });

/// Second derivatives C of a law at F are made definite as any matrix is.
void expect_nearest(const Mat9& C, const Mat3& F, const std::string& name) {
  const Mat9 nearest = positive_semidefinite(C), split = positive_semidefinite(C, F);
  EXPECT_LE((split - nearest).norm(), 2e-14 * C.norm()) << name;
  EXPECT_LE((split - split.transpose()).norm(), 1e-15 * C.norm()) << name;
}

TEST_P(MadeDefinite, in_the_principal_frame_as_without_one) {
  const Law& law = GetParam().law;
  const double stiffness = 2.0 * lame(law).mu + std::abs(lame(law).lambda);
  std::vector<SampleDeformation> all = within(law);
  all.push_back({"crushed", kTurn * Vec3(0.3, 1.0, 1.1).asDiagonal() * kOther, 1.0});
  all.push_back({"pressed", kTurn * Vec3(0.5, 0.5, 0.5).asDiagonal() * kOther, 1.0});
  all.push_back({"drawn", kTurn * Vec3(3.0, 0.4, 0.4).asDiagonal() * kOther, 1.0});
  all.push_back({"nearly flat", kTurn * Vec3(1e-7, 1.0, 1.2).asDiagonal() * kOther, 1.0});
  if (invertible(law)) {
    all.push_back({"a plane", Vec3(1.2, 1.0, 0.0).asDiagonal(), 1.0});
    all.push_back({"a line, nearly", Vec3(1.2, 0.0, 1e-200).asDiagonal(), 1.0});
    all.push_back({"a point", Mat3::Zero(), 1.0});
  }
  int indefinite = 0;
  for (const SampleDeformation& d : all) {
    const Mat9 C = density(law, d.F, kSecond).second;
    expect_nearest(C, d.F, d.name);
    indefinite += (positive_semidefinite(C) - C).norm() > 1e-3 * C.norm();
    // Pressure of another point, as in elements of several.
    expect_nearest(C - 2.0 * stiffness * parts(law, d.F, kSecond).dilatation.second, d.F, d.name + " under pressure");
  }
  EXPECT_GE(indefinite, 4);
}

}  // namespace
}  // namespace sinew::solid
