// One still picture of a state that a person understands: what it looks like, how far it has moved, how large it is.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "sinew/io/picture_view.hpp"
#include "sinew/sim/snapshot.hpp"

namespace sinew::io {

enum class PictureColor { displacement, von_mises };

/// A point of a cloud, coloured by a value.
struct CloudPoint {
  Eigen::Vector3d at;
  double value = 0.0;
};

/// Where an output was over a run, and where it was to be.
struct Course {
  std::string name;
  Eigen::Matrix3Xd way;     ///< [m]
  Eigen::Matrix3Xd wanted;  ///< [m] the last is the target; empty without one
  double off = 0.0;         ///< [m] how far the output is off its target, in what counts
};

struct PictureOptions {
  std::string title;
  std::string outcome = {};          ///< behind the status: what came of the targets
  int warnings = 0;                  ///< behind the status, whose dot is then not green
  std::vector<Course> courses = {};  ///< of outputs that are more than their ends
  /// Drawn over the picture, with a legend of their own in place of that of displacements.
  std::vector<CloudPoint> cloud = {};
  std::string cloud_name = {}, cloud_unit = {};
  PictureColor color = PictureColor::displacement;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  ///< upright on the page, as against gravity; zero: chosen
};

inline constexpr int kPictureWidth = 1600, kPictureHeight = 1000;  ///< [px]

/// From where `draw_picture` looks at these two states.
PictureView picture_view(const Snapshot& rest, const Snapshot& end, const PictureOptions& options);

/// Draws `end` as a PNG: solids coloured and half transparent, so that the rods in them show; the shape they had in
/// `rest` (the state at t = 0) as a pale silhouette; rods at their thickness (two pixels at least), orange, or coloured
/// if there is no solid; sliding points as dots; forces of contacts as arrows; outputs with their names, their ways and
/// how far they have come, or are off their targets, which are rings; axes, a scale bar and a legend in readable units.
/// Objects of the two states belong together by name. What is not finite is left out; no number makes it fail.
/// WriteError if the file cannot be written.
void draw_picture(const std::filesystem::path& png, const Snapshot& rest, const Snapshot& end,
                  const PictureOptions& options = {});

}  // namespace sinew::io
