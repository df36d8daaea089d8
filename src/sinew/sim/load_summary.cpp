#include "sinew/sim/load_summary.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/error/digits.hpp"
#include "sinew/solid/moduli.hpp"
#include "sinew/solid/pressure.hpp"

namespace sinew {

namespace {

double largest_factor(const Drive& drive) {
  const Table* const table = std::get_if<Table>(&drive);
  if (!table) return 1.0;
  double largest = 0.0;
  for (const double value : table->values) largest = std::abs(value) > std::abs(largest) ? value : largest;
  return largest;
}

double softest(const solid::Body& body) {
  double young = INFINITY;
  for (const solid::Material& material : body.materials)
    young = std::min(young, solid::young(solid::lame(material.law)));
  return young;
}

std::string in_kilopascals(double pressure) { return three_digits(1e-3 * pressure) + " kPa"; }

}  // namespace

LoadSummary summary_of(const Model& model, const LoadModel& load) {
  LoadSummary summary;
  summary.name = "loads." + load.name;
  summary.factor = largest_factor(load.factor);
  if (const RodLoadModel* const on_rod = std::get_if<RodLoadModel>(&load.on)) {
    summary.on = "rods." + model.rods[on_rod->rod].name;
    for (const RodLoadModel::At& at : on_rod->at) summary.force += summary.factor * at.weight * on_rod->force;
    return summary;
  }
  const SolidLoadModel& on_solid = std::get<SolidLoadModel>(load.on);
  const SolidModel& solid = model.solids[on_solid.solid];
  summary.on = "solids." + solid.name;
  summary.young = softest(solid.body);
  summary.pressure = summary.factor * on_solid.pressure;
  summary.faces = static_cast<int>(on_solid.faces.size());
  if (on_solid.force.cols() > 0) summary.force += summary.factor * on_solid.force.rowwise().sum();
  for (const solid::CellFace& face : on_solid.faces) {
    summary.force += solid::pressure_force(face, summary.pressure, solid.body.rest).rowwise().sum();
    summary.area += solid::face_shares(face, solid.body.rest).sum();
  }
  return summary;
}

std::string describe(const LoadSummary& load) {
  std::string text;
  if (load.faces > 0) {
    text = "pressure " + in_kilopascals(load.pressure) + " on " + std::to_string(load.faces) + " faces of " + load.on +
           " (" + three_digits(1e6 * load.area) + " mm^2), " + three_digits(std::abs(load.pressure) / load.young) +
           " of its Young's modulus";
    return text;
  }
  return "force (" + three_digits(load.force.x()) + ", " + three_digits(load.force.y()) + ", " +
         three_digits(load.force.z()) + ") N on " + load.on;
}

std::string largest_pressure(const Model& model) {
  LoadSummary largest;
  for (const LoadModel& load : model.loads) {
    LoadSummary summary = summary_of(model, load);
    if (summary.faces == 0) continue;
    const auto ratio = [](const LoadSummary& own) { return std::abs(own.pressure) / own.young; };
    if (largest.faces == 0 || ratio(summary) > ratio(largest)) largest = std::move(summary);
  }
  return largest.faces > 0 ? largest.name + ": " + describe(largest) : "";
}

}  // namespace sinew
