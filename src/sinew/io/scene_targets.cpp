// Targets: where outputs are to be brought.
#include <algorithm>

#include "sinew/io/nearest.hpp"
#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_values.hpp"

namespace sinew::io {
namespace {

using enum Need;

/// What the numbers of a target are.
struct Measure {
  Dimension dimension = Dimension::length;
  int components = 3;
};

bool is_length(Strain strain) { return strain >= Strain::elongation; }

/// That of the output of the same name.
Measure measure_of(const At& target, const std::string& output, const Target& own) {
  const std::optional<At> named = target.object("outputs", output);
  if (named && named->has("between")) return {Dimension::force, 1};
  if (named && named->says("quantity", "orientation")) return {Dimension::angle, 3};
  if (named && named->says("quantity", "strain"))
    return {is_length(own.strain) ? Dimension::number : Dimension::curvature, 1};
  return {};
}

Type<std::vector<double>> weights() {
  return list<double>("weights", quantity(Dimension::number, at_least(0.0)), {1, 3});
}

}  // namespace

Type<std::vector<Target>> targets() {
  const auto at_key =
      Key{"at", required,
          "where it is to be: a value, a table over time or `external`; of a position [x, y, z] [m], of "
          "an orientation the turn since the start as a rotation vector [rad], of a strain one number "
          "[1/m], of an output `between` two how hard they press [N]",
          "[120 mm, 0, 30 mm]"};
  Field<Target> where = {at_key, [](Target&, const At&) {},
                         [] {
                           return any_of({track(Dimension::length, 3).schema(), track(Dimension::angle, 3).schema(),
                                          track(Dimension::curvature, 1).schema(), track(Dimension::number, 1).schema(),
                                          track(Dimension::force, 1).schema(), Json{{"const", "external"}}});
                         }};
  Field<Target> tolerance = {
      {"tolerance", optional,
       "how far off still counts as reached; 0.1 mm, 0.1 deg, 0.1 1/m, 0.1 % or 0.01 N if left out", "0.5 mm"},
      [](Target&, const At&) {},
      [] {
        return any_of({quantity(Dimension::length).schema(), quantity(Dimension::angle).schema(),
                       quantity(Dimension::curvature).schema(), quantity(Dimension::force).schema()});
      }};
  const Type<Target> target = map<Target>(
      {"a target",
       {where,
        field<Target>({"strain", optional, "which strain of the output, where that is one", "bending_y"},
                      &Target::strain, word_of<Strain>(strain_words())),
        field<Target>({"weights", optional,
                       "how much each component matters, 0 where it may be anything; all 1 if left out", "[1, 1, 0]"},
                      &Target::weights, weights()),
        tolerance}});
  const auto read = [=](const At& at) {
    std::vector<Target> all;
    if (!at.is(Node::Kind::map)) at.refuse("must be a map from the name of an output to where it is to be");
    for (std::size_t i = 0; i < at.node().entries.size(); ++i) {
      const std::string& name = at.node().entries[i].key;
      const At own = at.entry(i);
      const std::vector<std::string> known = at.names_in("outputs");
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        const std::string near = nearest(name, known);
        at.refuse_key(name, "is not the name of an output of this scene",
                      near.empty()
                          ? "describe it under `outputs:`, as in `" + name + ": {solid: finger, point: [100 mm, 0, 0]}`"
                          : "did you mean `" + near + "`?");
      }
      Target value = target.read(own);
      value.output = name;
      const std::optional<At> output = own.object("outputs", name);
      if (own.has("strain") && !(output && output->says("quantity", "strain")))
        own.refuse_key("strain", "is of outputs with `quantity: strain`", "remove it, or record a strain there");
      const Measure measure = measure_of(own, name, value);
      const At goal = own.child(at_key);
      if (goal.is(Node::Kind::scalar) && goal.node().text == "external") {
        value.at = External{};
      } else {
        value.at = track(measure.dimension, measure.components).read(goal);
      }
      if (own.has("tolerance"))
        value.tolerance = quantity(measure.dimension, above(0.0)).read(own.child(tolerance.key));
      all.push_back(value);
    }
    return all;
  };
  return {read, [=] { return named_schema(target.schema()); }};
}

}  // namespace sinew::io
