// Crossings that are made together beside those that are made one by one.
#include "sinew/rod/crossings.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <type_traits>

#include "rod/random_rods.hpp"
#include "sinew/rod/forces.hpp"

namespace sinew::rod {
namespace {

/// Forces and weights between and at the ends of sections, more than fit in one call.
std::vector<PointLoad> loads_on(const Rod& rod) {
  std::vector<PointLoad> loads;
  for (int i = 0; i < 30; ++i) {
    PointLoad load{rod.length() * i / 29.0, Vec3(0, 0.01 * (i % 3), 0.02), Vec3(0.3, -0.1 * i, 1.0)};
    load.weight = i % 2 == 0 ? 0.0 : 2.0 + i;
    load.spread = i % 3 == 0;
    loads.push_back(load);
  }
  return loads;
}

const Vec3 kGravity(0.5, -2.0, 9.0);
constexpr double kRate = 3.0;

/// A motion from elsewhere: where the mass points were, and how fast they moved.
struct Start {
  explicit Start(const Configuration& shape) : positions(mass_positions(shape)), velocities(positions) {
    std::srand(5);
    positions += 0.1 * Eigen::Matrix3Xd::Random(3, positions.cols());
    velocities.setRandom();
  }
  std::vector<StationInertia> inertia(const Configuration& shape) const {
    std::vector<StationInertia> inertia;
    station_inertia(*shape.rod, positions, velocities, kRate, kGravity, shape.origin, inertia);
    return inertia;
  }
  Eigen::Matrix3Xd positions, velocities;
};

/// A rod of all six strains goes one by one; its three rotations see the same as those of a rod that has no others.
TEST(Crossings, AreThoseMadeOneByOne) {
  for (const double size : {0.0, 1e-8, 1e-5, 1.0, 5.0}) {
    for (const bool bends : {true, false}) {
      const Rod turns = random_rod({0, 1, 2}, 0, size), all = random_rod({0, 1, 2, 3, 4, 5}, 0, size);
      const int nb = turns.base_coordinates();
      const Eigen::VectorXd q = make_coordinates(turns, size);
      Eigen::VectorXd more = Eigen::VectorXd::Zero(all.coordinates());
      more.head(nb) = q.head(nb);
      for (int i = 0; i < 3; ++i) more.segment<3>(nb + all.first[i]) = q.segment<3>(nb + turns.first[i]);
      const Configuration shape = configure(turns, kBase, q), other = configure(all, kBase, more);
      const Start start(shape);
      const std::vector<StationInertia> own = start.inertia(shape), apart_own = start.inertia(other);
      Equations together = make_equations(shape, true), apart = make_equations(other, true);
      add_loads(shape, loads_on(turns), {own, kGravity, bends}, together);
      add_loads(other, loads_on(all), {apart_own, kGravity, bends}, apart);
      const double scale = apart.chain.D.norm();
      EXPECT_LT((together.r.head(nb) - apart.r.head(nb)).norm(), 1e-13 * apart.r.norm());
      EXPECT_NEAR(together.acting, apart.acting, 1e-13 * apart.acting);
      EXPECT_LT((together.base - apart.base).norm(), 1e-13 * apart.base.norm());
      for (int i = 0; i < 3; ++i) {
        const int at = turns.first[i], from = all.first[i];
        EXPECT_LT((together.r.segment<3>(nb + at) - apart.r.segment<3>(nb + from)).norm(), 1e-13 * apart.r.norm());
        EXPECT_LT((together.chain.D.block<3, 3>(0, at) - apart.chain.D.block<3, 3>(0, from)).norm(), 1e-13 * scale);
        EXPECT_LT((together.chain.V.middleCols<3>(at) - apart.chain.V.middleCols<3>(from)).norm(),
                  1e-13 * apart.chain.V.norm());
      }
      ASSERT_EQ(together.internal.size(), apart.internal.size());
      for (std::size_t i = 0; i < apart.internal.size(); ++i) {
        EXPECT_LT((together.internal[i].before - apart.internal[i].before).norm(), 1e-12 * apart.r.norm());
        EXPECT_LT((together.internal[i].beyond - apart.internal[i].beyond).norm(), 1e-12 * apart.r.norm());
      }
    }
  }
}

/// More sections than there are lanes, and not a multiple of them; one turns too far for its group.
TEST(Crossings, OfManySectionsAreThoseMadeOneByOne) {
  Discretisation cut, wide;
  for (int i = 0; i <= 19; ++i) cut.ends.push_back(0.1 * i);
  wide.ends = cut.ends;
  cut.modes = modes_of({0, 1, 2});
  wide.modes = modes_of({0, 1, 2, 3});
  const Profile profile = {{0.0, 1.9, SolidPart{Circle{0.02}, Circle{0.01}, 1e6, 0.4, 1000.0, 10.0}, 0.0}};
  const Rod turns = make_rod(cut, profile), stretches = make_rod(wide, profile);
  for (const int tight : {-1, 2, 12, 18}) {
    Eigen::VectorXd q(turns.coordinates()), more = Eigen::VectorXd::Zero(stretches.coordinates());
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = std::sin(1.0 + 0.7 * static_cast<double>(i));
    if (tight >= 0) q[3 * tight] = 35.0;  // 3.5 rad
    for (int i = 0; i < turns.count(); ++i) more.segment<3>(4 * i) = q.segment<3>(3 * i);
    const Configuration shape = configure(turns, kBase, q), other = configure(stretches, kBase, more);
    const Start start(shape);
    const std::vector<StationInertia> own = start.inertia(shape), apart_own = start.inertia(other);
    Equations together = make_equations(shape, true), apart = make_equations(other, true);
    add_loads(shape, loads_on(turns), {own, kGravity}, together);
    add_loads(other, loads_on(stretches), {apart_own, kGravity}, apart);
    EXPECT_NEAR(together.acting, apart.acting, 1e-13 * apart.acting);
    for (int i = 0; i < turns.count(); ++i) {
      EXPECT_LT((together.r.segment<3>(3 * i) - apart.r.segment<3>(4 * i)).norm(), 1e-13 * apart.r.norm()) << i;
      EXPECT_LT((together.chain.D.block<3, 3>(0, 3 * i) - apart.chain.D.block<3, 3>(0, 4 * i)).norm(),
                1e-13 * apart.chain.D.norm());
      EXPECT_LT((together.chain.V.middleCols<3>(3 * i) - apart.chain.V.middleCols<3>(4 * i)).norm(),
                1e-13 * apart.chain.V.norm());
    }
    ASSERT_EQ(together.internal.size(), apart.internal.size());
    for (std::size_t i = 0; i < apart.internal.size(); ++i)
      EXPECT_LT((together.internal[i].beyond - apart.internal[i].beyond).norm(), 1e-12 * apart.r.norm());
  }
}

/// More sections than there are lanes, and not a multiple of them.
TEST(Crossings, AreThoseOfOneSectionWhereSectionsAreAlike) {
  Discretisation one, many;
  one.ends = {0.0, 1.1};
  one.modes = many.modes = modes_of({0, 1, 2});
  for (int i = 0; i <= 11; ++i) many.ends.push_back(0.1 * i);
  const Profile profile = {{0.0, 1.1, SolidPart{Circle{0.02}, Circle{0.02}, 1e6, 0.4, 1000.0, 10.0}, 0.0}};
  const Rod whole = make_rod(one, profile), cut = make_rod(many, profile);
  const Vec3 strain(0.4, -0.8, 1.1);
  const Configuration a = configure(whole, kBase, strain), b = configure(cut, kBase, strain.replicate<11, 1>());
  std::vector<PointLoad> loads = loads_on(whole);
  Equations of_one = make_equations(a, true), of_many = make_equations(b, true);
  add_loads(a, loads, of_one);
  add_loads(b, loads, of_many);
  // All sections turned alike are the one section turned.
  const Eigen::MatrixXd alike = Eigen::Matrix3d::Identity().replicate<11, 1>();
  const Eigen::MatrixXd tangent = alike.transpose() * linalg::dense(of_many.chain) * alike;
  EXPECT_LT((alike.transpose() * of_many.r - of_one.r).norm(), 1e-13 * of_one.r.norm());
  EXPECT_LT((tangent - linalg::dense(of_one.chain)).norm(), 1e-12 * tangent.norm());
  EXPECT_GT(of_one.r.norm(), 1.0);
}

/// What a station is, by its points one by one.
TEST(StationInertia, IsThatOfItsPoints) {
  const Rod rod = random_rod({0, 1, 2}, 1, 1.0);
  const Configuration shape = configure(rod, kBase, make_coordinates(rod, 1.0));
  const Start start(shape);
  const std::vector<StationInertia> stations = start.inertia(shape);
  for (const bool bends : {true, false}) {
    std::vector<PointLoad> points, weights;
    for (std::size_t i = 0; i < rod.masses.size(); ++i) {
      const MassPoint& mass = rod.masses[i];
      const auto at = static_cast<Eigen::Index>(i);
      const Vec3 moved = position(shape, mass.s, mass.offset) - start.positions.col(at);
      PointLoad point{mass.s, mass.offset};
      point.force = mass.mass * ((moved * kRate - start.velocities.col(at)) * kRate - kGravity);
      point.weight = mass.mass * kRate * kRate;
      point.spread = true;
      points.push_back(point);
      point.force.setZero();
      weights.push_back(point);
    }
    Equations one = make_equations(shape, true), other = one, tangent = one;
    add_loads(shape, {}, {stations, kGravity, bends}, one);
    add_loads(shape, points, other);
    add_loads(shape, bends ? points : weights, tangent);
    EXPECT_LT((one.r - other.r).norm(), 1e-13 * other.r.norm());
    EXPECT_LT((dense_tangent(shape, one) - dense_tangent(shape, tangent)).norm(),
              1e-13 * dense_tangent(shape, tangent).norm());
    EXPECT_GT(other.r.norm(), 0.1);
  }
}

class EveryRodKernel : public testing::TestWithParam<const char*> {};

template <class Numbers>
auto as_vector(Numbers& numbers) {
  auto* const at = reinterpret_cast<std::conditional_t<std::is_const_v<Numbers>, const double, double>*>(&numbers);
  return Eigen::Map<std::conditional_t<std::is_const_v<Numbers>, const Eigen::VectorXd, Eigen::VectorXd>>(
      at, static_cast<Eigen::Index>(sizeof(numbers) / sizeof(double)));
}

TEST_P(EveryRodKernel, GivesTheSame) {
  const RodKernels *own = rod_kernels(GetParam()), *portable = rod_kernels("portable");
  if (!own) GTEST_SKIP() << "this processor has no " << GetParam();
  std::srand(3);
  for (const double angle : {0.0, 1e-8, 1e-5, 0.3, 1.0, 2.9}) {
    for (int count = 1; count <= kLanes; ++count) {
      SectionLanes sections;
      CrossingLanes crossing;
      StationLanes station;
      as_vector(sections.p).setRandom();
      as_vector(sections.translation).setRandom();
      as_vector(sections.rotation).setRandom();
      as_vector(crossing).setRandom();
      as_vector(station).setRandom();
      sections.count = count;
      for (int lane = 0; lane < kLanes; ++lane) {
        const Mat3 R = lie::exp(Vec3::Random());
        for (int c = 0; c < 3; ++c) {
          for (int r = 0; r < 3; ++r) sections.R[c][r][lane] = R(r, c);
        }
        const double size =
            std::hypot(sections.rotation[0][lane], sections.rotation[1][lane], sections.rotation[2][lane]);
        for (auto& numbers : sections.rotation) numbers[lane] *= angle / size;
      }
      CrossedLanes one = {}, other = {};
      own->cross(sections, crossing, one);
      portable->cross(sections, crossing, other);
      StationLanes there = station;
      Eight acting = {}, expected = {};
      const double gravity[3] = {1.0, -2.0, 3.0};
      own->meet(sections, gravity, count % 2 == 0, station, one, acting);
      portable->meet(sections, gravity, count % 2 == 0, there, other, expected);
      // Lanes from `count` on are anything.
      const auto lanes = [count](const auto& numbers) {
        const auto all = as_vector(numbers);
        return Eigen::MatrixXd(Eigen::MatrixXd::Map(all.data(), kLanes, all.size() / kLanes).topRows(count));
      };
      EXPECT_LT((lanes(one) - lanes(other)).norm(), 1e-14 * (1.0 + lanes(other).norm())) << angle << " " << count;
      EXPECT_LT((lanes(station.loads) - lanes(there.loads)).norm(), 1e-14 * (1.0 + lanes(there.loads).norm()));
      EXPECT_LT((lanes(acting) - lanes(expected)).norm(), 1e-14 * lanes(expected).norm());
      EXPECT_GT(lanes(other).norm(), 0.01);

      Beginning from;
      Eigen::Map<Mat3>(&from.R[0][0]) = lie::exp(Vec3(0.3, 1.0, -2.0));
      Eigen::Map<Vec3>(from.p).setRandom();
      Eigen::Map<Vec3>(from.rotation) = angle * Vec3::Random().normalized();
      Eigen::Map<Vec3>(from.translation).setRandom();
      Reached here, beside;
      own->reach(from, crossing.length, count, here);
      portable->reach(from, crossing.length, count, beside);
      for (int k = 0; k < count; ++k) {
        const Mat3 R = Eigen::Map<Mat3>(&from.R[0][0]) * lie::exp(Eigen::Map<Vec3>(from.rotation) * crossing.length[k]);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(here.p[c][k], beside.p[c][k], 1e-14);
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
