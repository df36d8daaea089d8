// Outputs: what is recorded of which material point.
#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_regions.hpp"
#include "sinew/sim/quantities.hpp"

namespace sinew::io {
namespace {

/// The region of a reaction.
Field<Output> region() {
  struct Holder {
    Region region;
  };
  const Type<Holder> type =
      map<Holder>({"a region", region_fields<Holder>(&Holder::region), {exactly_one(region_names())}});
  return {{"region", Need::optional, "whose held nodes a reaction is summed over; all of them if left out",
           "{box: [[0, 0, 0], [5 mm, 1 cm, 1 cm]]}"},
          [=](Output& output, const At& at) { output.region = type.read(at).region; },
          type.schema};
}

/// A solid's outputs are of a point, but for a reaction.
Rule point_unless_reaction() {
  const auto check = [](const At& at, const std::vector<Key>&) {
    if (!at.has("solid")) return;
    const bool reaction = at.says("quantity", "reaction");
    if (!reaction && !at.has("point"))
      at.refuse_key("solid", "is given without `point`", "add `point`, or remove `solid`");
    if (reaction && at.has("point"))
      at.refuse_key("point", "has no meaning for a reaction", "give a `region`, or nothing for all that is held");
  };
  const Json reaction = says_schema("quantity", "reaction");
  return {check, {{"if", {{"required", {"solid"}}, {"not", reaction}}}, {"then", {{"required", {"point"}}}}}};
}

std::string known() {
  return "of a solid " + known_of(Subject::solid) + "; of a rod " + known_of(Subject::rod) + "; of a body " +
         known_of(Subject::body) +
         ". An orientation is how it has turned since the start, a reaction the force on what is held in `region`, the "
         "force on a body that of all that touches it";
}

}  // namespace

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
        field<Output>(
            {"body", optional, "the rigid body that is recorded: its centre of mass, or the force on it", "cube"},
            &Output::body, name_of("body")),
        field<Output>({"between", optional, "two objects, of which is recorded how they touch", "[cube, floor]"},
                      &Output::between, list<std::string>("two names", text(), {2, 2})),
        field<Output>({"rod", optional, "the rod whose point is recorded", "cable"}, &Output::rod, name_of("rod")),
        field<Output>(
            {"at", optional, "the abscissa of the point on the rod [m]; `tip`, as if left out, is its tip", "100 mm"},
            &Output::at, abscissa()),
        field<Output>({"quantity", optional, "what is recorded there: " + known(), "strain"}, &Output::quantity,
                      word_of<Quantity>(quantity_words())),
        region()},
       {exactly_one({"solid", "rod", "body", "between"}), excludes("between", {"quantity"}), needs("point", "solid"),
        needs("in", "solid"), needs("reach", "solid"), needs("region", "solid"), needs("at", "rod"),
        point_unless_reaction()}});
}

}  // namespace sinew::io
