// Loads: forces and moments on a point of a rod or along a piece of it.
#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_values.hpp"

namespace sinew::io {
namespace {

using enum Need;

/// A vector that is per length in a distributed load. A moment per length is a force.
Field<Load> resultant(Key key, Vec3 Load::*where, Dimension of_point, Dimension distributed) {
  const Type<Vec3> point = vec3(of_point), per_length = vec3(distributed);
  return {std::move(key), [=](Load& load, const At& at) { load.*where = (load.from ? per_length : point).read(at); },
          [=] {
            return any_of({point.schema(), per_length.schema()});
          }};
}

}  // namespace

Type<Load> load() {
  const auto check = [](const Load& load, const At& at) {
    if (load.from && load.to) check_from_to(*load.from, *load.to, at);
  };
  return map<Load>(
      {"a load",
       {field<Load>({"rod", required, "the rod that is loaded", "cable"}, &Load::rod, name_of("rod")),
        field<Load>({"at", optional, "the abscissa of a point load [m]; the tip if left out", "50 mm"}, &Load::at,
                    quantity(Dimension::length, at_least(0.0))),
        field<Load>({"from", optional, "the abscissa where a distributed load begins [m]", "0"}, &Load::from,
                    quantity(Dimension::length, at_least(0.0))),
        field<Load>({"to", optional, "the abscissa where a distributed load ends [m]", "100 mm"}, &Load::to,
                    quantity(Dimension::length, at_least(0.0))),
        resultant({"force", optional, "the force [N], of a distributed load per length [N/m]", "[0, 0, -1 N]"},
                  &Load::force, Dimension::force, Dimension::line_load),
        resultant({"moment", optional, "the moment [N m], of a distributed load per length [N]", "[0, 20 mN m, 0]"},
                  &Load::moment, Dimension::torque, Dimension::force),
        field<Load>({"follower", optional, "in the axes of the turning cross-section instead of the world's", "true"},
                    &Load::follower, boolean()),
        field<Load>({"factor", optional, "what both are multiplied by: a number, a table over time or `external`",
                     "{times: [0, 1], values: [0, 1]}"},
                    &Load::factor, drive(Dimension::number))},
       {at_least_one({"force", "moment"}), excludes("at", {"from", "to"}), needs("from", "to"), needs("to", "from")},
       check});
}

}  // namespace sinew::io
