#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "sinew/sim/building.hpp"

namespace sinew::building {

namespace {

/// Nodes in use, renumbered in their order.
void compact(solid::Mesh& mesh) {
  std::vector<int> number(mesh.nodes.cols(), -1);
  for (const auto& t : mesh.tetrahedra) {
    for (int node : t) number[node] = 0;
  }
  int used = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    mesh.nodes.col(used) = mesh.nodes.col(static_cast<Eigen::Index>(i)).eval();
    number[i] = used++;
  }
  mesh.nodes.conservativeResize(3, used);
  for (auto& t : mesh.tetrahedra) {
    for (int& node : t) node = number[node];
  }
}

/// Pattern of the lower triangle and where every element's blocks go in it.
void make_pattern(SolidModel& model) {
  const solid::Body& body = model.body;
  std::vector<std::set<int>> below(body.free_nodes);  // per column node, rows >= it
  for (const auto& t : body.tetrahedra) {
    for (int a : t) {
      for (int b : t) {
        if (body.unknown[b] >= 0 && body.unknown[a] >= body.unknown[b]) below[body.unknown[b]].insert(body.unknown[a]);
      }
    }
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < body.free_nodes; ++column) {
    for (int row : below[column]) {
      for (int j = 0; j < 3; ++j) {
        for (int i = row == column ? j : 0; i < 3; ++i) entries.emplace_back(3 * row + i, 3 * column + j, 0.0);
      }
    }
  }
  model.matrix.resize(3 * body.free_nodes, 3 * body.free_nodes);
  model.matrix.setFromTriplets(entries.begin(), entries.end());
  model.matrix.makeCompressed();
  const auto position = [&](int row, int column) {
    const int* begin = model.matrix.innerIndexPtr() + model.matrix.outerIndexPtr()[column];
    const int* end = model.matrix.innerIndexPtr() + model.matrix.outerIndexPtr()[column + 1];
    return static_cast<int>(std::lower_bound(begin, end, row) - model.matrix.innerIndexPtr());
  };
  for (int i = 0; i < 3 * body.free_nodes; ++i) model.diagonal.push_back(position(i, i));
  std::array<int, 9> absent;
  absent.fill(-1);
  model.block.assign(16 * body.tetrahedra.size(), absent);
  for (std::size_t e = 0; e < body.tetrahedra.size(); ++e) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const int row = body.unknown[body.tetrahedra[e][a]], column = body.unknown[body.tetrahedra[e][b]];
        if (row < 0 || column < 0 || row < column) continue;
        for (int i = 0; i < 9; ++i) {
          if (row == column && i % 3 < i / 3) continue;
          model.block[16 * e + 4 * a + b][i] = position(3 * row + i % 3, 3 * column + i / 3);
        }
      }
    }
  }
}

/// Reads a mesh. What is wrong inside it carries the mesh's own file and line; a path that leads nowhere is the field's
/// fault.
solid::Mesh read_named(const MeshReader& read_mesh, const std::filesystem::path& file, const std::string& path) {
  try {
    return read_mesh(file);
  } catch (const InputError& error) {
    InputFault fault = error.fault();
    if (fault.file.empty()) fault.path = path;
    throw InputError(fault);
  }
}

}  // namespace

SolidModel build_solid(const Scene& scene, const std::string& name, const Solid& solid, const MeshReader& read_mesh) {
  const std::string path = "solids." + name;
  SolidModel model;
  model.name = name;
  model.frame = find_frame(scene, solid.frame, path);
  require_positive(solid.material.young, path + ".material.young", "give Young's modulus, for example 600 kPa");
  if (!(solid.material.poisson > -1.0 && solid.material.poisson < 0.5)) {
    reject(path + ".material.poisson", text(solid.material.poisson), "must lie between -1 and 0.5 in a solid",
           "use 0.49 for a nearly incompressible silicone");
  }
  require_positive(solid.scale, path + ".scale", "0.001 if the mesh is in millimetres");

  solid::Mesh mesh =
      read_named(read_mesh, solid.mesh.is_absolute() ? solid.mesh : scene.folder / solid.mesh, path + ".mesh");
  compact(mesh);
  const Eigen::Matrix3Xd scaled = solid.scale * mesh.nodes;
  const Placement pose = stand(scene, model.frame, solid.pose);
  const Eigen::Matrix3Xd world = (pose.R * scaled).colwise() + pose.p;
  const double diagonal = (world.rowwise().maxCoeff() - world.rowwise().minCoeff()).norm();

  if (!(diagonal > kSmallest && diagonal < kLargest && world.allFinite())) {
    reject(path + ".scale", text(solid.scale), "makes the body " + text(diagonal) + " m large",
           "give the scale that turns mesh coordinates into metres, 0.001 for millimetres; check the pose");
  }

  std::vector<bool> clamped(scaled.cols(), false);
  for (std::size_t b = 0; b < solid.fixed.size(); ++b) {
    const Box& box = solid.fixed[b];
    const Eigen::Matrix3Xd& where = box.in == In::world ? world : scaled;
    const double slack = 1e-9 * diagonal;
    int count = 0;
    for (Eigen::Index i = 0; i < where.cols(); ++i) {
      if (((where.col(i) - box.lower).array() < -slack).any() || ((where.col(i) - box.upper).array() > slack).any())
        continue;
      clamped[i] = true;
      ++count;
    }
    if (count == 0) {
      reject(path + ".fixed", text(box.lower) + " .. " + text(box.upper) + " m", "no node of the mesh lies in this box",
             "the nodes span " + text(Vec3(where.rowwise().minCoeff())) + " .. " +
                 text(Vec3(where.rowwise().maxCoeff())) + " m " +
                 (box.in == In::world ? "in the world" : "before the pose") + "; check scale and units");
    }
  }
  const auto held = std::count(clamped.begin(), clamped.end(), true);
  if (held < 3) {
    reject(path + ".fixed", std::to_string(held) + " nodes",
           "at least three nodes must be fixed, or the body falls or turns freely",
           "add `fixed: {box: [[..], [..]]}` around the part that is held");
  }
  if (held == scaled.cols()) reject(path + ".fixed", "all nodes", "some node must be free", "make the box smaller");

  double volume = 0.0;
  for (const auto& t : mesh.tetrahedra) volume += solid::volume(scaled, t);
  if (solid.mass.has_value() == solid.density.has_value()) {
    reject(path, "", "needs exactly one of mass and density", "give `mass: 75 g` or `density: 1070 kg/m^3`");
  }
  const double mass = solid.mass ? *solid.mass : *solid.density * volume;
  require_positive(mass, path + (solid.mass ? ".mass" : ".density"), "give the mass of the body");
  model.surface = solid::surface(mesh.tetrahedra);
  model.body = solid::make_body(world, mesh.tetrahedra, solid::lame(solid.material.young, solid.material.poisson), mass,
                                clamped);
  model.body.damping_mass = solid.rayleigh.mass;
  model.body.damping_stiffness = solid.rayleigh.stiffness;
  make_pattern(model);
  return model;
}

}  // namespace sinew::building
