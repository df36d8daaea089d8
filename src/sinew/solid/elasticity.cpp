#include "sinew/solid/elasticity.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace sinew::solid {

namespace {

using Vec30 = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * kMostNodes, 1>;

/// Adds scale * B^T C B with dF = sum_a dx_a g_a^T.
void add_contracted(const Mat9& C, double scale, const Eigen::Ref<const Eigen::Matrix3Xd>& g, ElementMatrix& K) {
  for (Eigen::Index b = 0; b < g.cols(); ++b) {
    const Eigen::Matrix<double, 9, 3> right =
        scale * (g(0, b) * C.leftCols<3>() + g(1, b) * C.middleCols<3>(3) + g(2, b) * C.rightCols<3>());
    for (Eigen::Index a = b; a < g.cols(); ++a) {
      K.block<3, 3>(3 * a, 3 * b) +=
          g(0, a) * right.topRows<3>() + g(1, a) * right.middleRows<3>(3) + g(2, a) * right.bottomRows<3>();
    }
  }
}

void complete_upper(ElementMatrix& K) { K.triangularView<Eigen::StrictlyUpper>() = K.transpose(); }

template <ConstitutiveLaw L>
Parts parts_of(const L& law, const Mat3& F, Derivatives wanted, Tangent kind) {
  if constexpr (requires { law.rotated(F, wanted); }) {
    if (kind == Tangent::definite) return law.rotated(F, wanted);
  }
  return parts(law, F, wanted);
}

template <ConstitutiveLaw L>
void evaluate_by(const L& law, const ElementRest& rest, const NodeVectors& x, Derivatives wanted, Tangent kind,
                 ElementResponse& response) {
  const Eigen::Index n = rest.nodes();
  const std::size_t points = rest.volumes.size();
  std::array<Parts, kMostPoints> at;
  double volume = 0.0, theta = 0.0;
  response.energy = 0.0;
  for (std::size_t q = 0; q < points; ++q) {
    at[q] = parts_of(law, deformation_gradient(rest, q, x), wanted, kind);
    volume += rest.volumes[q];
    theta += rest.volumes[q] * at[q].dilatation.value;
    response.energy += rest.volumes[q] * at[q].shape.value;
  }
  theta /= volume;
  const Volumetric U = law.volumetric(theta);
  response.energy += volume * U.value;
  if (wanted == Derivatives::none) return;
  if (!std::isfinite(response.energy)) {  // beyond where the law ends
    response.force.setConstant(3, n, INFINITY);
    response.stiffness.setZero(3 * n, 3 * n);
    return;
  }

  response.force.setZero(3, n);
  for (std::size_t q = 0; q < points; ++q)
    response.force.noalias() +=
        rest.volumes[q] * (at[q].shape.first + U.first * at[q].dilatation.first) * rest.gradients_at(q);
  if (wanted == Derivatives::first) return;

  ElementMatrix& K = response.stiffness;
  K.setZero(3 * n, 3 * n);
  NodeVectors slope = NodeVectors::Zero(3, n);  // d theta / dx
  constexpr bool kRotated = requires(const Mat3& F) { law.rotated(F, wanted); };
  for (std::size_t q = 0; q < points; ++q) {
    Mat9 C = at[q].shape.second + U.first * at[q].dilatation.second;
    if (kind == Tangent::definite && !kRotated) C = positive_semidefinite(C);
    add_contracted(C, rest.volumes[q], rest.gradients_at(q), K);
    slope.noalias() += rest.volumes[q] / volume * at[q].dilatation.first * rest.gradients_at(q);
  }
  const Vec30 g = slope.reshaped();
  K.noalias() += volume * U.second * g * g.transpose();
  complete_upper(K);
}

}  // namespace

void evaluate(const Law& law, const ElementRest& rest, const NodeVectors& x, Derivatives wanted, Tangent kind,
              ElementResponse& response) {
  std::visit([&](const auto& own) { evaluate_by(own, rest, x, wanted, kind, response); }, law);
}

Mat3 deformation_gradient(const ElementRest& rest, std::size_t q, const NodeVectors& x) {
  return x * rest.gradients_at(q).transpose();
}

double mean_dilatation(const Law& law, const ElementRest& rest, const NodeVectors& x) {
  double volume = 0.0, theta = 0.0;
  for (std::size_t q = 0; q < rest.volumes.size(); ++q) {
    const Parts at = parts(law, deformation_gradient(rest, q, x), Derivatives::none);
    volume += rest.volumes[q];
    theta += rest.volumes[q] * at.dilatation.value;
  }
  return theta / volume;
}

Mat3 stress(const Law& law, const Mat3& F, double theta) {
  const Parts at = parts(law, F, Derivatives::first);
  return at.shape.first + volumetric(law, theta).first * at.dilatation.first;
}

NodeVectors viscous_force(const Lame& moduli, const ElementRest& rest, std::span<const Mat3> R, const NodeVectors& v) {
  double volume = 0.0, dilation = 0.0;
  NodeVectors force = NodeVectors::Zero(3, rest.nodes()), slope = force;
  for (std::size_t q = 0; q < rest.volumes.size(); ++q) {
    const auto g = rest.gradients_at(q);
    const Mat3 rate = R[q].transpose() * deformation_gradient(rest, q, v);
    volume += rest.volumes[q];
    dilation += rest.volumes[q] * rate.trace();
    force.noalias() += rest.volumes[q] * moduli.mu * (R[q] * (rate + rate.transpose())) * g;
    slope.noalias() += rest.volumes[q] * R[q] * g;
  }
  return force + moduli.lambda * dilation / volume * slope;
}

void add_viscous_stiffness(const Lame& moduli, double rate, const ElementRest& rest, std::span<const Mat3> R,
                           ElementMatrix& stiffness) {
  const Eigen::Index n = rest.nodes();
  double volume = 0.0;
  NodeVectors slope = NodeVectors::Zero(3, n);
  for (std::size_t q = 0; q < rest.volumes.size(); ++q) {
    const NodeVectors b = R[q] * rest.gradients_at(q);
    const double factor = rate * rest.volumes[q] * moduli.mu;
    volume += rest.volumes[q];
    slope += rest.volumes[q] * b;
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        auto block = stiffness.block<3, 3>(3 * i, 3 * j);
        block.noalias() += factor * b.col(j) * b.col(i).transpose();
        block.diagonal().array() += factor * b.col(i).dot(b.col(j));
      }
    }
  }
  const Vec30 g = slope.reshaped();
  stiffness.noalias() += rate * moduli.lambda / volume * g * g.transpose();
}

}  // namespace sinew::solid
