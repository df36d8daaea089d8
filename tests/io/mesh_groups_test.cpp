// Groups: what a file calls by one name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
using testing::ElementsAre;
using testing::HasSubstr;

/// Two tetrahedra that share a face, that face, and an end of it.
Sample grouped() {
  Sample sample = samples::two_tetrahedra;
  sample.cells = {{10, {0, 1, 2, 3}, {1}}, {10, {1, 2, 3, 4}, {1, 2}}, {5, {1, 3, 2}, {6, 7}}, {1, {4}, {1}}};
  sample.names = {{{3, 1}, "the body"}, {{2, 6}, "wall"}, {{2, 1}, "of no element"}};
  return sample;
}

std::vector<std::string> names(const solid::Mesh& mesh) {
  std::vector<std::string> all;
  for (const auto& [name, group] : mesh.groups) all.push_back(name);
  return all;
}

std::string gmsh_2(const Sample& sample, Form form = Form::text) {
  return samples::gmsh_2(form, std::endian::little, sample);
}
std::string gmsh_4(const Sample& sample, Form form = Form::text) {
  return samples::gmsh_4(form, std::endian::little, sample);
}
std::string vtk(const Sample& sample, Form form = Form::text) { return samples::legacy_vtk(form, false, sample); }

TEST(GmshGroups, HaveNamesOrNumbersAndMayOverlap) {
  for (const Form form : {Form::text, Form::binary}) {
    for (const std::string& bytes : {gmsh_2(grouped(), form), gmsh_4(grouped(), form)}) {
      const solid::Mesh mesh = parse_mesh(bytes, "mesh");
      EXPECT_EQ(mesh.cells.size(), 2u);  // though one stands twice in a file of 2.2
      EXPECT_TRUE(mesh.ignored.empty());
      EXPECT_THAT(names(mesh), ElementsAre("1", "2", "7", "the body", "wall"));
      EXPECT_THAT(mesh.groups.at("the body").cells, ElementsAre(0, 1));
      EXPECT_THAT(mesh.groups.at("the body").nodes, ElementsAre(0, 1, 2, 3, 4));
      EXPECT_THAT(mesh.groups.at("2").cells, ElementsAre(1));
      EXPECT_THAT(mesh.groups.at("2").nodes, ElementsAre(1, 2, 3, 4));
      for (const char* name : {"7", "wall"}) {
        EXPECT_THAT(mesh.groups.at(name).faces, ElementsAre(solid::CellFace{3, {1, 3, 2}}));
        EXPECT_THAT(mesh.groups.at(name).nodes, ElementsAre(1, 2, 3));
      }
      EXPECT_THAT(mesh.groups.at("1").nodes, ElementsAre(4));  // that of points: a group has a dimension
    }
  }
}

TEST(GmshGroups, OfOneNameAreOne) {
  Sample sample = grouped();
  sample.names = {{{3, 1}, "all"}, {{2, 6}, "all"}, {{0, 1}, "all"}};
  for (const std::string& bytes : {gmsh_2(sample), gmsh_4(sample)}) {
    const solid::Mesh mesh = parse_mesh(bytes, "mesh");
    EXPECT_THAT(names(mesh), ElementsAre("2", "7", "all"));
    EXPECT_THAT(mesh.groups.at("all").cells, ElementsAre(0, 1));
    EXPECT_EQ(mesh.groups.at("all").faces.size(), 1u);
    EXPECT_THAT(mesh.groups.at("all").nodes, ElementsAre(0, 1, 2, 3, 4));
  }
}

TEST(GmshGroups, OfASurfaceThatLooksTheOtherWayHaveTheSameName) {
  Sample sample = grouped();
  sample.cells[2].groups = {-6, -7};
  for (const std::string& bytes : {gmsh_2(sample), gmsh_4(sample)}) {
    EXPECT_THAT(names(parse_mesh(bytes, "mesh")), ElementsAre("1", "2", "7", "the body", "wall"));
  }
}

TEST(GmshGroups, OfNumberZeroOrOfUnknownEntitiesAreNone) {
  Sample sample = grouped();
  sample.cells[2].groups = {0};
  const solid::Mesh two = parse_mesh(gmsh_2(sample), "mesh");
  EXPECT_THAT(names(two), ElementsAre("1", "2", "the body"));
  EXPECT_EQ(two.ignored.at("triangle"), 1);
  const std::string four = gmsh_4(grouped());
  const std::size_t start = four.find("$Entities"), end = four.find("$Nodes");
  const solid::Mesh without = parse_mesh(four.substr(0, start) + four.substr(end), "mesh");
  EXPECT_TRUE(without.groups.empty());
  EXPECT_EQ(without.ignored, (std::map<std::string, int>{{"triangle", 1}, {"vertex", 1}}));
  const solid::Mesh other = parse_mesh(replaced(four, "3 1 4 \n", "3 77 4 \n"), "mesh");
  EXPECT_THAT(other.groups.at("the body").cells, ElementsAre(1));
  const std::string no_tags = replaced(gmsh_2(grouped()), "1 4 2 1 1 \n", "1 4 0\n");
  EXPECT_THAT(parse_mesh(no_tags, "mesh").groups.at("the body").cells, ElementsAre(1));
}

TEST(GmshGroups, MayHaveNoNames) {
  Sample sample = grouped();
  for (const std::string& text : {gmsh_2(sample), gmsh_4(sample)}) {
    const std::size_t start = text.find("$PhysicalNames"), end = text.find("$EndPhysicalNames") + 18;
    EXPECT_THAT(names(parse_mesh(text.substr(0, start) + text.substr(end), "mesh")), ElementsAre("1", "2", "6", "7"));
  }
  sample.names = {{{3, 1}, ""}, {{2, 6}, "a \"b\" c"}};
  EXPECT_THAT(names(parse_mesh(gmsh_4(sample), "mesh")), ElementsAre("1", "2", "7", "a \"b\" c"));
}

TEST(GmshGroups, SayWhereTheFaultIs) {
  const std::string two = gmsh_2(grouped()), four = gmsh_4(grouped());
  expect_fault(replaced(two, "\"wall\"", "wall"), 7, "wall", "in quotation marks");
  expect_fault(replaced(two, "\"wall\"", "\"wall"), 7, "wall", "in quotation marks");
  expect_fault(replaced(two, "\"wall\"", ""), 7, "", "in quotation marks");
  expect_fault(replaced(two, "\n2 6 ", "\n4 6 "), 7, "4", "dimension of an entity must be from 0 to 3");
  expect_fault(replaced(two, "\n2 6 ", "\n2 x "), 7, "\"x\"", "whole number");
  expect_fault(replaced(two, "Names\n3", "Names\n4"), 9, "$EndPhysicalNames", "whole number");
  expect_fault(replaced(two, "Names\n3", "Names\n2"), 8, "\"3\"", "$EndPhysicalNames must stand here");
  expect_fault(replaced(two, "Names\n3", "Names\n-3"), 5, "-3", "0 or more");
  expect_fault(replaced(two, "1 4 2 1 1", "1 4 2 one 1"), 26, "\"one\"", "whole number");
  expect_fault(replaced(two, "1 4 2 1 1", "1 4 -2 1 1"), 26, "-2", "number of tags");
  expect_fault(replaced(four, "3 1 4 \n", "7 1 4 \n"), 51, "7", "dimension of an entity must be from 0 to 3");
  expect_fault(replaced(four, "$Entities\n1 0 1 2", "$Entities\n1 0 1 3"), 35, "$EndEntities", "whole number");
  expect_fault(replaced(four, "$Entities\n1 0 1 2", "$Entities\n1 0 1 1000000000"), 35, "$EndEntities", "whole number");
  expect_fault(replaced(four, "$Entities\n1 0 1 2", "$Entities\n1 0 1 -2"), 11, "-2", "0 or more");
  std::string late = four;
  const std::size_t start = late.find("$Entities"), end = late.find("$Nodes"), elements = late.find("$Elements");
  late = late.substr(0, start) + late.substr(elements) + late.substr(start, elements - start);
  EXPECT_GT(elements, end);
  EXPECT_THAT(fault_of(late).rule, HasSubstr("must come before $Elements"));
  Sample crowd = grouped();
  for (int i = 0; i < 101; ++i) crowd.cells[0].groups.push_back(10 + i);
  EXPECT_THAT(fault_of(gmsh_4(crowd)).rule, HasSubstr("at most 100 physical groups"));
}

TEST(GmshGroups, TakeNumbersOfAnySize) {
  for (const char* number : {"2147483647", "9223372036854775807", "-9223372036854775808"}) {
    const std::string text = replaced(gmsh_2(grouped()), "1 4 2 1 1", fmt::format("1 4 2 {} 1", number));
    const std::string name = number[0] == '-' ? number + 1 : number;
    EXPECT_THAT(parse_mesh(text, "mesh").groups.at(name).cells, ElementsAre(0));
  }
}

TEST(VtkGroups, ComeFromAnArrayOverTheCells) {
  for (const char* name : {"gmsh:physical", "medit:ref", "CellEntityIds", "cell_tags", "material", "region", "Material",
                           "GMSH:PHYSICAL", "cellentityids"}) {
    for (const char* head : {"SCALARS", "FIELD"}) {
      for (const char* type : {"int", "short", "vtktypeint64", "vtktypeint32", "vtkIdType"}) {
        Sample sample = grouped();
        sample.array = fmt::format("{} {} {}", head, name, type);
        for (const Form form : {Form::text, Form::binary}) {
          for (const std::string& bytes : {vtk(sample, form), samples::legacy_vtk(form, true, sample)}) {
            const solid::Mesh mesh = parse_mesh(bytes, "mesh");
            ASSERT_THAT(names(mesh), ElementsAre("1", "6")) << sample.array;
            EXPECT_THAT(mesh.groups.at("1").cells, ElementsAre(0, 1));
            EXPECT_THAT(mesh.groups.at("6").nodes, ElementsAre(1, 2, 3));
          }
        }
      }
    }
    Sample sample = grouped();
    sample.array = fmt::format("SCALARS {} int", name);
    EXPECT_THAT(names(parse_mesh(samples::vtu({.format = "appended", .compressed = true}, sample), "mesh")),
                ElementsAre("1", "6"));
  }
}

TEST(VtkGroups, OfNumberZeroAreNoneForSomeArrays) {
  const auto of = [](const char* array, int number) {
    Sample sample = grouped();
    sample.array = fmt::format("SCALARS {} int", array);
    sample.cells[0].groups = {number};
    const std::vector<std::string> found = names(parse_mesh(vtk(sample), "mesh"));
    EXPECT_EQ(found, names(parse_mesh(samples::vtu({}, sample), "mesh")));
    return found;
  };
  for (const char* array : {"gmsh:physical", "medit:ref"}) EXPECT_THAT(of(array, 0), ElementsAre("1", "6"));
  for (const char* array : {"CellEntityIds", "cell_tags", "material", "region"}) {
    EXPECT_THAT(of(array, 0), ElementsAre("0", "1", "6"));
  }
  for (const char* array : {"gmsh:physical", "CellEntityIds"}) EXPECT_THAT(of(array, -9), ElementsAre("1", "6", "9"));
  for (const char* array : {"medit:ref", "region"}) EXPECT_THAT(of(array, -9), ElementsAre("-9", "1", "6"));
}

/// Of two arrays the earlier in the list counts, wherever it stands; others are passed over.
TEST(VtkGroups, ComeFromOneArrayOnly) {
  Sample sample = grouped();
  sample.array = "SCALARS cell_tags int";
  const std::string region = "region 1 4 int\n20 20 20 20\n", physical = "gmsh:physical 1 4 int\n30 30 30 30\n";
  const std::string reals = "gmsh:physical 1 4 double\n0 0 0 0\n", pairs = "medit:ref 2 4 int\n1 1 1 1 1 1 1 1\n";
  const auto found = [&](const std::string& arrays, int count) {
    return names(parse_mesh(vtk(sample) + fmt::format("FIELD FieldData {}\n", count) + arrays, "mesh"));
  };
  EXPECT_THAT(found(region, 1), ElementsAre("1", "6"));
  EXPECT_THAT(found(region + physical, 2), ElementsAre("30"));
  EXPECT_THAT(found(reals + pairs, 2), ElementsAre("1", "6"));
  EXPECT_THAT(found(reals + "METADATA\nINFORMATION 0\n\n" + physical, 2), ElementsAre("30"));
  const std::string of_points = "POINT_DATA 5\nSCALARS gmsh:physical int\nLOOKUP_TABLE default\n1 2 3 4 5\n";
  EXPECT_THAT(names(parse_mesh(vtk(sample) + of_points, "mesh")), ElementsAre("1", "6"));

  const std::string vtu = samples::vtu({}, sample), end = "</CellData>";
  const auto array = [](const char* type, const char* name, int components, const char* values) {
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\">{}</DataArray>\n", type, name,
                       components, values);
  };
  const std::string earlier = array("Int32", "gmsh:physical", 1, "30 30 30 30");
  EXPECT_THAT(names(parse_mesh(replaced(vtu, end, earlier + end), "mesh")), ElementsAre("30"));
  EXPECT_THAT(names(parse_mesh(replaced(vtu, "<CellData>", "<CellData>" + earlier), "mesh")), ElementsAre("30"));
  for (const std::string& other :
       {array("Int32", "region", 1, "20 20 20 20"), array("Float64", "gmsh:physical", 1, "30 30 30 30"),
        array("Int32", "gmsh:physical", 2, "1 1 1 1 1 1 1 1"), array("String", "gmsh:physical", 1, "?")}) {
    EXPECT_THAT(names(parse_mesh(replaced(vtu, end, other + end), "mesh")), ElementsAre("1", "6"));
  }
}

TEST(VtkGroups, AreFoundBehindAllOtherData) {
  const auto text = [](Form form) {
    const auto reals = [&](std::size_t count) {
      return samples::numbers<double>(std::vector<double>(count, 0.5), form, std::endian::big) + "\n";
    };
    std::string others = "VECTORS v double\n" + reals(15) + "NORMALS n double\n" + reals(15);
    others += "TENSORS t double\n" + reals(45) + "TENSORS6 t6 double\n" + reals(30);
    others +=
        "TEXTURE_COORDINATES tc 2 double\n" + reals(10) + "SCALARS pairs double 2\nLOOKUP_TABLE default\n" + reals(10);
    others +=
        "GLOBAL_IDS id vtkIdType\n" + samples::numbers<std::int32_t>(std::vector(5, 1), form, std::endian::big) + "\n";
    others += form == Form::text ? "COLOR_SCALARS c 3\n" + reals(15) + "LOOKUP_TABLE lut 2\n" + reals(8)
                                 : "COLOR_SCALARS c 3\n" + std::string(15, ' ') + "\nLOOKUP_TABLE lut 2\n" +
                                       std::string(8, '\n') + "\n";
    others += "METADATA\nINFORMATION 0\n\n";
    return replaced(vtk(grouped(), form), "CELL_DATA", others + "CELL_DATA");
  };
  for (const Form form : {Form::text, Form::binary}) {
    EXPECT_THAT(names(parse_mesh(text(form), "mesh")), ElementsAre("1", "6"));
  }
  // Behind what is not known there may be anything.
  const std::string strings = replaced(vtk(grouped()), "SCALARS s double", "SCALARS s string");
  EXPECT_TRUE(parse_mesh(strings, "mesh").groups.empty());
  EXPECT_TRUE(parse_mesh(replaced(vtk(grouped()), "SCALARS s", "SPLINES s"), "mesh").groups.empty());
  EXPECT_TRUE(parse_mesh(replaced(vtk(grouped()), "s double", "s double 7"), "mesh").groups.empty());
  EXPECT_THAT(names(parse_mesh(replaced(vtk(grouped()), "LOOKUP_TABLE default\n1 ", "1 "), "mesh")),
              ElementsAre("1", "6"));
}

TEST(VtkGroups, WantANumberForEachCell) {
  const std::string text = vtk(grouped());
  const std::string rule = "gmsh:physical must have a number for each of the 4 cells";
  expect_fault(replaced(text, "CELL_DATA 4", "CELL_DATA 3"), 31, "3", rule);
  expect_fault(replaced(text, "CELL_DATA 4", "CELL_DATA 5"), 31, "5", rule);
  expect_fault(replaced(text, "1 1 6 1 \n", "1 1 6\n"), 35, "end of file", "groups of cells must follow");
  expect_fault(replaced(text, "1 1 6 1 \n", "1 1 6.5 1\n"), 33, "6.5", "whole number");
  expect_fault(replaced(text, "CELL_DATA 4", "CELL_DATA 1000000000000"), 30, "1000000000000", "do not fit");
  Sample field = grouped();
  field.array = "FIELD region int";
  expect_fault(replaced(vtk(field), "region 1 4", "region 1 3"), 32, "3",
               "region must have a number for each of the 4");
  const std::string vtu = samples::vtu({}, grouped());
  expect_fault(replaced(vtu, "1 1 6 1 \n", "1 1 6\n"), 24, "end of file", "a number of gmsh:physical must follow");
  expect_fault(replaced(vtu, "1 1 6 1 \n", "1 1 6 1 1\n"), 23, "\"1\"", "must end after 4 numbers");
  const std::string binary = samples::vtu({.format = "binary"}, grouped());
  const std::size_t array = binary.find("gmsh:physical"), data = binary.find("  EAAAA", array);
  ASSERT_NE(data, std::string::npos);
  expect_fault(std::string(binary).replace(data, 7, "  DAAAA"), 22, "12 bytes", "must have 16 bytes");
}

TEST(VtkGroups, OfThePiecesOfAVtuAreJoined) {
  Sample sample = grouped();
  const std::string text = samples::vtu({}, sample);
  const std::size_t begin = text.find("<Piece"), end = text.find("</UnstructuredGrid>");
  const solid::Mesh mesh = parse_mesh(text.substr(0, end) + text.substr(begin), "mesh");
  EXPECT_THAT(mesh.groups.at("1").cells, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(mesh.groups.at("6").nodes, ElementsAre(1, 2, 3, 6, 7, 8));
}

TEST(MeshGroups, AreNeverReadFromHalfAFile) {
  for (const samples::File& file : samples::all_files(grouped())) {
    SCOPED_TRACE(file.name);
    const std::string& bytes = file.bytes;
    std::size_t size = bytes.find("$EndElements") + 11;
    if (file.name.ends_with(".vtk")) size = bytes.size() - 3;
    if (file.name.ends_with(".vtu"))
      size = bytes.find(bytes.find("\n</App") == std::string::npos ? "</VTK" : "\n</App");
    for (std::size_t i = 0; i < size; ++i) {
      try {  // legacy VTK is whole without its data
        const solid::Mesh mesh = parse_mesh(bytes.substr(0, i), "mesh");
        EXPECT_TRUE(mesh.groups.empty() && file.name.ends_with(".vtk")) << i;
      } catch (const InputError&) {
      }
    }
  }
}

TEST(MeshGroups, SurviveEveryChangedByte) {
  Sample sample = grouped();
  sample.coordinates = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
  sample.cells = {{12, {0, 1, 2, 3, 4, 5, 6, 7}, {1}}, {9, {0, 1, 2, 3}, {6, 7}}, {3, {0, 1}, {2}}};
  sample.tags = {1, 2, 3, 4, 5, 6, 7, 8};
  int accepted = 0, refused = 0;
  for (const samples::File& file : samples::all_files(sample)) {
    for (std::size_t i = 0; i < file.bytes.size(); ++i) {
      for (const char byte : {'\0', '\xff', '9'}) {
        std::string bytes = file.bytes;
        bytes[i] = byte;
        try {
          const solid::Mesh mesh = parse_mesh(bytes, "mesh");
          solid::summarize(mesh);
          for (const auto& [name, group] : mesh.groups) {
            for (const int cell : group.cells) ASSERT_LT(static_cast<std::size_t>(cell), mesh.cells.size());
            for (const int node : group.nodes) ASSERT_TRUE(node >= 0 && node < mesh.nodes.cols());
          }
          ++accepted;
        } catch (const InputError&) {
          ++refused;
        }
      }
    }
  }
  EXPECT_GT(accepted, 1000);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace sinew::io
