#include "sinew/rod/kinematics.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace sinew::rod {

using lie::RotationMap;

namespace {

/// A section from its start to the local abscissa sigma: gamma = p + R (sigma V(sigma k) u), frame R exp(sigma k).
struct Piece {
  Piece(const Configuration& shape, int section, double length)
      : R(shape.R[section]),
        k(shape.k[section]),
        u(shape.u[section]),
        sigma(length),
        exponential(RotationMap::exponential(length * k)),
        tangent(RotationMap::tangent(length * k)) {}

  Vec3 chord() const { return sigma * (tangent * u); }

  /// Turning and moving of the end (dgamma, taken at the end itself) when the strain number `strain` changes.
  void end_motion(int strain, Vec3& turn, Vec3& move) const {
    if (strain < 3) {
      turn = R * (sigma * (tangent * Vec3::Unit(strain)));
      move = R * (sigma * sigma * tangent.gradient(u).col(strain));
    } else {
      turn.setZero();
      move = R * (sigma * (tangent * Vec3::Unit(strain - 3)));
    }
  }

  /// Second derivatives with respect to the six strains of F . R chord + sum_i f_i . R exp(sigma k) y_i, in the frame
  /// of the section's start: F given as is, the sum through S = sum y_i f_i^T (columns already in the start frame).
  Eigen::Matrix<double, 6, 6> hessian(const Vec3& F, const Mat3& S) const {
    Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
    const double sigma2 = sigma * sigma;
    H.topLeftCorner<3, 3>() = sigma2 * (tangent.hessian(sigma * u * F.transpose()) + exponential.hessian(S));
    H.bottomLeftCorner<3, 3>() = sigma2 * tangent.transposed_gradient(F);
    H.topRightCorner<3, 3>() = H.bottomLeftCorner<3, 3>().transpose();
    return H;
  }

  const Mat3& R;
  const Vec3& k;
  const Vec3& u;
  double sigma;
  RotationMap exponential, tangent;
};

/// Moment, inertia and virial about the configuration's origin of everything met so far on the way from tip to base.
struct Resultant {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  Mat3 virial = Mat3::Zero();  ///< sum x f^T
  double mass = 0.0;
  Vec3 first = Vec3::Zero();   ///< sum w x
  Mat3 second = Mat3::Zero();  ///< sum w (|x|^2 I - x x^T)

  void add(const Vec3& x, const Vec3& f, double w) {
    force += f;
    moment += x.cross(f);
    virial += x * f.transpose();
    mass += w;
    first += w * x;
    second += w * (x.squaredNorm() * Mat3::Identity() - x * x.transpose());
  }
  double work(const Vec3& turn, const Vec3& move) const { return move.dot(force) + turn.dot(moment); }
  /// sum w J and the change of the moment: what an earlier twist (omega, v) is multiplied with.
  void response(const Vec3& turn, const Vec3& move, Vec3& angular, Vec3& linear) const {
    linear = mass * move + turn.cross(first);
    angular = first.cross(move) + second * turn;                           // sum w x x (move + turn x x)
    angular += move.cross(force) + virial * turn - virial.trace() * turn;  // sum (move + turn x x) x f
  }
};

}  // namespace

Configuration configure(const Rod& rod, const Placement& base, const Eigen::VectorXd& q) {
  Configuration shape;
  shape.rod = &rod;
  const int N = rod.sections();
  shape.R.resize(N + 1);
  shape.p.resize(N + 1);
  shape.k.resize(N);
  shape.u.resize(N);
  shape.omega.setZero(3, rod.coordinates());
  shape.v.setZero(3, rod.coordinates());
  shape.origin = base.p;
  shape.R[0] = base.R;
  shape.p[0] = base.p;
  const Vec3 axis = base.R.col(0);
  for (int i = 0; i < rod.base_coordinates(); ++i) {
    if (rod.base[i] == BaseAxis::translation) {
      shape.p[0] -= q[i] * axis;
      shape.v.col(i) = -axis;
    } else {
      shape.R[0] = shape.R[0] * lie::exp(q[i] * Vec3::UnitX());
      shape.omega.col(i) = axis;  // the axis passes through the origin: v = 0
    }
  }
  for (int i = 0; i < N; ++i) {
    const Vec6 xi = strain(rod, q, i);
    shape.k[i] = xi.head<3>();
    shape.u[i] = Vec3::UnitX() + xi.tail<3>();
    const Piece piece(shape, i, rod.section_length(i));
    shape.R[i + 1] = shape.R[i] * piece.exponential.matrix();
    shape.p[i + 1] = shape.p[i] + shape.R[i] * piece.chord();
    for (int c = 0; c < rod.strains(); ++c) {
      const int j = rod.first_coordinate(i) + c;
      Vec3 turn, move;
      piece.end_motion(rod.basis[c], turn, move);
      shape.omega.col(j) = turn;
      shape.v.col(j) = move - turn.cross(shape.p[i + 1] - shape.origin);
    }
  }
  return shape;
}

CurvePoint curve_point(const Configuration& shape, double s) {
  CurvePoint point;
  point.section = shape.rod->section_at(s);
  const Piece piece(shape, point.section, s - shape.rod->ends[point.section]);
  point.position = shape.p[point.section] + piece.R * piece.chord();
  point.R = piece.R * piece.exponential.matrix();
  point.derivative = point.R * piece.u;
  point.second = point.R * piece.k.cross(piece.u);
  return point;
}

Vec3 position(const Configuration& shape, double s, const Vec3& offset) {
  const CurvePoint point = curve_point(shape, s);
  return point.position + point.R * offset;
}

Eigen::Matrix3Xd position_jacobian(const Configuration& shape, double s, const Vec3& offset) {
  const Rod& rod = *shape.rod;
  Eigen::Matrix3Xd J = Eigen::Matrix3Xd::Zero(3, rod.coordinates());
  const int section = rod.section_at(s);
  const Piece piece(shape, section, s - rod.ends[section]);
  const Vec3 arm = piece.R * (piece.exponential * offset);
  const Vec3 x = shape.p[section] + piece.R * piece.chord() + arm - shape.origin;
  const int own = rod.first_coordinate(section);
  for (int j = 0; j < own; ++j) J.col(j) = shape.v.col(j) + shape.omega.col(j).cross(x);
  for (int c = 0; c < rod.strains(); ++c) {
    Vec3 turn, move;
    piece.end_motion(rod.basis[c], turn, move);
    J.col(own + c) = move + turn.cross(arm);
  }
  return J;
}

Eigen::VectorXd tangent_gradient(const Configuration& shape, double s, const Vec3& f) {
  const Rod& rod = *shape.rod;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(rod.coordinates());
  const CurvePoint point = curve_point(shape, s);
  const Piece piece(shape, point.section, s - rod.ends[point.section]);
  const Vec3 couple = point.derivative.cross(f);  // f . (omega x gamma_s) = omega . (gamma_s x f)
  const int own = rod.first_coordinate(point.section);
  gradient.head(own) = shape.omega.leftCols(own).transpose() * couple;
  for (int c = 0; c < rod.strains(); ++c) {
    Vec3 turn, move;
    piece.end_motion(rod.basis[c], turn, move);
    gradient[own + c] = turn.dot(couple);
    if (rod.basis[c] >= 3) gradient[own + c] += f.dot(point.R.col(rod.basis[c] - 3));
  }
  return gradient;
}

void add_loads(const Configuration& shape, std::span<const PointLoad> loads, Eigen::Ref<Eigen::VectorXd> gradient,
               Eigen::Ref<Eigen::MatrixXd> tangent) {
  const Rod& rod = *shape.rod;
  const int m = rod.strains();
  Resultant beyond;  // everything beyond the current section
  std::ptrdiff_t last = static_cast<std::ptrdiff_t>(loads.size()) - 1;
  Eigen::Matrix<double, 6, 6> angular_linear;  // column c: what a twist before the section is multiplied with
  std::vector<Vec3> turn(m), move(m);

  // tangent(i, j) for a coordinate i before the section and j = first + c of it, both triangles.
  const auto couple_to_earlier = [&](int first, int c) {
    for (int i = 0; i < first; ++i) {
      const double value =
          shape.omega.col(i).dot(angular_linear.col(c).head<3>()) + shape.v.col(i).dot(angular_linear.col(c).tail<3>());
      tangent(i, first + c) += value;
      tangent(first + c, i) += value;
    }
  };

  for (int section = rod.sections() - 1; section >= 0; --section) {
    const int first = rod.first_coordinate(section);
    angular_linear.setZero();
    Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();  // over all six strains

    // Points beyond the section: they see it through its far end.
    const Mat3& R0 = shape.R[section];
    const Mat3& R1 = shape.R[section + 1];
    const Piece whole(shape, section, rod.section_length(section));
    const Mat3 S =
        R1.transpose() * (beyond.virial - (shape.p[section + 1] - shape.origin) * beyond.force.transpose()) * R0;
    H += whole.hessian(R0.transpose() * beyond.force, S);
    for (int c = 0; c < m; ++c) {
      const Vec3 w = shape.omega.col(first + c), v = shape.v.col(first + c);
      Vec3 angular, linear;
      gradient[first + c] += beyond.work(w, v);
      beyond.response(w, v, angular, linear);
      angular_linear.col(c).head<3>() += angular;
      angular_linear.col(c).tail<3>() += linear;
      for (int d = 0; d < m; ++d) {  // w J^T J of the section with itself; the force part is in H
        const Vec3 wd = shape.omega.col(first + d), vd = shape.v.col(first + d);
        tangent(first + d, first + c) +=
            wd.dot(beyond.first.cross(v) + beyond.second * w) + vd.dot(beyond.mass * v + w.cross(beyond.first));
      }
    }

    // Points of the section itself.
    for (; last >= 0 && rod.section_at(loads[last].s) == section; --last) {
      const PointLoad& load = loads[last];
      const Piece piece(shape, section, load.s - rod.ends[section]);
      const Vec3 arm = R0 * (piece.exponential * load.offset);
      const Vec3 x = shape.p[section] + R0 * piece.chord() + arm - shape.origin;
      const Vec3 f = R0.transpose() * load.force;
      H += piece.hessian(f, load.offset * f.transpose());
      for (int c = 0; c < m; ++c) {
        piece.end_motion(rod.basis[c], turn[c], move[c]);
        move[c] += turn[c].cross(arm);
        gradient[first + c] += move[c].dot(load.force);
        angular_linear.col(c).head<3>() += move[c].cross(load.force) + load.weight * x.cross(move[c]);
        angular_linear.col(c).tail<3>() += load.weight * move[c];
      }
      for (int c = 0; c < m; ++c) {
        for (int d = 0; d < m; ++d) tangent(first + d, first + c) += load.weight * move[d].dot(move[c]);
      }
      beyond.add(x, load.force, load.weight);
    }

    for (int c = 0; c < m; ++c) {
      for (int d = 0; d < m; ++d) tangent(first + d, first + c) += H(rod.basis[d], rod.basis[c]);
      couple_to_earlier(first, c);
    }
  }

  // The base's own coordinates.
  for (int c = 0; c < rod.base_coordinates(); ++c) {
    const Vec3 w = shape.omega.col(c), v = shape.v.col(c);
    Vec3 angular, linear;
    gradient[c] += beyond.work(w, v);
    beyond.response(w, v, angular, linear);
    for (int d = 0; d < rod.base_coordinates(); ++d) {
      tangent(d, c) += shape.omega.col(d).dot(angular) + shape.v.col(d).dot(linear);
    }
  }
}

}  // namespace sinew::rod
