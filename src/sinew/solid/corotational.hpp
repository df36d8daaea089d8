// The corotational law: linear elasticity in a frame that turns with the element.
//
// With the polar decomposition F = R S and the Lame constants mu, lambda, the energy density is
//     psi(F) = mu |S - I|^2 + lambda / 2 tr(S - I)^2,
// its stress P = 2 mu (F - R) + lambda tr(S - I) R equals R K (R^T x - X) written per volume: the variation of R does
// no work. Derivation and the exact tangent are in README.md of this folder.
#pragma once

#include <Eigen/Core>

namespace sinew::solid {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

struct Lame {
  double mu = 0.0;      ///< [Pa]
  double lambda = 0.0;  ///< [Pa]
};

/// From Young's modulus [Pa] and Poisson's ratio in (-1, 0.5).
Lame lame(double young, double poisson);

/// The rotation nearest to F (a proper one, also where det F <= 0).
Mat3 polar_rotation(const Mat3& F);

/// psi(F) [J/m^3].
double energy_density(const Lame& material, const Mat3& F, const Mat3& R);

/// First Piola-Kirchhoff stress P = d psi / dF [Pa].
Mat3 stress(const Lame& material, const Mat3& F, const Mat3& R);

/// Cauchy stress of the linear law in the turned frame, sigma = R (2 mu e + lambda tr e I) R^T with e = S - I [Pa].
Mat3 corotated_stress(const Lame& material, const Mat3& F, const Mat3& R);

/// How stress changes with nodal positions. For shape function gradients g_i, g_j the 3 x 3 stiffness block of the pair
/// is
///     volume * ( 2 mu g_i.g_j I + lambda b_i b_j^T - turning [b_i]x G [b_j]x ),     b = R g.
/// `exact` is d P / dF; `rotated` freezes R (R K R^T of the paper): positive semi-definite, the same at rest.
struct TangentFrame {
  Mat3 R;
  Mat3 G;          ///< how much the frame turns: (tr(T) I - T)^-1 with the left stretch T = R S R^T; I / 2 if frozen
  double turning;  ///< lambda tr(S - I) - 2 mu; -2 mu if frozen
};
TangentFrame exact_tangent(const Lame& material, const Mat3& F, const Mat3& R);
TangentFrame rotated_tangent(const Lame& material, const Mat3& R);

Mat3 stiffness_block(const Lame& material, const TangentFrame& frame, const Vec3& gradient_i, const Vec3& gradient_j);

/// sqrt(3/2) times the norm of the deviator [Pa].
double von_mises(const Mat3& cauchy);

}  // namespace sinew::solid
