// The tendon-driven rod that rod codes are timed with: three seconds of motion, beside their published run times.
//
// Two links of 0.3 m, radius 30 mm, density 1000 kg/m^3, E = 1 MPa, nu = 0.5, shear viscosity 10 kPa s, Legendre order
// 1 on torsion, both bendings and elongation, tendons at (0, 0, 20 mm) and (0, 20 mm, 0) pulled with 1 N each, gravity
// across. The published times (SoRoSim, SoRoMoX) are of a Core Ultra 7 165H and of a step of 0.1 ms.
#include <chrono>
#include <cstdio>
#include <numbers>

#include "sinew/sim/places.hpp"
#include "sinew/sim/run.hpp"

namespace {

sinew::Scene tendon_arm(double step) {
  using namespace sinew;
  Scene scene;
  scene.time = {step, 3.0};
  scene.gravity = Vec3(0, 0, -9.81);
  Rod rod;
  rod.path = {Vec3::Zero(), Vec3(0.6, 0, 0)};
  rod.sections = 2;
  rod.strains = {Strain::torsion, Strain::bending_y, Strain::bending_z, Strain::elongation};
  rod.order = {1, 1, 1, 1, 0, 0};
  rod.section = Circle{0.03};
  rod.material = {1e6, 0.5, 1000.0, 1e4, 0.0};
  scene.rods.emplace_back("arm", rod);
  for (const double angle : {0.0, 0.5 * std::numbers::pi}) {
    Actuator pull;
    pull.rod = "arm";
    pull.driven = Driven::force;
    pull.drive = Table{{0.0}, {1.0}};
    pull.tendon = Tendon{0.0, std::nullopt, Taper(0.02), Taper(angle)};
    scene.actuators.emplace_back(angle == 0.0 ? "side" : "top", pull);
  }
  Output tip;
  tip.rod = "arm";
  scene.outputs.emplace_back("tip", tip);
  return scene;
}

}  // namespace

int main() {
  std::printf("3 s of a rod with two tendons; published: SoRoSim 75.8 s, SoRoMoX 36.5 s\n");
  std::printf("%10s %10s %12s %14s   %s\n", "step [ms]", "steps", "time [s]", "us a step", "tip at 3 s [m]");
  for (const double step : {1e-4, 1e-3, 5e-3}) {
    const sinew::Model model = sinew::build(tendon_arm(step), [](const auto&) { return sinew::solid::Mesh{}; });
    sinew::State last = sinew::initial_state(model);
    long steps = 0;
    const auto start = std::chrono::steady_clock::now();
    const sinew::RunEnd end = sinew::run(model, last, [&](const sinew::State& state, const sinew::StepReport&) {
      last = state;
      ++steps;
      return true;
    });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (end != sinew::RunEnd::done) return 1;
    const sinew::Vec3 tip = sinew::output_position(model, last, model.outputs[0]);
    std::printf("%10.1f %10ld %12.2f %14.1f   (%.6f, %.6f, %.6f)\n", 1e3 * step, steps, seconds,
                1e6 * seconds / static_cast<double>(steps), tip.x(), tip.y(), tip.z());
  }
  return 0;
}
