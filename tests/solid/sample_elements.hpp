// Elements of every kind for the laws that all of them must meet. Node numbers are written out here again, from the
// description of VTK's cell types 10, 24 and 12.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "sinew/solid/mesh.hpp"

namespace sinew::solid {

inline const Kind kKinds[] = {Kind::tet4, Kind::tet10, Kind::hex8};

inline NodeVectors reference_shape(Kind kind) {
  if (kind == Kind::hex8) {
    NodeVectors nodes(3, 8);
    nodes << -1, 1, 1, -1, -1, 1, 1, -1,  //
        -1, -1, 1, 1, -1, -1, 1, 1,       //
        -1, -1, -1, -1, 1, 1, 1, 1;
    return nodes;
  }
  NodeVectors nodes(3, 10);
  nodes << 0, 1, 0, 0, 0.5, 0.5, 0.0, 0.0, 0.5, 0.0,  //
      0, 0, 1, 0, 0.0, 0.5, 0.5, 0.0, 0.0, 0.5,       //
      0, 0, 0, 1, 0.0, 0.0, 0.0, 0.5, 0.5, 0.5;
  if (kind == Kind::tet4) return nodes.leftCols(4);
  return nodes;
}

/// Turned, sheared and, by `bump`, bent or twisted: at 0 affine, at 0.1 with strongly curved edges.
inline NodeVectors distorted(Kind kind, double bump) {
  const Mat3 A{{0.9, 0.3, -0.2}, {-0.2, 1.1, 0.4}, {0.1, -0.3, 0.8}};
  NodeVectors nodes = (A * reference_shape(kind)).colwise() + Vec3(0.3, -2.0, 5.0);
  const double size = kind == Kind::hex8 ? 2.0 * bump : bump;
  for (Eigen::Index j = 0; j < nodes.cols(); ++j) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      nodes(i, j) += size * std::sin(1.7 * static_cast<double>((3 * j + i + 1) * (j + 2 * i + 1)));
    }
  }
  return nodes;
}

inline Cell whole_cell(Kind kind, int first = 0) {
  Cell cell{kind, {}};
  for (int i = 0; i < node_count(kind); ++i) cell.node[static_cast<std::size_t>(i)] = first + i;
  return cell;
}

/// Local points inside the reference element.
inline std::vector<Vec3> points_inside(Kind kind, int count, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Vec3> points;
  while (static_cast<int>(points.size()) < count) {
    const Vec3 p(uniform(random), uniform(random), uniform(random));
    if (kind == Kind::hex8) {
      points.push_back(2.0 * p - Vec3::Ones());
    } else if (p.sum() < 1.0) {
      points.push_back(p);
    }
  }
  return points;
}

}  // namespace sinew::solid
