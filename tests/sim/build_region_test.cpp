// What regions take of a solid: nodes (`fixed`), cells (`parts`), faces (loads).
#include <gmock/gmock.h>

#include <numeric>

#include "sim/rejected.hpp"
#include "validation/solids.hpp"

namespace sinew::test {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;

/// Three hexahedra in a row along x, corners at 0, 1, 2, 3; node number (k 2 + j) 4 + i.
solid::Mesh row() {
  solid::Mesh mesh = block_mesh(3, 1, 1, Vec3(3, 1, 1), solid::Kind::hex8);
  const auto across = [](int i) { return solid::CellFace{4, {i, i + 4, i + 12, i + 8}}; };
  const auto all_of = [](solid::Group group) {
    for (const solid::CellFace& face : group.faces)
      group.nodes.insert(group.nodes.end(), face.nodes().begin(), face.nodes().end());
    std::sort(group.nodes.begin(), group.nodes.end());
    return group;
  };
  std::vector<int> every(16);
  std::iota(every.begin(), every.end(), 0);
  mesh.groups["ends"] = {{0, 2}, {}, every};  // cells that have all nodes of the one between them
  mesh.groups["first"] = all_of({{}, {across(0), across(1)}, {}});
  mesh.groups["inner"] = all_of({{}, {across(1)}, {}});
  mesh.groups["both"] = {{0, 2}, {across(3)}, every};
  mesh.groups["edge"] = {{}, {}, {3, 7}};
  return mesh;
}

/// Turned by 90 degrees about z, then moved: x of the mesh is along y of the world.
Scene scene_of(const Pose& pose = {{0, 0, 0.5 * pi}, {10, 0, 0}}) {
  Scene scene = solid_scene(solid::corotational(1e6, 0.3), 1);
  scene.analysis = Analysis::dynamic;
  scene.solids[0].second.pose = pose;
  return scene;
}

Model build_row(const Scene& scene) {
  return build(scene, [](const auto&) { return row(); });
}

std::vector<int> held_by(const Region& region, double scale = 1.0) {
  Scene scene = scene_of();
  scene.solids[0].second.scale = scale;
  hold(scene, region);
  const Model model = build_row(scene);
  std::vector<int> nodes;
  for (int i = 0; i < model.solids[0].body.nodes(); ++i) {
    if (model.solids[0].body.unknown(0, i) < 0) nodes.push_back(i);
  }
  return nodes;
}

TEST(Region, is_given_before_the_pose_or_in_the_world) {
  const auto last = ElementsAre(3, 7, 11, 15);
  EXPECT_THAT(held_by(Box{Vec3(2.5, -1, -1), Vec3(4, 2, 2), In::object}), last);
  EXPECT_THAT(held_by(Box{Vec3(8, 2.5, -1), Vec3(11, 4, 2), In::world}), last);
  EXPECT_THAT(held_by(Sphere{Vec3(3, 0, 0), 1.0, In::object}), ElementsAre(2, 3, 7, 11));
  EXPECT_THAT(held_by(Sphere{Vec3(10, 3, 0), 1.0, In::world}), ElementsAre(2, 3, 7, 11));
  EXPECT_THAT(held_by(Plane{Vec3(3, 9, 9), Vec3(2, 0, 0), {}, In::object}), last);
  EXPECT_THAT(held_by(Plane{Vec3(9, 3, 9), Vec3(0, -2, 0), {}, In::world}), last);
  EXPECT_THAT(held_by(Plane{Vec3(3, 0, 0), Vec3(1, 0, 0), 1.0, In::object}), ElementsAre(2, 3, 6, 7, 10, 11, 14, 15));
  EXPECT_THAT(held_by(NodeNumbers{{5, 0}}), ElementsAre(0, 5));
  EXPECT_THAT(held_by(GroupName{"edge"}), ElementsAre(3, 7));
}

TEST(Region, takes_nodes_on_its_border_however_they_are_rounded) {
  // 3 * 0.1 is more than 0.3.
  EXPECT_THAT(held_by(Sphere{Vec3(0.2, 0, 0), 0.1}, 0.1), ElementsAre(1, 2, 3, 6, 10));
  EXPECT_THAT(held_by(Box{Vec3(0.25, 0, 0), Vec3(0.3, 0.1, 0.1)}, 0.1), ElementsAre(3, 7, 11, 15));
}

/// Of the pressure on a region, the middles of its faces.
std::vector<Vec3> pressed(const Region& region) {
  Scene scene = scene_of({});
  load_solid(scene, region, Vec3::Zero(), 1.0);
  const Model model = build_row(scene);
  std::vector<Vec3> middles;
  for (const solid::CellFace& face : std::get<SolidLoadModel>(model.loads[0].on).faces) {
    Vec3 sum = Vec3::Zero();
    for (const int node : face.nodes()) sum += model.solids[0].body.rest.col(node);
    middles.emplace_back(sum / face.count);
  }
  return middles;
}

std::vector<int> materials(const Region& region) {
  Scene scene = scene_of({});
  scene.solids[0].second.parts.push_back({region, scene.solids[0].second.material});
  return build_row(scene).solids[0].body.material;
}

TEST(Region, of_a_group_has_the_faces_and_cells_that_the_file_lists) {
  EXPECT_THAT(materials(GroupName{"ends"}), ElementsAre(1, 0, 1));
  EXPECT_THAT(materials(Box{Vec3(-1, -1, -1), Vec3(2, 2, 2)}), ElementsAre(1, 1, 0));
  const std::vector<Vec3> ends = pressed(GroupName{"ends"});
  EXPECT_EQ(ends.size(), 10u);  // none of the cell between them
  for (const Vec3& x : ends) EXPECT_NE(x.x(), 1.5);
  EXPECT_THAT(pressed(GroupName{"first"}), ElementsAre(Vec3(0, 0.5, 0.5)));  // of two faces the one outside
  EXPECT_THAT(pressed(GroupName{"both"}), ElementsAre(Vec3(3, 0.5, 0.5)));
  EXPECT_EQ(pressed(WholeSurface{}).size(), 14u);
  EXPECT_EQ(pressed(Box{Vec3(-1, -1, -1), Vec3(1, 2, 2)}).size(), 5u);

  Scene scene = scene_of({});
  scene.solids[0].second.parts.push_back({GroupName{"first"}, {}});
  scene.solids[0].second.parts[0].material.law = solid::corotational(1e6, 0.3);
  expect_rejected(scene, row(), "solids.solid.parts.0", "no cell of the mesh belongs");
}

TEST(Region, without_a_face_shares_a_force_equally_and_takes_no_pressure) {
  Scene scene = scene_of({});
  load_solid(scene, GroupName{"edge"}, Vec3(0, 0, 6));
  const Eigen::Matrix3Xd force = std::get<SolidLoadModel>(build_row(scene).loads[0].on).force;
  EXPECT_EQ(force.col(3), Vec3(0, 0, 3));
  EXPECT_EQ(force.col(7), Vec3(0, 0, 3));
  EXPECT_EQ(force.sum(), 6.0);
  load_solid(scene, GroupName{"edge"}, Vec3::Zero(), 1.0);
  expect_rejected(scene, row(), "loads.load1", "no face of the surface belongs");
}

TEST(Region, of_faces_inside_the_body_takes_no_load_and_no_springs) {
  for (const double pressure : {0.0, 1.0}) {
    Scene scene = scene_of({});
    load_solid(scene, GroupName{"inner"}, Vec3(0, 0, 1.0 - pressure), pressure);
    expect_rejected(scene, row(), "loads.load0.group", "none of its faces is on the boundary");
  }
  Scene scene = scene_of({});
  scene.solids[0].second.springs.push_back({GroupName{"inner"}, Vec3::Ones()});
  expect_rejected(scene, row(), "solids.solid.springs.0.group", "none of its faces is on the boundary");
}

}  // namespace
}  // namespace sinew::test
