// Numbers that no real material or scene has, most likely because a unit was forgotten. They are warned of, not
// refused: a model of something unreal is legal. What no star has is refused: energies would not be finite.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/sim/building.hpp"

namespace sinew::building {

namespace {

/// The softest gels have some 100 Pa, silicone gels 1 kPa and more; diamond has 1.2 TPa.
constexpr double kSoftestGel = 50.0, kSoftest = 1e3, kStiffest = 1.3e12;  // [Pa]
/// The lightest foams have 5 kg/m^3, osmium 22 590.
constexpr double kLightest = 5.0, kHeaviest = 23e3;  // [kg/m^3]
/// Four times that of Jupiter.
constexpr double kMostGravity = 100.0;  // [m/s^2]
/// Neutron stars have up to some 1e18 kg/m^3, 1e35 Pa and 1e13 m/s^2.
constexpr double kBeyondDensity = 1e19, kBeyondModulus = 1e36, kBeyondGravity = 1e14;  // [kg/m^3], [Pa], [m/s^2]

/// 0 is none, of a section whose stiffness is given.
void check_modulus(Model& model, double young, const std::string& path) {
  if (young > kBeyondModulus)
    reject(path + ".material", text(young) + " Pa", "is more than Young's modulus of a neutron star",
           "check the moduli and their units");
  if (young <= 0.0 || (young >= kSoftest && young <= kStiffest)) return;
  const bool soft = young < kSoftest;
  model.warnings.push_back({.code = "unit_of_modulus",
                            .where = path,
                            .message = "Young's modulus is " + text(young) + " Pa, " +
                                       (young < kSoftestGel ? "less than that of any gel"
                                        : soft              ? "less than that of most gels"
                                                            : "more than that of diamond"),
                            .remedy = "numbers without a unit are pascals",
                            .value = young,
                            .limit = soft ? kSoftest : kStiffest,
                            .unit = "Pa"});
}

/// Of a density that is given; 0 is massless. (A mass may stand for more than a body.)
void check_density(Model& model, double density, const std::string& path) {
  if (density > kBeyondDensity)
    reject(path + (path.starts_with("rods.") ? ".material.density" : ".density"), text(density) + " kg/m^3",
           "is more than that of a neutron star", "check the number and its unit");
  if (density <= 0.0 || (density >= kLightest && density <= kHeaviest)) return;
  const bool light = density < kLightest;
  model.warnings.push_back({.code = "unit_of_density",
                            .where = path,
                            .message = "its density is " + text(density) + " kg/m^3, " +
                                       (light ? "less than that of most foams" : "more than that of any metal"),
                            .remedy = "numbers without a unit are kg/m^3: water has 1000 kg/m^3, or 1 g/cm^3",
                            .value = density,
                            .limit = light ? kLightest : kHeaviest,
                            .unit = "kg/m^3"});
}

void check_gravity(Model& model) {
  const double gravity = model.scene.gravity.norm();
  if (!(gravity < kBeyondGravity))
    reject("gravity", text(gravity) + " m/s^2", "is more than that of a neutron star", "check its numbers and units");
  if (gravity <= kMostGravity) return;
  model.warnings.push_back({.code = "unit_of_gravity",
                            .where = "gravity",
                            .message = text(gravity) + " m/s^2 is more than four times that of Jupiter",
                            .remedy = "numbers are m/s^2: the earth has 9.81",
                            .value = gravity,
                            .limit = kMostGravity,
                            .unit = "m/s^2"});
}

void check_radius(Model& model, const RodModel& rod) {
  const double radius = rod::radius_at(rod.rod.profile, 0.0);
  if (radius <= 0.5 * rod.rod.length()) return;
  model.warnings.push_back({.code = "unit_of_radius",
                            .where = "rods." + rod.name,
                            .message = "its radius of " + text(radius) + " m is more than half its length of " +
                                       text(rod.rod.length()) + " m",
                            .remedy = "numbers without a unit are metres",
                            .value = radius,
                            .limit = 0.5 * rod.rod.length(),
                            .unit = "m"});
}

/// Positions without mm, and turns in degrees.
void check_target(Model& model, const EffectorModel& effector, const Track& track) {
  const OutputModel& output = model.outputs[effector.output];
  double farthest = 0.0, most = 0.0;  // from where it starts; of a turn
  const Eigen::ArrayXd counts = (effector.weights.array() > 0.0).cast<double>();
  for (const Eigen::VectorXd& value : track.values) {
    farthest = std::max(farthest, (counts * (value - effector.start).array()).matrix().norm());
    most = std::max(most, (counts * value.array()).matrix().norm());
  }
  const std::string path = "targets." + output.name + ".at";
  if (output.quantity == Quantity::position && farthest > 10.0 * model.size)
    model.warnings.push_back({.code = "unit_of_target",
                              .where = path,
                              .message = "goes " + text(farthest) + " m from where the output starts, in a scene of " +
                                         text(model.size) + " m",
                              .remedy = "numbers without a unit are metres",
                              .value = farthest,
                              .limit = model.size,
                              .unit = "m"});
  if (output.quantity == Quantity::orientation && most > 2.0 * std::numbers::pi)
    model.warnings.push_back({.code = "unit_of_target",
                              .where = path,
                              .message = "turns by " + text(most) + " rad",
                              .remedy = "numbers without a unit are radians",
                              .value = most,
                              .unit = "rad"});
}

}  // namespace

void warn_of_units(Model& model) {
  check_gravity(model);
  for (std::size_t number = 0; number < model.solids.size(); ++number) {
    const SolidModel& solid = model.solids[number];
    const bool weighed = model.scene.solids[number].second.mass.has_value();
    const std::vector<solid::Material>& materials = solid.body.materials;  // of the solid, then those of its parts
    for (std::size_t i = 0; i < materials.size(); ++i) {
      const std::string path = "solids." + solid.name + (i == 0 ? "" : ".parts." + std::to_string(i - 1));
      check_modulus(model, solid::young(solid::lame(materials[i].law)), path);
      if (!weighed) check_density(model, materials[i].density, path);
    }
  }
  for (const auto& [name, rod] : model.scene.rods) {
    if (rod.cable == Cable::geometric) continue;
    check_modulus(model, rod.material.young, "rods." + name);
    check_density(model, rod.material.density, "rods." + name);
    for (std::size_t i = 0; i < rod.parts.size(); ++i) {
      const std::string path = "rods." + name + ".parts." + std::to_string(i);
      check_modulus(model, rod.parts[i].material.young, path);
      check_density(model, rod.parts[i].material.density, path);
    }
  }
  for (const RodModel& rod : model.rods) check_radius(model, rod);
  for (const auto& [name, body] : model.scene.bodies)
    check_density(model, body.density.value_or(0.0), "bodies." + name);
  for (std::size_t i = 0; i < model.effectors.size(); ++i)
    if (const Track* const track = std::get_if<Track>(&model.scene.targets[i].at))
      check_target(model, model.effectors[i], *track);
}

}  // namespace sinew::building
