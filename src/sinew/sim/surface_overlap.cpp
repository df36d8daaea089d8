#include "sinew/sim/surface_overlap.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "sinew/threads/interruption.hpp"

namespace sinew {

namespace {

using Corners = std::array<Vec3, 3>;

/// Six times the signed volume of a tetrahedron.
double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return (b - a).cross(c - a).dot(d - a); }

bool pierces(const Vec3& p, const Vec3& q, const Corners& t) { return pierced_at(p, q, t).has_value(); }

/// Whether two triangles cross: an edge of one goes through the other.
bool cross(const Corners& s, const Corners& t) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (pierces(s[i], s[(i + 1) % 3], t) || pierces(t[i], t[(i + 1) % 3], s)) return true;
  }
  return false;
}

Corners corners_of(const solid::Triangle& triangle, const Eigen::Matrix3Xd& x) {
  return {Vec3(x.col(triangle[0])), Vec3(x.col(triangle[1])), Vec3(x.col(triangle[2]))};
}

bool share_a_node(const solid::Triangle& a, const solid::Triangle& b) {
  return std::any_of(a.begin(), a.end(), [&b](int node) { return std::find(b.begin(), b.end(), node) != b.end(); });
}

bool stopped(const Model& model, int solid, int other) {
  const Collider a{Collider::Kind::solid, solid}, b{Collider::Kind::solid, other};
  return std::any_of(model.pairs.begin(), model.pairs.end(), [&](const PairModel& pair) {
    return (pair.a == a && pair.b == b) || (pair.a == b && pair.b == a);
  });
}

}  // namespace

std::optional<double> pierced_at(const Vec3& p, const Vec3& q, const Corners& t) {
  const double from = volume(t[0], t[1], t[2], p), to = volume(t[0], t[1], t[2], q);
  // (Of what lies in one plane rounding would say that it crosses.)
  const double size = std::max({(t[1] - t[0]).norm(), (t[2] - t[0]).norm(), (q - p).norm(), (p - t[0]).norm()});
  if (from * to >= 0.0 || std::min(std::abs(from), std::abs(to)) < 1e-12 * size * size * size) return std::nullopt;
  const double a = volume(p, q, t[0], t[1]), b = volume(p, q, t[1], t[2]), c = volume(p, q, t[2], t[0]);
  const bool inside = (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0);
  return inside ? std::optional(from / (from - to)) : std::nullopt;
}

SurfaceWatch::SurfaceWatch(const Model& model) : model_(&model) {
  const auto count = static_cast<int>(model.solids.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i; j < count; ++j) {
      if (!stopped(model, i, j)) pairs_.push_back({i, j, 0});
    }
  }
  if (pairs_.empty()) return;
  boxes_.resize(model.solids.size());
  for (const SolidModel& solid : model.solids) x_.push_back(solid.body.rest);
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    for (const solid::Triangle& triangle : model.solids[i].surface) {
      contact::Box& box = boxes_[i].emplace_back();
      for (const int node : triangle) box.extend(Vec3(x_[i].col(node)));
    }
    trees_.emplace_back(boxes_[i]);
  }
  for (Pair& pair : pairs_) pair.at_start = crossings(pair).crossings;
}

void SurfaceWatch::fit(const State& state) {
  for (std::size_t i = 0; i < trees_.size(); ++i) {
    x_[i] = state.solids[i].x;
    const std::vector<solid::Triangle>& surface = model_->solids[i].surface;
    for (std::size_t k = 0; k < surface.size(); ++k) {
      boxes_[i][k].setEmpty();
      for (const int node : surface[k]) boxes_[i][k].extend(Vec3(x_[i].col(node)));
    }
    trees_[i].fit(boxes_[i]);
  }
}

SurfaceOverlap SurfaceWatch::crossings(const Pair& pair) const {
  SurfaceOverlap found{pair.solid, pair.other, 0, Vec3::Zero()};
  const std::vector<solid::Triangle>&own = model_->solids[pair.solid].surface,
        &others = model_->solids[pair.other].surface;
  const auto solid = static_cast<std::size_t>(pair.solid), other = static_cast<std::size_t>(pair.other);
  for (std::size_t i = 0; i < own.size(); ++i) {
    threads::Interruption::check();
    trees_[other].each_near(boxes_[solid][i], [&](int j) {
      const auto number = static_cast<std::size_t>(j);
      if (solid == other && (number <= i || share_a_node(own[i], others[number]))) return;
      const Corners s = corners_of(own[i], x_[solid]), t = corners_of(others[number], x_[other]);
      if (!cross(s, t)) return;
      if (found.crossings++ == 0) found.where = (s[0] + s[1] + s[2]) / 3.0;
    });
  }
  return found;
}

std::vector<SurfaceOverlap> SurfaceWatch::look(const State& state) {
  std::vector<SurfaceOverlap> all;
  if (pairs_.empty()) return all;
  fit(state);
  for (const Pair& pair : pairs_) {
    SurfaceOverlap found = crossings(pair);
    found.crossings -= pair.at_start;
    if (found.crossings > 0) all.push_back(found);
  }
  return all;
}

}  // namespace sinew
