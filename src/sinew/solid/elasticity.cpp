#include "sinew/solid/elasticity.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/solid/principal.hpp"

namespace sinew::solid {

namespace {

using ElementVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * kMostNodes, 1>;

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

/// A law with a definite tangent of its own; others have theirs taken from the exact one.
template <class L>
concept OwnDefinite = requires(const L& law, const Mat3& F, Derivatives wanted) {
  law.definite(F, wanted);
};

template <ConstitutiveLaw L>
Parts parts_of(const L& law, const Mat3& F, Derivatives wanted, Tangent kind) {
  if constexpr (OwnDefinite<L>) {
    if (kind == Tangent::definite) return law.definite(F, wanted);
  }
  return parts(law, F, wanted);
}

/// Adds an element's energy and what `wanted` asks for, of the stiffness what is on and below the diagonal. `law_at`
/// has the law of a quadrature point; w and v may differ from point to point, U not.
template <class LawAt>
void add(const LawAt& law_at, const ElementRest& rest, const NodeVectors& x, Derivatives wanted, Tangent kind,
         ElementResponse& response) {
  using L = std::decay_t<decltype(law_at(0))>;
  const std::size_t points = rest.volumes.size();
  const L& common = law_at(0);
  const double share = pointwise_share(rest.kind, common.lame());
  std::array<Mat3, kMostPoints> F;
  std::array<Parts, kMostPoints> at;
  std::array<Volumetric, kMostPoints> U;
  double volume = 0.0, theta = 0.0, energy = 0.0;
  for (std::size_t q = 0; q < points; ++q) {
    F[q] = deformation_gradient(rest, q, x);
    at[q] = parts_of<L>(law_at(q), F[q], wanted, kind);
    U[q] = common.volumetric(at[q].dilatation.value);
    volume += rest.volumes[q];
    theta += rest.volumes[q] * at[q].dilatation.value;
    energy += rest.volumes[q] * (at[q].shape.value + share * U[q].value);
  }
  theta /= volume;
  const Volumetric mean = common.volumetric(theta);
  response.energy += energy + (1.0 - share) * volume * mean.value;
  if (wanted == Derivatives::none) return;
  if (!std::isfinite(response.energy)) {  // beyond where the law ends
    response.force.setConstant(INFINITY);
    return;
  }

  const auto pressure = [&](std::size_t q) { return share * U[q].first + (1.0 - share) * mean.first; };
  for (std::size_t q = 0; q < points; ++q)
    response.force.noalias() +=
        rest.volumes[q] * (at[q].shape.first + pressure(q) * at[q].dilatation.first) * rest.gradients_at(q);
  if (wanted == Derivatives::first) return;

  NodeVectors slope = NodeVectors::Zero(3, rest.nodes());  // d theta / dx
  for (std::size_t q = 0; q < points; ++q) {
    const Part& v = at[q].dilatation;
    const Vec9 d = v.first.reshaped();
    Mat9 C = at[q].shape.second + pressure(q) * v.second;
    C.noalias() += (share * U[q].second * d) * d.transpose();
    if (kind == Tangent::definite && !OwnDefinite<L>) C = positive_semidefinite(C, F[q]);
    add_contracted(C, rest.volumes[q], rest.gradients_at(q), response.stiffness);
    slope.noalias() += rest.volumes[q] / volume * v.first * rest.gradients_at(q);
  }
  if (share == 1.0) return;
  const ElementVector g = slope.reshaped();
  response.stiffness.noalias() += (1.0 - share) * volume * mean.second * g * g.transpose();
}

/// Saint Venant-Kirchhoff's law for what a step has changed of the strain. Its definite tangent is the one without
/// stress: viscous stress is small where steps are.
struct Viscosity {
  static constexpr bool kInvertible = true;
  SaintVenantKirchhoff law;
  Mat3 dE;  ///< E - E_0 where it is asked for

  Part shape(const Mat3& F, Derivatives wanted) const { return law.shape(F, dE, wanted); }
  Part dilatation(const Mat3& F, Derivatives wanted) const { return law.dilatation(F, dE, wanted); }
  Volumetric volumetric(double v) const { return law.volumetric(v); }
  Lame lame() const { return law.moduli; }

  Parts definite(const Mat3& F, Derivatives wanted) const {
    Parts both = {shape(F, wanted), dilatation(F, wanted)};
    if (wanted != Derivatives::second) return both;
    both.shape.second = law.shape(F, Mat3::Zero(), wanted).second;
    both.dilatation.second.setZero();
    return both;
  }
};

void reset(ElementResponse& response, Eigen::Index nodes, Derivatives wanted) {
  response.energy = 0.0;
  if (wanted != Derivatives::none) response.force.setZero(3, nodes);
  if (wanted == Derivatives::second) response.stiffness.setZero(3 * nodes, 3 * nodes);
}

}  // namespace

double pointwise_share(Kind kind, const Lame& moduli) {
  constexpr double kSoft = 1.5;  // lambda / mu at a Poisson's ratio of 0.3
  if (kind == Kind::tet4 || moduli.lambda <= 0.0) return 1.0;
  return kind == Kind::tet10 ? std::min(1.0, kSoft * moduli.mu / moduli.lambda) : 0.0;
}

void evaluate(const Law& law, const ElementRest& rest, const NodeVectors& x, Derivatives wanted, Tangent kind,
              ElementResponse& response) {
  reset(response, rest.nodes(), wanted);
  std::visit(
      [&](const auto& own) {
        add(
            [&own](std::size_t) -> const auto& { return own; }, rest, x, wanted, kind, response);
      },
      law);
  if (wanted == Derivatives::second) complete_upper(response.stiffness);
}

void add_viscosity(const Lame& moduli, double rate, const ElementRest& rest, const NodeVectors& x0,
                   const NodeVectors& x, Derivatives wanted, Tangent kind, ElementResponse& response) {
  const SaintVenantKirchhoff law{0.0, 0.0, {rate * moduli.mu, rate * moduli.lambda}};
  const NodeVectors dx = x - x0;
  const auto law_at = [&](std::size_t q) {  // from the motion, so that small steps keep their digits
    const Mat3 dF = deformation_gradient(rest, q, dx), F = deformation_gradient(rest, q, x0) + 0.5 * dF;
    return Viscosity{law, 0.5 * (F.transpose() * dF + dF.transpose() * F)};
  };
  add(law_at, rest, x, wanted, kind, response);
  if (wanted == Derivatives::second) complete_upper(response.stiffness);
}

Mat3 deformation_gradient(const ElementRest& rest, std::size_t q, const NodeVectors& x) {
  return x * rest.gradients_at(q).transpose();
}

ElementStress::ElementStress(const Law& law, const ElementRest& rest, const NodeVectors& x)
    : law_(law), share_(pointwise_share(rest.kind, lame(law))) {
  if (share_ == 1.0) return;
  double volume = 0.0, theta = 0.0;
  for (std::size_t q = 0; q < rest.volumes.size(); ++q) {
    volume += rest.volumes[q];
    theta += rest.volumes[q] * dilatation(law, deformation_gradient(rest, q, x));
  }
  mean_ = volumetric(law, theta / volume).first;
}

Mat3 ElementStress::operator()(const Mat3& F) const {
  const Parts at = parts(law_, F, Derivatives::first);
  if (!std::isfinite(at.shape.value)) return Mat3::Constant(NAN);
  const double pressure = share_ * volumetric(law_, at.dilatation.value).first + (1.0 - share_) * mean_;
  return at.shape.first + pressure * at.dilatation.first;
}

}  // namespace sinew::solid
