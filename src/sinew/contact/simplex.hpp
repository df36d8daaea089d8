// Pairs of points, segments, triangles and planes: how near they come, and along which normal.
#pragma once

#include <Eigen/Core>
#include <array>

namespace sinew::contact {

using Vec3 = Eigen::Vector3d;

/// What touches: a point, a segment or a triangle with a thickness around it, or a half-space below a plane through one
/// point. Triangles know their outside, by the order of their corners.
struct Simplex {
  enum class Kind { point, segment, triangle, plane };
  Kind kind = Kind::point;
  std::array<Vec3, 3> x;  ///< [m] as many as the kind has: 1, 2, 3, 1
  /// Out of a half-space; of a segment what stands for it where the two cross; of a triangle what stands for it past
  /// its rim, where it is that of a surface (zero: the triangle's own).
  Vec3 normal = Vec3::Zero();
  double radius = 0.0;  ///< [m]
  /// Not zero: of a point, which is then the middle of a circle across this vector, as long as the circle's radius [m].
  /// Its lowest point over a plane is meant, whichever that is as the circle turns.
  Vec3 rim = Vec3::Zero();
  /// Of a circle: from its middle to where it was lowest when it was found, of length 1. What lies flat, but for
  /// kFlatRim, has its lowest point there: where rounding tips it would make that jump about.
  Vec3 low = Vec3::Zero();
  /// Of a triangle in a valley of its surface, from the face across its edge from corner `valley` to the next: in front
  /// of that edge its plane goes on past it, below that face. -1 of all others.
  int valley = -1;
  int corners() const { return kind == Kind::triangle ? 3 : kind == Kind::segment ? 2 : 1; }
};

Simplex point_at(const Vec3& x, double radius);
/// `outward` may be zero where it is not known.
Simplex segment_at(const Vec3& from, const Vec3& to, const Vec3& outward, double radius);
Simplex plane_at(const Vec3& x, const Vec3& normal);
/// A circle around `axis` (of length 1), which meets planes alone.
Simplex circle_at(const Vec3& middle, const Vec3& axis, double radius, const Vec3& low);
/// Sine of the tilt below which a circle lies flat on a plane.
inline constexpr double kFlatRim = 1e-5;

/// From the middle of a circle to its lowest point over a plane with this normal; zero of what is none.
Vec3 lowest_on_rim(const Simplex& own, const Vec3& normal);

/// The points of two simplices that are nearest to each other, as weights of their corners, and the normal from b to a.
struct Nearest {
  std::array<double, 3> a{}, b{};
  Vec3 normal = Vec3::Zero();
  double gap = 0.0;  ///< [m] between their surfaces, negative where they overlap
};

/// Of a point and any other, or two segments; others are refused with std::invalid_argument. Above and below a triangle
/// the normal is its own, so that it does not turn where the point passes through. The gap's derivative along any
/// motion of the corners is normal . (sum of a dx_a - sum of b dx_b).
Nearest nearest(const Simplex& a, const Simplex& b);

/// Whether p is over a triangle that stands in a valley, or in front of the valley's edge.
bool over_face(const Simplex& b, const Vec3& p);

/// How two simplices face each other, chosen once and kept while they move a little, so that the normal is smooth: by
/// the face of b, across both edges, along the line between their nearest points (thick ones, which stay apart, also
/// from a face), or along a fixed direction (thin ones beside a face or past an end, where that line turns about as
/// they touch).
struct Facing {
  enum class Kind { face, crossing, apart, fixed };
  Kind kind = Kind::fixed;
  Vec3 normal = Vec3::Zero();
  /// Of `apart`: they did not cross when this was chosen. They can come to cross through the triangle itself only:
  /// a point that passes the plane beyond the rim keeps a positive distance.
  bool outside = false;
};
Facing facing(const Simplex& a, const Simplex& b);
Nearest nearest(const Simplex& a, const Simplex& b, const Facing& kept);

/// Second derivative of the gap over the corners of a and then of b, three coordinates each [1/m].
using GapHessian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 18, 18>;

/// With y = sum c_i x_i = d n from the nearest point of b to that of a (c_i: weights, negative of b), e_k = dy/ds_k for
/// each parameter s_k by which one of the two points may slide along its edge or face, C_ik = dc_i/ds_k,
/// G_kl = e_k . e_l and P = 1 - n n^T, differentiating the gap's gradient c_i n and the conditions e_k . y = 0 gives
///     H_ij = c_i c_j (P - e G^-1 e^T) / d - c_i (e G^-1 C_j) n^T - n (e G^-1 C_i)^T c_j - d (C_i G^-1 C_j) n n^T.
/// Zero where the normal is fixed, and of a plane.
GapHessian gap_hessian(const Simplex& a, const Simplex& b, const Nearest& found, const Facing& kept);

/// Weights of the corners at the point of a segment or triangle that is nearest to p.
std::array<double, 2> on_segment(const Vec3& p, const Vec3& x, const Vec3& y);
std::array<double, 3> on_triangle(const Vec3& p, const Vec3& x, const Vec3& y, const Vec3& z);

}  // namespace sinew::contact
