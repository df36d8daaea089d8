// Integrating g' = g hat(xi) over a step: a product of exponentials, each of a sum of the strains at Gauss points.
//
//     g(end) = g(begin) exp(W_1) ... exp(W_J),     W_j = sum_d w_jd Z_d
//
// Z_d are the Legendre coefficients of the strains in the section. A constant strain needs one exponential and is
// exact; a varying one takes a commutator-free Magnus scheme of order six. No commutators appear, so each W_j is linear
// in the coordinates and all derivatives of a section of constant strain carry over.
#pragma once

#include <Eigen/Core>

#include "sinew/rod/section.hpp"

namespace sinew::rod {

/// The highest Legendre degree of a strain.
constexpr int kHighestDegree = 5;
/// Exponentials in a step of varying strain.
constexpr int kExponentials = 5;

/// 6 x (degree + 1) Legendre coefficients over a section: the strains are sum_d Z_d P_d(x), x from -1 to 1.
using Coefficients = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kHighestDegree + 1>;
/// Exponentials x (degree + 1).
using Weights = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kExponentials, kHighestDegree + 1>;

/// P_0, P_1, .. at x, and their derivatives.
using LegendreValues = Eigen::Matrix<double, kHighestDegree + 1, 1>;
LegendreValues legendre(double x);
LegendreValues legendre_slopes(double x);

/// Part of a section that one product of exponentials crosses, with the weights w_jd.
struct Step {
  double begin = 0.0, end = 0.0;  ///< [m]
  Weights weights;
};

/// A section cut into steps, more for a higher degree. Up to degree two the integration is as good as the strains; from
/// degree three on its order, six, is that of the rod.
std::vector<Step> integration_steps(double begin, double end, int degree);

/// The weights of a step of the section begin .. end that starts at `from` and ends at s, and their first and second
/// derivatives with respect to s.
struct PartialWeights {
  Weights value, first, second;
};
PartialWeights partial_weights(double begin, double end, int degree, double from, double s);
void partial_weights(double begin, double end, int degree, double from, double s, PartialWeights& weights);

}  // namespace sinew::rod
