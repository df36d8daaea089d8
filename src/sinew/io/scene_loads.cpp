// Loads: forces and moments on a point of a rod or along a piece of it, forces and pressure on solids.
#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_regions.hpp"

namespace sinew::io {
namespace {

using enum Need;

/// A vector that is per length in a distributed load. A moment per length is a force.
Field<RodLoad> resultant(Key key, Vec3 RodLoad::*where, Dimension of_point, Dimension distributed) {
  const Type<Vec3> point = vec3(of_point), per_length = vec3(distributed);
  return {std::move(key), [=](RodLoad& load, const At& at) { load.*where = (load.from ? per_length : point).read(at); },
          [=] {
            return any_of({point.schema(), per_length.schema()});
          }};
}

Type<RodLoad> rod_load() {
  const auto check = [](const RodLoad& load, const At& at) {
    if (load.from && load.to) check_from_to(*load.from, *load.to, at);
  };
  return map<RodLoad>(
      {"a load",
       {field<RodLoad>({"rod", required, "the rod that is loaded", "cable"}, &RodLoad::rod, name_of("rod")),
        field<RodLoad>({"at", optional, "the abscissa of a point load [m]; `tip`, as if left out, is the tip", "50 mm"},
                       &RodLoad::at, abscissa()),
        field<RodLoad>({"from", optional, "the abscissa where a distributed load begins [m]", "0"}, &RodLoad::from,
                       quantity(Dimension::length, at_least(0.0))),
        field<RodLoad>({"to", optional, "the abscissa where a distributed load ends [m]", "100 mm"}, &RodLoad::to,
                       quantity(Dimension::length, at_least(0.0))),
        resultant({"force", optional, "the force [N], of a distributed load per length [N/m]", "[0, 0, -1 N]"},
                  &RodLoad::force, Dimension::force, Dimension::line_load),
        resultant({"moment", optional, "the moment [N m], of a distributed load per length [N]", "[0, 20 mN m, 0]"},
                  &RodLoad::moment, Dimension::torque, Dimension::force),
        field<RodLoad>(
            {"follower", optional, "in the axes of the turning cross-section instead of the world's", "true"},
            &RodLoad::follower, boolean()),
        field<RodLoad>({"factor", optional, "what both are multiplied by: a number, a table over time or `external`",
                        "{times: [0, 1], values: [0, 1]}"},
                       &RodLoad::factor, drive(Dimension::number))},
       {at_least_one({"force", "moment"}), excludes("at", {"from", "to"}), needs("from", "to"), needs("to", "from")},
       check});
}

Type<SolidLoad> solid_load() {
  using L = SolidLoad;
  return map<L>(
      {"a load",
       together<L>(
           together<L>(
               {field<L>({"solid", required, "the solid that is loaded", "finger"}, &L::solid, name_of("solid"))},
               region_fields<L>(&L::region)),
           {field<L>(
                {"force", optional, "the force in all [N], spread evenly over the region's surface", "[0, 0, -1 N]"},
                &L::force, vec3(Dimension::force)),
            field<L>({"pressure", optional,
                      "the pressure [Pa] on the region's surface, which it follows; negative: suction", "20 kPa"},
                     &L::pressure, quantity(Dimension::pressure)),
            field<L>({"factor", optional, "what both are multiplied by: a number, a table over time or `external`",
                      "{times: [0, 1], values: [0, 1]}"},
                     &L::factor, drive(Dimension::number))}),
       {at_least_one({"force", "pressure"}), exactly_one(region_names())}});
}

}  // namespace

/// Which of the two it is, its key `rod` or `solid` says.
Type<Load> load() {
  const Type<RodLoad> on_rod = rod_load();
  const Type<SolidLoad> on_solid = solid_load();
  return {[=](const At& at) -> Load {
            if (at.is(Node::Kind::map) && at.has("solid") && !at.has("rod")) return on_solid.read(at);
            return on_rod.read(at);
          },
          [=] {
            return any_of({on_rod.schema(), on_solid.schema()});
          }};
}

}  // namespace sinew::io
