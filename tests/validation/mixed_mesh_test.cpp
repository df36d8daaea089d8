// Meshes of several kinds of elements, and tetrahedra raised to 10 nodes on the way in.
#include <filesystem>
#include <fstream>

#include "sinew/error/input_error.hpp"
#include "sinew/io/mesh_file.hpp"
#include "sinew/sim/view.hpp"
#include "sinew/solid/laws.hpp"
#include "validation/solids.hpp"

namespace sinew::test {
namespace {

namespace fs = std::filesystem;
using solid::Kind;
using solid::Mat3;

const solid::OgdenTerm kRubber[] = {{6.3e5, 1.3}, {1.2e3, 5.0}, {-1e4, -2.0}};
const std::pair<const char*, solid::Law> kLaws[] = {
    {"corotational", solid::corotational(1e6, 0.4)},
    {"saint_venant_kirchhoff", solid::saint_venant_kirchhoff(1e6, 0.4)},
    {"neo_hookean", solid::neo_hookean(1e6, 0.45)},
    {"mooney_rivlin", solid::mooney_rivlin(1.2e5, 0.5e5, solid::Poisson{0.45})},
    {"ogden", solid::ogden(kRubber, solid::Bulk{2e6})}};

const Vec3 kSize(40 * mm, 20 * mm, 10 * mm);

/// A block whose inner nodes are out of place, of tetrahedra with 4 nodes and beyond half its length with 10.
solid::Mesh mixed_block() {
  solid::Mesh mesh = block_mesh(4, 3, 3, kSize);
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) {
    const Eigen::Array3d x = mesh.nodes.col(i).cwiseQuotient(kSize).array();
    if ((x < 0.01).any() || (x > 0.99).any() || std::abs(x[0] - 0.5) < 0.01) continue;
    for (int a = 0; a < 3; ++a)
      mesh.nodes(a, i) += 0.8 * mm * std::sin(2.3 * static_cast<double>((i + 1) * (2 * a + 1)));
  }
  return half_quadratic(mesh);
}

Model build_of(const Scene& scene, const solid::Mesh& mesh) {
  return build(scene, [&mesh](const fs::path&) { return mesh; });
}

std::map<Kind, int> kinds(const Model& model) {
  std::map<Kind, int> count;
  for (const solid::Cell& cell : model.solids[0].body.cells) ++count[cell.kind];
  return count;
}

/// What is said about a mesh that is refused.
InputFault fault_of(const Scene& scene, const solid::Mesh& mesh) {
  try {
    build_of(scene, mesh);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    return error.fault();
  }
  return {};
}

/// First Piola-Kirchhoff stress along x of a bar stretched by l, free across, and its stretch there.
std::pair<double, double> uniaxial(const solid::Law& law, double l) {
  const auto stress = [&](double t) {
    return solid::density(law, Vec3(l, t, t).asDiagonal(), solid::Derivatives::first).first;
  };
  double low = 0.5, high = 1.0;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.5 * (low + high);
    (stress(t)(1, 1) < 0.0 ? low : high) = t;
  }
  return {stress(low)(0, 0), low};
}

TEST(MixedMesh, passes_the_patch_test) {
  const solid::Mesh mesh = mixed_block();
  for (const auto& [name, law] : kLaws) {
    SCOPED_TRACE(name);
    Scene scene = solid_scene(law);
    hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
    const Model model = build_of(scene, mesh);
    EXPECT_EQ(kinds(model), (std::map<Kind, int>{{Kind::tet10, 216}}));
    const solid::Body& body = model.solids[0].body;
    const Mat3 F{{1.2, 0.1, 0.0}, {-0.05, 0.9, 0.1}, {0.1, 0.0, 1.05}};
    const Eigen::Matrix3Xd x = F * body.rest, f = solid::elastic_force(body, x);
    int inside = 0;
    for (Eigen::Index i = 0; i < f.cols(); ++i) {
      const Eigen::Array3d at = body.rest.col(i).cwiseQuotient(kSize).array();
      if ((at < 1e-9).any() || (at > 1 - 1e-9).any()) continue;
      ++inside;
      EXPECT_LT(f.col(i).norm(), 1e-12 * f.norm()) << i;
    }
    EXPECT_GT(inside, 100);
  }
}

/// Equilibrium, not only balance where it should be: the seam would give way if its nodes were not tied.
TEST(MixedMesh, stretches_as_one_body) {
  constexpr double stretch = 1.2;
  const solid::Mesh mesh = mixed_block();
  for (const auto& [name, law] : kLaws) {
    SCOPED_TRACE(name);
    Scene scene = solid_scene(law);
    scene.frames.emplace_back(
        "grip", Frame{{}, FrameMotion{{0.0, 1.0}, {}, {Vec3::Zero(), (stretch - 1) * kSize.x() * Vec3::UnitX()}}});
    hold(scene, plane(Vec3::Zero(), Vec3::UnitX()), {true, false, false});
    hold(scene, plane(kSize, Vec3::UnitX()), {true, false, false}).frame = "grip";
    Box no_end{Vec3::Zero(), Vec3(kSize.x() - mm, 0, kSize.z())};
    hold(scene, no_end, {false, true, false});
    no_end.upper = Vec3(kSize.x() - mm, kSize.y(), 0);
    hold(scene, no_end, {false, false, true});
    Output reaction;
    reaction.solid = "solid";
    reaction.quantity = Quantity::reaction;
    reaction.region = plane(Vec3::Zero(), Vec3::UnitX());
    scene.outputs.emplace_back("pull", reaction);
    const SolvedSolid solved = solve(scene, mesh);
    const auto [stress, across] = uniaxial(law, stretch);
    const double exact = -stress * kSize.y() * kSize.z();
    const double held = signal_values(solved.model, solved.end())[0];
    std::cout << name << ": reaction over the exact one, less 1: " << held / exact - 1 << "\n";
    EXPECT_NEAR(held, exact, 1e-8 * std::abs(exact));
    const Eigen::Matrix3Xd& rest = solved.model.solids[0].body.rest;
    const Eigen::Matrix3Xd error = solved.end().solids[0].x - Vec3(stretch, across, across).asDiagonal() * rest;
    EXPECT_LT(error.colwise().norm().maxCoeff(), 1e-8 * kSize.norm());
  }
}

TEST(MixedMesh, says_that_it_raised_the_order) {
  Scene scene = solid_scene(kLaws[0].second);
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
  const solid::Mesh linear = block_mesh(4, 1, 1, kSize), mixed = half_quadratic(linear);
  const Model raised = build_of(scene, mixed);
  ASSERT_EQ(raised.warnings.size(), 1u);
  EXPECT_NE(to_string(raised.warnings[0]).find("solids.solid.mesh: "), std::string::npos);
  EXPECT_NE(to_string(raised.warnings[0]).find(std::to_string(solid::meeting_orders(mixed.cells)) + " 4-node"),
            std::string::npos);
  EXPECT_NE(to_string(raised.warnings[0]).find("(12)"), std::string::npos) << to_string(raised.warnings[0]);
  EXPECT_EQ(kinds(build_of(scene, linear)), (std::map<Kind, int>{{Kind::tet4, 24}}));
  scene.solids[0].second.order = 2;
  for (const solid::Mesh& mesh : {linear, mixed}) {
    const Model asked = build_of(scene, mesh);
    EXPECT_TRUE(asked.warnings.empty());
    EXPECT_EQ(kinds(asked), (std::map<Kind, int>{{Kind::tet10, 24}}));
    EXPECT_EQ(asked.solids[0].body.nodes(), raised.solids[0].body.nodes());
  }
  for (const int order : {0, 3}) {
    scene.solids[0].second.order = order;
    EXPECT_EQ(fault_of(scene, linear).path, "solids.solid.order");
  }
}

/// 10-node tetrahedra with edges so bent that neighbours which follow them are folded.
TEST(MixedMesh, is_refused_if_raising_folds_it) {
  Scene scene = solid_scene(kLaws[0].second);
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
  const solid::Mesh linear = block_mesh(4, 1, 1, kSize);
  solid::Mesh mesh = half_quadratic(linear);
  for (Eigen::Index i = linear.nodes.cols(); i < mesh.nodes.cols(); ++i) {
    if (std::abs(mesh.nodes(0, i) - 0.5 * kSize.x()) < 1e-9) mesh.nodes(0, i) -= 12 * mm;
  }
  const InputFault fault = fault_of(scene, mesh);
  EXPECT_EQ(fault.path, "solids.solid.mesh");
  EXPECT_NE(fault.rule.find("folded"), std::string::npos) << fault.rule;
}

TEST(MixedMesh, of_hexahedra_on_tetrahedra_is_refused) {
  Scene scene = solid_scene(kLaws[0].second);
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
  solid::Mesh mesh = block_mesh(4, 1, 1, kSize, Kind::hex8);
  const solid::Mesh others = block_mesh(4, 1, 1, kSize);
  mesh.cells.erase(mesh.cells.begin() + 2, mesh.cells.end());
  mesh.cells.insert(mesh.cells.end(), others.cells.begin() + 12, others.cells.end());
  const InputFault fault = fault_of(scene, mesh);
  EXPECT_EQ(fault.path, "solids.solid.mesh");
  EXPECT_NE(fault.value.find("cells 1 (8-node hexahedron) and "), std::string::npos) << fault.value;
  EXPECT_NE(fault.value.find("(4-node tetrahedron)"), std::string::npos) << fault.value;
  EXPECT_NE(fault.remedy.find("same kind of element"), std::string::npos) << fault.remedy;
}

TEST(MixedMesh, with_edges_of_two_middles_is_refused) {
  Scene scene = solid_scene(kLaws[0].second);
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
  solid::Mesh mesh = block_mesh(2, 1, 1, kSize, Kind::tet10);
  const Eigen::Index nodes = mesh.nodes.cols();
  mesh.nodes.conservativeResize(3, nodes + 1);
  int& node = mesh.cells[0].node[4];
  mesh.nodes.col(nodes) = mesh.nodes.col(node);
  node = static_cast<int>(nodes);
  EXPECT_NE(fault_of(scene, mesh).rule.find("the node in its middle"), std::string::npos);
}

TEST(MixedMesh, of_pieces_apart_does_what_each_does_alone) {
  const solid::Mesh bricks = block_mesh(6, 2, 1, kSize, Kind::hex8);
  solid::Mesh others = block_mesh(4, 1, 1, kSize);
  others.nodes.row(1).array() += 2 * kSize.y();
  const auto end = [](const solid::Mesh& mesh, int order) {
    Scene scene = solid_scene(kLaws[2].second);
    scene.gravity = Vec3(0, 0, -9.81);
    scene.solids[0].second.order = order;
    hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
    return solve(scene, mesh);
  };
  for (const int order : {1, 2}) {
    const SolvedSolid both = end(together(bricks, others), order);
    EXPECT_TRUE(find_warning(both.model.warnings, "mesh_pieces", "solids.solid.mesh"));
    EXPECT_EQ(both.model.warnings.size(), static_cast<std::size_t>(order));  // and that hexahedra are not raised
    const Vec3 of_bricks(40 * mm, 10 * mm, 5 * mm), of_others(40 * mm, 50 * mm, 5 * mm);
    const Vec3 alone = end(bricks, 1).moved(of_bricks), beside = end(others, order).moved(of_others);
    EXPECT_LT((both.moved(of_bricks) - alone).norm(), 1e-7 * alone.norm());
    EXPECT_LT((both.moved(of_others) - beside).norm(), 1e-7 * beside.norm());
    EXPECT_GT((alone - beside).norm(), 1e-3 * alone.norm());
  }
}

/// Node numbers are those of the file; with an edge, a face or a cell comes what raising put on it.
TEST(RaisedMesh, is_held_and_loaded_by_the_nodes_of_the_file) {
  solid::Mesh mesh = block_mesh(3, 2, 2, kSize);
  mesh.nodes.conservativeResize(3, mesh.nodes.cols() + 1);
  for (Eigen::Index i = mesh.nodes.cols() - 1; i > 5; --i) mesh.nodes.col(i) = mesh.nodes.col(i - 1).eval();
  for (solid::Cell& cell : mesh.cells) {  // node 5 is one that no cell uses
    for (std::size_t i = 0; i < 4; ++i) cell.node[i] += cell.node[i] >= 5 ? 1 : 0;
  }
  mesh.nodes.col(5).setConstant(7.0);
  const auto root = [](const Vec3& x) { return std::abs(x.x()) < 1e-9; };
  const auto end = [](const Vec3& x) { return std::abs(x.x() - kSize.x()) < 1e-9; };
  const auto bent = [&](const Region& held, const Region& loaded) {
    Scene scene = solid_scene(kLaws[2].second);
    scene.solids[0].second.order = 2;
    hold(scene, held);
    load_solid(scene, loaded, Vec3(0, 0, 0.1), 500.0);
    return solve(scene, mesh);
  };
  const SolvedSolid listed = bent(nodes_where(mesh, root), nodes_where(mesh, end)),
                    swept = bent(plane(Vec3::Zero(), Vec3::UnitX()), plane(kSize, Vec3::UnitX()));
  EXPECT_EQ(listed.model.solids[0].held(), swept.model.solids[0].held());
  EXPECT_EQ(listed.end().solids[0].x, swept.end().solids[0].x);
  EXPECT_GT((listed.end().solids[0].x - listed.model.solids[0].body.rest).norm(), mm);
  Scene scene = solid_scene(kLaws[2].second);
  scene.solids[0].second.order = 2;
  hold(scene, NodeNumbers{{static_cast<int>(mesh.nodes.cols())}});
  EXPECT_EQ(fault_of(scene, mesh).path, "solids.solid.fixed.nodes");  // a raised node has no number
  scene.solids[0].second.fixed = {{NodeNumbers{{5}}}};
  EXPECT_NE(fault_of(scene, mesh).rule.find("no element"), std::string::npos);
}

/// Cables, anchors and outputs sit in the raised elements; a mesh that is mixed ends where a raised one does.
TEST(RaisedMesh, carries_cables_as_a_mesh_of_10_node_tetrahedra_does) {
  Scene scene = cable_block();
  scene.time.duration = 0.05;
  const solid::Mesh linear = read_block("");
  scene.solids[0].second.order = 1;
  const Model native = build_of(scene, solid::quadratic(linear)), mixed = build_of(scene, half_quadratic(linear)),
              coarse = build_of(scene, linear);
  scene.solids[0].second.order = 2;
  const Model raised = build_of(scene, linear);
  EXPECT_EQ(raised.points.size(), native.points.size());
  const auto pulled = [](const Model& model) {
    const Trace trace = run_all(model);
    EXPECT_EQ(trace.end, RunEnd::done);
    return tip(model, trace.states.back());
  };
  const Vec3 at = pulled(raised);
  EXPECT_EQ(at, pulled(native));
  EXPECT_LT((at - pulled(mixed)).norm(), 1e-8 * mm);
  EXPECT_GT((at - pulled(coarse)).norm(), 0.01 * mm);
  const Snapshot seen = snapshot(raised, initial_state(raised), "");
  EXPECT_EQ(seen.solids[0].cells[0].kind, Kind::tet10);
  EXPECT_EQ(seen.solids[0].nodes.cols(), solid::quadratic(linear).nodes.cols());
}

/// Legacy VTK, 10-node tetrahedra.
void write_tetrahedra(const fs::path& path, const solid::Mesh& mesh) {
  std::ofstream out(path);
  out.precision(17);
  out << "# vtk DataFile Version 2.0\nraised\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << mesh.nodes.cols()
      << " double\n"
      << mesh.nodes.transpose() << "\nCELLS " << mesh.cells.size() << " " << 11 * mesh.cells.size() << "\n";
  for (const solid::Cell& cell : mesh.cells) {
    out << 10;
    for (const int node : cell.nodes()) out << " " << node;
    out << "\n";
  }
  out << "CELL_TYPES " << mesh.cells.size() << "\n";
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) out << "24\n";
}

TEST(RaisedMesh, bends_the_finger_further_and_as_a_file_of_10_node_tetrahedra) {
  const fs::path file = fs::path(SINEW_SOURCE_DIR) / "examples/meshes/finger.vtk",
                 written = fs::temp_directory_path() / "sinew_raised_finger.vtk";
  write_tetrahedra(written, solid::quadratic(io::read_mesh(file)));
  const auto bent = [](const fs::path& path, int order) {
    Scene scene = solid_scene(solid::neo_hookean(600e3, 0.45));
    Solid& finger = scene.solids[0].second;
    finger.scale = 1e-3;
    finger.order = order;
    hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
    load_solid(scene, plane(Vec3(95 * mm, 0, 0), Vec3::UnitX()), Vec3(0, 0, -0.01));
    return solve(scene, io::read_mesh(path)).moved(Vec3(95 * mm, 0, 0));
  };
  const Vec3 coarse = bent(file, 1), raised = bent(file, 2), native = bent(written, 1);
  std::cout << "finger: order 1 bends by " << -1e3 * coarse.z() << " mm, order 2 by " << -1e3 * raised.z() << " mm\n";
  EXPECT_LT(raised.z(), 1.1 * coarse.z());
  EXPECT_LT((raised - native).norm(), 1e-9 * raised.norm());
  fs::remove(written);
}

TEST(RaisedMesh, does_not_lock) {
  Scene scene = solid_scene(solid::corotational(1e6, 0.495));
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
  const solid::Mesh mesh = block_mesh(2, 1, 1, kSize);
  const Model model = build_of(scene, mesh);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(to_string(model.warnings[0]).find("set `order: 2`"), std::string::npos) << to_string(model.warnings[0]);
  scene.solids[0].second.order = 2;
  EXPECT_TRUE(build_of(scene, mesh).warnings.empty());
}

}  // namespace
}  // namespace sinew::test
