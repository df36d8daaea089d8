#include "sinew/rigid/body.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "sinew/lie/rotation.hpp"

namespace sinew::rigid {

void set_velocities(const Motion& start, double rate, Motion& end) {
  end.v = (end.p - start.p) * rate;
  end.w = lie::log(start.R.transpose() * end.R) * rate;
}

void move_on(const Motion& start, double time, Motion& end) {
  end.p = start.p + time * start.v;
  end.R = start.R * lie::exp(time * start.w);
}

Equations equations(const Body& body, const Motion& start, const Motion& end, double rate, const Vec3& gravity) {
  Motion now = end;
  set_velocities(start, rate, now);
  const Mat3& I = body.inertia;
  const Vec3 torque = (I * (now.w - start.w)) * rate + now.w.cross(I * now.w);
  Equations own;
  own.r << body.mass * ((now.v - start.v) * rate - gravity), now.R * torque;
  own.tangent.setZero();
  own.tangent.topLeftCorner<3, 3>() = body.mass * rate * rate * Mat3::Identity();
  if (rate == 0.0) return own;
  // R_0^T exp(d) R_0 exp(f) = exp(f + V(f)^-1 R_0^T d + ..) with f = w / rate: dw = rate V^-1 R_0^T d.
  const Mat3 V = lie::RotationMap::tangent(now.w / rate).matrix();
  const Mat3 by_w = I * rate + lie::hat(now.w) * I - lie::hat(I * now.w);
  const Mat3 by_turn = now.R * by_w * (rate * V.inverse()) * start.R.transpose() - lie::hat(now.R * torque);
  own.tangent.bottomRightCorner<3, 3>() = 0.5 * (by_turn + by_turn.transpose());
  return own;
}

double kinetic_energy(const Body& body, const Motion& motion) {
  return 0.5 * (body.mass * motion.v.squaredNorm() + motion.w.dot(body.inertia * motion.w));
}

}  // namespace sinew::rigid
