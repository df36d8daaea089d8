// Outputs: what is recorded of which material point.
#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_values.hpp"

namespace sinew::io {
Type<Output> output() {
  using enum Need;
  const auto x = [](Output& o) -> Vec3& { return o.point.x; };
  const auto where = [](Output& o) -> In& { return o.point.in; };
  return map<Output>(
      {"an output",
       {field<Output>({"solid", optional, "the solid whose point is recorded", "finger"}, &Output::solid,
                      name_of("solid")),
        field<Output>({"point", optional, "the point of the solid [m]", "[100 mm, 0, 0]"}, x, vec3(Dimension::length)),
        field<Output>({"in", optional, "where point is given, in the object before its pose or the world", "world"},
                      where, in()),
        field<Output>({"reach", optional, "how far outside the mesh the point may lie [m]", "2 mm"}, &Output::reach,
                      quantity(Dimension::length, at_least(0.0))),
        field<Output>({"rod", optional, "the rod whose point is recorded", "cable"}, &Output::rod, name_of("rod")),
        field<Output>({"at", optional, "the abscissa of the point on the rod [m]", "100 mm"}, &Output::at,
                      quantity(Dimension::length, at_least(0.0))),
        field<Output>(
            {"quantity", optional,
             "what is recorded there: the position, or of a rod also strain, force, moment or stress", "strain"},
            &Output::quantity, word_of<Quantity>({"position", "strain", "force", "moment", "stress"}))},
       {exactly_one({"solid", "rod"}), needs("solid", "point"), needs("point", "solid"), needs("in", "solid"),
        needs("reach", "solid"), needs("rod", "at"), needs("at", "rod"), only_with("solid", "quantity", "position")}});
}

}  // namespace sinew::io
