// Solids that pass through themselves or each other: their surfaces cross where no contact pair stops them.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "sinew/contact/mesh.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// Where the segment from p to q goes through the inside of a triangle, as a part of its length; none where it does
/// not.
std::optional<double> pierced_at(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& triangle);

/// Two surfaces that cross each other, or one that crosses itself.
struct SurfaceOverlap {
  int solid = 0, other = 0;   ///< of the model's; the same of one that crosses itself
  int crossings = 0;          ///< pairs of triangles, beyond those at the start of a run
  Vec3 where = Vec3::Zero();  ///< [m] of one of them
};

/// Looks for such pairs, and keeps its memory. Surfaces that a contact pair of the scene stops are left to it.
class SurfaceWatch {
 public:
  explicit SurfaceWatch(const Model& model);
  /// Takes O(n log n) for n triangles.
  std::vector<SurfaceOverlap> look(const State& state);
  bool idle() const { return pairs_.empty(); }

 private:
  struct Pair {
    int solid = 0, other = 0, at_start = 0;
  };
  SurfaceOverlap crossings(const Pair& pair) const;
  void fit(const State& state);

  const Model* model_;
  std::vector<contact::Tree> trees_;  ///< of each solid's triangles
  std::vector<std::vector<contact::Box>> boxes_;
  std::vector<Eigen::Matrix3Xd> x_;
  std::vector<Pair> pairs_;
};

}  // namespace sinew
