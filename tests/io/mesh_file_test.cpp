#include "sinew/io/mesh_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "io/mesh_faults.hpp"
#include "io/mesh_writers.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/solid/mesh_summary.hpp"

namespace sinew::io {
namespace {

using samples::Form;
using testing::HasSubstr;

using samples::all_files;
using samples::File;

const std::vector<solid::Cell> kTwoTetrahedra = {{solid::Kind::tet4, {0, 1, 2, 3}}, {solid::Kind::tet4, {1, 2, 3, 4}}};

class Folder : public testing::Test {
 protected:
  Folder() : path_(std::filesystem::temp_directory_path() / fmt::format("sinew_mesh_{}", getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() override { std::filesystem::remove_all(path_); }

  std::filesystem::path write(const File& file) const {
    std::ofstream(path_ / file.name, std::ios::binary) << file.bytes;
    return path_ / file.name;
  }

  std::filesystem::path path_;
};

using ReadMesh = Folder;

TEST_F(ReadMesh, ReadsTheSameMeshFromEveryFormat) {
  for (const File& file : all_files()) {
    SCOPED_TRACE(file.name);
    const solid::Mesh mesh = read_mesh(write(file));
    ASSERT_EQ(mesh.nodes.cols(), 5);
    EXPECT_EQ(mesh.nodes, Eigen::Map<const Eigen::Matrix3Xd>(samples::two_tetrahedra.coordinates.data(), 3, 5));
    EXPECT_EQ(mesh.cells, kTwoTetrahedra);
    EXPECT_TRUE(mesh.groups.empty());
    EXPECT_EQ(mesh.ignored, (std::map<std::string, int>{{"triangle", 1}, {"vertex", 1}}));
  }
}

TEST(ParseMesh, JoinsThePiecesOfAVtu) {
  const std::string text = samples::vtu({});
  const std::size_t begin = text.find("<Piece"), end = text.find("</UnstructuredGrid>");
  const solid::Mesh mesh = parse_mesh(text.substr(0, end) + text.substr(begin), "mesh");
  EXPECT_EQ(mesh.nodes.cols(), 10);
  EXPECT_EQ(mesh.nodes.leftCols(5), mesh.nodes.rightCols(5));
  ASSERT_EQ(mesh.cells.size(), 4u);
  EXPECT_EQ(mesh.cells[1], kTwoTetrahedra[1]);
  EXPECT_EQ(mesh.cells[3], (solid::Cell{solid::Kind::tet4, {6, 7, 8, 9}}));
  EXPECT_EQ(mesh.ignored.at("triangle"), 2);
}

TEST(ParseMesh, ReadsManyElementsBehindOneHeadOfABinaryGmshFile) {
  const auto ints = [](const std::vector<int>& values) {
    return samples::numbers<std::int32_t>(values, Form::binary, std::endian::little);
  };
  const std::string text = samples::gmsh_2(Form::binary);
  const std::string start = text.substr(0, text.find("$Elements")) + "$Elements\n3\n" + ints({15, 1, 0, 1, 7});
  const std::string elements = ints({4, 2, 1}) + ints({2, 9, 7, 3, 100, 5}) + ints({3, 9, 3, 100, 5, 2});
  const solid::Mesh mesh = parse_mesh(start + elements + "\n$EndElements\n", "mesh");
  EXPECT_EQ(mesh.cells, kTwoTetrahedra);
  expect_fault(start + replaced(elements, ints({4, 2, 1}), ints({4, 3, 1})), 0, "3", "at most the 2 elements left");
  expect_fault(start + replaced(elements, ints({4, 2, 1}), ints({4, 2, -1})), 0, "-1", "number of tags");
}

TEST_F(ReadMesh, TellsTheFormatFromTheContentNotFromTheName) {
  EXPECT_EQ(read_mesh(write({"wrong.vtk", samples::gmsh_4(Form::text)})).nodes.cols(), 5);
  EXPECT_EQ(read_mesh(write({"no_ending", samples::vtu({})})).nodes.cols(), 5);
}

TEST_F(ReadMesh, RefusesWhatIsNoMeshFile) {
  const auto message = [](const std::filesystem::path& path) -> std::string {
    try {
      read_mesh(path);
    } catch (const InputError& error) {
      // A path that leads nowhere is a fault of whatever named it; what is wrong inside is a fault of the file.
      const bool inside = std::filesystem::is_regular_file(path);
      EXPECT_EQ(error.fault().file, inside ? path.string() : "");
      if (!inside) {
        EXPECT_EQ(error.fault().value, path.string());
      }
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message(path_ / "missing.vtk"), HasSubstr("does not exist"));
  EXPECT_THAT(message(path_), HasSubstr("is a folder"));
  EXPECT_THAT(message("/dev/null"), HasSubstr("not a regular file"));
  EXPECT_THAT(message(write({"empty.vtk", ""})), HasSubstr("is empty"));
  EXPECT_THAT(message(write({"blank.vtk", " \n\n"})), HasSubstr("must begin with"));
  EXPECT_THAT(message(write({"garbage.msh", std::string(1000, '\x01')})), HasSubstr("must begin with"));
  EXPECT_THAT(message(write({"surface.ply", "ply\nformat ascii 1.0\n"})), HasSubstr("must begin with"));
}

TEST(ReadShippedMesh, FindsTheFingerAndTheTrunk) {
  const std::filesystem::path folder = std::filesystem::path(SINEW_SOURCE_DIR) / "examples/meshes";
  const solid::Mesh finger_mesh = read_mesh(folder / "finger.vtk");
  EXPECT_EQ(finger_mesh.cells.size(), 856u);
  const solid::MeshSummary finger = solid::summarize(finger_mesh);
  EXPECT_EQ(finger.nodes, 284);
  EXPECT_EQ(finger.unused_nodes, 0);
  EXPECT_EQ(finger.lower, Eigen::Vector3d(0, -7.5, -7.5));
  EXPECT_EQ(finger.upper, Eigen::Vector3d(95, 7.5, 7.5));
  // Profile: 95 x 15 less the bevel and five gaps, 5 wide below and 8 above, 10.5 deep; extruded by 15.
  EXPECT_NEAR(finger.volume, 15 * (95 * 15 - 12.5 - 5 * 6.5 * 10.5), 1e-3);
  EXPECT_GT(finger.worst_quality, 0.5);
  const solid::Mesh trunk_mesh = read_mesh(folder / "trunk.vtk");
  EXPECT_EQ(trunk_mesh.cells.size(), 1834u);
  const solid::MeshSummary trunk = solid::summarize(trunk_mesh);
  EXPECT_GT(trunk.worst_quality, 0.5);
}

TEST(ReadForeignMesh, FindsAllCellsOfAFileOfMixedCells) {
  const std::filesystem::path path = std::filesystem::path(SINEW_SOURCE_DIR) / "../shared/meshes/finger.vtk";
  if (!std::filesystem::exists(path)) return;  // its own mesh of mixed cells is in the tests above
  const solid::Mesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.nodes.cols(), 158);
  EXPECT_EQ(mesh.cells.size(), 389u);
  EXPECT_TRUE(mesh.groups.empty());
  EXPECT_EQ(mesh.ignored, (std::map<std::string, int>{{"vertex", 26}, {"line", 88}, {"triangle", 306}}));
  EXPECT_EQ(solid::surface(mesh.cells).size(), 306u);
}

/// How much of a file the mesh needs: what comes later may be missing.
std::size_t needed(const File& file) {
  if (file.name.ends_with(".vtk")) return file.bytes.find("POINT_DATA") - 10;  // less the last digits and blanks
  if (file.name.ends_with(".msh")) return file.bytes.find("$EndElements") + 11;
  return file.bytes.find(file.name.starts_with("appended") ? "\n</AppendedData" : "</VTKFile>");
}

TEST(ParseMesh, RefusesEveryTruncation) {
  for (const File& file : all_files()) {
    SCOPED_TRACE(file.name);
    for (std::size_t size = 0; size < needed(file); ++size) {
      EXPECT_THROW(parse_mesh(file.bytes.substr(0, size), "mesh"), InputError) << size << " of " << file.bytes.size();
    }
  }
}

TEST(ParseMesh, SurvivesEveryChangedByte) {
  int accepted = 0, refused = 0;
  for (const File& file : all_files()) {
    for (std::size_t i = 0; i < file.bytes.size(); ++i) {
      for (const char byte : {'\0', '\xff', '9'}) {
        std::string bytes = file.bytes;
        bytes[i] = byte;
        try {
          solid::summarize(parse_mesh(bytes, "mesh"));
          ++accepted;
        } catch (const InputError&) {
          ++refused;
        }
      }
    }
  }
  EXPECT_GT(accepted, 1000);  // titles, data that is not used
  EXPECT_GT(refused, 1000);
}

TEST(ParseMesh, RefusesCountsThatTheFileCannotHold) {
  const std::string huge = "1000000000000";
  const std::string vtk2 = samples::legacy_vtk(Form::text, false), vtk5 = samples::legacy_vtk(Form::binary, true);
  const std::string fit = "do not fit into the";
  expect_fault(replaced(vtk2, "POINTS 5", "POINTS " + huge), 9, huge, fit);
  expect_fault(replaced(vtk2, "CELLS 4 16", "CELLS 4 " + huge), 12, huge, fit);
  expect_fault(replaced(vtk2, "CELL_TYPES 4", "CELL_TYPES " + huge), 22, huge, fit);
  expect_fault(replaced(vtk5, "POINTS 5", "POINTS " + huge), 0, huge, fit);
  expect_fault(replaced(vtk5, "CELLS 5", "CELLS " + huge), 0, huge, fit);
  expect_fault(replaced(vtk5, "TIME 1 1", "TIME 1 " + huge), 0, huge, fit);
  expect_fault(replaced(samples::gmsh_2(Form::text), "$Nodes\n5", "$Nodes\n" + huge), 9, huge, fit);
  expect_fault(replaced(samples::gmsh_4(Form::text), "$Nodes\n2 5", "$Nodes\n2 " + huge), 9, huge, fit);
  expect_fault(replaced(samples::gmsh_2(Form::binary), "$Elements\n4", "$Elements\n" + huge), 0, huge, fit);
  expect_fault(replaced(samples::vtu({}), "NumberOfPoints=\"5\"", "NumberOfPoints=\"" + huge + "\""), 4, huge,
               "at most 2147483647");
  for (const bool compressed : {false, true}) {
    const std::string vtu = samples::vtu({.format = "binary", .compressed = compressed});
    const InputFault fault = fault_of(replaced(vtu, "NumberOfPoints=\"5\"", "NumberOfPoints=\"2000000000\""));
    EXPECT_THAT(fault.rule, HasSubstr("48000000000 bytes"));
    EXPECT_EQ(fault.line, 6);
  }
  expect_fault(replaced(vtk2, "POINTS 5", "POINTS -5"), 9, "-5", "0 or more");
  expect_fault(replaced(vtk2, "POINTS 5", "POINTS 99999999999999999999"), 9, "99999999999999999999", "whole number");
}

TEST(ParseMesh, SaysWhereInALegacyVtkTheFaultIs) {
  const std::string two = samples::legacy_vtk(Form::text, false), five = samples::legacy_vtk(Form::text, true);
  expect_fault(replaced(two, "Version 2.0", "Version 1.0"), 1, "Version 1.0", "from 2 to 5");
  expect_fault(replaced(two, "ASCII", "UTF8"), 3, "\"UTF8\"", "ASCII or BINARY");
  expect_fault(replaced(two, "UNSTRUCTURED_GRID", "POLYDATA"), 4, "POLYDATA", "UNSTRUCTURED_GRID");
  expect_fault(replaced(two, "POINTS 5 double", "POINTS 5 quadruple"), 9, "quadruple", "type of the numbers");
  expect_fault(replaced(two, "1.25", "1,25"), 10, "\"1,25\"", "a coordinate must be a number");
  expect_fault(replaced(two, "1.25", "nan"), 10, "nan", "finite");
  expect_fault(replaced(two, "1.25", "-inf"), 10, "-inf", "finite");
  expect_fault(replaced(two, "1.25", "1e999"), 10, "1e999", "double precision");
  expect_fault(replaced(two, "0 1 2 3", "0 1 2 x"), 16, "\"x\"", "whole number");
  expect_fault(replaced(two, "0 1 2 3", "0 1 2 5"), 15, "5", "from 0 to 4");
  expect_fault(replaced(two, "0 1 2 3", "0 1 2 -1"), 15, "-1", "from 0 to 4");
  expect_fault(replaced(two, "5 10 1 10", "10 10 1 10"), 13, "3 nodes", "must have 4 nodes");
  expect_fault(replaced(two, "CELLS 4 16", "CELLS 4 17"), 12, "17", "must have 16 entries");
  expect_fault(replaced(two, "CELLS 4 16", "CELLS 4 15"), 19, "4", "fit into the 4 entries left");
  expect_fault(replaced(two, "CELLS 4 16", "CELLS 5 16"), 20, "none left", "fit into the 0 entries");
  expect_fault(replaced(two, "CELL_TYPES 4", "CELL_TYPES 3"), 23, "3 types of 4 cells", "as many entries as CELLS");
  expect_fault(replaced(five, "OFFSETS vtktypeint64", "OFFSETS double"), 16, "double", "integer type");
  expect_fault(replaced(five, "0 3 7 8 12", "0 3 7 8 11"), 17, "0 to 11", "from 0 to 12");
  expect_fault(replaced(five, "0 3 7 8 12", "0 7 3 8 12"), 20, "3", "must lie between 7 and 12");
  expect_fault(replaced(five, "0 1 2 0 1 2 3", "0 1 2 0 1 2 9"), 20, "9", "cell 1 (0-based) must be from 0 to 4");
}

TEST(ParseMesh, SaysWhereInAVtuTheFaultIs) {
  const std::string text = samples::vtu({}), raw = samples::vtu({.format = "appended"});
  expect_fault(replaced(text, "UnstructuredGrid", "PolyData"), 2, "PolyData", "of type UnstructuredGrid");
  expect_fault(replaced(text, "</Points>", "</Point>"), 9, "", "well-formed XML");
  expect_fault(replaced(text, "LittleEndian", "Middle"), 2, "Middle", "byte_order");
  expect_fault(replaced(text, "UInt32", "UInt16"), 2, "UInt16", "header_type");
  expect_fault(replaced(text, "=\"3\"", "=\"2\""), 6, "2", "must be 3");
  expect_fault(replaced(text, "Float64", "Float80"), 6, "Float80", "the type of a DataArray");
  expect_fault(replaced(text, "ascii", "hex"), 6, "hex", "ascii, binary or appended");
  expect_fault(replaced(text, "1.25", "nan"), 7, "nan", "finite");
  expect_fault(replaced(text, "1.25", "1.2.5"), 7, "1.2.5", "must be a number");
  expect_fault(replaced(text, "1.25 1 ", "1.25 1 1 "), 7, "\"1\"", "must end after 15 numbers");
  expect_fault(replaced(text, "1.25 1 ", "1.25"), 8, "end of file", "must follow");
  expect_fault(replaced(text, "\"types\"", "\"kinds\""), 10, "", "a DataArray named types");
  expect_fault(replaced(text, "0 1 2 0 1 2 3", "0 1 2 0 1 2 9"), 11, "9", "from 0 to 4");
  expect_fault(replaced(text, "NumberOfPoints=\"5\"", "NumberOfPoints=\"x\""), 4, "x", "whole number");
  expect_fault(replaced(raw, "offset=\"0\"", "offset=\"900\""), 6, "900", "AppendedData");
  expect_fault(replaced(raw, "offset=\"0\"", "offset=\"-1\""), 6, "-1", "AppendedData");
  expect_fault(replaced(raw, "\"raw\"", "\"hex\""), 15, "hex", "\"raw\" or \"base64\"");
  expect_fault(replaced(raw, "UInt32", "UInt64"), 10, "bytes", "must have 16 bytes");
  const std::string coded = samples::vtu({.format = "binary"});
  expect_fault(replaced(coded, "  eAAAA", "  eA?AA"), 6, "?", "digit of base64");
  const std::string zlib = samples::vtu({.format = "appended", .compressed = true});
  expect_fault(replaced(zlib, "\x78\x9c", "\x78\x9d"), 6, "block", "inflate");
  expect_fault(replaced(zlib, "vtkZLib", "vtkLZ4"), 6, "vtkLZ4", "vtkZLibDataCompressor or none");
}

TEST(ParseMesh, SaysWhereInAGmshFileTheFaultIs) {
  const std::string two = samples::gmsh_2(Form::text), four = samples::gmsh_4(Form::text);
  expect_fault(replaced(two, "2.2 0", "4.0 0"), 2, "4.0", "2.2 or 4.1");
  expect_fault(replaced(two, "2.2 0 8", "2.2 2 8"), 2, "2", "0 (text) or 1 (binary)");
  expect_fault(replaced(two, "2.2 0 8", "2.2 0 4"), 2, "4", "must be 8");
  expect_fault(replaced(two, "$EndPhysicalNames", "$End"), 7, "$End", "$EndPhysicalNames must stand here");
  expect_fault(replaced(two, "$Nodes\n5", "$Nodes\n4"), 18, "\"2\"", "$EndNodes");
  expect_fault(replaced(two, "$Nodes\n5", "$Nodes\n6"), 21, "\"$EndNodes\"", "whole number");
  expect_fault(replaced(two, "1.25", "inf"), 19, "inf", "finite");
  expect_fault(replaced(two, "2 4 2 0 1", "2 40 2 0 1"), 26, "40", "element type");
  expect_fault(replaced(two, "7 3 100 5", "7 3 100 6"), 26, "node tag 6", "must be in $Nodes");
  expect_fault(replaced(two, "\n100 \n", "\n7 \n"), 14, "node tag 7", "one node only");
  expect_fault(replaced(four, "$Nodes\n2 5", "$Nodes\n2 6"), 9, "6", "must be 5");
  expect_fault(replaced(four, "\n2 1 1 \n", "\n7 1 1 \n"), 14, "7", "from 0 to 3");
  expect_fault(replaced(four, "$Elements", "$Nodes"), 21, "$Nodes", "must come once");
  expect_fault(four.substr(0, four.find("$Elements")), 20, "end of file", "section $Elements");
  const std::string binary = samples::gmsh_4(Form::binary);
  expect_fault(replaced(binary, std::string("\x01\0\0\0", 4), "abcd"), 3, "another number", "the number 1");
}

TEST(ParseMesh, FindsNumbersThatAreNotFiniteInBinaryFiles) {
  const std::string place = samples::bytes(1.25, std::endian::big);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    expect_fault(replaced(samples::legacy_vtk(Form::binary, false), place, samples::bytes(bad, std::endian::big)), 0,
                 "node 4 (0-based)", "finite");
  }
}

solid::Mesh two_tetrahedra() { return parse_mesh(samples::vtu({}), "mesh"); }

TEST(CheckMesh, WantsACell) {
  solid::Mesh mesh = two_tetrahedra();
  mesh.cells.clear();
  const InputFault fault = check_fault(mesh);
  EXPECT_EQ(fault.value, "1 triangle, 1 vertex");
  EXPECT_THAT(fault.rule, HasSubstr("at least one tetrahedron with 4 or 10 nodes"));
}

TEST(MeshFile, OfOtherProgramsIsRefusedByItsName) {
  EXPECT_THAT(fault_of("$NOD\n1\n1 0 0 0\n$ENDNOD\n").rule, HasSubstr("Gmsh file of version 1"));
  EXPECT_THAT(fault_of("(0 \"Created by a mesher\")\n(2 3)\n").rule, HasSubstr("ANSYS Fluent"));
}

TEST(CheckMesh, WantsNodeNumbersInRange) {
  for (const int node : {-1, 5}) {
    solid::Mesh mesh = two_tetrahedra();
    mesh.cells[1].node[2] = node;
    EXPECT_EQ(check_fault(mesh).value, std::to_string(node));
  }
}

TEST(CheckMesh, NamesTheElementOfNegativeVolume) {
  solid::Mesh mesh = two_tetrahedra();
  std::swap(mesh.cells[1].node[0], mesh.cells[1].node[1]);
  const InputFault one = check_fault(mesh);
  EXPECT_THAT(one.value, HasSubstr("volume -0.375 of tetrahedron 1 (0-based"));
  EXPECT_THAT(one.rule, HasSubstr("1 of 2 do not"));
  EXPECT_THAT(one.remedy, HasSubstr("reorder"));
  std::swap(mesh.cells[0].node[0], mesh.cells[0].node[1]);
  EXPECT_THAT(check_fault(mesh).remedy, HasSubstr("all are the wrong way round"));
}

TEST(CheckMesh, JudgesAVolumeBySizeOfTheElement) {
  solid::Mesh mesh = two_tetrahedra();
  for (const double scale : {1e-9, 1.0, 1e9}) {
    solid::Mesh scaled = mesh;
    scaled.nodes *= scale;
    EXPECT_NO_THROW(check_mesh(scaled, "mesh"));
    scaled.nodes(2, 3) = 2e-11 * scale;  // volume 3.3e-12, edge cubed 2.8
    EXPECT_NO_THROW(check_mesh({scaled.nodes, {kTwoTetrahedra[0]}, {}, {}, {}}, "mesh"));
    scaled.nodes(2, 3) = 1e-11 * scale;
    EXPECT_THROW(check_mesh({scaled.nodes, {kTwoTetrahedra[0]}, {}, {}, {}}, "mesh"), InputError);
  }
  mesh.nodes.col(3) = mesh.nodes.col(2);
  EXPECT_THAT(check_fault(mesh).value, HasSubstr("volume 0 of tetrahedron 0"));
}

TEST(CheckMesh, RefusesVolumesBeyondTheRangeOfNumbers) {
  solid::Mesh mesh = two_tetrahedra();
  mesh.nodes *= 1e200;
  EXPECT_THROW(check_mesh(mesh, "mesh"), InputError);
  mesh.nodes(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(check_fault(mesh).value, HasSubstr("node 0 (0-based) at (nan"));
}

}  // namespace
}  // namespace sinew::io
