// Meshes of blocks, for tests that read no file.
#pragma once

#include <map>
#include <utility>

#include "sinew/solid/mesh.hpp"

namespace sinew::test {

/// The same mesh with nodes in the middle of all edges.
inline solid::Mesh quadratic(solid::Mesh mesh) {
  static constexpr int kEdges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  std::map<std::pair<int, int>, int> middle;
  auto nodes = static_cast<int>(mesh.nodes.cols());
  for (solid::Cell& cell : mesh.cells) {
    cell.kind = solid::Kind::tet10;
    for (std::size_t e = 0; e < 6; ++e) {
      const auto ends = std::minmax(cell.node[static_cast<std::size_t>(kEdges[e][0])],
                                    cell.node[static_cast<std::size_t>(kEdges[e][1])]);
      const auto [at, fresh] = middle.try_emplace({ends.first, ends.second}, nodes);
      if (fresh) ++nodes;
      cell.node[4 + e] = at->second;
    }
  }
  mesh.nodes.conservativeResize(3, nodes);
  for (const auto& [ends, node] : middle)
    mesh.nodes.col(node) = 0.5 * (mesh.nodes.col(ends.first) + mesh.nodes.col(ends.second));
  return mesh;
}

/// A block from the origin to `size` in nx x ny x nz boxes: one hexahedron each, or six tetrahedra.
inline solid::Mesh block_mesh(int nx, int ny, int nz, const solid::Vec3& size, solid::Kind kind = solid::Kind::tet4) {
  solid::Mesh mesh;
  const auto number = [=](int i, int j, int k) { return (k * (ny + 1) + j) * (nx + 1) + i; };
  mesh.nodes.resize(3, (nx + 1) * (ny + 1) * (nz + 1));
  for (int k = 0; k <= nz; ++k) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i)
        mesh.nodes.col(number(i, j, k)) = solid::Vec3(size.x() * i / nx, size.y() * j / ny, size.z() * k / nz);
    }
  }
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const auto corner = [&](int c) { return number(i + (c & 1), j + ((c >> 1) & 1), k + ((c >> 2) & 1)); };
        if (kind == solid::Kind::hex8) {
          mesh.cells.push_back(
              {kind, {corner(0), corner(1), corner(3), corner(2), corner(4), corner(5), corner(7), corner(6)}});
          continue;
        }
        // Six tetrahedra around the diagonal from corner 0 to corner 7.
        const int ring[] = {1, 3, 2, 6, 4, 5, 1};
        for (int t = 0; t < 6; ++t) {
          solid::Cell tet = {solid::Kind::tet4, {corner(0), corner(ring[t]), corner(ring[t + 1]), corner(7)}};
          if (solid::volume(mesh.nodes, tet) < 0.0) std::swap(tet.node[1], tet.node[2]);
          mesh.cells.push_back(tet);
        }
      }
    }
  }
  return kind == solid::Kind::tet10 ? quadratic(mesh) : mesh;
}

}  // namespace sinew::test
