// Crossings that are made together beside those that are made one by one.
#include "sinew/rod/crossings.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <string>

#include "rod/random_rods.hpp"
#include "sinew/rod/forces.hpp"

namespace sinew::rod {
namespace {

/// Forces and inertia between and at the ends of sections, more than fit in one call.
std::vector<PointLoad> loads_on(const Rod& rod, const Configuration& shape) {
  std::vector<PointLoad> loads;
  for (int i = 0; i < 30; ++i) {
    PointLoad load{rod.length() * i / 29.0, Vec3(0, 0.01 * (i % 3), 0.02), Vec3(0.3, -0.1 * i, 1.0)};
    load.weight = i % 2 == 0 ? 0.0 : 2.0 + i;
    load.bends = i % 5 != 0;
    loads.push_back(load);
  }
  for (std::size_t k = 0; k < rod.stations.size(); ++k) {
    PointLoad load{rod.stations[k].s, Vec3(0, 0.02, 0), shape.stations[k].R * Vec3(0.1, 0.2, 0.3)};
    load.weight = 0.5;
    load.station = static_cast<int>(k);
    loads.push_back(load);
  }
  std::stable_sort(loads.begin(), loads.end(), [](const PointLoad& a, const PointLoad& b) { return a.s < b.s; });
  return loads;
}

/// A rod of all six strains goes one by one; its three rotations see the same as those of a rod that has no others.
TEST(Crossings, AreThoseMadeOneByOne) {
  for (const double size : {0.0, 1e-8, 1e-5, 1.0, 5.0}) {
    const Rod turns = random_rod({0, 1, 2}, 0, size), all = random_rod({0, 1, 2, 3, 4, 5}, 0, size);
    const int nb = turns.base_coordinates();
    const Eigen::VectorXd q = make_coordinates(turns, size);
    Eigen::VectorXd more = Eigen::VectorXd::Zero(all.coordinates());
    more.head(nb) = q.head(nb);
    for (int i = 0; i < 3; ++i) more.segment<3>(nb + all.first[i]) = q.segment<3>(nb + turns.first[i]);
    Configuration shape = configure(turns, kBase, q), other = configure(all, kBase, more);
    add_stations(shape);
    add_stations(other);
    const std::vector<PointLoad> loads = loads_on(turns, shape);
    Equations together = make_equations(shape, true), apart = make_equations(other, true);
    add_loads(shape, loads, together);
    add_loads(other, loads, apart);
    const double scale = apart.chain.D.norm();
    EXPECT_LT((together.r.head(nb) - apart.r.head(nb)).norm(), 1e-13 * apart.r.norm());
    for (int i = 0; i < 3; ++i) {
      const int at = turns.first[i], from = all.first[i];
      EXPECT_LT((together.r.segment<3>(nb + at) - apart.r.segment<3>(nb + from)).norm(), 1e-13 * apart.r.norm());
      EXPECT_LT((together.chain.D.block<3, 3>(0, at) - apart.chain.D.block<3, 3>(0, from)).norm(), 1e-13 * scale);
      EXPECT_LT((together.chain.V.middleCols<3>(at) - apart.chain.V.middleCols<3>(from)).norm(),
                1e-13 * apart.chain.V.norm());
    }
  }
}

class EveryRodKernel : public testing::TestWithParam<const char*> {};

TEST_P(EveryRodKernel, GivesTheSame) {
  const RodKernels *own = rod_kernels(GetParam()), *portable = rod_kernels("portable");
  if (!own) GTEST_SKIP() << "this processor has no " << GetParam();
  std::srand(3);
  for (const double angle : {0.0, 1e-8, 1e-5, 0.3, 1.0, 2.9}) {
    for (int count = 1; count <= kCrossings; ++count) {
      Crossings given;
      const auto fill = [](auto& numbers) {
        double* const at = reinterpret_cast<double*>(&numbers);
        Eigen::VectorXd::Map(at, static_cast<Eigen::Index>(sizeof(numbers) / sizeof(double))).setRandom();
      };
      fill(given);
      Eigen::Map<Mat3>(&given.from.R[0][0]) = lie::exp(Vec3(0.3, 1.0, -2.0));
      Eigen::Map<Vec3>(given.from.rotation).normalize();
      Eigen::Map<Vec3>(given.from.rotation) *= angle;
      given.count = count;
      std::fill(given.length + count, given.length + kCrossings, 0.0);
      Crossed one, other;
      own->cross(given, one);
      portable->cross(given, other);
      const auto numbers = [](const Crossed& of) {
        return Eigen::VectorXd(Eigen::VectorXd::Map(of.gradient, sizeof(Crossed) / sizeof(double)));
      };
      EXPECT_LT((numbers(one) - numbers(other)).norm(), 1e-14 * (1.0 + numbers(other).norm())) << angle << " " << count;
      EXPECT_GT(numbers(other).norm(), 0.01);
      Reached here, there;
      own->reach(given.from, given.length, count, here);
      portable->reach(given.from, given.length, count, there);
      for (int k = 0; k < count; ++k) {
        const Mat3 R =
            Eigen::Map<Mat3>(&given.from.R[0][0]) * lie::exp(Eigen::Map<Vec3>(given.from.rotation) * given.length[k]);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(here.p[c][k], there.p[c][k], 1e-14);
          for (int r = 0; r < 3; ++r) EXPECT_NEAR(here.R[c][r][k], R(r, c), 1e-14);
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Registers, EveryRodKernel, testing::Values("portable", "avx2", "avx512"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace sinew::rod
