// What may touch something, where it is at the start of a step: surfaces of triangles, and points of rods.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sinew/sim/contact_places.hpp"

namespace sinew {

/// The surface of a solid, or of a rigid mesh, in the world: its points, directions out of it, and boxes around
/// triangles and ridges.
struct Surface {
  const contact::Mesh* mesh = nullptr;  ///< null of what has none, or touches nothing
  std::optional<contact::Pose> pose;    ///< of what is rigid, when it was fitted
  Eigen::Matrix3Xd x;
  contact::Outward outward;
  contact::Tree faces, edges;
  std::vector<contact::Box> boxes;
};

/// Of all obstacles, bodies, solids and rods.
class Surfaces {
 public:
  /// Fits those that are in a pair to where they are.
  void fit(const Moment& now);
  /// Null of what has none.
  const Surface* of(const Collider& own) const;
  /// Where a rod is at the abscissae by which it touches, 3 x n [m].
  const Eigen::Matrix3Xd& points_of_rod(int number) const { return rods_[static_cast<std::size_t>(number)]; }

 private:
  void fit(const Collider& own, const Moment& now);
  std::array<std::vector<Surface>, 3> of_kind_;
  std::vector<Eigen::Matrix3Xd> rods_;
};

/// Distance [m] from a point to the nearest of the triangles whose boxes are within `far` of it; infinite if none is.
/// Beyond `far` others may be nearer.
double distance_to_triangles(const Surface& surface, const Vec3& point, double far);

/// How deep a point is in a surface, with its thickness [m]; 0 outside. From outside only what is within `near` of it
/// counts.
double depth_in(const Surface& surface, const contact::Simplex& point, double near);

/// How deep a segment is in a surface in the middle between the triangles that it passes through and, where it is thin,
/// its ends [m]; 0 where it stays outside.
double depth_of_line(const Surface& surface, const contact::Simplex& line, double near);

/// Distance [m] between a segment and a triangle; 0 where it passes through it.
double distance_to_line(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& triangle);

double longest_edge(const contact::Simplex& face);

/// Whether a point and a triangle of the same surface are neighbours.
bool near_at_rest(const contact::Mesh& mesh, int node, const std::array<int, 3>& face);

/// The largest cosine between d, of length 1, and an edge that leaves a point of a surface: how much the surface goes
/// on from there towards d.
double steepest_edge(const Surface& surface, int point, const Vec3& d);

/// contact::grazed_plane of a surface, to whose triangle p is nearest: of the planes across its ridges.
Vec3 grazed_plane(const Surface& surface, int triangle, const Vec3& p, const Vec3& outward);

/// Between the normals of the two triangles beside a ridge; none where they lie in one plane, but for 10 degrees, or in
/// a valley: points meet these.
std::optional<Vec3> outward_of_ridge(const Surface& surface, const contact::Ridge& ridge);

}  // namespace sinew
