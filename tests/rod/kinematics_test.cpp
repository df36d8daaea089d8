#include "sinew/rod/kinematics.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "rod/random_rods.hpp"
#include "sinew/rod/forces.hpp"
#include "support/difference.hpp"

namespace sinew::rod {
namespace {

using test::difference;

class EveryBasis : public testing::TestWithParam<std::tuple<std::size_t, int, double>> {
 protected:
  int order = std::get<1>(GetParam());
  double size = std::get<2>(GetParam());
  Rod rod = random_rod(kBases[std::get<0>(GetParam())], order, size);
  Eigen::VectorXd q = make_coordinates(rod, size);
  Configuration at(const Eigen::VectorXd& x) const { return configure(rod, kBase, x); }

  Equations equations(const Eigen::VectorXd& x, const std::vector<PointLoad>& loads, int slides = 0) const {
    const Configuration shape = at(x);
    Equations all = make_equations(shape, conservative(loads), slides);
    add_loads(shape, loads, all);
    return all;
  }
  Eigen::MatrixXd numeric_tangent(const std::vector<PointLoad>& loads) const {
    return difference([&](const Eigen::VectorXd& x) { return equations(x, loads).r; }, q, 1e-6);
  }
};

TEST_P(EveryBasis, position_jacobian_matches_finite_differences) {
  for (double s : kAbscissae) {
    const Eigen::MatrixXd J = position_jacobian(at(q), s, kOffset);
    const Eigen::MatrixXd D =
        difference([&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return position(at(x), s, kOffset); }, q, 1e-6);
    EXPECT_GT(J.norm(), 0.1) << "nothing is compared";
    EXPECT_LT((J - D).norm(), 5e-9) << s;
  }
}

TEST_P(EveryBasis, derivatives_along_the_curve_match_finite_differences) {
  const Configuration shape = at(q);
  for (double s : {0.1, 0.42, 0.83}) {
    const CurvePoint point = curve_point(shape, s);
    const double e = 1e-6;
    const CurvePoint plus = curve_point(shape, s + e), minus = curve_point(shape, s - e);
    EXPECT_GT(point.derivative.norm(), 0.1);
    EXPECT_LT((point.derivative - (plus.position - minus.position) / (2 * e)).norm(), 1e-9);
    // gamma_s = R u up to the error of the integration.
    EXPECT_LT((point.second - (plus.derivative - minus.derivative) / (2 * e)).norm(),
              order == 0 ? 1e-9 : 1e-9 + 2e-2 * size);
    const Vec6 xi = strain(rod, q, s);
    EXPECT_LT((point.derivative - point.R * Vec3(Vec3::UnitX() + xi.tail<3>())).norm(),
              order == 0 ? 1e-14 : 1e-14 + 3e-3 * size);
  }
}

TEST_P(EveryBasis, loads_give_the_work_and_its_exact_second_derivative) {
  std::vector<PointLoad> loads;
  for (double s : kAbscissae) loads.push_back({s, kOffset, Vec3(1.0 + s, -0.5, 0.3 * s)});
  loads.push_back({1.15, Vec3::Zero(), Vec3(0.1, 0.2, -0.7)});
  const Equations all = equations(q, loads);
  Eigen::VectorXd by_jacobians = Eigen::VectorXd::Zero(rod.coordinates());
  for (const PointLoad& load : loads)
    by_jacobians += position_jacobian(at(q), load.s, load.offset).transpose() * load.force;
  EXPECT_GT(all.r.norm(), 0.1);
  EXPECT_LT((all.r - by_jacobians).norm(), 1e-13 * (1 + all.r.norm()));
  const Eigen::MatrixXd H = dense_tangent(at(q), all);
  EXPECT_LT((H - H.transpose()).norm(), 1e-13 * (1 + H.norm()));
  EXPECT_LT((H - numeric_tangent(loads)).norm(), 5e-8);
}

TEST_P(EveryBasis, followers_and_moments_have_their_exact_unsymmetric_tangent) {
  for (const bool follower : {false, true}) {
    std::vector<PointLoad> loads;
    const Configuration start = at(q);
    // A follower's force and moment turn with the cross-section; the moment alone is dead.
    const auto loaded = [&](const Configuration& shape) {
      std::vector<PointLoad> now;
      for (double s : {0.1, 0.42, 0.8, 1.1}) {
        const Mat3 R = follower ? curve_point(shape, s).R : Mat3::Identity();
        PointLoad load{s, kOffset, R * Vec3(1.0 + s, -0.5, 0.3 * s)};
        load.moment = R * Vec3(0.4, 0.2 - s, 0.7);
        load.follower = follower;
        now.push_back(load);
      }
      return now;
    };
    const Equations all = equations(q, loaded(start));
    const Eigen::MatrixXd numeric =
        difference([&](const Eigen::VectorXd& x) { return equations(x, loaded(at(x))).r; }, q, 1e-6);
    const Eigen::MatrixXd H = dense_tangent(start, all);
    EXPECT_LT((H - numeric).norm(), 5e-8) << follower;
    EXPECT_GT((H - H.transpose()).norm(), 1e-3) << "a symmetric one would have passed";
  }
}

TEST_P(EveryBasis, weights_give_the_mass_matrix) {
  std::vector<PointLoad> loads;
  for (double s : kAbscissae) loads.push_back({s, kOffset, Vec3::Zero(), 1.0 + s * s});
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(rod.coordinates(), rod.coordinates());
  for (const PointLoad& load : loads) {
    const Eigen::MatrixXd J = position_jacobian(at(q), load.s, load.offset);
    expected += load.weight * J.transpose() * J;
  }
  EXPECT_GT(expected.norm(), 0.1);
  EXPECT_LT((dense_tangent(at(q), equations(q, loads)) - expected).norm(), 1e-13 * expected.norm());
}

TEST_P(EveryBasis, stiffnesses_give_the_exact_tangent_of_springs) {
  // Springs from where the points are: forces S (X - X_0) grow from f.
  std::vector<Mat6> stiffness;  // by turns, of which these springs feel none, and motions
  for (double s : kAbscissae) {
    Mat3 S = Vec3(1.0 + s, -0.5, 2.0 * s).asDiagonal();
    S(0, 1) = S(1, 0) = 0.3 - s;
    S(1, 2) = S(2, 1) = 0.7 * s;
    stiffness.emplace_back(Mat6::Zero()).bottomRightCorner<3, 3>() = S;
  }
  const Configuration start = at(q);
  const auto sprung = [&](const Configuration& shape) {
    std::vector<PointLoad> loads;
    for (std::size_t i = 0; i < std::size(kAbscissae); ++i) {
      const double s = kAbscissae[i];
      PointLoad load{s, kOffset, Vec3(1.0 + s, -0.5, 0.3 * s)};
      load.force +=
          stiffness[i].bottomRightCorner<3, 3>() * (position(shape, s, kOffset) - position(start, s, kOffset));
      load.stiffness = &stiffness[i];
      loads.push_back(load);
    }
    return loads;
  };
  const Eigen::MatrixXd numeric =
      difference([&](const Eigen::VectorXd& x) { return equations(x, sprung(at(x))).r; }, q, 1e-6);
  const Eigen::MatrixXd H = dense_tangent(start, equations(q, sprung(start)));
  EXPECT_GT(H.norm(), 0.1);
  EXPECT_LT((H - H.transpose()).norm(), 1e-13 * (1 + H.norm()));
  EXPECT_LT((H - numeric).norm(), 5e-8);
}

TEST_P(EveryBasis, sliding_abscissae_have_their_exact_derivatives) {
  const Vec3 f(0.7, -0.4, 0.5);
  double largest = 0.0;
  for (double s : kAbscissae) {
    PointLoad load{s, Vec3::Zero(), f};
    load.slide = 0;
    const Equations all = equations(q, {load}, 1);
    const auto along = [&](const Eigen::VectorXd& x, double at_s) {
      return f.dot(curve_point(at(x), at_s).derivative);
    };
    const Eigen::MatrixXd D =
        difference([&](const Eigen::VectorXd& x) { return Eigen::VectorXd::Constant(1, along(x, s)); }, q, 1e-6);
    const auto coupling_of = [&](const Slide& slide) {
      Eigen::VectorXd coupling(rod.coordinates());
      coupling << at(q).base.transpose() * slide.attachment.g, dense(all.chain, slide.attachment);
      return coupling;
    };
    const Eigen::VectorXd coupling = coupling_of(all.slides[0]);
    largest = std::max(largest, coupling.norm());
    EXPECT_LT((coupling - D.transpose()).norm(), 5e-9) << s;
    const bool turns = !rod.sections[0].stretches() && at(q).strains[0].cols() == 1;
    const std::optional<Slide> direct = slide_at(at(q), curve_point(at(q), s), f);
    ASSERT_EQ(direct.has_value(), turns);
    if (direct) {
      EXPECT_LT((coupling_of(*direct) - coupling).norm(), 1e-13 * (1.0 + coupling.norm())) << s;
      EXPECT_NEAR(direct->second, all.slides[0].second, 1e-13 * (1.0 + std::abs(direct->second))) << s;
    }
    if (s == 0.3) continue;  // a section's edge: one-sided
    const double e = 1e-6;
    EXPECT_NEAR(all.slides[0].second, (along(q, s + e) - along(q, s - e)) / (2 * e), 2e-8) << s;
  }
  EXPECT_GT(largest, 0.01);
}

TEST_P(EveryBasis, internal_wrench_balances_what_lies_beyond) {
  const std::vector<PointLoad> loads = {{0.42, kOffset, Vec3(1.0, 2.0, -0.5)},
                                        {1.1, Vec3::Zero(), Vec3(0.3, -1.0, 0.2)}};
  const Configuration shape = at(q);
  const Equations all = equations(q, loads);
  std::vector<double> places;
  for (const Balance& at : all.internal) {
    places.push_back(at.s);
    const CurvePoint here = curve_point(shape, at.s);
    for (const bool before : {true, false}) {
      Vec6 needed = Vec6::Zero();
      for (const PointLoad& load : loads) {
        if (before ? load.s < at.s : load.s <= at.s) continue;
        needed.head<3>() -=
            here.R.transpose() * (position(shape, load.s, load.offset) - here.position).cross(load.force);
        needed.tail<3>() -= here.R.transpose() * load.force;
      }
      EXPECT_LT(((before ? at.before : at.beyond) - needed).norm(), 2e-13) << at.s << before;
    }
  }
  std::vector<double> expected = {0.42, 1.1};  // the latter is the tip
  for (const Section& section : rod.sections) expected.push_back(section.begin);
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(places, expected);
}

INSTANTIATE_TEST_SUITE_P(Rod, EveryBasis,
                         testing::Combine(testing::Range<std::size_t>(0, kBases.size()), testing::Values(0, 1, 3),
                                          testing::ValuesIn(kSizes)));

TEST(Kinematics, constant_bending_is_a_circle_whatever_the_sections) {
  for (int sections : {1, 2, 7}) {
    Discretisation cut;
    for (int i = 0; i <= sections; ++i) cut.ends.push_back(2.0 * std::numbers::pi * i / sections);
    cut.modes = modes_of({2});
    const Rod rod = make_rod(cut, {{0.0, cut.ends.back(), SolidPart{}}});
    const Configuration shape =
        configure(rod, Placement{}, Eigen::VectorXd::Constant(sections, 0.5));  // radius 2, half a circle
    EXPECT_LT((shape.p.back() - Vec3(0.0, 4.0, 0.0)).norm(), 1e-14 * sections) << sections;
    EXPECT_LT((curve_point(shape, std::numbers::pi).position - Vec3(2.0, 2.0, 0.0)).norm(), 1e-14 * sections);
  }
}

TEST(Kinematics, varying_strain_converges_with_order_six_to_the_same_curve) {
  // The same field of strains, linear and quadratic over the rod, on ever finer sections of degree two.
  const auto field = [](double s) {
    Vec6 xi;
    xi << 0.8 - s, 0.5 * s, 1.0 - 0.5 * s * s, 0.1 * s, -0.05 * s * s, 0.02;
    return xi;
  };
  const auto tip = [&](int sections) {
    Discretisation cut;
    for (int i = 0; i <= sections; ++i) cut.ends.push_back(2.0 * i / sections);
    for (int i = 0; i < sections; ++i) {
      const Vec6 a = field(cut.ends[i]), c = field(cut.ends[i + 1]), b = field(0.5 * (cut.ends[i] + cut.ends[i + 1]));
      Coefficients& Z = cut.rest.emplace_back(6, 3);  // the quadratic through three points, in Legendre polynomials
      Z.col(0) = (a + 4.0 * b + c) / 6.0;
      Z.col(1) = 0.5 * (c - a);
      Z.col(2) = (a - 2.0 * b + c) / 3.0;
    }
    const Rod rod = make_rod(cut, {{0.0, 2.0, SolidPart{}}});
    return configure(rod, Placement{}, Eigen::VectorXd()).p.back();
  };
  const Vec3 exact = tip(64);
  const double coarse = (tip(2) - exact).norm(), fine = (tip(4) - exact).norm(), finer = (tip(8) - exact).norm();
  EXPECT_GT(coarse, 1e-7);
  EXPECT_NEAR(std::log2(fine / finer), 6.0, 0.2);
  EXPECT_LT(coarse, 1e-4);
}

TEST(Kinematics, base_slides_along_and_turns_about_its_axes) {
  const Rod rod = random_rod({2}, 0, 0.0, {{false, 0, -1.0}, {false, 2}, {true, 0}});
  Eigen::VectorXd q = Eigen::VectorXd::Zero(rod.coordinates());
  q[0] = 0.1;
  q[1] = 0.02;
  q[2] = 0.5 * std::numbers::pi;
  const Configuration shape = configure(rod, Placement{}, q);
  EXPECT_LT((shape.p[0] - Vec3(-0.1, 0.0, 0.02)).norm(), 1e-15);
  EXPECT_LT((shape.R[0] * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-15);
}

}  // namespace
}  // namespace sinew::rod
