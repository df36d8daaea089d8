#include "sinew/solid/body.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <utility>

namespace sinew::solid {

Body make_body(Eigen::Matrix3Xd rest, std::vector<Tetrahedron> tetrahedra, const Lame& material, double mass,
               const std::vector<bool>& clamped) {
  Body body;
  body.rest = std::move(rest);
  body.tetrahedra = std::move(tetrahedra);
  body.material = material;
  body.masses.setZero(body.nodes());
  double total = 0.0;
  for (const Tetrahedron& t : body.tetrahedra) {
    Mat3 edges;
    for (int i = 0; i < 3; ++i) edges.col(i) = body.rest.col(t[i + 1]) - body.rest.col(t[0]);
    const Mat3 inverse = edges.inverse();
    Eigen::Matrix<double, 3, 4> gradients;
    gradients.rightCols<3>() = inverse.transpose();
    gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
    body.gradients.push_back(gradients);
    body.volumes.push_back(edges.determinant() / 6.0);
    total += body.volumes.back();
  }
  for (int e = 0; e < body.elements(); ++e) {
    for (int node : body.tetrahedra[e]) body.masses[node] += 0.25 * mass * body.volumes[e] / total;
  }
  for (int i = 0; i < body.nodes(); ++i) body.unknown.push_back(clamped[i] ? -1 : body.free_nodes++);
  return body;
}

Mat3 deformation_gradient(const Body& body, int element, const Eigen::Matrix3Xd& x) {
  const Tetrahedron& t = body.tetrahedra[element];
  const auto& g = body.gradients[element];
  Mat3 F = Mat3::Zero();
  for (int i = 0; i < 4; ++i) F += x.col(t[i]) * g.col(i).transpose();
  return F;
}

std::vector<Mat3> rotations(const Body& body, const Eigen::Matrix3Xd& x) {
  std::vector<Mat3> R(body.elements());
  for (int e = 0; e < body.elements(); ++e) R[e] = polar_rotation(deformation_gradient(body, e, x));
  return R;
}

namespace {

/// Adds volume * P g_i to the nodes of an element.
void scatter(const Body& body, int e, const Mat3& P, Eigen::Matrix3Xd& force) {
  const Eigen::Matrix<double, 3, 4> f = body.volumes[e] * P * body.gradients[e];
  for (int i = 0; i < 4; ++i) force.col(body.tetrahedra[e][i]) += f.col(i);
}

double largest_column(const Eigen::Matrix3Xd& columns) {
  return columns.cols() ? columns.colwise().norm().maxCoeff() : 0.0;
}

}  // namespace

Eigen::Matrix3Xd elastic_force(const Body& body, const Eigen::Matrix3Xd& x) {
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, body.nodes());
  for (int e = 0; e < body.elements(); ++e) {
    const Mat3 F = deformation_gradient(body, e, x);
    scatter(body, e, stress(body.material, F, polar_rotation(F)), force);
  }
  return force;
}

double elastic_energy(const Body& body, const Eigen::Matrix3Xd& x) {
  double energy = 0.0;
  for (int e = 0; e < body.elements(); ++e) {
    const Mat3 F = deformation_gradient(body, e, x);
    energy += body.volumes[e] * energy_density(body.material, F, polar_rotation(F));
  }
  return energy;
}

Eigen::Matrix3Xd residual(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x, const Vec3& gravity,
                          double* scale) {
  const Eigen::Matrix3Xd v = (x - start.x) * start.rate;
  const Eigen::Matrix3Xd elastic = elastic_force(body, x);
  Eigen::Matrix3Xd viscous = Eigen::Matrix3Xd::Zero(3, body.nodes());
  if (body.damping_stiffness > 0.0) {
    for (int e = 0; e < body.elements(); ++e) {
      const Mat3& R = start.rotation[e];
      const Mat3 rate = R.transpose() * deformation_gradient(body, e, v);  // sum v_i g_i^T in the frame of the element
      const Mat3 strain_rate = 0.5 * (rate + rate.transpose());
      const Mat3 sigma = body.damping_stiffness * (2.0 * body.material.mu * strain_rate +
                                                   body.material.lambda * strain_rate.trace() * Mat3::Identity());
      scatter(body, e, R * sigma, viscous);
    }
  }
  const Eigen::Matrix3Xd inertia =
      ((v - start.v) * start.rate + body.damping_mass * v).array().rowwise() * body.masses.transpose().array();
  const Eigen::Matrix3Xd weight = gravity * body.masses.transpose();
  if (scale)
    *scale =
        std::max({largest_column(elastic), largest_column(viscous), largest_column(inertia), largest_column(weight)});
  return inertia + elastic + viscous - weight;
}

void assemble_tangent(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x, Tangent kind,
                      const InsertBlock& insert) {
  const double viscous = body.damping_stiffness * start.rate;
  for (int e = 0; e < body.elements(); ++e) {
    const Mat3 F = deformation_gradient(body, e, x);
    const Mat3 R = polar_rotation(F);
    const TangentFrame elastic =
        kind == Tangent::exact ? exact_tangent(body.material, F, R) : rotated_tangent(body.material, R);
    const TangentFrame damping = rotated_tangent(body.material, start.rotation[e]);
    const auto& g = body.gradients[e];
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const int row = body.unknown[body.tetrahedra[e][a]], column = body.unknown[body.tetrahedra[e][b]];
        if (row < 0 || column < 0 || row < column) continue;
        Mat3 block = body.volumes[e] * stiffness_block(body.material, elastic, g.col(a), g.col(b));
        if (viscous > 0.0)
          block += viscous * body.volumes[e] * stiffness_block(body.material, damping, g.col(a), g.col(b));
        insert(e, a, b, block);
      }
    }
  }
}

Eigen::VectorXd mass_diagonal(const Body& body, double rate) {
  return body.masses * ((rate + body.damping_mass) * rate);
}

Eigen::VectorXd von_mises(const Body& body, const Eigen::Matrix3Xd& x) {
  Eigen::VectorXd values(body.elements());
  for (int e = 0; e < body.elements(); ++e) {
    const Mat3 F = deformation_gradient(body, e, x);
    values[e] = von_mises(corotated_stress(body.material, F, polar_rotation(F)));
  }
  return values;
}

}  // namespace sinew::solid
