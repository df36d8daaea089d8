#include "sinew/sim/iteration_work.hpp"

#include <algorithm>

namespace sinew {

// A point of quadrature of an element costs some 5000 multiplications (stress, its derivative and the product with the
// gradients of the shape functions), a section of a rod some 3000; the rest is small beside them.
double iteration_work(const Model& model) {
  constexpr double kPoint = 5e3, kSection = 3e3;
  double work = 0.0;
  for (const SolidModel& solid : model.solids) {
    if (solid.fronts) work += solid.fronts->work();
    work += kPoint * solid.body.points();
  }
  for (const RodModel& rod : model.rods) work += kSection * rod.rod.count();
  return work;
}

int affordable_iterations(const Model& model, int wanted) {
  const double affordable = kPatience / std::max(iteration_work(model), 1.0);
  return static_cast<int>(std::min<double>(wanted, std::max(affordable, 2.0 * model.scene.newton.limit)));
}

}  // namespace sinew
