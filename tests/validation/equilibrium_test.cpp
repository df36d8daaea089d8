// Equilibria of random scenes, judged by their energy alone. Where a state is at rest, the potential
//
//     P = elastic energy + weight - sum F . p - sum (force of a motor) (its position)
//
// is stationary among the states that keep the constraints c = 0: dP/du + (dc/du)^T lambda = 0 for some lambda, u being
// the free nodes, the coordinates of rods and the abscissae of sliding points. Both derivatives are central
// differences, and lambda is what fits best, so that none of the engine's forces, Jacobians or multipliers is asked.
#include <gtest/gtest.h>

#include <Eigen/QR>

#include "sinew/sim/motors.hpp"
#include "sinew/sim/newton.hpp"
#include "support/columns.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;
using test::Random;

/// A number of the state, and how far it moves anything [m] per unit of it.
struct Coordinate {
  enum Of { node, rod, point } of;
  int object;
  Eigen::Index number;
  double reach;
  double& in(State& state) const {
    if (of == node) return state.solids[object].x.data()[number];
    return of == rod ? state.rods[object].q[number] : state.points[object].s;
  }
};

std::vector<Coordinate> coordinates(const Model& model, const State& state) {
  std::vector<Coordinate> all;
  for (int i = 0; i < static_cast<int>(model.solids.size()); ++i) {
    const solid::Body& body = model.solids[i].body;
    for (Eigen::Index n = 0; n < body.rest.cols(); ++n) {
      for (int axis = 0; axis < 3; ++axis) {
        if (body.unknown(axis, n) >= 0) all.push_back({Coordinate::node, i, 3 * n + axis, 1.0});
      }
    }
  }
  for (int i = 0; i < static_cast<int>(model.rods.size()); ++i) {
    const rod::Configuration shape = rod_shape(model, state, i);
    const rod::Rod& rod = model.rods[i].rod;
    const int samples = 6 * rod.count();
    Eigen::VectorXd reach = Eigen::VectorXd::Zero(state.rods[i].q.size());
    for (int n = 0; n <= samples; ++n) {
      const rod::Matrix6X twists = rod::twists_at(shape, rod.length() * n / samples);
      for (Eigen::Index k = 0; k < reach.size(); ++k)
        reach[k] = std::max(reach[k], twists.col(k).tail<3>().norm() + rod.length() * twists.col(k).head<3>().norm());
    }
    for (Eigen::Index k = 0; k < reach.size(); ++k) all.push_back({Coordinate::rod, i, k, reach[k]});
  }
  for (int i = 0; i < static_cast<int>(model.points.size()); ++i) {
    if (!model.points[i].fixed) all.push_back({Coordinate::point, i, 0, 1.0});
  }
  // What a motor holds is not free.
  std::erase_if(all, [&](const Coordinate& own) {
    return own.of == Coordinate::rod && std::ranges::any_of(model.actuators, [&](const ActuatorModel& motor) {
             return !motor.tendon && !motor.told_force() && motor.line.rod == own.object && own.number == 0;
           });
  });
  return all;
}

/// Elastic energy, weight, and the potential of what pulls and pushes [J].
struct Potential {
  double elastic = 0.0, outside = 0.0;
};

Potential potential(const Model& model, State& state) {
  std::vector<rod::Configuration> shapes;
  for (int i = 0; i < static_cast<int>(model.rods.size()); ++i) {
    shapes.push_back(rod_shape(model, state, i));
    state.rods[i].masses = rod::mass_positions(shapes.back());
  }
  const EnergyBalance energy = energy_balance(model, state);
  Potential found{energy.elastic, energy.weight};
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    if (const auto* on_rod = std::get_if<RodLoadModel>(&model.loads[i].on)) {
      for (const RodLoadModel::At& at : on_rod->at) {
        found.outside -= state.loads[i] * at.weight * on_rod->force.dot(rod::position(shapes[on_rod->rod], at.s));
      }
    } else {
      const auto& on_solid = std::get<SolidLoadModel>(model.loads[i].on);
      found.outside -= state.loads[i] * on_solid.force.cwiseProduct(state.solids[on_solid.solid].x).sum();
    }
  }
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    if (!model.actuators[i].told_force()) continue;
    found.outside -= state.actuators[i] * motor_position(model, state, model.actuators[i]);
  }
  return found;
}

/// What couplings hold at 0 [m].
Eigen::VectorXd constraints(const Model& model, const State& state) {
  std::vector<double> c;
  for (const TieModel& tie : model.ties) {
    const rod::Configuration own = rod_shape(model, state, tie.rod), other = rod_shape(model, state, tie.other);
    const rod::CentrePoint there = rod::centre_point(other, tie.other_s);
    const Vec3 apart = there.R.transpose() * (rod::position(own, tie.s) - there.position) - tie.other_offset;
    for (const int axis : tie.along) c.push_back(tie.other_axes.col(axis).dot(apart));
  }
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const PointModel& point = model.points[i];
    const Vec3 apart = solid_point(model, state, point.solid, point.where) -
                       rod::position(rod_shape(model, state, point.line.rod), state.points[i].s);
    c.insert(c.end(), apart.begin(), apart.end());
  }
  return Eigen::Map<Eigen::VectorXd>(c.data(), static_cast<Eigen::Index>(c.size()));
}

/// The largest unbalanced force over the largest force there is, both per metre of what they move.
double unbalanced(const Model& model, const State& at_rest) {
  State state = at_rest;
  const std::vector<Coordinate> u = coordinates(model, state);
  const auto count = static_cast<Eigen::Index>(u.size());
  Eigen::VectorXd elastic(count), outside(count);
  Eigen::MatrixXd slopes(constraints(model, state).size(), count);  // dc/du
  for (Eigen::Index k = 0; k < count; ++k) {
    const Coordinate& own = u[k];
    double& number = own.in(state);
    const double before = number, change = 3e-7 / own.reach;
    number = before + change;
    const Potential plus = potential(model, state);
    const Eigen::VectorXd c_plus = constraints(model, state);
    number = before - change;
    const Potential minus = potential(model, state);
    const double moved = 2.0 * change * own.reach;
    slopes.col(k) = (c_plus - constraints(model, state)) / moved;
    number = before;
    elastic[k] = (plus.elastic - minus.elastic) / moved;
    outside[k] = (plus.outside - minus.outside) / moved;
  }
  Eigen::VectorXd held = Eigen::VectorXd::Zero(count);
  if (slopes.rows() > 0) {
    const Eigen::MatrixXd across = slopes.transpose();
    held = across * across.completeOrthogonalDecomposition().solve(-(elastic + outside));
  }
  const auto largest = [](const Eigen::VectorXd& v) { return v.cwiseAbs().maxCoeff(); };
  return largest(elastic + outside + held) / std::max({largest(elastic), largest(outside), largest(held), 1e-12});
}

/// A block of any law with a cable in it that is pulled by a force or a length, under its weight and a load, perhaps.
Scene pulled_block(Random& random) {
  Scene scene = test::cable_block();
  scene.analysis = Analysis::quasi_static;
  scene.time = {1.0, 1.0};
  if (random.chance(0.5)) scene.gravity = Vec3(0, 0, -9.81);
  Solid& block = scene.solids[0].second;
  const double young = std::pow(10.0, random(5.0, 6.5)), poisson = random(0.2, 0.45);
  switch (random.whole(0, 3)) {
    case 0:
      block.material.law = solid::corotational(young, poisson);
      break;
    case 1:
      block.material.law = solid::neo_hookean(young, poisson);
      break;
    case 2:
      block.material.law = solid::saint_venant_kirchhoff(young, poisson);
      break;
    default:
      block.material.law = solid::mooney_rivlin(0.1 * young, 0.06 * young, solid::Poisson{poisson});
  }
  Rod& cable = scene.rods[0].second;
  cable.sections = random.whole(2, 8);
  cable.order.fill(random.whole(0, 1));
  cable.section = Circle{random(0.2, 0.8) * mm};
  cable.material.young = std::pow(10.0, random(8.0, 9.5));
  test::slide(scene, 0).points = random.whole(2, 7);
  Actuator& pull = scene.actuators[0].second;
  if (random.chance(0.5)) {
    pull.driven = Driven::force;
    pull.drive = Table{{0.0}, {young * 1e-6 * random(0.2, 3.0)}};
  } else {
    pull.drive = Table{{0.0}, {random(0.2, 3.0) * mm}};
  }
  return scene;
}

struct Counts {
  int judged = 0, stopped = 0;
  double worst = 0.0;
};

Counts look_at(int count, unsigned seed, Scene (*make)(Random&)) {
  Random random(seed);
  Counts counts;
  for (int i = 0; i < count; ++i) {
    const Model model =
        build(make(random), [](const auto&) { return test::block_mesh(6, 1, 1, Vec3(60 * mm, 10 * mm, 10 * mm)); });
    Workspace workspace(model);
    State state = initial_state(model);
    if (!accepted(advance(model, workspace, state).status)) {
      ++counts.stopped;
      continue;
    }
    ++counts.judged;
    const double left = unbalanced(model, state);
    counts.worst = std::max(counts.worst, left);
    EXPECT_LT(left, 1e-6) << "scene " << i;
  }
  std::printf("%d equilibria, at most %.1e of the largest force unbalanced; %d stopped\n", counts.judged, counts.worst,
              counts.stopped);
  return counts;
}

TEST(Equilibrium, OfColumnsIsThatOfTheirEnergy) { EXPECT_GT(look_at(60, 1, test::column).judged, 50); }
TEST(Equilibrium, OfBlocksWithACableIsThatOfTheirEnergy) { EXPECT_GT(look_at(30, 2, pulled_block).judged, 25); }
TEST(Equilibrium, OfManyColumnsIsThatOfTheirEnergy_slow) { EXPECT_GT(look_at(1000, 3, test::column).judged, 900); }
TEST(Equilibrium, OfManyBlocksIsThatOfTheirEnergy_slow) { EXPECT_GT(look_at(200, 4, pulled_block).judged, 170); }

}  // namespace
}  // namespace sinew
