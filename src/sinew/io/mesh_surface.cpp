// Surfaces of triangles: STL, text and binary, and Wavefront OBJ.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "sinew/io/byte_cursor.hpp"
#include "sinew/io/mesh_formats.hpp"

namespace sinew::io {
namespace {

constexpr std::size_t kHeader = 80, kFacet = 50;  // bytes of a binary STL file

/// Triangles as they are read. Points at the very same place become one; triangles with two such corners, which
/// programs of construction write where faces meet, are left out.
class Surface {
 public:
  int point(const Eigen::Vector3d& p) {
    const auto [entry, fresh] = number_.try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}, std::ssize(points_));
    if (fresh) points_.push_back(p);
    return static_cast<int>(entry->second);
  }

  void add(int a, int b, int c) {
    if (a == b || b == c || c == a) {
      ++flat_;
    } else {
      faces_.push_back({a, b, c});
    }
  }

  /// Whether a triangle of a polygon's fan looks against the polygon.
  bool dented(const std::vector<int>& corners) const {
    std::vector<Eigen::Vector3d> areas;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const auto at = [&](std::size_t i) { return points_[static_cast<std::size_t>(corners[i])]; };
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      areas.push_back((at(i) - at(0)).cross(at(i + 1) - at(0)));
      sum += areas.back();
    }
    return std::any_of(areas.begin(), areas.end(),
                       [&](const Eigen::Vector3d& area) { return area.dot(sum) < -1e-9 * sum.squaredNorm(); });
  }

  solid::Mesh mesh() && {
    solid::Mesh made;
    made.nodes.resize(3, std::ssize(points_));
    for (std::size_t i = 0; i < points_.size(); ++i) made.nodes.col(static_cast<Eigen::Index>(i)) = points_[i];
    made.faces = std::move(faces_);
    if (flat_ > 0) made.ignored["triangle without area"] = flat_;
    return made;
  }

 private:
  std::map<std::array<double, 3>, std::ptrdiff_t> number_;  // -0 made 0
  std::vector<Eigen::Vector3d> points_;
  std::vector<solid::Triangle> faces_;
  int flat_ = 0;
};

Eigen::Vector3d vector(ByteCursor& cursor, Encoding encoding, std::string_view what) {
  Eigen::Vector3d own;
  for (double& x : own) {
    x = cursor.real(encoding.text ? NumberType::f64 : NumberType::f32, encoding, what);
    if (!std::isfinite(x)) cursor.fail(fmt::format("{}", x), "coordinates must be finite", "export the part again");
  }
  return own;
}

void expect(ByteCursor& cursor, std::string_view wanted) {
  const std::string_view word = cursor.word(wanted);
  if (!equal_ignoring_case(word, wanted))
    cursor.fail(in_quotes(word), fmt::format("here `{}` must stand", wanted),
                "export the part again, best as binary STL");
}

void read_text_facet(ByteCursor& cursor, Surface& surface) {
  expect(cursor, "normal");
  for (int i = 0; i < 3; ++i) cursor.word("a normal");  // of no use, and often wrong
  expect(cursor, "outer");
  expect(cursor, "loop");
  std::array<int, 3> corner{};
  for (int& own : corner) {
    expect(cursor, "vertex");
    own = surface.point(vector(cursor, {}, "a coordinate"));
  }
  expect(cursor, "endloop");
  expect(cursor, "endfacet");
  surface.add(corner[0], corner[1], corner[2]);
}

/// The number of a corner as OBJ files have it: from 1, or backwards from the last point; after it what is not used.
int corner_of(ByteCursor& cursor, std::string_view token, std::size_t count) {
  const std::string_view digits = token.substr(0, token.find('/'));
  long long number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const auto points = static_cast<long long>(count);
  if (error != std::errc() || end != digits.data() + digits.size() || number == 0 || number < -points ||
      number > points)
    cursor.fail(in_quotes(token), fmt::format("a corner must be one of the {} points before it", count),
                "export the part again");
  return static_cast<int>(number > 0 ? number - 1 : points + number);
}

void read_obj_face(ByteCursor& cursor, const std::vector<int>& points, Surface& surface) {
  std::string_view rest = cursor.line();
  std::vector<int> corners;
  while (true) {
    const std::size_t from = rest.find_first_not_of(" \t\r");
    if (from == std::string_view::npos) break;
    rest.remove_prefix(from);
    const std::string_view token = rest.substr(0, rest.find_first_of(" \t\r"));
    rest.remove_prefix(token.size());
    if (token.starts_with("#")) break;
    corners.push_back(points[static_cast<std::size_t>(corner_of(cursor, token, points.size()))]);
  }
  if (corners.size() < 3) cursor.fail("f", "a face must have three corners or more", "export the part again");
  if (surface.dented(corners))
    cursor.fail("f", "a face with a dent cannot be cut into triangles here", "export the part with triangles alone");
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) surface.add(corners[0], corners[i], corners[i + 1]);
}

/// Lines of an OBJ file that say nothing about its polygons: normals, texture, names, lines, remarks.
bool passed_over(std::string_view word) {
  static constexpr std::array<std::string_view, 11> others = {"vn", "vt",     "vp",     "o", "g", "group",
                                                              "s",  "mtllib", "usemtl", "l", "p"};
  return word.starts_with("#") || std::find(others.begin(), others.end(), word) != others.end();
}

}  // namespace

std::size_t binary_stl_size(std::string_view bytes) {
  if (bytes.size() < kHeader + 4) return 0;
  ByteCursor cursor(bytes.substr(kHeader, 4), "");
  const auto count = static_cast<std::size_t>(cursor.integer(NumberType::u32, {.text = false}, ""));
  const std::size_t size = kHeader + 4 + kFacet * count;
  return count > 0 && bytes.size() >= size ? size : 0;
}

solid::Mesh parse_binary_stl(std::string_view bytes, const std::string& file) {
  ByteCursor cursor(bytes.substr(kHeader + 4), file);
  cursor.fix_line(0);
  const Encoding binary{.text = false};
  Surface surface;
  for (std::size_t i = 0; i < (bytes.size() - kHeader - 4) / kFacet; ++i) {
    cursor.skip(3, NumberType::f32, binary, "a normal");
    std::array<int, 3> corner{};
    for (int& own : corner) own = surface.point(vector(cursor, binary, "a corner"));
    cursor.skip(1, NumberType::u16, binary, "an attribute");
    surface.add(corner[0], corner[1], corner[2]);
  }
  return std::move(surface).mesh();
}

solid::Mesh parse_text_stl(std::string_view bytes, const std::string& file) {
  ByteCursor cursor(bytes, file);
  Surface surface;
  bool ended = false;  // what stands between two solids, or behind the last one, is a remark
  while (!cursor.done()) {
    const std::string_view word = cursor.word("a facet");
    if (equal_ignoring_case(word, "solid") || equal_ignoring_case(word, "endsolid")) {
      ended = equal_ignoring_case(word, "endsolid");
      cursor.line();
    } else if (ended) {
      cursor.line();
    } else if (equal_ignoring_case(word, "facet")) {
      read_text_facet(cursor, surface);
    } else {
      cursor.fail(in_quotes(word), "here `facet` or `endsolid` must stand",
                  "export the part again, best as binary STL");
    }
  }
  return std::move(surface).mesh();
}

bool is_obj(std::string_view first) { return first == "v" || first == "f" || passed_over(first); }

solid::Mesh parse_obj(std::string_view bytes, const std::string& file) {
  ByteCursor cursor(bytes, file);
  Surface surface;
  std::vector<int> points;
  while (!cursor.done()) {
    const std::string_view word = cursor.word("a line of the file");
    if (word == "v") {
      points.push_back(surface.point(vector(cursor, {}, "a coordinate")));
      cursor.line();
    } else if (word == "f") {
      read_obj_face(cursor, points, surface);
    } else if (passed_over(word)) {
      cursor.line();
    } else {
      cursor.fail(in_quotes(word), "is no line of a surface of polygons", "export the part again, as polygons");
    }
  }
  return std::move(surface).mesh();
}

}  // namespace sinew::io
