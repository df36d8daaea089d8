#include "sinew/sim/view.hpp"

#include <algorithm>
#include <cstdio>

#include "sinew/sim/internal.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/signals.hpp"

namespace sinew {

namespace {

/// In the order of ParaView's symmetric tensors.
Eigen::Matrix<double, 6, 1> six(const solid::Mat3& t) { return {t(0, 0), t(1, 1), t(2, 2), t(0, 1), t(1, 2), t(0, 2)}; }

}  // namespace

RodSnapshot sample_cable(const Model& model, const State& state, int number) {
  const GeometricCableModel& cable = model.cables[number];
  const Eigen::VectorXd& z = state.cables[number].z;
  const Placement base = cable_base(model, state, number);
  const int m = cable.cable.points + 1;
  RodSnapshot sample;
  sample.name = cable.name;
  sample.radius.setZero(m);
  sample.abscissa.setZero(m);
  sample.points.resize(3, m);
  sample.tangents.resize(3, m);
  sample.points.col(0) = base.p - z[0] * base.R.col(0);
  for (int i = 0; i + 1 < m; ++i) sample.points.col(i + 1) = z.segment<3>(1 + 3 * i);
  for (int i = 1; i < m; ++i) {
    const Vec3 d = sample.points.col(i) - sample.points.col(i - 1);
    sample.abscissa[i] = sample.abscissa[i - 1] + d.norm();
    sample.tangents.col(i) = d.norm() > 0.0 ? d.normalized() : Vec3(base.R.col(0));
  }
  sample.tangents.col(0) = m > 1 ? Vec3(sample.tangents.col(1)) : Vec3(base.R.col(0));
  return sample;
}

contact::Skin sample_shape(const Model& model, const contact::Shape& shape, const Placement& place) {
  contact::Skin skin = contact::skin(shape, model.size);
  if (std::holds_alternative<contact::HalfSpace>(shape)) {
    const Vec3 middle = place.R.transpose() * (model.middle - place.p);
    for (Vec3& point : skin.points) point += Vec3(middle.x(), middle.y(), 0.0);
  }
  return skin;
}

namespace {

RodSnapshot sample_rod(const Model& model, const State& state, int number) {
  const rod::Rod& rod = model.rods[number].rod;
  const rod::Configuration shape = rod_shape(model, state, number);
  int degree = 0;
  for (const rod::Coefficients& Z : shape.strains) degree = std::max(degree, static_cast<int>(Z.cols()) - 1);
  const int per_section = degree == 0 ? 4 : std::max(8, 64 / rod.count());
  const int m = rod.count() * per_section + 1;
  RodSnapshot sample;
  sample.name = model.rods[number].name;
  sample.radius.resize(m);
  sample.abscissa.resize(m);
  sample.points.resize(3, m);
  sample.tangents.resize(3, m);
  sample.von_mises.resize(m);
  Eigen::MatrixXd strains(6, m), internal(6, m), stresses(3, m);
  for (int j = 0; j < m; ++j) {
    const rod::Section& section = rod.sections[std::min(j / per_section, rod.count() - 1)];
    const double s = j + 1 == m ? rod.length() : section.begin + section.length() * (j % per_section) / per_section;
    const rod::CurvePoint point = rod::curve_point(shape, s);
    sample.abscissa[j] = s;
    sample.radius[j] = rod::radius_at(rod.profile, s);
    sample.points.col(j) = point.position;
    sample.tangents.col(j) = point.derivative.normalized();
    strains.col(j) = rod::strain(rod, state.rods[number].q, s);
    internal.col(j) = internal_wrench(model, state, number, s);
    const rod::SectionStress stress = rod::stress_at(rod.profile, s, internal.col(j));
    stresses.col(j) << stress.axial, stress.bending, stress.torsion;
    sample.von_mises[j] = stress.von_mises;
  }
  static const char* const kInternal[] = {"torsion_moment", "bending_moment_y", "bending_moment_z",
                                          "axial_force",    "shear_force_y",    "shear_force_z"};
  static const char* const kStresses[] = {"axial_stress", "bending_stress", "torsion_stress"};
  for (int i = 0; i < 6; ++i) sample.fields.push_back({rod::kStrainNames[static_cast<std::size_t>(i)], strains.row(i)});
  for (int i = 0; i < 6; ++i) sample.fields.push_back({kInternal[i], internal.row(i)});
  for (int i = 0; i < 3; ++i) sample.fields.push_back({kStresses[i], stresses.row(i)});
  return sample;
}

BodySnapshot sample_body(const Model& model, const std::string& name, const contact::Shape& shape,
                         const Placement& place) {
  BodySnapshot sample;
  sample.name = name;
  sample.ground = std::holds_alternative<contact::HalfSpace>(shape);
  contact::Skin skin = sample_shape(model, shape, place);
  sample.points.resize(3, static_cast<Eigen::Index>(skin.points.size()));
  for (std::size_t i = 0; i < skin.points.size(); ++i)
    sample.points.col(static_cast<Eigen::Index>(i)) = apply(place, skin.points[i]);
  sample.surface = std::move(skin.triangles);
  return sample;
}

}  // namespace

std::string when(const Model& model, const State& state) {
  char text[80];
  switch (model.scene.analysis) {
    case Analysis::modal:
      if (state.grid == 0) return "rest";
      std::snprintf(text, sizeof text, "mode %ld, %.4g Hz", state.grid, state.frequency);
      return text;
    case Analysis::statics:
      std::snprintf(text, sizeof text, "%.4g %% of the load", 100.0 * state.time / model.scene.time.duration);
      return text;
    case Analysis::dynamic:
    case Analysis::quasi_static:
      break;
  }
  std::snprintf(text, sizeof text, "t = %.6g s", state.time);
  return text;
}

Snapshot snapshot(const Model& model, const State& state, const std::string& status) {
  Snapshot view;
  view.time = state.time;
  view.status = status;
  view.when = when(model, state);
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const SolidModel& solid = model.solids[i];
    const Eigen::Matrix3Xd& x = state.solids[i].x;
    const int cells = solid.body.elements();
    Eigen::VectorXd von_mises(cells), ratio(cells), least(cells), material(cells);
    Eigen::MatrixXd stress(6, cells), strain(6, cells);
    for (int cell = 0; cell < cells; ++cell) {
      const solid::CellMeans means = solid::cell_means(solid.body, cell, x);
      von_mises[cell] = solid::von_mises(means.stress);
      ratio[cell] = means.volume_ratio;
      least[cell] = means.least_volume_ratio;
      material[cell] = solid.body.material[static_cast<std::size_t>(cell)];
      stress.col(cell) = six(means.stress);
      strain.col(cell) = six(means.strain);
    }
    view.solids.push_back({solid.name,
                           solid.body.rest,
                           x,
                           solid.body.cells,
                           solid.surface,
                           von_mises,
                           {{"stress", stress},
                            {"strain", strain},
                            {"volume_ratio", ratio.transpose()},
                            {"least_volume_ratio", least.transpose()},
                            {"material", material.transpose()}}});
  }
  for (std::size_t i = 0; i < model.rods.size(); ++i)
    view.rods.push_back(sample_rod(model, state, static_cast<int>(i)));
  for (std::size_t i = 0; i < model.cables.size(); ++i)
    view.rods.push_back(sample_cable(model, state, static_cast<int>(i)));
  for (std::size_t i = 0; i < model.bodies.size(); ++i)
    view.bodies.push_back(
        sample_body(model, model.bodies[i].name, model.bodies[i].shape, {state.bodies[i].R, state.bodies[i].p}));
  for (const ObstacleModel& own : model.obstacles)
    view.bodies.push_back(sample_body(model, own.name, own.shape, compose(moved(model, state, own.frame), own.pose)));
  for (const ContactState& own : state.contacts) {
    if (own.force.isZero()) continue;  // only watched
    view.contacts.push_back({own.point, force_on_second(own), own.on_second ? own.normal : Vec3(-own.normal)});
  }
  for (std::size_t k = 0; k < model.points.size(); ++k) {
    if (!state.points[k].on) continue;
    view.sliding_points.push_back({"", solid_point(model, state, model.points[k].solid, model.points[k].where)});
  }
  for (const OutputModel& output : model.outputs) {
    if (output.quantity != Quantity::position) continue;
    view.outputs.push_back({output.name, output_position(model, state, output)});
  }
  return view;
}

}  // namespace sinew
