#include "sinew/io/scene_values.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sinew::io {
namespace {

constexpr Need optional = Need::optional;
constexpr Need required = Need::required;

/// Neighbours must ascend; the fault stands at the later one.
void check_ascending(const std::vector<double>& values, const At& at) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (!(values[i] > values[i - 1])) at.item(i).refuse("must be greater than the value before it");
  }
}

void check_one_per_time(std::size_t size, std::size_t times, const At& at) {
  if (size != times) {
    at.refuse(fmt::format("must have one entry per time, {}, not {}", times, size),
              "give one entry for each of `times`");
  }
}

Type<Box> region() {
  const auto set_corners = [](Box& box, const std::vector<Vec3>& corners) {
    box.lower = corners[0];
    box.upper = corners[1];
  };
  const auto check = [](const std::vector<Vec3>& corners, const At& at) {
    for (int axis = 0; axis < 3; ++axis) {
      if (corners[0][axis] <= corners[1][axis]) continue;
      at.refuse(fmt::format("must have its lower corner first: {} > {} m along {}", corners[0][axis], corners[1][axis],
                            "xyz"[axis]),
                "swap the two numbers of this axis");
    }
    if (corners[0] == corners[1]) at.refuse("must not be empty: both corners are the same point", "enlarge the box");
  };
  const Type<std::vector<Vec3>> corners =
      list<Vec3>("corners, lower then upper", vec3(Dimension::length), {2, 2}, check);
  Field<Box> box = {{"box", required, "the lower and the upper corner of a box [m]", "[[0, 0, 0], [5 mm, 1 cm, 1 cm]]"},
                    [=](Box& target, const At& at) { set_corners(target, corners.read(at)); },
                    corners.schema};
  return map<Box>(
      {"a region",
       {box,
        field<Box>({"in", optional, "where the corners are given, in the object before its pose or the world", "world"},
                   &Box::in, in())}});
}

}  // namespace

Type<Vec3> vec3(Dimension dimension) {
  const Type<std::vector<double>> three =
      list<double>(dimension == Dimension::number
                       ? "numbers [x, y, z]"
                       : std::string(name(dimension).substr(name(dimension).find(' ') + 1)) + " values [x, y, z]",
                   quantity(dimension), {3, 3});
  const auto read = [=](const At& at) {
    const std::vector<double> values = three.read(at);
    return Vec3(values[0], values[1], values[2]);
  };
  return {read, three.schema, [](const Vec3& v) { return Json{v.x(), v.y(), v.z()}; }};
}

Type<Vec3> direction() {
  const Type<Vec3> any = vec3(Dimension::number);
  const auto read = [=](const At& at) {
    const Vec3 value = any.read(at);
    if (value.isZero(0.0)) at.refuse("must not be zero: it is a direction");
    return value;
  };
  return {read, any.schema};
}

Type<In> in() { return word_of<In>({"object", "world"}); }

Type<Pose> pose() {
  return map<Pose>(
      {"a pose",
       {field<Pose>({"rotate", optional, "the angles [a, b, c] of R = Rz(c) Ry(b) Rx(a) [rad]", "[0, 0, 90 deg]"},
                    &Pose::rotate, vec3(Dimension::angle)),
        field<Pose>({"translate", optional, "the shift after the rotation [m]", "[0, 20 mm, 0]"}, &Pose::translate,
                    vec3(Dimension::length))}});
}

Type<std::vector<double>> times() { return list<double>("times", quantity(Dimension::time), {1}, check_ascending); }

Type<FrameMotion> frame_motion() {
  const auto check = [](const FrameMotion& motion, const At& at) {
    if (at.has("rotate")) check_one_per_time(motion.rotate.size(), motion.times.size(), at.child("rotate"));
    if (at.has("translate")) check_one_per_time(motion.translate.size(), motion.times.size(), at.child("translate"));
    if (!at.has("rotate") && !at.has("translate")) {
      at.refuse_key("translate", "is missing: a motion needs rotate, translate or both",
                    "add one, for example `translate: [[0, 0, 0], [0, 20 mm, 0]]`");
    }
  };
  return map<FrameMotion>(
      {"a motion",
       {field<FrameMotion>({"times", required, "the ascending times of the entries below [s]", "[0, 2]"},
                           &FrameMotion::times, times()),
        field<FrameMotion>({"rotate", optional, "the angles [a, b, c] at each time [rad]", "[[0, 0, 0], [0, 0, 1]]"},
                           &FrameMotion::rotate, list<Vec3>("angles, one per time", vec3(Dimension::angle), {1})),
        field<FrameMotion>({"translate", optional, "the shift at each time [m]", "[[0, 0, 0], [0, 20 mm, 0]]"},
                           &FrameMotion::translate, list<Vec3>("shifts, one per time", vec3(Dimension::length), {1}))},
       {},
       check});
}

Type<std::vector<Box>> regions() {
  const Type<Box> one = region();
  const Type<std::vector<Box>> several = list<Box>("regions", one, {1});
  return {[=](const At& at) { return at.is(Node::Kind::list) ? several.read(at) : std::vector<Box>{one.read(at)}; },
          [=] {
            return any_of({one.schema(), several.schema()});
          }};
}

Type<std::filesystem::path> file_name() {
  const Type<std::string> name = text();
  return {[=](const At& at) { return std::filesystem::path(name.read(at)); }, name.schema};
}

Type<std::vector<Vec3>> path() {
  return list<Vec3>("points [x, y, z]", vec3(Dimension::length), {2},
                    [](const std::vector<Vec3>& points, const At& at) {
                      for (std::size_t i = 1; i < points.size(); ++i) {
                        if (points[i] == points[i - 1])
                          at.item(i).refuse("is the same point as the one before it", "remove one of them");
                      }
                    });
}

Type<std::vector<Strain>> strains() {
  const Type<Strain> one = word_of<Strain>({"torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"});
  Type<std::vector<Strain>> type =
      list<Strain>("strains", one, {1, 6}, [](const std::vector<Strain>& values, const At& at) {
        for (std::size_t i = 0; i < values.size(); ++i) {
          if (std::count(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(i), values[i]) > 0) {
            at.item(i).refuse("is listed twice", "keep one of them");
          }
        }
      });
  const auto read = [type](const At& at) {
    std::vector<Strain> values = type.read(at);
    std::sort(values.begin(), values.end());  // the order of the six is the same everywhere
    return values;
  };
  const auto show = [=](const std::vector<Strain>& values) {
    Json json = Json::array();
    for (const Strain strain : values) json.push_back(one.show(strain));
    return json;
  };
  return {read,
          [type] {
            Json json = type.schema();
            json["uniqueItems"] = true;
            return json;
          },
          show};
}

Type<Drive> drive(Dimension dimension) {
  const Type<double> value = quantity(dimension);
  const Type<Table> table = map<Table>(
      {"a table over time",
       {field<Table>({"times", required, "the ascending times of the values [s]", "[0, 1]"}, &Table::times, times()),
        field<Table>({"values", required,
                      fmt::format("the value at each time [{}], linear in between", si_unit(dimension)), "[0, 0.02]"},
                     &Table::values, list<double>("values, one per time", value, {1}))},
       {},
       [](const Table& t, const At& at) { check_one_per_time(t.values.size(), t.times.size(), at.child("values")); }});
  const auto read = [=](const At& at) -> Drive {
    if (at.is(Node::Kind::map)) return table.read(at);
    if (at.is(Node::Kind::scalar) && at.node().text == "external") return External{};
    const bool word = at.is(Node::Kind::scalar) && at.node().text.find_first_of("0123456789") == std::string::npos;
    if (word || !at.is(Node::Kind::scalar)) {
      at.refuse(fmt::format("must be {}, a table over time or `external`", name(dimension)));
    }
    return Table{{0.0}, {value.read(at)}};
  };
  return {read, [=] { return any_of({value.schema(), Json{{"const", "external"}}, table.schema()}); }};
}

Type<std::variant<int, std::vector<double>>> count_or_lengths(int least, bool from_zero) {
  using Value = std::variant<int, std::vector<double>>;
  const Type<int> count = whole_number(least, 10000);
  const Type<std::vector<double>> lengths =
      list<double>("lengths", quantity(Dimension::length, at_least(0.0)), {from_zero ? 2u : 1u, 10001},
                   [=](const std::vector<double>& values, const At& at) {
                     check_ascending(values, at);
                     if (from_zero && values[0] != 0.0) at.item(0).refuse("must be 0, where the rod starts");
                   });
  const auto read = [=](const At& at) -> Value {
    if (at.is(Node::Kind::list)) return lengths.read(at);
    return count.read(at);
  };
  const auto show = [](const Value& value) { return Json(std::get<int>(value)); };
  return {read, [=] { return any_of({count.schema(), lengths.schema()}); }, show};
}

}  // namespace sinew::io
