// A clamped Cosserat rod under a dead tip force, solved without the engine: the balance of moments integrated from the
// base by Runge-Kutta, and its three unknowns there by shooting. Accurate to about 1e-12.
#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "validation/rods.hpp"

namespace sinew::test {

struct ShotTip {
  Vec3 p;
  rod::Mat3 R;
};

namespace shooting {

/// R is followed as nine numbers; m is the internal moment in the world.
struct Along {
  Vec3 p = Vec3::Zero();
  rod::Mat3 R = rod::Mat3::Identity();
  Vec3 m = Vec3::Zero();
};

inline Along slope(const Along& at, const Vec3& force, const Stiffness& stiffness, bool extensible) {
  const Vec3 m = at.R.transpose() * at.m, n = at.R.transpose() * force;
  Vec3 kappa, u = Vec3::UnitX();
  for (int i = 0; i < 3; ++i) {
    kappa[i] = m[i] / stiffness[static_cast<std::size_t>(i)];
    if (extensible) u[i] += n[i] / stiffness[static_cast<std::size_t>(i + 3)];
  }
  Along d;
  d.p = at.R * u;
  d.R.col(0) = at.R * kappa.cross(Vec3(Vec3::UnitX()));
  d.R.col(1) = at.R * kappa.cross(Vec3(Vec3::UnitY()));
  d.R.col(2) = at.R * kappa.cross(Vec3(Vec3::UnitZ()));
  d.m = force.cross(d.p);  // m' = -p' x n
  return d;
}

inline Along shoot(double length, const Vec3& force, const Stiffness& stiffness, bool extensible, const Vec3& moment) {
  constexpr int kSteps = 3000;
  const double h = length / kSteps;
  Along at;
  at.m = moment;
  const auto ahead = [](const Along& a, const Along& d, double step) {
    return Along{a.p + step * d.p, a.R + step * d.R, a.m + step * d.m};
  };
  for (int i = 0; i < kSteps; ++i) {
    const Along k1 = slope(at, force, stiffness, extensible);
    const Along k2 = slope(ahead(at, k1, h / 2), force, stiffness, extensible);
    const Along k3 = slope(ahead(at, k2, h / 2), force, stiffness, extensible);
    const Along k4 = slope(ahead(at, k3, h), force, stiffness, extensible);
    at.p += h / 6 * (k1.p + 2 * k2.p + 2 * k3.p + k4.p);
    at.R += h / 6 * (k1.R + 2 * k2.R + 2 * k3.R + k4.R);
    at.m += h / 6 * (k1.m + 2 * k2.m + 2 * k3.m + k4.m);
  }
  return at;
}

}  // namespace shooting

/// The rod lies along x and its cross-section's axes are the world's at the base.
inline ShotTip shoot_cantilever(double length, const Vec3& force, const Stiffness& stiffness, bool extensible) {
  Vec3 moment = Vec3::Zero();  // at the base
  constexpr int kGrowth = 10;
  for (int part = 1; part <= kGrowth; ++part) {
    const Vec3 now = force * part / kGrowth;
    for (int iteration = 0; iteration < 12; ++iteration) {
      const Vec3 left = shooting::shoot(length, now, stiffness, extensible, moment).m;
      rod::Mat3 J;
      const double scale = 1e-6 * (force.norm() * length);
      for (int i = 0; i < 3; ++i) {
        const Vec3 d = scale * Vec3::Unit(i);
        J.col(i) = (shooting::shoot(length, now, stiffness, extensible, moment + d).m -
                    shooting::shoot(length, now, stiffness, extensible, moment - d).m) /
                   (2.0 * scale);
      }
      const Vec3 dm = J.lu().solve(left);
      moment -= dm;
      if (dm.norm() < (part < kGrowth ? 1e-6 : 1e-14) * force.norm() * length) break;
    }
  }
  const shooting::Along end = shooting::shoot(length, force, stiffness, extensible, moment);
  return {end.p, end.R};
}

}  // namespace sinew::test
