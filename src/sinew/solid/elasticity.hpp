// Elastic energy, forces and stiffness of one element of any kind and law.
//
// With w_q the volumes of its quadrature points, V their sum and psi = w(F) + U(v(F)) its law,
//     E = sum_q w_q w(F_q) + V U(theta),      theta = 1/V sum_q w_q v(F_q),
// so the dilatation enters by its mean over the element, which is what keeps elements of many points from locking
// where U is stiff. With one point it is the plain law.
#pragma once

#include <span>

#include "sinew/solid/laws.hpp"

namespace sinew::solid {

/// What an element is at rest: shape function gradients at each quadrature point [1/m], node_count columns a point, and
/// the points' volumes [m^3].
struct ElementRest {
  Eigen::Map<const Eigen::Matrix3Xd> gradients;
  std::span<const double> volumes;
  Eigen::Index nodes() const { return gradients.cols() / static_cast<Eigen::Index>(volumes.size()); }
  auto gradients_at(std::size_t q) const {
    return gradients.middleCols(static_cast<Eigen::Index>(q) * nodes(), nodes());
  }
};

/// 3n x 3n over the coordinates of the nodes, one node after the other.
using ElementMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * kMostNodes, 3 * kMostNodes>;

/// Which elastic tangent: `exact`, or a positive semi-definite one: of the corotational law `R K R^T` of the paper, of
/// others the exact one with what is negative at each point taken out.
enum class Tangent { exact, definite };

struct ElementResponse {
  double energy = 0.0;      ///< [J], infinite where the law ends
  NodeVectors force;        ///< dE/dx [N]
  ElementMatrix stiffness;  ///< d2E/dx2 [N/m]
};

/// Nodes at x. Fills what `wanted` asks for.
void evaluate(const Law& law, const ElementRest& rest, const NodeVectors& x, Derivatives wanted, Tangent kind,
              ElementResponse& response);

/// F at a quadrature point.
Mat3 deformation_gradient(const ElementRest& rest, std::size_t q, const NodeVectors& x);

/// theta of an element.
double mean_dilatation(const Law& law, const ElementRest& rest, const NodeVectors& x);
/// First Piola-Kirchhoff stress [Pa] where the deformation gradient is F, in an element of mean dilatation theta.
Mat3 stress(const Law& law, const Mat3& F, double theta);

/// Forces and stiffness of viscosity in frames R that stay, one per quadrature point: linear, K v with
///     K = sum_q w_q (2 mu |sym R^T Fdot|^2)'' + lambda / V g g^T,   g = sum_q w_q d(R : F_q)/dx,
/// symmetric and positive semi-definite. Moduli in [Pa s].
NodeVectors viscous_force(const Lame& moduli, const ElementRest& rest, std::span<const Mat3> R, const NodeVectors& v);
void add_viscous_stiffness(const Lame& moduli, double rate, const ElementRest& rest, std::span<const Mat3> R,
                           ElementMatrix& stiffness);

}  // namespace sinew::solid
