// Where the material points of a rod are, and how they move when its coordinates change: (2), (3), (4) and (5).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sinew/lie/rotation.hpp"
#include "sinew/linalg/chain.hpp"
#include "sinew/rod/crossings.hpp"
#include "sinew/rod/rod.hpp"

namespace sinew::rod {

using linalg::Matrix6X;
/// Twists of the coordinates of one section: 6 x m.
using SectionTwists = linalg::Columns<Eigen::Dynamic>;
static_assert(linalg::kLargest == 6 * (kHighestDegree + 1));

/// One exponential: the frame (R, p) times exp(phi, rho).
struct Piece {
  Piece() = default;  ///< nothing yet
  Piece(const Mat3& frame, const Vec3& start, const Vec6& W)
      : R(frame), p(start), phi(W.head<3>()), rho(W.tail<3>()), maps(lie::RotationMap::both(phi)) {
    tip = p + R * (tangent() * rho);
  }
  const lie::RotationMap& exponential() const { return maps[0]; }
  const lie::RotationMap& tangent() const { return maps[1]; }
  Mat3 end_frame() const { return R * exponential().matrix(); }
  const Vec3& end() const { return tip; }

  Mat3 R;
  Vec3 p;
  Vec3 phi, rho;
  std::array<lie::RotationMap, 2> maps;
  Vec3 tip;
};

/// The few exponentials of one step.
class Pieces {
 public:
  void clear() { count_ = 0; }
  const Piece& emplace_back(const Mat3& frame, const Vec3& start, const Vec6& W) {
    return all_[count_++] = Piece(frame, start, W);
  }
  std::size_t size() const { return count_; }
  const Piece& operator[](std::size_t j) const { return all_[j]; }
  operator std::span<const Piece>() const { return {all_.data(), count_}; }

 private:
  std::array<Piece, kExponentials> all_;
  std::size_t count_ = 0;
};

/// The base of a rod: its placement at rest in the world, and how far it has been turned since (free bases only).
struct Base {
  Placement rest;
  Mat3 turned = Mat3::Identity();
};

/// A rod in space. Everything below reads it. A twist (omega, v) moves what lies beyond: x' = v + omega x (x - origin).
struct Configuration {
  const Rod* rod = nullptr;
  Base from;
  Eigen::VectorXd q;
  Vec3 origin = Vec3::Zero();         ///< the base at rest: keeps lever arms short wherever the scene stands
  std::vector<Mat3> R;                ///< N + 1 frames at the section ends
  std::vector<Vec3> p;                ///< N + 1 positions [m]
  std::vector<Coefficients> strains;  ///< N Legendre coefficients, 1 added to the elongation: hat(xi) as it is
  std::vector<int> first_step;        ///< of each section, N + 1
  struct StepStart {
    Mat3 R;
    Vec3 p;
    SectionTwists before;  ///< twists that the coordinates of the section give to this frame
    int piece;             ///< first of its exponentials
  };
  std::vector<StepStart> steps;
  std::vector<Piece> pieces;
  Matrix6X base;    ///< twists of the base's coordinates
  Matrix6X twists;  ///< of the strain coordinates, as felt beyond their section
};

/// The frame of the first cross-section; and the twists of the base's coordinates, where they are asked for.
Placement first_frame(const Rod& rod, const Base& base, const Eigen::VectorXd& q, Matrix6X* twists = nullptr);

/// (3), (4) from the base's placement and q.
Configuration configure(const Rod& rod, const Base& base, const Eigen::VectorXd& q);
/// The same in the memory of an earlier one.
void configure(const Rod& rod, const Base& base, const Eigen::VectorXd& q, Configuration& shape);
Configuration configure(const Rod& rod, const Placement& base, const Eigen::VectorXd& q);
/// The same, but where the shape is that already. The rod must not have changed.
void reconfigure(const Rod& rod, const Base& base, const Eigen::VectorXd& q, Configuration& shape);

/// The exponentials from the start of a step to an abscissa in it, and how they change with it.
struct Branch {
  int section = 0, step = 0;  ///< step: in Configuration::steps
  PartialWeights weights;
  Pieces pieces;
  Mat3 R;
  Vec3 p;
};
Branch branch(const Configuration& shape, double s);
/// The same in a step of section i that is known already, as in Branch; `branch` is written over.
void branch_in(const Configuration& shape, int i, int step, double s, Branch& branch);
/// To a station, by its own weights; their derivatives are left alone.
void branch_to(const Configuration& shape, const Station& station, Branch& branch);

/// A point on the centreline.
struct CentrePoint {
  int section = 0;
  Vec3 position;    ///< gamma(s)
  Mat3 R;           ///< frame of the cross-section
  Vec3 derivative;  ///< gamma_s
  Vec3 second;      ///< gamma_ss, to the accuracy of the strains
};
CentrePoint centre_point(const Configuration& shape, double s);

/// The same, and how it moves.
struct CurvePoint : CentrePoint {
  SectionTwists twists;  ///< of the coordinates of its own section, as felt at the point
};
CurvePoint curve_point(const Configuration& shape, double s);

/// Position of the material point at abscissa s, offset in the cross-section's frame.
Vec3 position(const Configuration& shape, double s, const Vec3& offset = Vec3::Zero());

/// The longest exponential [m] of constant strains that can be made together with others (rod/crossings); 0 where the
/// strains vary.
double longest_exponential(const Coefficients& strains);

/// Where the mass points are, 3 x count [m].
Eigen::Matrix3Xd mass_positions(const Configuration& shape);
void mass_positions(const Configuration& shape, Eigen::Matrix3Xd& positions);

/// Twist of every coordinate as felt at abscissa s, 6 x n; zero beyond it.
Matrix6X twists_at(const Configuration& shape, double s);

/// (5): 3 x n derivative of position() with respect to q.
Eigen::Matrix3Xd position_jacobian(const Configuration& shape, double s, const Vec3& offset = Vec3::Zero());

/// Velocity of a point at x (from the origin) under a twist.
inline Vec3 moved(const Vec6& twist, const Vec3& x) { return twist.tail<3>() + twist.head<3>().cross(x); }

/// Twists of the six numbers W of a piece, 6 x 6, about the origin.
Mat6 piece_twists(const Piece& piece, const Vec3& origin);

}  // namespace sinew::rod
