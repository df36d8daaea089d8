#include "sinew/io/mesh_cells.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "io/mesh_faults.hpp"
#include "io/mesh_writers.hpp"
#include "sinew/solid/mesh_summary.hpp"

namespace sinew::io {
namespace {

using samples::Form;
using samples::Sample;
using solid::Kind;
using testing::HasSubstr;

/// A unit cube (nodes 0 to 7), a 10-node tetrahedron with straight edges (8 to 17), a 4-node one beside the cube (18),
/// a node that nobody uses, and cells of lower dimension.
Sample every_kind() {
  Sample sample;
  sample.coordinates = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1, 3, 0,   0,   5, 0, 0,
                        3, 4, 0, 3, 0, 6, 4, 0, 0, 4, 2, 0, 3, 2, 0, 3, 0, 3, 4, 0, 3, 3, 2, 3, 2, 0.5, 0.5, 9, 9, 9};
  sample.cells = {{12, {0, 1, 2, 3, 4, 5, 6, 7}, {1}},
                  {13, {0, 1, 2, 4, 5, 6}, {1}},
                  {9, {0, 3, 2, 1}, {3}},
                  {9, {4, 5, 6, 7}, {}},
                  {10, {1, 2, 6, 18}, {}},
                  {3, {0, 1}, {4}},
                  {21, {8, 9, 12}, {4}},
                  {24, {8, 9, 10, 11, 12, 13, 14, 15, 16, 17}, {1}},
                  {22, {8, 10, 9, 14, 13, 12}, {3}},
                  {5, {0, 1, 2}, {}},
                  {1, {6}, {5}},
                  {3, {1, 2}, {}},
                  {1, {7}, {}}};
  for (std::size_t i = 0; i < sample.points(); ++i) sample.tags.push_back(100 - 3 * static_cast<int>(i));
  return sample;
}

const solid::Cell kCube = {Kind::hex8, {0, 1, 2, 3, 4, 5, 6, 7}};
const solid::Cell kBeside = {Kind::tet4, {1, 2, 6, 18}};
const solid::Cell kCurved = {Kind::tet10, {8, 9, 10, 11, 12, 13, 14, 15, 16, 17}};
constexpr std::array<std::array<int, 2>, 6> kEdges = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

solid::Mesh mesh_of(const Sample& sample) { return parse_mesh(samples::legacy_vtk(Form::text, false, sample), "mesh"); }

/// The sample with the cells of one type only.
Sample only(int type) {
  Sample sample = every_kind();
  std::erase_if(sample.cells, [type](const samples::Cell& cell) { return cell.type != type; });
  return sample;
}

void move(Sample& sample, std::size_t node, const Eigen::Vector3d& to) {
  std::copy(to.begin(), to.end(), sample.coordinates.begin() + 3 * static_cast<std::ptrdiff_t>(node));
}

TEST(MeshCells, AreTheSameInEveryFormat) {
  const Sample sample = every_kind();
  for (const samples::File& file : samples::all_files(sample)) {
    SCOPED_TRACE(file.name);
    const solid::Mesh mesh = parse_mesh(file.bytes, "mesh");
    EXPECT_EQ(mesh.nodes, Eigen::Map<const Eigen::Matrix3Xd>(sample.coordinates.data(), 3, 20));
    EXPECT_EQ(mesh.cells, (std::vector<solid::Cell>{kCube, kBeside, kCurved}));
    EXPECT_EQ(mesh.ignored, (std::map<std::string, int>{
                                {"wedge", 1}, {"quadrilateral", 1}, {"triangle", 1}, {"line", 1}, {"vertex", 1}}));
    ASSERT_EQ(mesh.groups.size(), 4u);
    EXPECT_EQ(mesh.groups.at("1").cells, (std::vector<int>{0, 2}));
    EXPECT_EQ(mesh.groups.at("1").nodes.size(), 18u);
    EXPECT_TRUE(mesh.groups.at("1").faces.empty());
    EXPECT_EQ(mesh.groups.at("3").faces,
              (std::vector<solid::CellFace>{{4, {0, 3, 2, 1}}, {6, {8, 10, 9, 14, 13, 12}}}));
    EXPECT_EQ(mesh.groups.at("3").nodes, (std::vector<int>{0, 1, 2, 3, 8, 9, 10, 12, 13, 14}));
    EXPECT_EQ(mesh.groups.at("4").nodes, (std::vector<int>{0, 1, 8, 9, 12}));
    EXPECT_EQ(mesh.groups.at("5").nodes, std::vector<int>{6});
    for (const char* name : {"3", "4", "5"}) EXPECT_TRUE(mesh.groups.at(name).cells.empty());
    for (const char* name : {"4", "5"}) EXPECT_TRUE(mesh.groups.at(name).faces.empty());
  }
}

TEST(MeshCells, AreTheSameInEveryFormatOneKindAlone) {
  const std::vector<std::pair<int, solid::Cell>> kinds = {{10, kBeside}, {12, kCube}, {24, kCurved}};
  for (const auto& [type, cell] : kinds) {
    for (const samples::File& file : samples::all_files(only(type))) {
      const solid::Mesh mesh = parse_mesh(file.bytes, "mesh");
      EXPECT_EQ(mesh.cells, std::vector<solid::Cell>{cell}) << file.name;
      EXPECT_TRUE(mesh.ignored.empty()) << file.name;
    }
  }
}

TEST(MeshCells, VoxelsBecomeHexahedraAndPixelsQuadrilaterals) {
  Sample sample = only(12);
  sample.cells = {{11, {0, 1, 3, 2, 4, 5, 7, 6}, {}}, {8, {0, 1, 3, 2}, {7}}};
  for (const std::string& bytes : {samples::legacy_vtk(Form::binary, true, sample), samples::vtu({}, sample)}) {
    const solid::Mesh mesh = parse_mesh(bytes, "mesh");
    EXPECT_EQ(mesh.cells, std::vector<solid::Cell>{kCube});
    EXPECT_NEAR(solid::volume(mesh.nodes, mesh.cells[0]), 1.0, 1e-15);
    EXPECT_EQ(mesh.groups.at("7").faces, (std::vector<solid::CellFace>{{4, {0, 1, 2, 3}}}));
  }
}

/// What Gmsh 4.15 writes of one 10-node tetrahedron.
TEST(MeshCells, NodesOfGmshStandInTheMiddleOfTheirEdges) {
  const std::string two =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n1 0 0 0\n2 2 0 0\n3 0 4 0\n4 0 0 6\n5 1 0 0\n6 1 2 0\n7 0 2 "
      "0\n"
      "8 0 0 3\n9 0 2 3\n10 1 0 3\n$EndNodes\n$Elements\n1\n1 11 2 0 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n";
  const std::string four =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 2 4 6 0 0 \n$EndEntities\n$Nodes\n1 10 1 10\n"
      "3 1 0 10\n1\n2\n3\n4\n5\n6\n7\n8\n9\n10\n0 0 0\n2 0 0\n0 4 0\n0 0 6\n1 0 0\n1 2 0\n0 2 0\n0 0 3\n0 2 3\n1 0 3\n"
      "$EndNodes\n$Elements\n1 1 1 1\n3 1 11 1\n1 1 2 3 4 5 6 7 8 9 10 \n$EndElements\n";
  for (const std::string& text : {two, four}) {
    const solid::Mesh mesh = parse_mesh(text, "mesh");
    ASSERT_EQ(mesh.cells.size(), 1u);
    for (std::size_t e = 0; e < kEdges.size(); ++e) {
      const auto place = [&](std::size_t k) { return mesh.nodes.col(mesh.cells[0].node[k]); };
      const auto [a, b] = kEdges[e];
      EXPECT_EQ(place(4 + e), 0.5 * (place(static_cast<std::size_t>(a)) + place(static_cast<std::size_t>(b)))) << e;
    }
    EXPECT_NEAR(solid::volume(mesh.nodes, mesh.cells[0]), 8.0, 1e-12);
  }
}

TEST(MeshCells, ThatStandTwiceAreOne) {
  Sample sample = every_kind();
  sample.cells.insert(sample.cells.begin(), {10, {1, 2, 6, 18}, {8}});
  sample.cells.push_back({12, {0, 1, 2, 3, 4, 5, 6, 7}, {9}});
  sample.cells.push_back({10, {2, 6, 1, 18}, {9}});  // the same tetrahedron in another order is left to check_mesh
  const solid::Mesh mesh = mesh_of(sample);
  ASSERT_EQ(mesh.cells.size(), 4u);
  EXPECT_EQ(mesh.cells[0], kBeside);
  EXPECT_EQ(mesh.cells[1], kCube);
  EXPECT_EQ(mesh.cells[2], kCurved);
  EXPECT_EQ(mesh.groups.at("1").cells, (std::vector<int>{1, 2}));
  EXPECT_EQ(mesh.groups.at("8").cells, std::vector<int>{0});
  EXPECT_EQ(mesh.groups.at("9").cells, (std::vector<int>{1, 3}));
}

TEST(MeshCells, WantTheNodesOfTheirKind) {
  const auto with = [](int type, int nodes, int group) {
    Sample sample = only(10);
    sample.cells.push_back({type, {}, {}});
    if (group != 0) sample.cells.back().groups = {group};
    for (int i = 0; i < nodes; ++i) sample.cells.back().nodes.push_back(i);
    return samples::legacy_vtk(Form::text, false, sample);
  };
  expect_fault(with(10, 10, 0), 15, "10 nodes", "tetrahedron in cell 1 (0-based) must have 4 nodes");
  expect_fault(with(24, 4, 0), 15, "4 nodes", "quadratic tetrahedron in cell 1 (0-based) must have 10 nodes");
  expect_fault(with(12, 20, 0), 15, "20 nodes", "hexahedron in cell 1 (0-based) must have 8 nodes");
  expect_fault(with(11, 7, 0), 15, "7 nodes", "voxel in cell 1 (0-based) must have 8 nodes");
  expect_fault(with(5, 4, 3), 15, "4 nodes", "triangle in cell 1 (0-based) must have 3 nodes");
  EXPECT_EQ(parse_mesh(with(5, 4, 0), "mesh").ignored.at("triangle"), 1);  // nobody uses it
  EXPECT_EQ(parse_mesh(with(4, 6, 3), "mesh").groups.at("3").nodes, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(parse_mesh(with(25, 20, 3), "mesh").ignored.at("quadratic hexahedron"), 1);
  EXPECT_EQ(parse_mesh(with(99, 20, 3), "mesh").ignored.at("VTK cell type 99"), 1);
  const std::string gmsh = samples::gmsh_2(Form::text, std::endian::little, only(24));
  expect_fault(replaced(gmsh, " 49 52 ", " 49 "), 56, "\"$EndElements\"", "whole number");
}

TEST(MeshCells, WantNodesInRange) {
  const std::string vtk = samples::legacy_vtk(Form::text, false, only(24));
  expect_fault(replaced(vtk, "16 17", "16 20"), 13, "20", "node number in cell 0 (0-based) must be from 0 to 19");
  Sample faces = every_kind();
  faces.cells[2].nodes[3] = 20;
  for (const bool five : {false, true}) {
    const InputFault fault = fault_of(samples::legacy_vtk(Form::text, five, faces));
    EXPECT_EQ(fault.value, "20");
    EXPECT_THAT(fault.rule, HasSubstr("cell 2 (0-based) must be from 0 to 19"));
  }
  faces.cells[2].groups.clear();
  EXPECT_NO_THROW(mesh_of(faces));  // nobody uses it
  Sample gmsh = only(24);
  gmsh.cells.push_back({22, {8, 10, 9, 14, 13, 12}, {3}});
  for (const std::string& text : {samples::gmsh_2(Form::text, std::endian::little, gmsh),
                                  samples::gmsh_4(Form::text, std::endian::little, gmsh)}) {
    const InputFault fault = fault_of(replaced(text, "76 70 73 58 61 64", "76 70 73 58 61 1"));
    EXPECT_EQ(fault.value, "node tag 1");
    EXPECT_THAT(fault.rule,
                HasSubstr("element 1 (0-based, counting used elements only), a quadratic triangle, must be"));
  }
}

TEST(CheckCells, RefusesANodeThatStandsTwice) {
  solid::Mesh mesh = mesh_of(every_kind());
  mesh.cells[0].node[7] = 4;
  const InputFault hexahedron = check_fault(mesh);
  EXPECT_EQ(hexahedron.value, "node 4 twice");
  EXPECT_THAT(hexahedron.rule, HasSubstr("cell 0 (0-based, counting used cells only), an 8-node hexahedron, must all"));
  EXPECT_THAT(hexahedron.remedy, HasSubstr("split it into tetrahedra"));
  mesh.cells = {kCurved, kBeside};
  mesh.cells[1].node = {1, 2, 6, 1};
  EXPECT_THAT(check_fault(mesh).rule, HasSubstr("cell 1 (0-based, counting used cells only), a 4-node tetrahedron"));
  mesh.cells = {kCurved};
  mesh.cells[0].node[9] = 8;
  EXPECT_EQ(check_fault(mesh).value, "node 8 twice");
}

TEST(CheckCells, WantsNodeNumbersInRange) {
  for (const int node : {-1, 20}) {
    solid::Mesh mesh = mesh_of(every_kind());
    mesh.cells[2].node[9] = node;
    EXPECT_EQ(check_fault(mesh).value, std::to_string(node));
    EXPECT_THAT(check_fault(mesh).rule, HasSubstr("10-node tetrahedron, must be from 0 to 19"));
  }
}

TEST(CheckCells, RefusesAFoldedTetrahedron) {
  Sample sample = every_kind();
  move(sample, 12, {4, 0.3, 0});  // from the middle of an edge of length 2
  EXPECT_NO_THROW(mesh_of(sample));
  move(sample, 12, {4.6, 0, 0});  // beyond a quarter from the end the edge turns back
  const InputFault fault = fault_of(samples::vtu({}, sample));
  EXPECT_THAT(fault.value, HasSubstr("relative Jacobian -"));
  EXPECT_THAT(fault.value, HasSubstr("cell 2 (0-based, counting used cells only), a 10-node tetrahedron"));
  EXPECT_THAT(fault.rule, HasSubstr("a curved or twisted element must not be folded"));
  EXPECT_THAT(fault.rule, HasSubstr("1 of 1 are folded"));
  EXPECT_THAT(fault.remedy, HasSubstr("straighten its edges"));
}

TEST(CheckCells, RefusesTheNodesOfATetrahedronInAnotherOrder) {
  Sample sample = only(24);
  std::swap(sample.cells[0].nodes[8], sample.cells[0].nodes[9]);  // Gmsh's order in a VTK file
  EXPECT_THAT(fault_of(samples::vtu({}, sample)).remedy, HasSubstr("another order than that of the file's format"));
}

TEST(CheckCells, RefusesATwistedHexahedron) {
  Sample sample = every_kind();
  std::swap(sample.cells[0].nodes[2], sample.cells[0].nodes[3]);  // a voxel's order
  std::swap(sample.cells[0].nodes[6], sample.cells[0].nodes[7]);
  const InputFault fault = fault_of(samples::vtu({}, sample));
  EXPECT_THAT(fault.value, HasSubstr("cell 0 (0-based, counting used cells only), an 8-node hexahedron"));
  EXPECT_THAT(fault.rule, HasSubstr("must not be folded"));
  EXPECT_THAT(fault.remedy, HasSubstr("another order than that of the file's format"));
  sample = every_kind();
  move(sample, 6, {0.2, 0.2, 0.2});  // pushed in through the diagonal of its neighbours: folded at this corner only
  EXPECT_GT(solid::volume(Eigen::Map<const Eigen::Matrix3Xd>(sample.coordinates.data(), 3, 20), kCube), 0.0);
  EXPECT_THAT(fault_of(samples::vtu({}, sample)).remedy, HasSubstr("less twist"));
  move(sample, 6, {0.8, 0.8, 0.8});
  EXPECT_NO_THROW(mesh_of(sample));
}

TEST(CheckCells, TurnsThoseThatAreAllTheWrongWayRound) {
  for (const int type : {10, 12, 24}) {
    Sample sample = only(type);
    const solid::Mesh right = parse_mesh(samples::vtu({}, sample), "mesh");
    EXPECT_EQ(right.turned, 0);
    for (std::size_t i = 0; i < sample.points(); ++i) sample.coordinates[3 * i + 2] *= -1.0;
    const solid::Mesh turned = parse_mesh(samples::vtu({}, sample), "mesh");
    EXPECT_EQ(turned.turned, 1) << type;
    EXPECT_DOUBLE_EQ(solid::volume(turned.nodes, turned.cells[0]), solid::volume(right.nodes, right.cells[0])) << type;
    EXPECT_NO_THROW(check_mesh(turned, "mesh")) << type;
  }
  Sample sample = only(12);
  sample.cells.push_back(sample.cells[0]);
  for (int i = 0; i < 4; ++i) std::swap(sample.cells[1].nodes[i], sample.cells[1].nodes[i + 4]);
  const InputFault fault = fault_of(samples::vtu({}, sample));
  EXPECT_THAT(fault.value, HasSubstr("cell 1 "));
  EXPECT_THAT(fault.rule, HasSubstr("1 of 2 are folded"));
  EXPECT_THAT(fault.remedy, Not(HasSubstr("wrong way round")));
}

TEST(CheckCells, RefusesCellsWithoutVolume) {
  for (const int type : {12, 24}) {
    Sample sample = only(type);
    for (std::size_t i = 0; i < sample.points(); ++i) sample.coordinates[3 * i + 2] = 0.0;
    EXPECT_THAT(fault_of(samples::vtu({}, sample)).rule, HasSubstr("must not be folded")) << type;
    for (double& x : sample.coordinates) x = 1e200;
    EXPECT_THAT(fault_of(samples::vtu({}, sample)).rule, HasSubstr("must not be folded")) << type;
  }
}

TEST(CheckCells, JudgesAFoldByTheSizeOfTheElement) {
  for (const double scale : {1e-9, 1.0, 1e9}) {
    Sample sample = every_kind();
    for (double& x : sample.coordinates) x *= scale;
    EXPECT_NO_THROW(mesh_of(sample)) << scale;
    for (std::size_t i = 0; i < 8; ++i) sample.coordinates[3 * i + 2] *= 1e-9;  // thin, but not folded
    EXPECT_NO_THROW(
        check_mesh({Eigen::Map<const Eigen::Matrix3Xd>(sample.coordinates.data(), 3, 20), {kCube}, {}, {}, {}}, "mesh"))
        << scale;
  }
}

TEST(CheckCells, NamesTheCellsOfAFileThatHasNoneToUse) {
  Sample sample = every_kind();
  std::erase_if(sample.cells, [](const samples::Cell& c) { return c.type == 10 || c.type == 12 || c.type == 24; });
  for (const samples::File& file : samples::all_files(sample)) {
    const InputFault fault = fault_of(file.bytes);
    EXPECT_EQ(fault.value, "1 line, 1 quadrilateral, 1 triangle, 1 vertex, 1 wedge, 2 faces in groups") << file.name;
    EXPECT_THAT(fault.remedy, HasSubstr("mesh the volume"));
  }
  sample.cells = {{1, {6}, {5}}};
  EXPECT_EQ(fault_of(samples::vtu({}, sample)).value, "lines or points only");
}

}  // namespace
}  // namespace sinew::io
