// Meshes of blocks, for tests that read no file.
#pragma once

#include <utility>

#include "sinew/solid/mesh_order.hpp"

namespace sinew::test {

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
  return kind == solid::Kind::tet10 ? solid::quadratic(mesh) : mesh;
}

/// A mesh of 4-node tetrahedra, those beyond half its length along x raised. Nodes that only the others would have had
/// stay, unused.
inline solid::Mesh half_quadratic(const solid::Mesh& linear) {
  solid::Mesh mesh = solid::quadratic(linear);
  const double half = 0.5 * (linear.nodes.row(0).minCoeff() + linear.nodes.row(0).maxCoeff());
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    if (solid::cell_nodes(linear.nodes, linear.cells[i]).row(0).mean() < half) mesh.cells[i] = linear.cells[i];
  }
  return mesh;
}

/// Both in one mesh, sharing no node; groups are left out.
inline solid::Mesh together(const solid::Mesh& first, const solid::Mesh& second) {
  solid::Mesh mesh;
  mesh.nodes.resize(3, first.nodes.cols() + second.nodes.cols());
  mesh.nodes << first.nodes, second.nodes;
  mesh.cells = first.cells;
  for (solid::Cell cell : second.cells) {
    for (int i = 0; i < solid::node_count(cell.kind); ++i)
      cell.node[static_cast<std::size_t>(i)] += static_cast<int>(first.nodes.cols());
    mesh.cells.push_back(cell);
  }
  return mesh;
}

}  // namespace sinew::test
