#include "sinew/sim/internal.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace sinew {

rod::Vec6 internal_wrench(const Model& model, const State& state, int number, double s) {
  const rod::Rod& rod = model.rods[number].rod;
  const RodState& own = state.rods[number];
  const int i = rod.section_at(s);
  const rod::Section& section = rod.sections[i];
  const double t = std::clamp((s - section.begin) / section.length(), 0.0, 1.0);
  rod::Vec6 wrench = (1.0 - t) * own.internal.col(2 * i) + t * own.internal.col(2 * i + 1);
  const rod::Vec6 elastic = rod::stiffness_at(rod.profile, s) * rod::deviation(rod, own.q, s);
  for (const rod::Mode& mode : section.modes) wrench[mode.strain] = elastic[mode.strain];
  return wrench;
}

rod::SectionStress section_stress(const Model& model, const State& state, int number, double s) {
  return rod::stress_at(model.rods[number].rod.profile, s, internal_wrench(model, state, number, s));
}

}  // namespace sinew
