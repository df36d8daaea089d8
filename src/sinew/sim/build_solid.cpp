#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/sim/building.hpp"
#include "sinew/solid/mesh_order.hpp"
#include "sinew/solid/mesh_pieces.hpp"

namespace sinew::building {

namespace {

/// Nodes in use, renumbered in their order; returns the new number of each, or -1.
std::vector<int> compact(solid::Mesh& mesh) {
  std::vector<int> number(mesh.nodes.cols(), -1);
  for (const solid::Cell& cell : mesh.cells) {
    for (const int node : cell.nodes()) number[node] = 0;
  }
  int used = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    mesh.nodes.col(used) = mesh.nodes.col(static_cast<Eigen::Index>(i)).eval();
    number[i] = used++;
  }
  mesh.nodes.conservativeResize(3, used);
  for (solid::Cell& cell : mesh.cells) {
    for (int i = 0; i < solid::node_count(cell.kind); ++i) cell.node[i] = number[cell.node[i]];
  }
  for (auto& [name, group] : mesh.groups) {
    const auto unused = [&number](int node) { return number[node] < 0; };
    std::erase_if(group.nodes, unused);
    for (int& node : group.nodes) node = number[node];
    std::erase_if(group.faces, [&](const solid::CellFace& face) {
      return std::any_of(face.nodes().begin(), face.nodes().end(), unused);
    });
    for (solid::CellFace& face : group.faces) {
      for (int i = 0; i < face.count; ++i) face.node[i] = number[face.node[i]];
    }
  }
  return number;
}

/// Cells must be tied wherever they meet.
void check_tied(const std::vector<solid::Cell>& cells, const std::string& path) {
  const auto name = [&cells](int cell) {
    return std::to_string(cell) + " (" + solid::name(cells[static_cast<std::size_t>(cell)].kind) + ")";
  };
  const auto both = [&](const solid::CellPair& pair) {
    return "cells " + name(pair[0]) + " and " + name(pair[1]) + ", 0-based, counting used cells only";
  };
  if (const auto pair = solid::mismatched_faces(cells))
    reject(path, both(*pair), "a quadrilateral face cannot be tied to triangles, and the body would come apart there",
           "mesh pieces that touch with the same kind of element, hexahedra or tetrahedra");
  if (const auto pair = solid::mismatched_edges(cells))
    reject(path, both(*pair), "share an edge, but not the node in its middle, and the body would come apart there",
           "join nodes at the same place in the program that writes the mesh");
}

/// "node 12 (0-based) at [1, 2, 3]", in the file's numbers and unit.
std::string node_in_words(const solid::Mesh& mesh, int node) {
  return "node " + std::to_string(node) + " (0-based) at " + text(Vec3(mesh.nodes.col(node)));
}

/// Cells must share the nodes by which they meet. Pieces that do not hang together are told.
void check_pieces(const solid::Mesh& mesh, const std::string& path, std::vector<Warning>& warnings) {
  const solid::Pieces pieces = solid::find_pieces(mesh.cells, mesh.nodes.cols());
  if (const std::vector<int> hanging = solid::hanging_nodes(mesh.nodes, mesh.cells, pieces); !hanging.empty())
    reject(path, node_in_words(mesh, hanging.front()),
           "lies on a face of a cell that does not have it, and the body would come apart there (" +
               std::to_string(hanging.size()) + " such nodes)",
           "mesh both sides with the same nodes (in Gmsh: BooleanFragments before meshing)");
  const std::vector<std::array<int, 2>> same = solid::coincident_nodes(mesh.nodes, mesh.cells);
  if (!same.empty())
    warnings.push_back(
        {.code = "nodes_coincide",
         .where = path,
         .message = std::to_string(same.size()) + " nodes are at the place of another and not tied to it, the first " +
                    node_in_words(mesh, same.front()[0]) + " and node " + std::to_string(same.front()[1]),
         .remedy = "join nodes at the same place in the program that writes the mesh, unless a crack is "
                   "meant there",
         .value = static_cast<double>(same.size())});
  if (pieces.count > 1)
    warnings.push_back({.code = "mesh_pieces",
                        .where = path,
                        .message = "it is " + std::to_string(pieces.count) +
                                   " pieces that share no nodes, so nothing ties them to each other",
                        .remedy = "join them in the program that writes the mesh, or give each its own file and solid",
                        .value = static_cast<double>(pieces.count),
                        .limit = 1.0});
}

/// What a reader has changed.
void tell_of_changes(const solid::Mesh& mesh, const std::string& path, std::vector<Warning>& warnings) {
  std::string types;
  for (const auto& [type, count] : mesh.simplified)
    types += (types.empty() ? "" : ", ") + std::to_string(count) + " of type " + type;
  if (!types.empty())
    warnings.push_back({.code = "elements_simplified",
                        .where = path,
                        .message = "hybrid, reduced and modified elements are read as plain ones, " + types,
                        .remedy = "nothing where they are fine enough; tetrahedra of 4 nodes lock near Poisson's ratio "
                                  "0.5, where `order: 2` helps"});
  if (mesh.turned > 0)
    warnings.push_back(
        {.code = "elements_turned",
         .where = path,
         .message =
             std::to_string(mesh.turned) +
             " elements, all of their kind, were inside out and are turned: their nodes stood in the other order",
         .remedy = "see that the mesh is not mirrored; the program that wrote it can write it right"});
}

/// Gives 4-node tetrahedra nodes in the middle of their edges where that is asked for, or where they meet cells that
/// have them.
void raise_order(solid::Mesh& mesh, int order, const std::string& path, std::vector<Warning>& warnings) {
  if (order != 1 && order != 2)
    reject(path + ".order", std::to_string(order), "must be 1 or 2", "1 keeps the elements of the file, 2 raises them");
  const auto of = [&mesh](solid::Kind kind) {
    return std::count_if(mesh.cells.begin(), mesh.cells.end(),
                         [kind](const solid::Cell& cell) { return cell.kind == kind; });
  };
  const auto hexahedra = of(solid::Kind::hex8), linear = of(solid::Kind::tet4);
  if (order == 2 && hexahedra > 0)
    warnings.push_back({.code = "order_not_raised",
                        .where = path + ".order",
                        .message = "raises tetrahedra only; hexahedra keep their 8 nodes (" +
                                   std::to_string(hexahedra) + " of them)"});
  const int meeting = solid::meeting_orders(mesh.cells);
  if (order == 1 && meeting == 0) return;
  mesh = solid::quadratic(std::move(mesh));
  if (meeting == 0) return;
  if (order == 1)
    warnings.push_back({.code = "order_raised",
                        .where = path + ".mesh",
                        .message = std::to_string(meeting) +
                                   " 4-node tetrahedra meet 10-node ones; to tie them all 4-node tetrahedra (" +
                                   std::to_string(linear) + ") are raised to 10 nodes, as with `order: 2`"});
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    if (mesh.cells[i].kind == solid::Kind::tet10 && !(solid::smallest_jacobian(mesh.nodes, mesh.cells[i]) > 1e-12))
      reject(path + ".mesh", "cell " + std::to_string(i) + " (0-based, counting used cells only)",
             "this tetrahedron is folded once its edges follow the curved ones of the 10-node tetrahedra it meets",
             "save all tetrahedra of the mesh with 10 nodes, or all with 4");
  }
}

/// The material as bodies want it. Rayleigh's share of the stiffness is a viscosity of the same shape. Without a
/// density it is 0 or, where the body's mass is given, any.
solid::Material make_material(const SolidMaterial& material, const Solid& solid, const std::string& path) {
  const solid::Lame moduli = solid::lame(material.law);
  if (!(moduli.mu > 0.0 && 3.0 * moduli.lambda + 2.0 * moduli.mu > 0.0 && std::isfinite(moduli.lambda))) {
    reject(path, "shear modulus " + text(moduli.mu) + " Pa, bulk modulus " + text(solid::bulk_modulus(moduli)) + " Pa",
           "both must be greater than 0 and finite",
           "give young > 0 and poisson between -1 and 0.5 (0.49 for a nearly incompressible silicone)");
  }
  require_not_negative(material.viscosity, path + ".viscosity", "leave it out for none");
  if (material.density) require_positive(*material.density, path + ".density", "give the density of this material");
  const double b = solid.rayleigh.stiffness, eta = material.viscosity;
  const double density = material.density.value_or(solid.density.value_or(solid.mass ? 1.0 : 0.0));
  return {material.law, density, {b * moduli.mu + eta, b * moduli.lambda - 2.0 / 3.0 * eta}};
}

/// Holds the coordinates of the nodes in `fixed`, each by its frame: along different axes these may be different ones.
Eigen::Array<bool, 3, Eigen::Dynamic> hold(const Scene& scene, const Solid& solid, const std::string& path,
                                           SolidModel& model) {
  const Eigen::Index nodes = model.body.rest.cols();
  Eigen::Array<bool, 3, Eigen::Dynamic> held = Eigen::Array<bool, 3, Eigen::Dynamic>::Constant(3, nodes, false);
  model.carrier = Eigen::Array3Xi::Constant(3, nodes, -1);
  for (const Held& own : solid.fixed) {
    const int frame = own.frame ? find_frame(scene, own.frame, path + ".fixed") : model.frame;
    for (const int node : select(model, own.region, path + ".fixed").nodes) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!own.axes[axis]) continue;
        if (held(axis, node) && model.carrier(axis, node) != frame)
          reject(path + ".fixed", text(Vec3(model.body.rest.col(node))) + " m",
                 std::string("a node there is held along ") + "xyz"[axis] + " by two frames",
                 "let one frame hold a node along an axis; others may hold it along other `axes`");
        model.carrier(axis, node) = frame;
        held(axis, node) = true;
      }
    }
  }
  return held;
}

}  // namespace

solid::Mesh read_named(const Scene& scene, const MeshReader& read_mesh, const std::filesystem::path& file,
                       const std::string& path) {
  try {
    return read_mesh(file.is_absolute() ? file : scene.folder / file);
  } catch (const InputError& error) {
    InputFault fault = error.fault();
    if (fault.file.empty()) fault.path = path;
    throw InputError(fault);
  }
}

void warn_of_scale(double size, double scale, const std::string& path, std::vector<Warning>& warnings) {
  if (scale == 1.0 && size > 5.0)
    warnings.push_back({.code = "unit_of_mesh",
                        .where = path,
                        .message = "the mesh is " + text(size) + " m large",
                        .remedy = "write `scale: 0.001` if its file is in millimetres",
                        .value = size,
                        .unit = "m"});
}

SolidModel build_solid(const Scene& scene, const std::string& name, const Solid& solid, const MeshReader& read_mesh,
                       std::vector<Warning>& warnings) {
  const std::string path = "solids." + name;
  SolidModel model;
  model.name = name;
  model.frame = find_frame(scene, solid.frame, path);
  require_positive(solid.scale, path + ".scale", "0.001 if the mesh is in millimetres");

  solid::Mesh mesh = read_named(scene, read_mesh, solid.mesh, path + ".mesh");
  if (mesh.cells.empty())
    reject(path + ".mesh", solid.mesh.string(), "is a surface without elements",
           "mesh the volume inside it, for example with Gmsh, and name that file");
  tell_of_changes(mesh, path + ".mesh", warnings);
  check_tied(mesh.cells, path + ".mesh");
  check_pieces(mesh, path + ".mesh", warnings);
  model.mesh.number = compact(mesh);
  raise_order(mesh, solid.order, path, warnings);
  model.mesh.object = solid.scale * mesh.nodes;
  model.mesh.boundary = solid::boundary(mesh.cells);
  model.mesh.groups = std::move(mesh.groups);
  model.mesh.ignored = std::move(mesh.ignored);
  const Placement pose = stand(scene, model.frame, solid.pose);
  const Eigen::Matrix3Xd world = (pose.R * model.mesh.object).colwise() + pose.p;
  model.mesh.diagonal = (world.rowwise().maxCoeff() - world.rowwise().minCoeff()).norm();
  if (!(model.mesh.diagonal > kSmallest && model.mesh.diagonal < kLargest && world.allFinite())) {
    reject(path + ".scale", text(solid.scale), "makes the body " + text(model.mesh.diagonal) + " m large",
           "give the scale that turns mesh coordinates into metres, 0.001 for millimetres; check the pose");
  }
  warn_of_scale(model.mesh.diagonal, solid.scale, path + ".scale", warnings);
  model.body.rest = world;  // for regions
  model.body.cells = mesh.cells;

  const auto by_parts = std::count_if(solid.parts.begin(), solid.parts.end(),
                                      [](const SolidPart& part) { return part.material.density.has_value(); });
  const bool densities = solid.density || solid.material.density || by_parts > 0;
  if (solid.mass.has_value() == densities)
    reject(path, "", "needs exactly one of mass and density", "give `mass: 75 g` or `density: 1070 kg/m^3`");
  if (solid.density) require_positive(*solid.density, path + ".density", "give the density of the body");
  if (solid.mass) require_positive(*solid.mass, path + ".mass", "give the mass of the body");
  require_not_negative(solid.rayleigh.mass, path + ".rayleigh.mass", "leave it out for none");
  require_not_negative(solid.rayleigh.stiffness, path + ".rayleigh.stiffness", "leave it out for none");

  std::vector<solid::Material> materials = {make_material(solid.material, solid, path + ".material")};
  std::vector<int> material(mesh.cells.size(), 0);
  for (std::size_t i = 0; i < solid.parts.size(); ++i) {
    const std::string own = path + ".parts." + std::to_string(i);
    materials.push_back(make_material(solid.parts[i].material, solid, own + ".material"));
    const std::vector<int> cells = select(model, solid.parts[i].region, own).cells;
    if (cells.empty())
      reject(own, "", "no cell of the mesh belongs to this region",
             "enlarge the region: a cell belongs to it with all its nodes, or to a group that lists it");
    for (const int cell : cells) material[cell] = static_cast<int>(i) + 1;
  }
  const auto without =
      std::count_if(material.begin(), material.end(), [&](int own) { return materials[own].density == 0.0; });
  if (without > 0)
    reject(path + ".density", "", "is not known of " + std::to_string(without) + " of the cells",
           "give the density of the body, or of the materials of all its parts");
  const auto held = hold(scene, solid, path, model);
  if (held.all()) reject(path + ".fixed", "all nodes", "some node must be free", "make the region smaller");

  const bool quadratic = std::any_of(mesh.cells.begin(), mesh.cells.end(),
                                     [](const solid::Cell& cell) { return cell.kind == solid::Kind::tet10; });
  const auto masses = solid.mass_matrix.value_or(quadratic ? solid::MassMatrix::consistent : solid::MassMatrix::lumped);
  model.body = solid::make_body(world, mesh.cells, materials, material, held, masses, solid.mass);
  model.body.damping_mass = solid.rayleigh.mass;
  model.surface = solid::triangles(model.mesh.boundary);
  for (std::size_t i = 0; i < solid.springs.size(); ++i) {
    const Spring& spring = solid.springs[i];
    const std::string own = path + ".springs." + std::to_string(i);
    if (!(spring.stiffness.minCoeff() >= 0.0 && spring.stiffness.allFinite()))
      reject(own + ".stiffness", text(spring.stiffness) + " N/m", "must not be negative", "give N/m along x, y and z");
    if (model.springs.size() == 0) model.springs.setZero(3, model.body.nodes());
    model.springs +=
        spring.stiffness * shares(model, select_loaded(model, spring.region, own), Spread::lumped).transpose();
  }
  return model;
}

}  // namespace sinew::building
