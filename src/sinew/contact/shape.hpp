// Shapes of rigid bodies and obstacles, in their own axes: what a point near one touches, volume and inertia.
#pragma once

#include <variant>
#include <vector>

#include "sinew/contact/mesh.hpp"
#include "sinew/contact/polyhedron.hpp"
#include "sinew/contact/simplex.hpp"

namespace sinew::contact {

/// The half-space z < 0. Of obstacles only.
struct HalfSpace {};

struct Ball {
  double radius = 0.0;  ///< [m] > 0
};

/// All within `radius` of a segment on z with its middle at the origin.
struct Capsule {
  double radius = 0.0;  ///< [m] > 0
  double length = 0.0;  ///< [m] of the segment, >= 0
};

/// About z, its middle at the origin.
struct Cylinder {
  double radius = 0.0, length = 0.0;  ///< [m] > 0
};

/// The prism that stands for a cylinder where flat parts meet it, with as much volume.
constexpr int kPrismSides = 48;
Polyhedron prism(const Cylinder& cylinder);

/// How far the edges of its prism stand out of a cylinder at most [1, of its radius]: as their volumes are the same,
/// sqrt(x / sin x) - 1 = 0.00143 with x = 2 pi / kPrismSides.
constexpr double kPrismStandsOut = 1.5e-3;

/// A box or a hull.
struct Convex {
  Polyhedron surface;
};

/// A mesh is any closed surface, and met as surfaces that deform are, part by part (sim/contact_search).
using Shape = std::variant<HalfSpace, Ball, Capsule, Cylinder, Convex, Mesh>;

/// The part of a shape's surface that is nearest to p: a point, a segment or the plane of a face, with its thickness.
/// Inside a polyhedron, or a cylinder near its ends, it is the face that is soonest reached; of faces that are equally
/// near, but for a thousandth of the size, the one that looks most against `outward`, the outside of what p belongs to
/// (zero where that is not known). Throws std::invalid_argument for a mesh.
Simplex nearest_part(const Shape& shape, const Vec3& p, const Vec3& outward = Vec3::Zero());
/// Part of the size within which what lies in a plane is in it.
inline constexpr double kSamePlane = 1e-6;
/// Cosine of the angle to its outside below which a face looks against a point.
inline constexpr double kAgainst = -0.2;

/// The normal of a face in whose plane p lies beside it, but for rounding, and so does where p is nearest to `part`; of
/// a face that looks against `outward`, the outside of what p belongs to. Zero where there is none. What slides in that
/// plane does not stop at the rim of the face.
Vec3 grazed_plane(const Shape& shape, const Vec3& p, const Simplex& part, const Vec3& outward);

/// An edge of a polyhedron; its normal is between those of its two faces.
Simplex edge_of(const Polyhedron& own, std::size_t edge);

/// The points and segments by which a shape presses into a surface of triangles: corners, edges, and the middle or the
/// axis of what is round, with its radius; a cylinder's rims as those of a prism of 48 sides. The normal of a corner is
/// between those of its faces. Of a mesh none.
std::vector<Simplex> prongs(const Shape& shape);

/// Half the edges of the smallest box about the origin that holds it in the directions of `axes` (columns); infinite
/// where it is.
Vec3 reach(const Shape& shape, const Eigen::Matrix3d& axes);

/// Its surface as triangles, counter-clockwise seen from outside; round ones by facets, of a half-space a square with
/// edges of `size` [m].
struct Skin {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
};
Skin skin(const Shape& shape, double size);

struct Bulk {
  double volume = 0.0;                                    ///< [m^3]
  Vec3 centre = Vec3::Zero();                             ///< [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();  ///< [m^5] about it, of unit density
};
/// Of a surface the volume is negative where it is inside out. Throws std::invalid_argument for a half-space.
Bulk bulk(const Shape& shape);

}  // namespace sinew::contact
