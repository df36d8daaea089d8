#include "sinew/rod/integration.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sinew::rod {

namespace {

struct Legendre {
  LegendreValues value, first, second;  ///< P_d and its derivatives
};

Legendre legendre_derivatives(double x) {
  Legendre P;
  P.value.setZero();
  P.first.setZero();
  P.second.setZero();
  P.value[0] = 1.0;
  P.value[1] = x;
  P.first[1] = 1.0;
  for (int n = 1; n < kHighestDegree; ++n) {
    P.value[n + 1] = ((2 * n + 1) * x * P.value[n] - n * P.value[n - 1]) / (n + 1);
    P.first[n + 1] = P.first[n - 1] + (2 * n + 1) * P.value[n];
    P.second[n + 1] = P.second[n - 1] + (2 * n + 1) * P.first[n];
  }
  return P;
}

/// Gauss nodes in [0, 1].
const std::array<double, 3> kNode = {0.5 - std::sqrt(15.0) / 10.0, 0.5, 0.5 + std::sqrt(15.0) / 10.0};

/// The time-symmetric scheme of order six with five exponentials whose first carries 1/6 of the step; the order
/// conditions and how they were solved are in README.md.
constexpr double kScheme[kExponentials][3] = {
    {0.20950636427861316327, -0.057819912793101030126, 0.014980215181154533524},
    {0.12611030195873218345, 0.31306793946603532825, -0.059060760579651775289},
    {-0.013758343061070327173, -0.066051608901424151802, -0.013758343061070327173},
    {-0.059060760579651775289, 0.31306793946603532825, 0.12611030195873218345},
    {0.014980215181154533524, -0.057819912793101030126, 0.20950636427861316327}};

}  // namespace

LegendreValues legendre(double x) { return legendre_derivatives(x).value; }
LegendreValues legendre_slopes(double x) { return legendre_derivatives(x).first; }

PartialWeights partial_weights(double begin, double end, int degree, double from, double s) {
  PartialWeights weights;
  partial_weights(begin, end, degree, from, s, weights);
  return weights;
}

void partial_weights(double begin, double end, int degree, double from, double s, PartialWeights& w) {
  const double h = s - from;
  if (degree == 0) {
    w.value.setConstant(1, 1, h);
    w.first.setConstant(1, 1, 1.0);
    w.second.setZero(1, 1);
    return;
  }
  for (Weights* one : {&w.value, &w.first, &w.second}) one->setZero(kExponentials, degree + 1);
  const double slope = 2.0 / (end - begin);
  for (int i = 0; i < 3; ++i) {
    const double c = kNode[static_cast<std::size_t>(i)], dx = c * slope;
    const Legendre P = legendre_derivatives(slope * (from + c * h - begin) - 1.0);
    for (int d = 0; d <= degree; ++d) {
      const double value = h * P.value[d], first = P.value[d] + h * dx * P.first[d];
      const double second = 2.0 * dx * P.first[d] + h * dx * dx * P.second[d];
      for (int j = 0; j < kExponentials; ++j) {
        w.value(j, d) += kScheme[j][i] * value;
        w.first(j, d) += kScheme[j][i] * first;
        w.second(j, d) += kScheme[j][i] * second;
      }
    }
  }
}

std::vector<Step> integration_steps(double begin, double end, int degree) {
  // Three Gauss points see the lever arm times P_5, of degree six, only on short steps.
  const int count = degree == kHighestDegree ? 8 : std::max(1, degree - 1);
  std::vector<Step> steps;
  for (int i = 0; i < count; ++i) {
    const double from = begin + (end - begin) * i / count;
    const double to = i + 1 == count ? end : begin + (end - begin) * (i + 1) / count;
    steps.push_back({from, to, partial_weights(begin, end, degree, from, to).value});
  }
  return steps;
}

}  // namespace sinew::rod
