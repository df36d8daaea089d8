// Input files of Abaqus and CalculiX.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/mesh_faults.hpp"
#include "sinew/io/mesh_file.hpp"

namespace sinew::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

const std::string kAbaqusNodes = R"(** a cube
*Heading
 Job name: bar, *not a keyword
*Node, nset=All
      1,           0.,           0.,           0.
      2, 1.0, 0, 0
      3, 1.0, 1.0, 0
     14, 0, 1.0, 0.
      5, 0, 0, 1.D0
      6, 1, 0, 1
      7, 1, 1, 1
      8, 0, 1, 1
)";
const std::string kAbaqusHexahedron = "*Element, type=C3D8R, elset=\"the bar\"\n 100, 1, 2, 3, 14,\n 5, 6, 7, 8\n";

solid::Mesh abaqus_mesh(const std::string& text) { return parse_mesh(text, "bar.inp"); }

TEST(Abaqus, NodesAndElementsKeepTheirNumbersInSetsAlone) {
  const solid::Mesh mesh = abaqus_mesh(kAbaqusNodes + kAbaqusHexahedron);
  ASSERT_EQ(mesh.nodes.cols(), 8);
  EXPECT_EQ(mesh.nodes.col(3), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(mesh.nodes.col(4), Eigen::Vector3d(0, 0, 1));
  ASSERT_EQ(mesh.cells.size(), 1u);
  EXPECT_EQ(mesh.cells[0].kind, solid::Kind::hex8);
  EXPECT_THAT(mesh.cells[0].nodes(), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_THAT(mesh.simplified, ElementsAre(Pair("C3D8R", 1)));
  EXPECT_THAT(mesh.groups.at("the bar").cells, ElementsAre(0));
  EXPECT_EQ(mesh.groups.at("All").nodes.size(), 8u);
}

TEST(Abaqus, SetsAreListedGeneratedOrMadeOfOthers) {
  const solid::Mesh mesh = abaqus_mesh(kAbaqusNodes + kAbaqusHexahedron +
                                       "*NSET, NSET=bottom\n1, 2, 3, 14\n"
                                       "*NSET, NSET=Odd, GENERATE\n1, 7, 2\n"
                                       "*NSET, NSET=both\nBOTTOM, odd\n"
                                       "*NSET, NSET=of_bar, ELSET=\"The Bar\"\n"
                                       "*NSET, NSET=both\n8,\n"
                                       "*NSET, NSET=made, INTERNAL\n1, 2\n"
                                       "*ELSET, ELSET=nothing\n"
                                       "*ELSET, ELSET=some, GENERATE\n1, 200, 1\n");
  EXPECT_THAT(mesh.groups.at("bottom").nodes, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(mesh.groups.at("Odd").nodes, ElementsAre(0, 2, 4, 6));
  EXPECT_THAT(mesh.groups.at("both").nodes, ElementsAre(0, 1, 2, 3, 4, 6, 7));
  EXPECT_EQ(mesh.groups.at("of_bar").nodes.size(), 8u);
  EXPECT_THAT(mesh.groups.at("some").cells, ElementsAre(0));
  EXPECT_FALSE(mesh.groups.contains("made"));
  EXPECT_FALSE(mesh.groups.contains("nothing"));
}

/// A set of elements and one of their nodes are often written under one name: one group. If they differ, none is
/// mistaken for the other.
TEST(Abaqus, SetsOfOneNameAreOneGroupIfTheyAgree) {
  const std::string bar = kAbaqusNodes + kAbaqusHexahedron + "*ELSET, ELSET=tip\n100\n";
  const solid::Mesh same = abaqus_mesh(bar + "*NSET, NSET=Tip\n1, 2, 3, 14, 5, 6, 7, 8\n");
  EXPECT_THAT(same.groups.at("tip").cells, ElementsAre(0));
  EXPECT_EQ(same.groups.at("tip").nodes.size(), 8u);
  const solid::Mesh other = abaqus_mesh(bar + "*NSET, NSET=Tip\n1, 2\n*SURFACE, NAME=tip\ntip, S1\n");
  EXPECT_FALSE(other.groups.contains("tip"));
  EXPECT_THAT(other.groups.at("tip.nodes").nodes, ElementsAre(0, 1));
  EXPECT_THAT(other.groups.at("tip.elements").cells, ElementsAre(0));
  EXPECT_THAT(other.groups.at("tip.faces").nodes, ElementsAre(0, 1, 2, 3));
}

/// Every face of an element is outward, as the manual numbers them.
TEST(Abaqus, SurfacesAreFacesOfGroups) {
  const std::string tetrahedron =
      "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
      "5, .5, 0, 0\n6, .5, .5, 0\n7, 0, .5, 0\n8, 0, 0, .5\n9, .5, 0, .5\n10, 0, .5, .5\n"
      "*ELEMENT, TYPE=C3D10, ELSET=e\n1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10\n";
  for (const std::string& text : {kAbaqusNodes + kAbaqusHexahedron, tetrahedron}) {
    const int faces = text == tetrahedron ? 4 : 6;
    std::string surfaces = "*ELSET, ELSET=one\n" + std::string(faces == 4 ? "1" : "100") + "\n";
    for (int i = 1; i <= faces; ++i)
      surfaces += "*SURFACE, TYPE=ELEMENT, NAME=f" + std::to_string(i) + "\none, S" + std::to_string(i) + "\n";
    const solid::Mesh mesh = abaqus_mesh(text + surfaces);
    std::vector<solid::CellFace> found;
    for (int i = 1; i <= faces; ++i) found.push_back(mesh.groups.at("f" + std::to_string(i)).faces.at(0));
    const auto key = [](const solid::CellFace& face) {
      std::vector<int> nodes(face.nodes().begin(), face.nodes().end());
      std::sort(nodes.begin(), nodes.end());
      return nodes;
    };
    std::set<std::vector<int>> outer, named;
    for (const solid::CellFace& face : solid::boundary(mesh.cells)) outer.insert(key(face));
    for (const solid::CellFace& face : found) {
      named.insert(key(face));
      const Eigen::Vector3d a = mesh.nodes.col(face.node[0]), b = mesh.nodes.col(face.node[1]),
                            c = mesh.nodes.col(face.node[2]),
                            middle = mesh.nodes.leftCols(faces == 4 ? 4 : 8).rowwise().mean();
      EXPECT_LT((b - a).cross(c - a).dot(middle - a), 0.0);
    }
    EXPECT_EQ(named, outer);
    EXPECT_EQ(key(found[0]), faces == 4 ? std::vector({0, 1, 2, 4, 5, 6}) : std::vector({0, 1, 2, 3}));
    EXPECT_EQ(key(found[1]), faces == 4 ? std::vector({0, 1, 3, 4, 7, 8}) : std::vector({4, 5, 6, 7}));
  }
}

const std::string kPart =
    "*Part, name=bar\n" + kAbaqusNodes + kAbaqusHexahedron + "*Nset, nset=held\n7, 8\n*End Part\n*Assembly, name=all\n";

TEST(Abaqus, AnInstanceIsPlaced) {
  const solid::Mesh moved = abaqus_mesh(kPart + "*Instance, name=bar-1, part=bar\n 10., 0., 0.\n*End Instance\n");
  EXPECT_EQ(moved.nodes.col(0), Eigen::Vector3d(10, 0, 0));
  const solid::Mesh turned =
      abaqus_mesh(kPart + "*Instance, name=bar-1, part=bar\n 1., 0., 0.\n 0, 0, 0, 0, 0, 1, 90.\n");
  EXPECT_TRUE(turned.nodes.col(0).isApprox(Eigen::Vector3d(0, 1, 0)));
  EXPECT_TRUE(turned.nodes.col(1).isApprox(Eigen::Vector3d(0, 2, 0)));
}

/// An independent instance has its nodes in itself.
TEST(Abaqus, AnInstanceMayHaveTheNodes) {
  const solid::Mesh mesh = abaqus_mesh(
      "*Part, name=bar\n*End Part\n*Assembly, name=all\n"
      "*Instance, name=bar-1, part=bar\n 0, 0, 2\n" +
      kAbaqusNodes + kAbaqusHexahedron + "*End Instance\n*End Assembly\n");
  EXPECT_EQ(mesh.nodes.col(4), Eigen::Vector3d(0, 0, 3));
  EXPECT_EQ(mesh.cells.size(), 1u);
}

/// Node 1 of the assembly is a reference point; node 1 of the part is meant where its instance is named.
TEST(Abaqus, NumbersOfTheAssemblyAreNotThoseOfThePart) {
  const solid::Mesh mesh = abaqus_mesh(kPart +
                                       "*Instance, name=bar-1, part=bar\n*End Instance\n"
                                       "*Node\n1, 50., 50., 50.\n*Element, type=CONN3D2\n1, bar-1.1, 1\n"
                                       "*Nset, nset=point\n1,\n*Nset, nset=corner, instance=bar-1\n1, 2\n"
                                       "*Nset, nset=mixed\nbar-1.3, 1, bar-1.held, corner\n"
                                       "*Nset, nset=HELD, instance=bar-1\n5\n"
                                       "*Elset, elset=_top_S2, internal, instance=bar-1\n100\n"
                                       "*Surface, type=ELEMENT, name=top\n_top_S2, S2\n*End Assembly\n");
  ASSERT_EQ(mesh.nodes.cols(), 8);
  EXPECT_FALSE(mesh.groups.contains("point"));
  EXPECT_THAT(mesh.groups.at("corner").nodes, ElementsAre(0, 1));
  EXPECT_THAT(mesh.groups.at("mixed").nodes, ElementsAre(0, 1, 2, 6, 7));
  EXPECT_THAT(mesh.groups.at("top").nodes, ElementsAre(4, 5, 6, 7));
  EXPECT_THAT(mesh.groups.at("held").nodes, ElementsAre(4));  // names are those first written
  EXPECT_THAT(mesh.groups.at("bar-1.held").nodes, ElementsAre(6, 7));
  EXPECT_FALSE(mesh.groups.contains("_top_S2"));
}

TEST(Abaqus, OnePartWithVolumeElementsIsRead) {
  const std::string other = "*Part, name=plate\n" + kAbaqusNodes + "*Element, type=R3D4\n1, 1, 2, 3, 14\n*End Part\n";
  const solid::Mesh mesh = abaqus_mesh(other + kPart);
  EXPECT_EQ(mesh.nodes.cols(), 8);
  EXPECT_THAT(mesh.ignored, ElementsAre(Pair("element of part \"plate\"", 1)));
  const std::string second = replaced(kPart, "name=bar", "name=arm");
  EXPECT_THAT(fault_of(second + kPart).value, HasSubstr("second part with volume elements, \"bar\""));
  const std::string twice = kPart + "*Instance, name=a, part=bar\n*End Instance\n*Instance, name=b, part=BAR\n";
  EXPECT_THAT(fault_of(twice).value, HasSubstr("second instance"));
}

/// Two cubes on each other share a face, which is not on the boundary.
TEST(Abaqus, ASurfaceWithoutFacesIsTheBoundary) {
  const solid::Mesh mesh =
      abaqus_mesh(kAbaqusNodes + "21, 0, 0, 2\n22, 1, 0, 2\n23, 1, 1, 2\n24, 0, 1, 2\n" + kAbaqusHexahedron +
                  "*ELEMENT, TYPE=C3D8, ELSET=upper\n200, 5, 6, 7, 8, 21, 22, 23, 24\n"
                  "*SURFACE, NAME=skin\nupper,\n*SURFACE, NAME=whole\n,\n"
                  "*SURFACE, NAME=dots, TYPE=NODE\n1, 2.5\n14\n"
                  "*SURFACE, NAME=sum, COMBINE=UNION\nskin, whole\n");
  EXPECT_EQ(mesh.groups.at("skin").faces.size(), 5u);
  EXPECT_EQ(mesh.groups.at("whole").faces.size(), 10u);
  EXPECT_THAT(mesh.groups.at("dots").nodes, ElementsAre(0, 3));
  EXPECT_EQ(mesh.ignored.at("surface made of others"), 1);
}

TEST(Abaqus, OtherElementsAreNamed) {
  const solid::Mesh mesh = abaqus_mesh(kAbaqusNodes + kAbaqusHexahedron +
                                       "*ELEMENT, TYPE=C3D6, ELSET=w\n1, 1, 2, 3, 5, 6, 7\n"
                                       "*ELEMENT, TYPE=S8R5\n2, 1, 2, 3, 14,\n5, 6, 7, 8\n"
                                       "*ELEMENT, TYPE=S4R, ELSET=skin\n3, 1, 2, 3, 14\n"
                                       "*SURFACE, NAME=under\nskin, SPOS\n");
  EXPECT_THAT(mesh.ignored, ElementsAre(Pair("element of type \"S8R5\"", 1), Pair("wedge", 1)));
  EXPECT_THAT(mesh.groups.at("skin").faces, ElementsAre(solid::CellFace{4, {0, 1, 2, 3}}));
  EXPECT_THAT(mesh.groups.at("under").faces, ElementsAre(solid::CellFace{4, {0, 1, 2, 3}}));
}

TEST(Abaqus, KindsBesideThePlainOnesAreTold) {
  std::map<std::string, int> kinds;
  for (const char* type : {"C3D8", "c3d8i", "C3D8RH", "DC3D8"}) {
    const solid::Mesh mesh = abaqus_mesh(kAbaqusNodes + "*ELEMENT, TYPE=" + type + "\n100, 1, 2, 3, 14, 5, 6, 7, 8\n");
    EXPECT_EQ(mesh.cells.size(), 1u) << type;
    for (const auto& [name, count] : mesh.simplified) kinds[name] += count;
  }
  EXPECT_THAT(kinds, ElementsAre(Pair("C3D8I", 1), Pair("C3D8RH", 1), Pair("DC3D8", 1)));
}

struct BrokenAbaqus {
  std::string text, value, rule;
  int line;
};

TEST(Abaqus, FaultsAreNamedWithTheirLine) {
  const std::vector<BrokenAbaqus> all = {
      {"*NODE\n1, 0, 0\n2, 0, x, 0\n", "\"x\"", "a coordinate must be a finite number", 3},
      {"*NODE\n1, 0, 0\n2, 0, 1e999, 0\n", "\"1e999\"", "a coordinate must be a finite number", 3},
      {"*NODE\n1.5, 0, 0\n", "\"1.5\"", "must be a whole number", 2},
      {"*NODE\n0, 0, 0\n", "\"0\"", "from 1 to 2147483647", 2},
      {"*NODE\n2147483648, 0, 0\n", "\"2147483648\"", "from 1 to 2147483647", 2},
      {"*NODE\n1\n", "\"1\"", "its number and up to three coordinates", 2},
      {"*NODE\n1, 0, 0, 0\n\n** 2\n1, 1, 0, 0\n", "1", "two nodes must not have the same number", 5},
      {kAbaqusNodes + "*ELEMENT\n1, 1, 2, 3, 5\n", "*ELEMENT", "must say of which type", 13},
      {kAbaqusNodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3\n", "element 1 with 3 nodes", "must have 4 nodes", 14},
      {kAbaqusNodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 99\n", "node 99", "nodes that are in the file", 14},
      {kAbaqusNodes + kAbaqusHexahedron + "100, 1, 2, 3, 14, 5, 6, 7, 8\n", "100", "two elements must not", 16},
      {kAbaqusNodes + "*NSET, NSET=a\n99\n", "99", "must name nodes and elements that are in the file", 13},
      {kAbaqusNodes + "*NSET, NSET=a\nb\n", "\"b\"", "no set of this name", 13},
      {kAbaqusNodes + "*NSET, NSET=a\n1,, 2\n", "\"1,, 2\"", "between two commas", 14},
      {kAbaqusNodes + "*NSET\n1\n", "*NSET", "must have a name", 13},
      {kAbaqusNodes + "*NSET, NSET=a, GENERATE\n1, 2, 0\n", "\"0\"", "from 1 to", 14},
      {kAbaqusNodes + "*NSET, NSET=a, GENERATE\n1\n", "\"1\"", "a range must have", 14},
      {kAbaqusNodes + "*NSET, NSET=a, INSTANCE=b\n1\n", "\"INSTANCE=b\"", "no instance of this name", 13},
      {"*NODE, SYSTEM=C\n1, 0, 0, 0\n", "\"SYSTEM=C\"", "Cartesian", 1},
      {"*HEADING\n*NODE, INPUT=nodes.inp\n", "*NODE", "several files", 2},
      {"*INCLUDE, INPUT=more.inp\n", "*INCLUDE", "several files", 1},
      {kAbaqusNodes + "*NGEN\n1, 2, 1\n", "*NGEN", "by a rule", 13},
      {"*HEADING\nnothing\n", "end of file", "must have nodes", 2},
      {"*INSTANCE, NAME=a, PART=b\n1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11\n", "\"1, 2", "displaced by three", 2},
  };
  for (const BrokenAbaqus& broken : all) {
    const InputFault fault = fault_of(broken.text);
    EXPECT_THAT(fault.value, HasSubstr(broken.value));
    EXPECT_THAT(fault.rule, HasSubstr(broken.rule));
    EXPECT_EQ(fault.line, broken.line) << broken.rule;
    EXPECT_FALSE(fault.remedy.empty());
  }
}

/// Each line of a short file names all nodes.
TEST(Abaqus, SetsOfSetsEndInABoundedTime) {
  std::string text = "*NODE, NSET=S\n";
  for (int i = 1; i <= 2000; ++i) text += std::to_string(i) + ", " + std::to_string(i) + ", 0, 0\n";
  for (int i = 0; i < 20000; ++i) text += "*NSET, NSET=T, GENERATE\n1, 2000\n";
  EXPECT_THAT(fault_of(text).rule, HasSubstr("a thousand times"));
}

}  // namespace
}  // namespace sinew::io
