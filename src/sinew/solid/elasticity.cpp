#include "sinew/solid/elasticity.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/solid/principal.hpp"

namespace sinew::solid {

namespace {

/// Nodes of an element of one kind. Sizes known to the compiler: asked for as it runs they made a force cost eight
/// times as much.
template <Kind kind>
using Nodes = Eigen::Matrix<double, 3, node_count(kind)>;
template <Kind kind>
using Stiffness = Eigen::Matrix<double, 3 * node_count(kind), 3 * node_count(kind)>;

template <class Visit>
void with_kind(Kind kind, const Visit& visit) {
  if (kind == Kind::tet4) return visit(std::integral_constant<Kind, Kind::tet4>());
  if (kind == Kind::tet10) return visit(std::integral_constant<Kind, Kind::tet10>());
  visit(std::integral_constant<Kind, Kind::hex8>());
}

template <Kind kind>
Eigen::Map<const Nodes<kind>> gradients_at(const ElementRest& rest, std::size_t q) {
  return Eigen::Map<const Nodes<kind>>(rest.gradients.data() + q * 3 * node_count(kind));
}

/// Adds scale * B^T C B with dF = sum_a dx_a g_a^T on and below the diagonal.
template <Kind kind>
void add_contracted(const Mat9& C, double scale, const Nodes<kind>& g, Eigen::Map<Stiffness<kind>>& K) {
  for (int b = 0; b < node_count(kind); ++b) {
    const Eigen::Matrix<double, 9, 3> right =
        scale * (g(0, b) * C.leftCols<3>() + g(1, b) * C.middleCols<3>(3) + g(2, b) * C.rightCols<3>());
    for (int a = b; a < node_count(kind); ++a) {
      K.template block<3, 3>(3 * a, 3 * b) +=
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
template <Kind kind, class LawAt>
void add(const LawAt& law_at, const ElementRest& rest, const NodeVectors& nodes, Derivatives wanted, Tangent tangent,
         ElementResponse& response) {
  using L = std::decay_t<decltype(law_at(0))>;
  constexpr std::size_t points = point_count(kind);
  const Eigen::Map<const Nodes<kind>> x(nodes.data());
  const L& common = law_at(0);
  const double share = pointwise_share(kind, common.lame());
  std::array<Mat3, points> F;
  std::array<Parts, points> at;
  std::array<Volumetric, points> U;
  double volume = 0.0, theta = 0.0, energy = 0.0;
  for (std::size_t q = 0; q < points; ++q) {
    F[q] = x * gradients_at<kind>(rest, q).transpose();
    at[q] = parts_of<L>(law_at(q), F[q], wanted, tangent);
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
  Eigen::Map<Nodes<kind>> force(response.force.data());
  for (std::size_t q = 0; q < points; ++q) {
    const Mat3 stress = rest.volumes[q] * (at[q].shape.first + pressure(q) * at[q].dilatation.first);
    force.noalias() += stress * gradients_at<kind>(rest, q);
  }
  if (wanted == Derivatives::first) return;

  Eigen::Map<Stiffness<kind>> K(response.stiffness.data());
  Nodes<kind> slope = Nodes<kind>::Zero();  // d theta / dx
  for (std::size_t q = 0; q < points; ++q) {
    const Part& v = at[q].dilatation;
    const Vec9 d = v.first.reshaped();
    Mat9 C = at[q].shape.second + pressure(q) * v.second;
    C.noalias() += (share * U[q].second * d) * d.transpose();
    if (tangent == Tangent::definite && !OwnDefinite<L>) C = positive_semidefinite(C, F[q]);
    add_contracted<kind>(C, rest.volumes[q], gradients_at<kind>(rest, q), K);
    slope.noalias() += (rest.volumes[q] / volume * v.first) * gradients_at<kind>(rest, q);
  }
  if (share == 1.0) return;
  const Eigen::Matrix<double, 3 * node_count(kind), 1> g = slope.reshaped();
  K.noalias() += ((1.0 - share) * volume * mean.second * g) * g.transpose();
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
  with_kind(rest.kind, [&](auto of_kind) {
    std::visit(
        [&](const auto& own) {
          add<of_kind()>(
              [&own](std::size_t) -> const auto& { return own; }, rest, x, wanted, kind, response);
        },
        law);
  });
  if (wanted == Derivatives::second) complete_upper(response.stiffness);
}

void add_viscosity(const Lame& moduli, double rate, const ElementRest& rest, const NodeVectors& x0,
                   const NodeVectors& x, Derivatives wanted, Tangent kind, ElementResponse& response) {
  const SaintVenantKirchhoff law{0.0, 0.0, {rate * moduli.mu, rate * moduli.lambda}};
  with_kind(rest.kind, [&](auto of_kind) {
    const Eigen::Map<const Nodes<of_kind()>> start(x0.data()), end(x.data());
    const Nodes<of_kind()> dx = end - start;
    const auto law_at = [&](std::size_t q) {  // from the motion, so that small steps keep their digits
      const auto g = gradients_at<of_kind()>(rest, q);
      const Mat3 dF = dx * g.transpose(), F = start * g.transpose() + 0.5 * dF;
      return Viscosity{law, 0.5 * (F.transpose() * dF + dF.transpose() * F)};
    };
    add<of_kind()>(law_at, rest, x, wanted, kind, response);
  });
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
