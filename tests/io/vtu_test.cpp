#include "sinew/io/vtu.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <type_traits>

#include "sinew/io/atomic_file.hpp"
#include "sinew/io/mesh_file.hpp"

namespace sinew::io {
namespace {

/// A decoder of its own, digit by digit.
std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const auto digit = digits.find(c);
    EXPECT_NE(digit, std::string::npos);
    bits = (bits << 6 | static_cast<unsigned>(digit)) & 0xffffffu;
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 0xff);
    }
  }
  return bytes;
}

template <class Value>
std::vector<Value> values(const pugi::xml_node& parent, const char* name) {
  const auto array = parent.find_child_by_attribute("DataArray", "Name", name);
  EXPECT_TRUE(array) << name;
  EXPECT_STREQ(array.attribute("format").value(), "binary");
  const std::string type = std::is_same_v<Value, double> ? "Float64" : sizeof(Value) == 1 ? "UInt8" : "Int64";
  EXPECT_EQ(array.attribute("type").value(), type) << name;
  const std::string bytes = from_base64(array.child_value());
  std::uint64_t size = 0;
  if (bytes.size() < 8) return {};
  std::memcpy(&size, bytes.data(), 8);
  EXPECT_EQ(size, bytes.size() - 8) << name;
  std::vector<Value> out(size / sizeof(Value));
  if (size > 0) std::memcpy(out.data(), bytes.data() + 8, size);
  return out;
}

pugi::xml_node piece(const pugi::xml_document& document) {
  return document.child("VTKFile").child("UnstructuredGrid").child("Piece");
}

void expect_values(const Eigen::MatrixXd& expected, const std::vector<double>& got) {
  ASSERT_EQ(static_cast<std::size_t>(expected.size()), got.size());
  for (std::size_t i = 0; i < got.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(expected.data()[i]), std::bit_cast<std::uint64_t>(got[i])) << i;
}

SolidSnapshot two_tetrahedra() {
  SolidSnapshot solid;
  solid.name = "finger";
  solid.rest.resize(3, 5);
  solid.rest << 0, 1, 0, 0, 1,  //
      0, 0, 1, 0, 1,            //
      0, 0, 0, 1, 1;
  solid.nodes = solid.rest;
  solid.nodes.col(3) << 0.1, -0.0, 1.0 / 3.0;
  solid.nodes.col(4) << std::numeric_limits<double>::denorm_min(), 1e300, -7;
  solid.cells = {{solid::Kind::tet4, {0, 1, 2, 3}}, {solid::Kind::tet4, {1, 4, 2, 3}}};
  solid.von_mises.resize(2);
  solid.von_mises << 1234.5, 1e6 / 7;
  return solid;
}

RodSnapshot rod(int samples) {
  RodSnapshot r;
  r.name = "cable";
  r.radius = Eigen::VectorXd::LinSpaced(samples, 0.0005, 0.001);
  r.abscissa = Eigen::VectorXd::LinSpaced(samples, 0, 0.081);
  r.points = Eigen::Matrix3Xd::Random(3, samples);
  r.tangents = Eigen::Matrix3Xd::Random(3, samples);
  r.fields = {{"torsion", Eigen::MatrixXd::Random(1, samples)}, {"force", Eigen::MatrixXd::Random(3, samples)}};
  r.von_mises = Eigen::VectorXd::Random(samples);
  return r;
}

class Series : public testing::Test {
 protected:
  Series() {
    char name[] = "/tmp/sinew_vtu_XXXXXX";
    top_ = mkdtemp(name);
    folder_ = top_ / "deep" / "view";
  }
  ~Series() override { std::filesystem::remove_all(top_); }

  struct Entry {
    double time;
    int part;
    std::string name, file;
  };
  std::vector<Entry> entries(const std::string& pvd) const {
    pugi::xml_document document;
    EXPECT_TRUE(document.load_file((folder_ / pvd).c_str())) << pvd;
    std::vector<Entry> out;
    for (const auto set : document.child("VTKFile").child("Collection").children("DataSet"))
      out.push_back({set.attribute("timestep").as_double(), set.attribute("part").as_int(),
                     set.attribute("name").value(), set.attribute("file").value()});
    return out;
  }
  std::filesystem::path top_, folder_;
};

TEST(Vtu, solid_has_all_its_numbers) {
  const SolidSnapshot solid = two_tetrahedra();
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(vtu_text(solid, 0.25).c_str()));
  const auto p = piece(document);
  EXPECT_EQ(p.attribute("NumberOfPoints").as_int(), 5);
  EXPECT_EQ(p.attribute("NumberOfCells").as_int(), 2);
  expect_values(solid.nodes, values<double>(p.child("Points"), "Points"));
  expect_values(solid.nodes - solid.rest, values<double>(p.child("PointData"), "displacement"));
  expect_values(solid.von_mises, values<double>(p.child("CellData"), "von_mises"));
  EXPECT_EQ(values<std::int64_t>(p.child("Cells"), "connectivity"),
            (std::vector<std::int64_t>{0, 1, 2, 3, 1, 4, 2, 3}));
  EXPECT_EQ(values<std::int64_t>(p.child("Cells"), "offsets"), (std::vector<std::int64_t>{4, 8}));
  EXPECT_EQ(values<std::uint8_t>(p.child("Cells"), "types"), (std::vector<std::uint8_t>{10, 10}));
  EXPECT_EQ(values<double>(p.parent().child("FieldData"), "TimeValue"), std::vector<double>{0.25});
}

TEST(Vtu, cells_of_every_kind_are_read_as_they_were) {
  SolidSnapshot solid;
  solid.nodes = Eigen::Matrix3Xd::Zero(3, 15);
  solid.nodes.leftCols(8) << 0, 1, 1, 0, 0, 1, 1, 0,  //
      0, 0, 1, 1, 0, 0, 1, 1,                         //
      0, 0, 0, 0, 1, 1, 1, 1;
  // On top of the cube's corners 4, 5, 7 a curved tetrahedron to node 8 and, on one of its faces, a straight one.
  solid.nodes.col(8) << 0, 0, 3;
  const int edges[6][2] = {{4, 5}, {5, 7}, {7, 4}, {4, 8}, {5, 8}, {7, 8}};
  for (int e = 0; e < 6; ++e)
    solid.nodes.col(9 + e) = (solid.nodes.col(edges[e][0]) + solid.nodes.col(edges[e][1])) / 2;
  solid.nodes.col(10) += Eigen::Vector3d(0.1, 0.1, 0);
  solid.cells = {{solid::Kind::hex8, {0, 1, 2, 3, 4, 5, 6, 7}},
                 {solid::Kind::tet10, {4, 5, 7, 8, 9, 10, 11, 12, 13, 14}},
                 {solid::Kind::tet4, {5, 6, 7, 8}}};
  const std::string text = vtu_text(solid, 0.5);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(text.c_str()));
  const auto cells = piece(document).child("Cells");
  EXPECT_EQ(values<std::uint8_t>(cells, "types"), (std::vector<std::uint8_t>{12, 24, 10}));
  EXPECT_EQ(values<std::int64_t>(cells, "offsets"), (std::vector<std::int64_t>{8, 18, 22}));
  const solid::Mesh mesh = parse_mesh(text, "text");
  EXPECT_EQ(mesh.cells, solid.cells);
  EXPECT_EQ(mesh.nodes, solid.nodes);
}

TEST(Vtu, rod_has_all_its_numbers) {
  for (const int samples : {1, 2, 3, 7}) {  // (every padding of base64)
    const RodSnapshot r = rod(samples);
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(vtu_text(r, 0).c_str()));
    const auto p = piece(document);
    EXPECT_EQ(p.attribute("NumberOfCells").as_int(), 1);
    expect_values(r.points, values<double>(p.child("Points"), "Points"));
    const auto data = p.child("PointData");
    expect_values(r.abscissa, values<double>(data, "abscissa"));
    expect_values(r.radius, values<double>(data, "radius"));
    expect_values(r.tangents, values<double>(data, "tangent"));
    expect_values(r.von_mises, values<double>(data, "von_mises"));
    for (const Field& field : r.fields) expect_values(field.values, values<double>(data, field.name.c_str()));
    EXPECT_EQ(values<std::int64_t>(p.child("Cells"), "offsets"), std::vector<std::int64_t>{samples});
    EXPECT_EQ(values<std::uint8_t>(p.child("Cells"), "types"), std::vector<std::uint8_t>{4});
  }
}

TEST(Vtu, leaves_out_what_there_is_not) {
  RodSnapshot r = rod(4);
  r.fields[0].values.resize(1, 0);
  r.von_mises.resize(0);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(vtu_text(r, 0).c_str()));
  const auto data = piece(document).child("PointData");
  EXPECT_FALSE(data.find_child_by_attribute("Name", "torsion"));
  EXPECT_FALSE(data.find_child_by_attribute("Name", "von_mises"));
  EXPECT_TRUE(data.find_child_by_attribute("Name", "radius"));
  ASSERT_TRUE(document.load_string(vtu_text(RodSnapshot{}, 0).c_str()));
  EXPECT_EQ(piece(document).attribute("NumberOfPoints").as_int(), 0);
  ASSERT_TRUE(document.load_string(vtu_text(SolidSnapshot{}, 0).c_str()));
  EXPECT_EQ(piece(document).attribute("NumberOfCells").as_int(), 0);
}

TEST_F(Series, has_a_file_per_object_and_one_for_all_once_it_is_finished) {
  SeriesWriter writer(folder_);
  Snapshot snapshot;
  snapshot.solids = {two_tetrahedra()};
  snapshot.rods = {rod(3)};
  for (int k = 0; k < 3; ++k) {
    snapshot.time = 0.1 * k;
    snapshot.solids[0].nodes(0, 0) = k;
    writer.add(snapshot);
    EXPECT_FALSE(std::filesystem::exists(folder_));
  }
  writer.finish();
  writer.finish();
  EXPECT_THROW(writer.add(snapshot), std::logic_error);
  const auto finger = entries("finger.pvd"), all = entries("run.pvd");
  ASSERT_EQ(finger.size(), 3u);
  ASSERT_EQ(all.size(), 6u);
  for (std::size_t k = 0; k < 3; ++k) {
    const Entry &own = finger[k], &solid = all[2 * k], &cable = all[2 * k + 1];
    EXPECT_EQ(own.file, "finger_000" + std::to_string(k) + ".vtu");
    EXPECT_EQ(own.time, 0.1 * static_cast<double>(k));
    EXPECT_EQ(solid.file, own.file);
    EXPECT_EQ(solid.part, 0);
    EXPECT_EQ(cable.name, "cable");
    EXPECT_EQ(cable.part, 1);
    EXPECT_EQ(cable.time, own.time);
    pugi::xml_document document;
    ASSERT_TRUE(document.load_file((folder_ / own.file).c_str()));
    EXPECT_EQ(values<double>(piece(document).child("Points"), "Points")[0], static_cast<double>(k));
  }
  EXPECT_EQ(entries("cable.pvd").size(), 3u);
  SeriesWriter again(folder_);  // a shorter run into the same folder forgets the longer
  again.add(snapshot);
  again.finish();
  EXPECT_EQ(entries("run.pvd").size(), 2u);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "finger_0001.vtu"));
  {
    SeriesWriter given_up(folder_);
    given_up.add(snapshot);
  }
  EXPECT_EQ(entries("run.pvd").size(), 2u) << "what is not finished replaces nothing";
  EXPECT_FALSE(std::filesystem::exists(partial_path(folder_)));
}

TEST_F(Series, no_two_objects_share_a_file) {
  Snapshot snapshot;
  snapshot.solids = {two_tetrahedra(), two_tetrahedra(), two_tetrahedra()};
  snapshot.rods = {rod(2), rod(3)};
  snapshot.solids[0].name = snapshot.rods[0].name = "run";
  snapshot.solids[1].name = snapshot.rods[1].name = "arm";
  snapshot.solids[2].name = "../<odd> & \"name\"";
  SeriesWriter writer(folder_);
  writer.add(snapshot);
  writer.finish();
  const auto all = entries("run.pvd");
  ASSERT_EQ(all.size(), 5u);
  std::set<std::string> files, parts;
  for (const auto& entry : all) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / entry.file)) << entry.file;
    files.insert(entry.file);
    parts.insert(std::to_string(entry.part));
  }
  EXPECT_EQ(files.size(), 5u);
  EXPECT_EQ(parts.size(), 5u);
  EXPECT_EQ(all[0].file, "run_solid_0000.vtu");
  EXPECT_EQ(all[3].file, "run_rod_0000.vtu");
  EXPECT_EQ(all[1].file, "arm_0000.vtu");
  EXPECT_EQ(all[4].file, "arm_rod_0000.vtu");
  EXPECT_EQ(all[2].name, snapshot.solids[2].name);
}

TEST_F(Series, says_where_it_cannot_write) {
  AppendFile(top_ / "file", AppendFile::Start::empty);
  EXPECT_THROW(SeriesWriter(top_ / "file" / "view"), WriteError);
}

}  // namespace
}  // namespace sinew::io
