#include <Eigen/Dense>
#include <algorithm>
#include <set>

#include "sinew/sim/building.hpp"
#include "sinew/solid/pressure.hpp"

namespace sinew::building {

namespace {

/// Which nodes a region holds.
class Inside {
 public:
  Inside(const SolidModel& solid, const std::string& path)
      : solid_(solid), path_(path), slack_(1e-9 * solid.mesh.diagonal) {}

  std::vector<bool> operator()(const Box& box) const {
    return each(box.in, [&](const Vec3& x) {
      return ((x - box.lower).array() >= -slack_).all() && ((x - box.upper).array() <= slack_).all();
    });
  }
  std::vector<bool> operator()(const Sphere& sphere) const {
    require_positive(sphere.radius, path_ + ".sphere.radius", "give the radius of the region");
    return each(sphere.in, [&](const Vec3& x) { return (x - sphere.center).norm() <= sphere.radius + slack_; });
  }
  std::vector<bool> operator()(const Plane& plane) const {
    if (!(plane.normal.norm() > 0.0))
      reject(path_ + ".plane.normal", text(plane.normal), "must not be zero", "give a direction, as [1, 0, 0]");
    const double within = plane.within.value_or(1e-6 * solid_.mesh.diagonal);
    const Vec3 n = plane.normal.normalized();
    return each(plane.in, [&](const Vec3& x) { return std::abs(n.dot(x - plane.point)) <= within; });
  }
  std::vector<bool> operator()(const NodeNumbers& list) const {
    std::vector<bool> in(nodes(), false);
    const std::vector<int>& number = solid_.mesh.number;
    for (const int node : list.numbers) {
      if (node < 0 || node >= static_cast<int>(number.size()))
        reject(
            path_ + ".nodes", std::to_string(node),
            "must be from 0 to " + std::to_string(static_cast<int>(number.size()) - 1) + ", as the file numbers nodes",
            "check the numbers");
      if (number[node] < 0)
        reject(path_ + ".nodes", std::to_string(node), "no element of the mesh uses this node", "remove it");
      in[number[node]] = true;
    }
    add_raised(in);
    return in;
  }
  std::vector<bool> operator()(const GroupName& group) const {
    const auto found = solid_.mesh.groups.find(group.name);
    if (found == solid_.mesh.groups.end()) {
      std::string known;
      for (const auto& [name, own] : solid_.mesh.groups) known += (known.empty() ? "" : ", ") + name;
      reject(path_ + ".group", group.name, "the mesh file has no group of this name",
             known.empty() ? "the file has no groups: save it from Gmsh with physical groups" : "known: " + known);
    }
    std::vector<bool> in(nodes(), false);
    for (const int node : found->second.nodes) in[node] = true;
    return in;
  }
  std::vector<bool> operator()(const WholeSurface&) const {
    std::vector<bool> in(nodes(), false);
    for (const solid::CellFace& face : solid_.mesh.boundary) {
      for (const int node : face.nodes()) in[node] = true;
    }
    return in;
  }

 private:
  /// A node that the file does not have, between two nodes of the region, belongs to it: an edge that was held whole by
  /// its ends stays so, and faces and cells keep all their nodes.
  void add_raised(std::vector<bool>& in) const {
    const int first = 1 + *std::max_element(solid_.mesh.number.begin(), solid_.mesh.number.end());
    for (const solid::Cell& cell : solid_.body.cells) {
      if (cell.kind != solid::Kind::tet10) continue;
      std::size_t middle = 4;
      for (const auto& [a, b] : solid::tetrahedron_edges()) {
        const int node = cell.node[middle++];
        if (node >= first && in[cell.node[a]] && in[cell.node[b]]) in[node] = true;
      }
    }
  }
  std::size_t nodes() const { return static_cast<std::size_t>(solid_.mesh.object.cols()); }
  template <class Test>
  std::vector<bool> each(In where, const Test& test) const {
    const Eigen::Matrix3Xd& x = where == In::world ? solid_.body.rest : solid_.mesh.object;
    std::vector<bool> in;
    for (Eigen::Index i = 0; i < x.cols(); ++i) in.push_back(test(x.col(i)));
    return in;
  }

  const SolidModel& solid_;
  const std::string& path_;
  const double slack_;  ///< [m] of rounding, for nodes on the border of a region
};

std::set<int> corners(const solid::CellFace& face) { return {face.corners().begin(), face.corners().end()}; }

/// Cells and boundary faces of a group, by what the file lists: faces, or else those of its cells.
void listed(const SolidModel& solid, const solid::Group& group, Selection& selection) {
  selection.cells = group.cells;
  std::vector<solid::Cell> cells;
  for (const int cell : group.cells) cells.push_back(solid.body.cells[cell]);
  std::set<std::set<int>> named;
  for (const solid::CellFace& face : group.faces.empty() ? solid::boundary(cells) : group.faces)
    named.insert(corners(face));
  for (const solid::CellFace& face : solid.mesh.boundary) {
    if (named.contains(corners(face))) selection.faces.push_back(face);
  }
}

}  // namespace

Selection select(const SolidModel& solid, const Region& region, const std::string& path) {
  const std::vector<bool> in = std::visit(Inside(solid, path), region);
  const auto all_in = [&in](std::span<const int> nodes) {
    return std::all_of(nodes.begin(), nodes.end(), [&in](int node) { return in[node]; });
  };
  Selection selection;
  for (std::size_t i = 0; i < in.size(); ++i) {
    if (in[i]) selection.nodes.push_back(static_cast<int>(i));
  }
  if (selection.nodes.empty()) {
    const bool world = std::visit(
        [](const auto& own) {
          if constexpr (requires { own.in; }) return own.in == In::world;
          return false;
        },
        region);
    const Eigen::Matrix3Xd& x = world ? solid.body.rest : solid.mesh.object;
    const Box* box = std::get_if<Box>(&region);
    reject(path, box ? text(box->lower) + " .. " + text(box->upper) + " m" : "",
           "no node of the mesh lies in this region",
           "the nodes span " + text(Vec3(x.rowwise().minCoeff())) + " .. " + text(Vec3(x.rowwise().maxCoeff())) +
               " m " + (world ? "in the world" : "before the pose") + "; check scale and units");
  }
  if (const GroupName* name = std::get_if<GroupName>(&region)) {
    listed(solid, solid.mesh.groups.at(name->name), selection);
    return selection;
  }
  for (std::size_t e = 0; e < solid.body.cells.size(); ++e) {
    if (all_in(solid.body.cells[e].nodes())) selection.cells.push_back(static_cast<int>(e));
  }
  for (const solid::CellFace& face : solid.mesh.boundary) {
    if (all_in(face.nodes())) selection.faces.push_back(face);
  }
  return selection;
}

Selection select_loaded(const SolidModel& solid, const Region& region, const std::string& path) {
  Selection selection = select(solid, region, path);
  const GroupName* name = std::get_if<GroupName>(&region);
  if (name && selection.faces.empty() && !solid.mesh.groups.at(name->name).faces.empty())
    reject(path + ".group", name->name, "none of its faces is on the boundary of the body",
           "name a group of faces of the surface, or give a region");
  return selection;
}

Eigen::VectorXd shares(const SolidModel& solid, const Selection& selection, Spread spread) {
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(solid.mesh.object.cols());
  for (const solid::CellFace& face : selection.faces) {
    const solid::FaceValues own = spread == Spread::evenly ? solid::face_shares(face, solid.body.rest)
                                                           : solid::lumped_face_shares(face, solid.body.rest);
    for (int i = 0; i < face.count; ++i) weight[face.node[i]] += own[i];
  }
  if (selection.faces.empty()) {
    for (const int node : selection.nodes) weight[node] = 1.0;
  }
  return weight / weight.sum();
}

}  // namespace sinew::building
