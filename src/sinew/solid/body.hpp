// A deformable volume in global coordinates: its immutable data, and the two halves of (7) and (8), forces and tangent.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sinew/solid/corotational.hpp"
#include "sinew/solid/mesh.hpp"

namespace sinew::solid {

/// Linear tetrahedra with lumped mass; some nodes clamped. Built once, read by everything below.
struct Body {
  Eigen::Matrix3Xd rest;  ///< [m] node positions without load, in the world
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Eigen::Matrix<double, 3, 4>> gradients;  ///< [1/m] of the four shape functions, per tetrahedron
  std::vector<double> volumes;                         ///< [m^3]
  Lame material;
  Eigen::VectorXd masses;        ///< [kg] lumped, one per node
  double damping_mass = 0.0;     ///< Rayleigh [1/s]
  double damping_stiffness = 0;  ///< Rayleigh [s]
  std::vector<int> unknown;      ///< per node: number among the free nodes, or -1 if clamped
  int free_nodes = 0;

  int nodes() const { return static_cast<int>(rest.cols()); }
  int elements() const { return static_cast<int>(tetrahedra.size()); }
};

/// Gradients and volumes from `rest` and `tetrahedra`, masses of a given total [kg] spread by volume. `clamped` per
/// node.
Body make_body(Eigen::Matrix3Xd rest, std::vector<Tetrahedron> tetrahedra, const Lame& material, double mass,
               const std::vector<bool>& clamped);

/// F = sum_i x_i g_i^T of one element.
Mat3 deformation_gradient(const Body& body, int element, const Eigen::Matrix3Xd& x);

/// Polar rotations of all elements.
std::vector<Mat3> rotations(const Body& body, const Eigen::Matrix3Xd& x);

/// What a time step needs to know about its start.
struct StepStart {
  Eigen::Matrix3Xd x, v;       ///< [m], [m/s] at the start
  std::vector<Mat3> rotation;  ///< polar rotations there: the frame in which damping acts during the step
  double rate = 0.0;           ///< 1 / h [1/s]; 0: equilibrium, without inertia and damping
};

/// Elastic force [N], 3 x n: dE/dx, so that it stands with a plus on the left of the equation of motion.
Eigen::Matrix3Xd elastic_force(const Body& body, const Eigen::Matrix3Xd& x);

/// Elastic energy [J].
double elastic_energy(const Body& body, const Eigen::Matrix3Xd& x);

/// Left minus right side of (7) under backward Euler, without the multipliers, 3 x n [N]:
///     M (v - v_0) / h + a M v + f(x) + b K_0 v - M g,      v = (x - x_0) / h,
/// with Rayleigh's a and b and K_0 the stiffness rotated as at the start of the step (symmetric, never gains energy).
/// `scale` [N] receives the largest single contribution at any node: what the residual is measured against.
Eigen::Matrix3Xd residual(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x, const Vec3& gravity,
                          double* scale = nullptr);

/// Which elastic tangent: `exact`, or `rotated` (R K R^T of the paper, always positive semi-definite).
enum class Tangent { exact, rotated };

/// Takes a 3 x 3 block for a pair of free nodes (a, b) with a >= b.
using InsertBlock = std::function<void(int element, int local_a, int local_b, const Mat3& block)>;

/// The matrix of (10) divided by h: A = M (1 + a h) / h^2 + b K_0 / h + K(x), element by element through `insert`
/// (local_a, local_b are corners 0..3). Mass and mass damping are on the diagonal: mass_diagonal().
void assemble_tangent(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x, Tangent kind,
                      const InsertBlock& insert);

/// Per node: m (1 / h + a) / h.
Eigen::VectorXd mass_diagonal(const Body& body, double rate);

/// Von Mises stress [Pa] per element.
Eigen::VectorXd von_mises(const Body& body, const Eigen::Matrix3Xd& x);

}  // namespace sinew::solid
