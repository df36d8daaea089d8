// What lies beyond a section, as a section sees it: sums over loads and the two matrices that follow from them.
#pragma once

#include "sinew/rod/crossings.hpp"
#include "sinew/rod/forces.hpp"

namespace sinew::rod {

/// Loads on what lies beyond, summed about the origin: what any number of them does is told by these few sums.
class Beyond {
 public:
  void add(const Vec3& x, const PointLoad& load) {
    const Vec3 moment = x.cross(load.force) + load.moment;
    wrench_.head<3>() += moment;
    wrench_.tail<3>() += load.force;
    const Vec3 weighted = load.weight * x;
    weight_ += load.weight;
    lever_ += weighted;
    if (load.follower) {
      second_ += x * weighted.transpose();
      carried_.head<3>() += moment;
      carried_.tail<3>() += load.force;
    } else {
      second_ += x * (weighted - load.force).transpose();
      moment_ += load.moment;
    }
    if (load.stiffness) {
      Mat6 J = Mat6::Identity();  // how x turns and moves, by a twist
      J.bottomLeftCorner<3, 3>() = -lie::hat(x);
      add_springs(J.transpose() * *load.stiffness * J);
    }
  }
  /// Sums over a station's points x = Q o: of w x, of x b^T, whose skew part is that of -x x f, and of w x x^T.
  void add(const Mat3& Q, const StationInertia& own, bool bends) {
    const Vec3 lever = Q * own.weight.col(0);
    const Mat3 pulled = Q * own.pull.transpose();
    weight_ += own.weight(0, 0);
    lever_ += lever;
    const Vec3 force = lever - own.pull.col(0);
    const Vec3 moment(pulled(2, 1) - pulled(1, 2), pulled(0, 2) - pulled(2, 0), pulled(1, 0) - pulled(0, 1));
    wrench_.head<3>() += moment;
    wrench_.tail<3>() += force;
    if (bends) {
      second_ += pulled;
      return;
    }
    second_ += Q * own.weight * Q.transpose();
    outside_.head<3>() += moment;
    outside_.tail<3>() += force;
  }
  void add(const Beyond& other) {
    if (other.sprung_) add_springs(other.springs_);
    wrench_ += other.wrench_;
    weight_ += other.weight_;
    lever_ += other.lever_;
    second_ += other.second_;
    carried_ += other.carried_;
    outside_ += other.outside_;
    moment_ += other.moment_;
  }

  /// Moment, force.
  const Vec6& wrench() const { return wrench_; }
  /// The part of it that takes part in the tangent.
  Vec6 bending() const { return wrench_ - outside_; }

  /// Of coordinates j nearer to the base and k, the second derivatives are T_j^T K T_k and (U T_k)^T T_j; for loads
  /// with a potential U = K. Weights answer the acceleration v + omega x X; a force that stays is moved by it; a wrench
  /// that is carried along does not change with what comes later, and a moment that stays has a later axis turn under
  /// it.
  Mat6 K() const { return sprung(assembled(Vec3(carried_.head<3>()), bending().tail<3>(), carried_.tail<3>())); }
  Mat6 U() const { return sprung(assembled(moment_, bending().tail<3>() - carried_.tail<3>(), Vec3::Zero())); }

  /// Lanes hold no springs, and neither followers nor moments: those have an unsymmetric tangent, and no lanes.
  bool sprung() const { return sprung_; }
  void put(int lane, LoadLanes& lanes) const {
    const Vec6 own = bending();
    for (int i = 0; i < 3; ++i) {
      lanes.moment[i][lane] = wrench_[i];
      lanes.force[i][lane] = wrench_[3 + i];
      lanes.bending_moment[i][lane] = own[i];
      lanes.bending_force[i][lane] = own[3 + i];
      lanes.lever[i][lane] = lever_[i];
      for (int j = 0; j < 3; ++j) lanes.second[j][i][lane] = second_(i, j);
    }
    lanes.weight[lane] = weight_;
  }
  void add(const LoadLanes& lanes, int lane) {
    for (int i = 0; i < 3; ++i) {
      wrench_[i] += lanes.moment[i][lane];
      wrench_[3 + i] += lanes.force[i][lane];
      outside_[i] += lanes.moment[i][lane] - lanes.bending_moment[i][lane];
      outside_[3 + i] += lanes.force[i][lane] - lanes.bending_force[i][lane];
      lever_[i] += lanes.lever[i][lane];
      for (int j = 0; j < 3; ++j) second_(i, j) += lanes.second[j][i][lane];
    }
    weight_ += lanes.weight[lane];
  }

 private:
  void add_springs(const Mat6& more) {
    if (sprung_) {
      springs_ += more;
    } else {
      springs_ = more;
    }
    sprung_ = true;
  }
  Mat6 sprung(Mat6 K) const {
    if (sprung_) K += springs_;
    return K;
  }
  Mat6 assembled(const Vec3& moment, const Vec3& moved, const Vec3& carried) const {
    Mat6 K;
    K.topLeftCorner<3, 3>() = -second_ - lie::hat(moment);
    K.topLeftCorner<3, 3>().diagonal().array() += second_.trace();
    K.topRightCorner<3, 3>() = lie::hat(lever_ - moved);
    K.bottomLeftCorner<3, 3>() = -lie::hat(lever_ + carried);
    K.bottomRightCorner<3, 3>() = weight_ * Mat3::Identity();
    return K;
  }

  Vec6 wrench_ = Vec6::Zero();
  double weight_ = 0.0;          ///< sum w
  Vec3 lever_ = Vec3::Zero();    ///< sum w x
  Mat3 second_ = Mat3::Zero();   ///< sum x (w x - f)^T, f the forces that stay
  Vec6 carried_ = Vec6::Zero();  ///< the wrench of followers
  Vec6 outside_ = Vec6::Zero();  ///< the wrench of stations that stay out of the tangent
  Vec3 moment_ = Vec3::Zero();   ///< sum of the moments that stay
  bool sprung_ = false;
  Mat6 springs_;  ///< sum of stiffnesses, by twists; only if there are any
};

}  // namespace sinew::rod
