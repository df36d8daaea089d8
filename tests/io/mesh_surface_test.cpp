// Surfaces of triangles from STL and OBJ files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "sinew/contact/mesh.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/mesh_file.hpp"
#include "sinew/solid/mesh.hpp"

namespace sinew::io {
namespace {

using testing::HasSubstr;

/// A tetrahedron with corners at the origin and on the axes, turned outward.
constexpr float kCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3.5F}};
constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

std::string text_stl() {
  std::string text = "solid a part\n";
  for (const auto& face : kFaces) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const int corner : face) {
      text += "      vertex";
      for (const float x : kCorners[corner]) text += " " + std::to_string(x);
      text += "\n";
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid a part\n";
}

void append(std::string& bytes, const auto& value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof value);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

std::string binary_stl(float spoil = 0.0F) {
  std::string bytes = "solid, says the header of this binary file";  // some programs do that
  bytes.resize(80, ' ');
  append(bytes, std::uint32_t{4});
  for (const auto& face : kFaces) {
    for (int i = 0; i < 3; ++i) append(bytes, 0.0F);
    for (const int corner : face) {
      for (const float x : kCorners[corner]) append(bytes, x + spoil);
    }
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

const char* const kObj =
    "# a part\nmtllib part.mtl\no part\nv 0 0 0 1 0.5 0.5\nv 1 0 0\nv 0 2 0\nv 0 0 3.5\nvn 0 0 1\nvt 0 0\nusemtl "
    "red\ns off\n"
    "f 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1 # a remark\nf -4 -1 -2\r\nf 2 3 4\n";

void expect_tetrahedron(const solid::Mesh& mesh) {
  EXPECT_EQ(mesh.nodes.cols(), 4);
  EXPECT_EQ(mesh.faces.size(), 4U);
  EXPECT_TRUE(mesh.cells.empty());
  EXPECT_EQ(contact::open_edges(mesh.faces), 0);
  double volume = 0.0;
  for (const solid::Triangle& t : mesh.faces)
    volume += mesh.nodes.col(t[0]).dot(mesh.nodes.col(t[1]).cross(mesh.nodes.col(t[2]))) / 6.0;
  EXPECT_NEAR(volume, 7.0 / 6.0, 1e-12);
}

TEST(SurfaceFile, IsTheSameInEveryFormat) {
  expect_tetrahedron(parse_mesh(text_stl(), "part.stl"));
  expect_tetrahedron(parse_mesh(binary_stl(), "part.stl"));
  expect_tetrahedron(parse_mesh(kObj, "part.obj"));
}

TEST(SurfaceFile, WhatStandsBehindTheLastTriangleIsARemark) {
  expect_tetrahedron(parse_mesh(text_stl() + "made by a program, version 3\nfacet count 4\n", "part.stl"));
  expect_tetrahedron(parse_mesh(binary_stl() + std::string(7, '\n') + "COLOR=red", "part.STL"));
  expect_tetrahedron(parse_mesh(std::string(kObj) + "group the part\n", "part.obj"));
}

TEST(SurfaceFile, PolygonsBecomeTrianglesAndThoseWithoutAreaGo) {
  const solid::Mesh mesh =
      parse_mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 2 0\nv 0 1 0\nv -0 -0 0\nf 1 2 3 4 5\nf 1 6 2\n", "p.obj");
  EXPECT_EQ(mesh.nodes.cols(), 5);
  EXPECT_EQ(mesh.faces.size(), 3U);
  EXPECT_EQ(mesh.ignored.at("triangle without area"), 1);
}

void expect_fault(const std::string& bytes, int line, const std::string& value, const std::string& rule) {
  try {
    parse_mesh(bytes, "part");
    ADD_FAILURE() << "nothing is wrong with " << bytes;
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().file, "part");
    EXPECT_EQ(error.fault().line, line);
    EXPECT_THAT(error.fault().value, HasSubstr(value));
    EXPECT_THAT(error.fault().rule, HasSubstr(rule));
    EXPECT_FALSE(error.fault().remedy.empty());
  }
}

TEST(SurfaceFile, FaultsAreToldWithTheirLine) {
  std::string spoilt = text_stl();
  spoilt.replace(spoilt.find("endloop"), 7, "vertex ");
  expect_fault(spoilt, 7, "vertex", "`endloop`");
  spoilt = text_stl();
  expect_fault(spoilt.substr(0, spoilt.find("endfacet")), 8, "", "endfacet");
  spoilt.replace(spoilt.find("1.0"), 3, "nan");
  expect_fault(spoilt, 6, "nan", "");
  expect_fault("solid nothing\nendsolid\n", 0, "", "no triangles");
  expect_fault("solid s\nfacets\n", 2, "facets", "`facet`");
  expect_fault(binary_stl(std::numeric_limits<float>::infinity()), 0, "inf", "finite");
  expect_fault("v 0 0 0\nv 1 0 0\nf 1 2 3\n", 3, "3", "2 points");
  expect_fault("v 0 0 0\nf 0 1 1\n", 2, "0", "1 points");
  expect_fault("v 0 0 0\nf -2 1 1\n", 2, "-2", "1 points");
  expect_fault("v 0 0 0\nf -9223372036854775808 1 1\n", 2, "-9223372036854775808", "1 points");
  expect_fault("v 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nv 0 0 0\nf 1 2 3 4 5 6\n", 7, "f", "dent");
  expect_fault("v 0 0 0\nf 1 x 1\n", 2, "x", "1 points");
  expect_fault("v 0 0 0\nv 1 0 0\nf 1 2\n", 3, "f", "three corners");
  expect_fault("v 0 0\n\nvn 1 1 1\n", 3, "vn", "");
  expect_fault("v 0 0 0\ncurv 0 1\n", 2, "curv", "polygons");
}

TEST(SurfaceFile, ACutBinaryFileIsToldAsSuch) {
  try {
    parse_mesh("Exported by a program" + binary_stl().substr(21, 200), "part.stl");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.fault().value, HasSubstr("221 bytes"));
    EXPECT_THAT(error.fault().remedy, HasSubstr("cut short"));
  }
}

}  // namespace
}  // namespace sinew::io
