// Which parts of two rigid shapes are near each other.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/contact/shape.hpp"

namespace sinew::contact {

/// x -> R x + p.
struct Pose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Vec3 p = Vec3::Zero();
  Vec3 operator*(const Vec3& x) const { return R * x + p; }
};

/// A part of a shape, from the shape's axes to where the shape is.
Simplex moved(const Pose& pose, Simplex own);

/// A part of each of two shapes, each in its own axes. `key` tells the parts from others of the same two shapes.
struct Meeting {
  Simplex a, b;
  std::uint64_t key = 0;
  bool swapped = false;  ///< a is of the second shape, b of the first
  /// In the world, of length 1: normal of a face in whose plane two polyhedra lie beside each other, and this meeting
  /// with it; zero where there is none.
  Vec3 grazed = Vec3::Zero();
};

/// Adds all that may touch where the shapes come nearer than `alarm` [m]. Two polyhedra meet along the axis that
/// separates them most: as corners of one clipped to a face of the other, or as two edges. Cylinders count as prisms
/// of 48 sides there, and are round to all else. Throws std::invalid_argument for a mesh, which is met part by part
/// (sim/contact_search).
void meet(const Shape& first, const Pose& at, const Shape& second, const Pose& there, double alarm,
          std::vector<Meeting>& found);

}  // namespace sinew::contact
