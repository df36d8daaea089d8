// Open surfaces with a thickness: what is sold as a sheet, met from both sides.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace sinew::contact {

/// A closed surface of triangles, counter-clockwise seen from outside.
struct Sheet {
  Eigen::Matrix3Xd points;  ///< [m]
  std::vector<std::array<int, 3>> triangles;
};

/// Why a surface makes no sheet of that thickness, for people: "has 3 edges where more than two triangles meet".
struct NoSheet : std::invalid_argument {
  explicit NoSheet(const std::string& why, std::optional<Eigen::Vector3d> place = std::nullopt)
      : std::invalid_argument(why), at(std::move(place)) {}
  std::optional<Eigen::Vector3d> at;  ///< [m]
};

/// The closed surface around all that is nearer than half the thickness [m] to a surface, but for its rims, which are
/// walls across instead of half rounds. Triangles need not be turned the same way. Throws NoSheet where more than two
/// triangles meet in an edge, where the surface has but one side (a Moebius strip), and where it bends, folds or
/// returns to itself within the thickness.
Sheet thicken(const Eigen::Matrix3Xd& points, std::vector<std::array<int, 3>> triangles, double thickness);

}  // namespace sinew::contact
