// Surfaces of triangles as shapes of bodies and obstacles.
#pragma once

#include <map>
#include <string>

#include "sinew/contact/polyhedron.hpp"
#include "support/contacts.hpp"

namespace sinew::test {

/// A box with its middle at `middle`, two triangles a face.
inline solid::Mesh box_surface(const Vec3& size, const Vec3& middle = Vec3::Zero()) {
  const contact::Polyhedron box = contact::box(size);
  solid::Mesh mesh;
  mesh.nodes.resize(3, 8);
  for (int i = 0; i < 8; ++i) mesh.nodes.col(i) = middle + box.corners[i];
  for (const std::vector<int>& face : box.faces) {
    mesh.faces.push_back({face[0], face[1], face[2]});
    mesh.faces.push_back({face[0], face[2], face[3]});
  }
  return mesh;
}

/// A block of 20 x 10 mm that rises out of a floor at z = 0, of one surface.
inline solid::Mesh floor_with_block(double height) {
  solid::Mesh mesh;
  mesh.nodes.resize(3, 16);
  const auto ring = [&mesh](int first, double x0, double x1, double y0, double y1, double z) {
    const std::array<std::array<double, 2>, 4> corners = {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
    for (int i = 0; i < 4; ++i) {
      const auto [x, y] = corners[static_cast<std::size_t>(i)];
      mesh.nodes.col(first + i) = Vec3(x, y, z);
    }
  };
  ring(0, 0, 20 * mm, 0, 10 * mm, height);
  ring(4, 0, 20 * mm, 0, 10 * mm, 0);
  ring(8, -20 * mm, 120 * mm, -100 * mm, 100 * mm, 0);
  ring(12, -20 * mm, 120 * mm, -100 * mm, 100 * mm, -20 * mm);
  mesh.faces = {{0, 1, 2}, {0, 2, 3}, {12, 14, 13}, {12, 15, 14}};
  for (const int upper : {0, 4, 8}) {
    for (int i = 0; i < 4; ++i) {
      const int next = (i + 1) % 4;
      mesh.faces.push_back({upper + 4 + i, upper + 4 + next, upper + next});
      mesh.faces.push_back({upper + 4 + i, upper + next, upper + i});
    }
  }
  return mesh;
}

inline Obstacle obstacle(const auto& shape, const Vec3& at) {
  Obstacle own;
  own.shape = shape;
  own.pose.translate = at;
  return own;
}

inline std::map<std::string, solid::Mesh> named(
    std::initializer_list<std::pair<const std::string, solid::Mesh>> meshes) {
  return meshes;
}

inline MeshReader reader(const std::map<std::string, solid::Mesh>& meshes) {
  return [meshes](const std::filesystem::path& path) { return meshes.at(path.filename().string()); };
}

inline MeshShape mesh_of(const std::string& file) { return {.file = file, .scale = 1.0, .hull = false}; }

}  // namespace sinew::test
