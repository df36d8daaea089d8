// Orders of convergence in the section length, against a shooting solution that does not know the engine.
#include "validation/shooting.hpp"

namespace sinew::test {
namespace {

const Stiffness kStiffness = {0.8, 1.0, 1.5, 60.0, 25.0, 30.0};
const Vec3 kForce(-0.6, 1.2, 0.9);  // out of plane: the tip moves by 0.4 of the length, and twists

class Convergence : public testing::TestWithParam<bool> {
 protected:
  const bool all_ = GetParam();  ///< six strains, or torsion and bending only
  const ShotTip exact_ = shoot_cantilever(1.0, kForce, kStiffness, all_);

  /// Distance of the tip from the exact one.
  double error(int order, int sections) const {
    Scene scene = straight_rod(1.0, sections, given(kStiffness), all_ ? kAll : kBending, order, 2);
    scene.newton.tolerance = 1e-13;
    add_load(scene, kForce);
    return (solve(scene).tip() - exact_.p).norm();
  }
  /// Power of the section length with which the error falls from n sections to 2 n; n + n/2 lies on the same line.
  double order_of(int order, int n) const {
    const double coarse = error(order, n), middle = error(order, n + n / 2), fine = error(order, 2 * n);
    const double found = std::log2(coarse / fine);
    EXPECT_NEAR(std::log(coarse / middle) / std::log(1.5), found, 0.2) << order;
    std::printf("order %d, %d to %d sections: error %.2e to %.2e, falls with power %.2f\n", order, n, 2 * n, coarse,
                fine, found);
    return found;
  }
};

TEST_P(Convergence, shooting_knows_the_closed_form_of_a_straight_pull_and_keeps_frames_orthogonal) {
  EXPECT_LT((exact_.R.transpose() * exact_.R - rod::Mat3::Identity()).norm(), 1e-12);
  EXPECT_GT((exact_.p - Vec3(1, 0, 0)).norm(), 0.4);
  EXPECT_GT(std::abs(exact_.R(2, 1) - exact_.R(1, 2)), 0.01);  // twisted
  const ShotTip pulled = shoot_cantilever(1.0, Vec3(3, 0, 0), kStiffness, all_);
  EXPECT_LT((pulled.p - Vec3(all_ ? 1.0 + 3.0 / 60.0 : 1.0, 0, 0)).norm(), 1e-12);
}

TEST_P(Convergence, constant_strain_is_of_second_order) { EXPECT_NEAR(order_of(0, 16), 2.0, 0.2); }
TEST_P(Convergence, linear_strain_is_of_fourth_order) { EXPECT_NEAR(order_of(1, 16), 4.0, 0.3); }
TEST_P(Convergence, quadratic_strain_is_of_sixth_order) { EXPECT_NEAR(order_of(2, 8), 6.0, 0.3); }

TEST_P(Convergence, cubic_strain_keeps_the_order_six_of_the_integration) {
  // The discretisation would give eight; the exponentials of a section (rod/integration) are of order six.
  EXPECT_GT(order_of(3, 4), 5.7);
}

TEST_P(Convergence, holds_under_a_distributed_load_too) {
  const auto tip_of = [this](int order, int sections) {
    Scene scene = straight_rod(1.0, sections, given(kStiffness), all_ ? kAll : kBending, order, 2);
    scene.newton.tolerance = 1e-13;
    RodLoad& load = add_load(scene, 2.0 * kForce);
    load.from = 0.0;
    load.to = 1.0;
    return solve(scene).tip();
  };
  const Vec3 exact = tip_of(3, 24);
  const auto power = [&](int order, int n) {
    return std::log2((tip_of(order, n) - exact).norm() / (tip_of(order, 2 * n) - exact).norm());
  };
  EXPECT_GT((exact - Vec3(1, 0, 0)).norm(), 0.3);
  EXPECT_NEAR(power(0, 16), 2.0, 0.2);
  EXPECT_NEAR(power(1, 12), 4.0, 0.3);
  EXPECT_NEAR(power(2, 6), 6.0, 0.3);
}

TEST_P(Convergence, one_section_gains_with_every_order) {
  double last = error(0, 1);
  for (int order = 1; order <= 5; ++order) {
    const double now = error(order, 1);
    EXPECT_LT(now, 0.2 * last) << order;
    last = now;
  }
  EXPECT_LT(last, 1e-7);
}

// Waits for the engine: with degree five the tip's error falls with the second power only, from 1e-9, because the first
// moment of P5 over a section is integrated with three Gauss nodes a step (exact to degree five; s P5 has six).
TEST_P(Convergence, quintic_strain_gains_over_quartic) { EXPECT_LT(error(5, 8), error(4, 8)); }

INSTANTIATE_TEST_SUITE_P(Strains, Convergence, testing::Values(false, true));

}  // namespace
}  // namespace sinew::test
