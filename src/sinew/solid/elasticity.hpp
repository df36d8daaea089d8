// Elastic energy, forces and stiffness of one element of any kind and law.
//
// With w_q the volumes of its quadrature points, V their sum and psi = w(F) + U(v(F)) its law,
//     E = sum_q w_q (w(F_q) + b U(v(F_q))) + (1 - b) V U(theta),      theta = 1/V sum_q w_q v(F_q),
// so a share 1 - b of U acts on the mean dilatation of the element, which is what keeps elements of many points from
// locking where U is stiff. With one point it is the plain law.
#pragma once

#include <span>

#include "sinew/solid/laws.hpp"

namespace sinew::solid {

/// What an element is at rest: shape function gradients at each quadrature point [1/m], node_count columns a point, and
/// the points' volumes [m^3].
struct ElementRest {
  Kind kind;
  Eigen::Map<const Eigen::Matrix3Xd> gradients;
  std::span<const double> volumes;
  Eigen::Index nodes() const { return node_count(kind); }
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

/// The share b of U that acts at each point rather than on the mean: all of it in elements of one point, and where U is
/// soft; of 10-node tetrahedra a part that is as stiff as U of a material of Poisson's ratio 0.3 (README).
double pointwise_share(Kind kind, const Lame& moduli);

/// Nodes at x. Fills what `wanted` asks for.
void evaluate(const Law& law, const ElementRest& rest, const NodeVectors& x, Derivatives wanted, Tangent kind,
              ElementResponse& response);

/// Adds Kelvin-Voigt damping of a step of backward Euler, by the Green strains E_0 at its start, nodes at x0: the
/// potential, with moduli in [Pa s] and rate = 1/h,
///     rate sum_q w_q (mu |E - E_0|^2 + lambda / 2 tr^2 (E - E_0)),
/// its dilatation shared out like U above. Rigid motion of any speed and size leaves it alone.
void add_viscosity(const Lame& moduli, double rate, const ElementRest& rest, const NodeVectors& x0,
                   const NodeVectors& x, Derivatives wanted, Tangent kind, ElementResponse& response);

/// F at a quadrature point.
Mat3 deformation_gradient(const ElementRest& rest, std::size_t q, const NodeVectors& x);

/// First Piola-Kirchhoff stress [Pa] of a law in an element, nodes at x, where the deformation gradient is F; NaN where
/// the law has ended.
class ElementStress {
 public:
  ElementStress(const Law& law, const ElementRest& rest, const NodeVectors& x);
  Mat3 operator()(const Mat3& F) const;

 private:
  const Law& law_;
  double share_ = 1.0, mean_ = 0.0;  ///< b, and U' of the mean dilatation
};

}  // namespace sinew::solid
