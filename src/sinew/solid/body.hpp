// A deformable volume in global coordinates: its immutable data, and the two halves of (7) and (8), forces and tangent.
#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <optional>
#include <vector>

#include "sinew/linalg/aligned.hpp"
#include "sinew/solid/elasticity.hpp"
#include "sinew/solid/embedding.hpp"
#include "sinew/solid/mesh.hpp"
#include "sinew/solid/tet_batch.hpp"

namespace sinew::solid {

/// What some of a body's cells are made of.
struct Material {
  Law law;
  double density = 0.0;  ///< [kg/m^3]
  Lame viscosity;        ///< [Pa s] of the whole Kelvin-Voigt damping, Rayleigh's part of the stiffness included
};

enum class MassMatrix { lumped, consistent };

/// Elements of any kinds and laws; some coordinates of nodes are held. Built once, read by everything below.
struct Body {
  Eigen::Matrix3Xd rest;  ///< [m] node positions without load, in the world
  std::vector<Cell> cells;
  std::vector<Material> materials;
  std::vector<int> material;         ///< of each cell
  std::vector<int> first_point;      ///< per cell, and one more: its quadrature points among all
  std::vector<int> first_gradient;   ///< per cell: its columns in `gradients`
  std::vector<double> volumes;       ///< [m^3] per quadrature point
  Eigen::Matrix3Xd gradients;        ///< [1/m] shape function gradients, see ElementRest
  Eigen::SparseMatrix<double> mass;  ///< [kg] nodes x nodes; the same in all directions
  Eigen::VectorXd masses;            ///< [kg] its row sums: what gravity acts on
  double damping_mass = 0.0;         ///< Rayleigh's alpha [1/s]
  Eigen::Matrix3Xi unknown;          ///< per node and axis: number among the unknowns, or -1 where it is held
  int unknowns = 0;
  std::vector<int> held_nodes;  ///< those of which a coordinate is held, ascending

  std::vector<TetBatch> batches;  ///< the corotational linear tetrahedra, in the order of their numbers
  std::vector<int> others;        ///< all other cells

  int nodes() const { return static_cast<int>(rest.cols()); }
  int elements() const { return static_cast<int>(cells.size()); }
  int points() const { return static_cast<int>(volumes.size()); }
  ElementRest element(int cell) const;
  const Material& of(int cell) const {
    return materials[static_cast<std::size_t>(material[static_cast<std::size_t>(cell)])];
  }
  /// Columns of x, or of anything given per node, at a cell's nodes.
  NodeVectors at_nodes(int cell, const Eigen::Matrix3Xd& x) const {
    return cell_nodes(x, cells[static_cast<std::size_t>(cell)]);
  }
};

/// Visits the coordinates that are held, (axis, node): those of a node together, nodes ascending.
template <class Visit>
void each_held(const Body& body, const Visit& visit) {
  for (const int node : body.held_nodes) {
    for (int axis = 0; axis < 3; ++axis) {
      if (body.unknown(axis, node) < 0) visit(axis, node);
    }
  }
}

/// What a quantity given per node is at the body's unknowns, and a quantity at the unknowns per node, 0 where held.
void at_unknowns(const Body& body, const Eigen::Matrix3Xd& nodal, Eigen::VectorXd& u);
void from_unknowns(const Body& body, const Eigen::VectorXd& u, Eigen::Matrix3Xd& nodal);

/// `material` per cell, `held` 3 x nodes. `total` [kg] replaces the densities' mass, keeping how it is spread.
Body make_body(Eigen::Matrix3Xd rest, std::vector<Cell> cells, std::vector<Material> materials,
               std::vector<int> material, const Eigen::Array<bool, 3, Eigen::Dynamic>& held,
               MassMatrix kind = MassMatrix::lumped, std::optional<double> total = {});

/// Renumbers the nodes within each batch's elements, those of low rank first.
void sort_batches(Body& body, const std::vector<int>& rank);

/// What a time step needs to know about its start; it sees what others own.
struct StepStart {
  const Eigen::Matrix3Xd &x, &v;  ///< [m], [m/s] at the start
  double rate = 0.0;              ///< 1 / h [1/s]; 0: equilibrium, without inertia and damping
};

/// Elastic force [N], 3 x n: dE/dx, so that it stands with a plus on the left of the equation of motion.
Eigen::Matrix3Xd elastic_force(const Body& body, const Eigen::Matrix3Xd& x);

/// Elastic energy [J]; infinite where an element's law ends (turned inside out, and not made for it).
double elastic_energy(const Body& body, const Eigen::Matrix3Xd& x);

/// Kinetic energy [J] of node velocities v [m/s], 3 x n: v^T M v / 2.
double kinetic_energy(const Body& body, const Eigen::Matrix3Xd& v);

/// Where a body is, as forces and tangent both need it first: records of the nodes and one more (see TetKernels), and
/// what the batches make of them.
struct Deformation {
  linalg::AlignedVector<double> nodes;   ///< [m] where they are, and how far they moved since the start
  std::vector<TetFrames> frames;         ///< of the batches
  linalg::AlignedVector<double> forces;  ///< [N] elastic and viscous ones of the batches
};
/// Memory of an earlier one is used again, here and below.
void deform(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x, Deformation& deformation);

/// Left minus right side of (7) under backward Euler, without loads and multipliers, 3 x n [N]:
///     M (v - v_0) / h + a M v + f(x) + d(x, x_0) - M g,      v = (x - x_0) / h,
/// with Rayleigh's a and the viscous forces d (`add_viscosity`). The deformation is that of the same start and place.
struct Residual {
  Eigen::Matrix3Xd sum;
  double scale = 0.0;  ///< [N] largest single contribution at any node: what the residual is measured against
  linalg::AlignedVector<double> others;  ///< [N] forces of elements that are in no batch, as a Deformation's
  Eigen::Matrix3Xd acceleration;         ///< [m/s^2] (v - v_0) / h + a v; room of steps that have an h
};
void residual(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x, const Deformation& deformation,
              const Vec3& gravity, Residual& residual);

/// Take the matrix of one element, 3n x 3n, and those of a batch, without the elements in the bits of `left_out`.
using InsertElement = std::function<void(int cell, const ElementMatrix& matrix)>;
using InsertBatch = std::function<void(const TetBatch& batch, const TetStiffness& stiffness, unsigned left_out)>;

/// The matrix of (10) divided by h, A = M (1 + a h) / h^2 + d'(x) + K(x), but for its mass, element by element.
/// mass_factor() times Body::mass is what is missing.
void assemble_tangent(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x,
                      const Deformation& deformation, Tangent kind, const InsertElement& insert,
                      const InsertBatch& insert_batch);

/// (1 / h + a) / h.
double mass_factor(const Body& body, double rate);

/// Cells whose volume has vanished or turned inside out at one of their quadrature points.
std::vector<int> folded_cells(const Body& body, const Eigen::Matrix3Xd& x);

/// Cells whose law has ended: their energy is not finite.
std::vector<int> ended_cells(const Body& body, const Eigen::Matrix3Xd& x);

/// Cauchy stress sigma = P F^T / J [Pa] at a point, with its element's share of the mean dilatation. NaN where the
/// element is flat or inside out, or a quadrature point is beyond where its law ends.
Mat3 cauchy_stress(const Body& body, const EmbeddedPoint& point, const Eigen::Matrix3Xd& x);
/// Green-Lagrange strain (F^T F - I) / 2 at a point.
Mat3 green_strain(const Body& body, const EmbeddedPoint& point, const Eigen::Matrix3Xd& x);

/// Means over a cell.
struct CellMeans {
  Mat3 stress;                ///< Cauchy's [Pa], over the volume that the cell has now; NaN where that is not positive
  Mat3 strain;                ///< Green and Lagrange's, over the volume at rest
  double volume_ratio = 1.0;  ///< volume now over volume at rest
  double least_volume_ratio = 1.0;  ///< of its quadrature points: not above 0 where it is flat or inside out
};
CellMeans cell_means(const Body& body, int cell, const Eigen::Matrix3Xd& x);

/// Eigenvalues of a symmetric tensor, largest first.
Vec3 principal_values(const Mat3& tensor);

}  // namespace sinew::solid
