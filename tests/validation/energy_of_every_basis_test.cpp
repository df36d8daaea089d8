// Energy in every strain basis, at every size of strain, constant and varying: what backward Euler does to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sinew/sim/places.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

const std::vector<std::vector<Strain>> kBases = {
    {Strain::torsion},
    {Strain::bending_y},
    {Strain::bending_z},
    {Strain::elongation},
    {Strain::shear_y},
    {Strain::shear_z},
    {Strain::torsion, Strain::bending_y, Strain::bending_z},
    {Strain::bending_y, Strain::elongation},
    {Strain::bending_z, Strain::shear_z},
    {Strain::torsion, Strain::bending_y, Strain::bending_z, Strain::elongation, Strain::shear_y, Strain::shear_z}};

class EnergyOfEveryBasis : public testing::TestWithParam<std::tuple<std::size_t, int, double>> {
 protected:
  /// A thick soft rod, whose frequencies are low, stress-free in strains of the given size.
  Model model(double step, double damping) const {
    const auto& [basis, order, size] = GetParam();
    Scene scene;
    scene.time = {step, 0.032};
    Rod rod;
    rod.path = {Vec3::Zero(), Vec3(0.5, 0, 0)};
    rod.sections = 2;
    rod.strains = kBases[basis];
    rod.order.fill(0);
    for (const Strain strain : rod.strains) rod.order[static_cast<std::size_t>(strain)] = order;
    RestStrains rest;
    rest.at = {0.0, 0.5};
    rest.strains = {size * Eigen::Matrix<double, 6, 1>(0.5, 1.0, -0.8, 0.1, 0.05, -0.1),
                    size * Eigen::Matrix<double, 6, 1>(-0.7, 0.4, 1.0, -0.1, 0.1, 0.05)};
    rod.rest = rest;
    rod.section = Circle{0.1};
    rod.material = {1e4, 0.3, 1000.0, damping, 0.0};
    scene.rods.emplace_back("rod", rod);
    return build(scene, test::read_block);
  }

  /// Let go from a deformation: energies after every step.
  static std::vector<double> energies(const Model& model) {
    State state = initial_state(model);
    RodState& own = state.rods[0];
    for (int i = 0; i < own.q.size(); ++i) own.q[i] = 0.05 * std::cos(1.0 + 1.3 * i);
    const auto shape = rod_shape(model, state, 0);
    const rod::Rod& rod = model.rods[0].rod;
    for (std::size_t m = 0; m < rod.masses.size(); ++m)
      own.masses.col(static_cast<Eigen::Index>(m)) = rod::position(shape, rod.masses[m].s, rod.masses[m].offset);
    std::vector<double> values = {energy_balance(model, state).total()};
    const RunEnd end = run(model, state, [&](const State& now, const StepReport&) {
      values.push_back(energy_balance(model, now).total());
      return true;
    });
    EXPECT_EQ(end, RunEnd::done);
    return values;
  }
};

TEST_P(EnergyOfEveryBasis, undamped_is_lost_in_proportion_to_the_step_and_damped_never_grows) {
  const double step = std::get<1>(GetParam()) == 0 ? 1e-3 : 1.25e-4;  // short for the highest frequency
  const std::vector<double> coarse = energies(model(step, 0.0)), fine = energies(model(0.5 * step, 0.0));
  const double before = coarse.front();
  ASSERT_GT(before, 0.0);
  const double lost = (before - coarse.back()) / before, lost_fine = (fine.front() - fine.back()) / before;
  EXPECT_GT(lost, 0.0);
  EXPECT_LT(lost, 0.2);
  EXPECT_NEAR(lost / lost_fine, 2.0, 0.1);  // the order of backward Euler
  const std::vector<double> damped = energies(model(step, 100.0));
  for (const auto& values : {coarse, fine, damped}) {
    for (std::size_t i = 1; i < values.size(); ++i) EXPECT_LE(values[i], values[i - 1] + 1e-9 * before) << i;
  }
  EXPECT_LT(damped.back(), coarse.back());
}

INSTANTIATE_TEST_SUITE_P(Rods, EnergyOfEveryBasis,
                         testing::Combine(testing::Range<std::size_t>(0, kBases.size()), testing::Values(0, 2),
                                          testing::Values(0.0, 1e-8, 1e-5, 1.0)));

}  // namespace
}  // namespace sinew
