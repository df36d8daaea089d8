#include "sinew/io/scene_regions.hpp"

#include <fmt/format.h>

namespace sinew::io {
namespace {

using enum Need;

Type<Region> within_box() {
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
  return {[=](const At& at) -> Region {
            const std::vector<Vec3> two = corners.read(at);
            return Box{two[0], two[1]};
          },
          corners.schema};
}

Type<Region> within_sphere() {
  const Type<Sphere> type = map<Sphere>({"a sphere",
                                         {field<Sphere>({"center", required, "its centre [m]", "[0, 0, 10 mm]"},
                                                        &Sphere::center, vec3(Dimension::length)),
                                          field<Sphere>({"radius", required, "its radius [m]", "5 mm"}, &Sphere::radius,
                                                        quantity(Dimension::length, above(0.0)))}});
  return {[=](const At& at) -> Region { return type.read(at); }, type.schema};
}

Type<Region> on_plane() {
  const Type<Plane> type = map<Plane>(
      {"a plane",
       {field<Plane>({"point", required, "a point of it [m]", "[0, 0, 0]"}, &Plane::point, vec3(Dimension::length)),
        field<Plane>({"normal", required, "the direction across it", "[1, 0, 0]"}, &Plane::normal, direction()),
        field<Plane>({"within", optional, "how far to either side nodes still count [m]", "0.1 mm"}, &Plane::within,
                     quantity(Dimension::length, at_least(0.0)))}});
  return {[=](const At& at) -> Region { return type.read(at); }, type.schema};
}

Type<Region> nodes() {
  const Type<std::vector<int>> type =
      list<int>("node numbers of the mesh file, from 0", whole_number(0, 2000000000), {1});
  return {[=](const At& at) -> Region { return NodeNumbers{type.read(at)}; }, type.schema};
}

Type<Region> group() {
  const Type<std::string> type = text();
  return {[=](const At& at) -> Region { return GroupName{type.read(at)}; }, type.schema};
}

Type<Region> whole_surface() {
  const Type<bool> type = boolean();
  return {[=](const At& at) -> Region {
            if (!type.read(at)) at.refuse("can only be true", "leave it out and give another region");
            return WholeSurface{};
          },
          [] {
            return Json{{"const", true}};
          }};
}

}  // namespace

const std::vector<RegionKey>& region_keys() {
  static const std::vector<RegionKey> keys = {
      {{"box", optional, "the lower and the upper corner of a box [m]", "[[0, 0, 0], [5 mm, 1 cm, 1 cm]]"},
       within_box()},
      {{"sphere", optional, "a sphere", "{center: [0, 0, 10 mm], radius: 5 mm}"}, within_sphere()},
      {{"plane", optional, "a plane, with what lies on it", "{point: [0, 0, 0], normal: [1, 0, 0]}"}, on_plane()},
      {{"nodes", optional, "node numbers of the mesh file, from 0", "[0, 3, 17]"}, nodes()},
      {{"group", optional, "what the mesh file has given this name: a physical group, or a cell tag", "base"}, group()},
      {{"surface", optional, "true: the whole boundary", "true"}, whole_surface()}};
  return keys;
}

std::vector<std::string> region_names() {
  std::vector<std::string> names;
  for (const RegionKey& own : region_keys()) names.push_back(own.key.name);
  return names;
}

void set_in(Region& region, In in, const At& at) {
  std::visit(
      [&](auto& own) {
        if constexpr (requires { own.in; }) {
          own.in = in;
        } else {
          at.refuse("has no meaning for a region without coordinates", "leave it out");
        }
      },
      region);
}

Type<std::array<bool, 3>> axes(Count count) {
  enum class Axis { x, y, z };
  const Type<std::vector<Axis>> some = distinct<Axis>("axes", {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}}, count);
  const auto read = [=](const At& at) {
    std::array<bool, 3> held = {};
    for (const Axis axis : some.read(at)) held[static_cast<std::size_t>(axis)] = true;
    return held;
  };
  const auto show = [=](const std::array<bool, 3>& held) {
    std::vector<Axis> listed;
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
      if (held[static_cast<std::size_t>(axis)]) listed.push_back(axis);
    }
    return some.show(listed);
  };
  return {read, some.schema, show};
}

}  // namespace sinew::io
