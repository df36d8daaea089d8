#include "sinew/rod/dynamics.hpp"

#include <Eigen/Dense>

namespace sinew::rod {

namespace {

/// Rigid motion of a frame, and what its acceleration is while q'' = 0; linear parts are those of its origin p.
struct Motion {
  Vec3 omega = Vec3::Zero(), v = Vec3::Zero();
  Vec3 alpha = Vec3::Zero(), a = Vec3::Zero();

  /// Of the frame beyond an exponential whose six numbers change at the constant rate dW.
  Motion beyond(const Piece& piece, const Vec6& dW) const {
    const Vec3 dphi = dW.head<3>(), drho = dW.tail<3>();
    const lie::RotationMap& V = piece.tangent();
    const Vec3 arm = piece.R * (V * piece.rho);
    const Vec3 turn = piece.R * (V * dphi), turning = piece.R * (V.gradient(dphi) * dphi);
    const Vec3 move = piece.R * (V.gradient(piece.rho) * dphi + V * drho);
    Vec3 moving = 2.0 * V.gradient(drho) * dphi;
    for (int i = 0; i < 3; ++i) moving[i] += dphi.dot(V.hessian(piece.rho * Vec3::Unit(i).transpose()) * dphi);
    Motion next;
    next.omega = omega + turn;
    next.v = v + omega.cross(arm) + move;
    next.alpha = alpha + omega.cross(turn) + turning;
    next.a = a + alpha.cross(arm) + omega.cross(Vec3(omega.cross(arm) + 2.0 * move)) + piece.R * moving;
    return next;
  }
  Vec3 acceleration(const Vec3& arm) const { return a + alpha.cross(arm) + omega.cross(Vec3(omega.cross(arm))); }
  Vec3 velocity(const Vec3& arm) const { return v + omega.cross(arm); }
};

/// Rates of the Legendre coefficients of a section's strains.
Coefficients rates(const Section& section, const Eigen::Ref<const Eigen::VectorXd>& velocity, Eigen::Index columns) {
  Coefficients rates = Coefficients::Zero(6, columns);
  for (std::size_t c = 0; c < section.modes.size(); ++c)
    rates(section.modes[c].strain, section.modes[c].degree) += velocity[static_cast<Eigen::Index>(c)];
  return rates;
}

Motion base_motion(const Configuration& shape, const Eigen::VectorXd& velocity) {
  Motion motion;
  const Rod& rod = *shape.rod;
  for (int i = 0; i < rod.base_coordinates(); ++i) {  // one after another, each about an axis the earlier ones turn
    const Vec3 axis = rod.base[i].turns ? shape.base.col(i).head<3>() : shape.base.col(i).tail<3>();
    if (rod.base[i].turns) {
      motion.alpha += velocity[i] * motion.omega.cross(axis);
      motion.omega += velocity[i] * axis;
    } else {
      motion.v += velocity[i] * axis;
    }
  }
  return motion;
}

/// Calls visit(mass point, its position, velocity and acceleration while q'' = 0).
template <class Visit>
void each_mass(const Configuration& shape, const Eigen::VectorXd& velocity, const Visit& visit) {
  const Rod& rod = *shape.rod;
  Motion motion = base_motion(shape, velocity);
  std::size_t next = 0;
  for (int i = 0; i < rod.count(); ++i) {
    const Section& section = rod.sections[i];
    const Coefficients Z = rates(section, rod.of_section(velocity, i), shape.strains[i].cols());
    for (int k = shape.first_step[i]; k < shape.first_step[i + 1]; ++k) {
      const Step& step = section.steps[static_cast<std::size_t>(k - shape.first_step[i])];
      const bool last = i + 1 == rod.count() && k + 1 == shape.first_step[i + 1];
      while (next < rod.masses.size() && (rod.masses[next].s < step.end || last)) {
        const double s = rod.masses[next].s;
        const Branch own = branch(shape, s);
        Motion here = motion;
        for (std::size_t j = 0; j < own.pieces.size(); ++j)
          here = here.beyond(own.pieces[j],
                             Z * own.weights.value.row(static_cast<Eigen::Index>(j)).head(Z.cols()).transpose());
        for (; next < rod.masses.size() && rod.masses[next].s == s; ++next) {
          const Vec3 arm = own.R * rod.masses[next].offset;
          visit(rod.masses[next], here.velocity(arm), here.acceleration(arm));
        }
      }
      for (Eigen::Index j = 0; j < step.weights.rows(); ++j) {
        const Piece& piece = shape.pieces[static_cast<std::size_t>(shape.steps[k].piece) + static_cast<std::size_t>(j)];
        motion = motion.beyond(piece, Z * step.weights.row(j).head(Z.cols()).transpose());
      }
    }
  }
}

}  // namespace

Equations mass_matrix(const Configuration& shape) {
  std::vector<PointLoad> loads;
  for (const MassPoint& mass : shape.rod->masses) loads.push_back({mass.s, mass.offset, Vec3::Zero(), mass.mass});
  Equations equations = make_equations(shape, true);
  add_loads(shape, loads, equations);
  return equations;
}

Eigen::VectorXd coriolis_forces(const Configuration& shape, const Eigen::VectorXd& velocity) {
  std::vector<PointLoad> loads;
  each_mass(shape, velocity, [&](const MassPoint& mass, const Vec3&, const Vec3& acceleration) {
    loads.push_back({mass.s, mass.offset, mass.mass * acceleration});
  });
  Equations equations = make_equations(shape, true);
  add_loads(shape, loads, equations);
  return equations.r;
}

Eigen::MatrixXd coriolis_matrix(const Configuration& shape, const Eigen::VectorXd& velocity) {
  const int n = shape.rod->coordinates();
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
  for (const MassPoint& mass : shape.rod->masses) {
    const Eigen::Matrix3Xd J = position_jacobian(shape, mass.s, mass.offset);
    Eigen::Matrix3Xd dJ(3, n);  // row i: velocity^T d2 X_i / dq2
    for (int i = 0; i < 3; ++i) {
      const std::vector<PointLoad> unit = {{mass.s, mass.offset, Vec3::Unit(i)}};
      Equations equations = make_equations(shape, true);
      add_loads(shape, unit, equations);
      dJ.row(i) = velocity.transpose() * dense_tangent(shape, equations);
    }
    C += mass.mass * J.transpose() * dJ;
  }
  return C;
}

double kinetic_energy(const Configuration& shape, const Eigen::VectorXd& velocity) {
  double energy = 0.0;
  each_mass(shape, velocity,
            [&](const MassPoint& mass, const Vec3& v, const Vec3&) { energy += 0.5 * mass.mass * v.squaredNorm(); });
  return energy;
}

}  // namespace sinew::rod
