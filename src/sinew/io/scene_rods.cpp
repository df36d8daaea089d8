// Rods: path, discretisation, stress-free shape, base, parts.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "sinew/io/nearest.hpp"
#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_values.hpp"

namespace sinew::io {
namespace {

using enum Need;

const std::vector<std::string> strain_names = texts_of(strain_words());

/// The orders of the six strains.
struct Orders {
  std::array<int, 6> of = {};
};

/// One order for all strains that vary, or a map from some of them to theirs. Read once these strains are known.
Field<Rod> order() {
  const Type<int> one = whole_number(0, 5);
  std::vector<Field<Orders>> fields;
  for (std::size_t c = 0; c < 6; ++c) {
    fields.push_back(field<Orders>(
        {strain_names[c], optional, "its Legendre order in a section", "1"},
        [c](Orders& orders) -> int& { return orders.of[c]; }, one));
  }
  const Type<Orders> several = map<Orders>({"an order", std::move(fields), {at_least_one(strain_names)}});
  const auto store = [=](Rod& rod, const At& at) {
    const auto varies = [&](std::size_t c) {
      return std::find(rod.strains.begin(), rod.strains.end(), static_cast<Strain>(c)) != rod.strains.end();
    };
    if (at.is(Node::Kind::list)) at.refuse("must be a whole number, or a map from strains to theirs");
    if (!at.is(Node::Kind::map)) {
      const int all = one.read(at);
      for (std::size_t c = 0; c < 6; ++c) rod.order[c] = varies(c) ? all : 0;
      return;
    }
    rod.order = several.read(at).of;
    for (std::size_t c = 0; c < 6; ++c) {
      if (!at.has(strain_names[c]) || varies(c)) continue;
      at.refuse_key(strain_names[c], "is the order of a strain that does not vary",
                    fmt::format("add {} to `strains`, or remove it here", strain_names[c]));
    }
  };
  const auto schema = [=] {
    Json json = any_of({one.schema(), several.schema()});
    json["default"] = 0;
    return json;
  };
  return {{"order", optional,
           "the Legendre order of the strains in a section, 0 (constant) to 5: one for all that "
           "vary, or some by name",
           "{torsion: 1, bending_y: 2}"},
          store,
          schema};
}

/// Strains over the arc length as they are written: each a value, or one for every abscissa.
struct StrainTable {
  std::vector<double> at;
  std::array<std::vector<double>, 6> strains;
};

Type<std::vector<double>> value_or_values(const Type<double>& value) {
  const Type<std::vector<double>> several = list<double>("values, one per abscissa", value, {1});
  return {[=](const At& at) { return at.is(Node::Kind::list) ? several.read(at) : std::vector{value.read(at)}; },
          [=] {
            return any_of({value.schema(), several.schema()});
          }};
}

void check_as_long_as_abscissae(const StrainTable& table, const At& at) {
  for (std::size_t c = 0; c < 6; ++c) {
    if (!at.has(strain_names[c]) || !at.child(strain_names[c]).is(Node::Kind::list)) continue;
    const At list = at.child(strain_names[c]);
    if (!at.has("at")) {
      list.refuse("is a list without the abscissae of its values", "add `at: [...]`, or give a single value");
    }
    if (table.strains[c].size() != table.at.size()) {
      list.refuse(fmt::format("must have one value per abscissa, {}, not {}", table.at.size(), table.strains[c].size()),
                  "give one value for each of `at`");
    }
  }
}

RestStrains row_by_row(const StrainTable& table) {
  RestStrains rest;
  rest.at = table.at.empty() ? std::vector{0.0} : table.at;
  for (std::size_t i = 0; i < rest.at.size(); ++i) {
    Eigen::Matrix<double, 6, 1> row = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t c = 0; c < 6; ++c) {
      const std::vector<double>& values = table.strains[c];
      if (!values.empty()) row[static_cast<Eigen::Index>(c)] = values[values.size() == 1 ? 0 : i];
    }
    rest.strains.push_back(row);
  }
  return rest;
}

Type<std::variant<Rest, RestStrains>> rest() {
  using Value = std::variant<Rest, RestStrains>;
  const Type<Rest> word = word_of<Rest>({{"path", Rest::path}, {"straight", Rest::straight}});
  std::vector<Field<StrainTable>> fields = {
      field<StrainTable>({"at", optional, "the ascending abscissae of the values below [m]", "[0, 50 mm]"},
                         &StrainTable::at, lengths({1}))};
  const std::vector<std::string> docs = {
      "its stress-free torsion [1/m]",         "its stress-free bending about y [1/m]",
      "its stress-free bending about z [1/m]", "its stress-free stretch minus 1",
      "its stress-free shear along y",         "its stress-free shear along z"};
  for (std::size_t c = 0; c < 6; ++c) {
    const bool elongation = static_cast<Strain>(c) == Strain::elongation;
    const Type<double> value =
        quantity(c < 3 ? Dimension::curvature : Dimension::number, elongation ? above(-1.0) : Range{});
    fields.push_back(field<StrainTable>(
        {strain_names[c], optional, docs[c], c < 3 ? "20 1/m" : "0.01"},
        [c](StrainTable& table) -> std::vector<double>& { return table.strains[c]; }, value_or_values(value)));
  }
  const Type<StrainTable> table =
      map<StrainTable>({"a rest shape", std::move(fields), {at_least_one(strain_names)}, check_as_long_as_abscissae});
  const auto read = [=](const At& at) -> Value {
    if (at.is(Node::Kind::map)) return row_by_row(table.read(at));
    if (at.is(Node::Kind::list)) at.refuse("must be path, straight or a map of strains");
    return word.read(at);
  };
  return {read,
          [=] {
            return any_of({word.schema(), table.schema()});
          },
          [=](const Value& value) { return word.show(std::get<Rest>(value)); }};
}

/// `clamped`, `free`, or the motions that are free.
Type<std::vector<BaseAxis>> free_motions() {
  using enum BaseAxis;
  const std::vector<BaseAxis> all = {x, y, z, turn_x, turn_y, turn_z};
  const std::vector<std::string> words = {"clamped", "free"};
  const Type<std::vector<BaseAxis>> some = distinct<BaseAxis>("free motions",
                                                              {{"x", BaseAxis::x},
                                                               {"y", BaseAxis::y},
                                                               {"z", BaseAxis::z},
                                                               {"turn_x", BaseAxis::turn_x},
                                                               {"turn_y", BaseAxis::turn_y},
                                                               {"turn_z", BaseAxis::turn_z}},
                                                              {1, 6});
  const auto read = [=](const At& at) {
    if (at.is(Node::Kind::list)) return some.read(at);
    if (at.is(Node::Kind::scalar) && at.node().text == words[0]) return std::vector<BaseAxis>{};
    if (at.is(Node::Kind::scalar) && at.node().text == words[1]) return std::vector(all);
    const std::string near = at.is(Node::Kind::scalar) ? nearest(at.node().text, words) : "";
    at.refuse("must be clamped, free or a list of the free motions",
              near.empty() ? "" : fmt::format("did you mean `{}`?", near));
  };
  const auto show = [=](const std::vector<BaseAxis>& motions) {
    return motions.empty() ? Json(words[0]) : motions == all ? Json(words[1]) : some.show(motions);
  };
  return {read, [=] { return any_of({Json{{"enum", words}}, some.schema()}); }, show};
}

/// The material of an object that has a section, which is read before it.
template <class T>
Field<T> material() {
  const Type<RodMaterial> of_shape = rod_material(Wants::modulus), of_given = rod_material(Wants::nothing);
  return {{"material", optional, "what it is made of", "{young: 5 GPa, poisson: 0.4, density: 1100}"},
          [=](T& object, const At& at) {
            const bool given = std::holds_alternative<GivenSection>(object.section);
            object.material = (given ? of_given : of_shape).read(at);
          },
          of_given.schema};
}

Type<std::vector<RodPart>> parts() {
  const Type<RodPart> part = map<RodPart>(
      {"a part of a rod",
       {field<RodPart>({"to", required, "the abscissa of its end [m]; of the last one, the rod's length", "0.3 m"},
                       &RodPart::to, quantity(Dimension::length, above(0.0))),
        field<RodPart>({"section", required, "the shape across", "{circle: {radius: 0.5 mm}}"}, &RodPart::section,
                       cross_section()),
        material<RodPart>()},
       {material_for_section()}});
  return list<RodPart>("parts, from base to tip", part, {1, 10000}, [](const std::vector<RodPart>& all, const At& at) {
    for (std::size_t i = 1; i < all.size(); ++i) {
      if (all[i].to > all[i - 1].to) continue;
      at.item(i).child("to").refuse(fmt::format("must be beyond the end of the part before it, {} m", all[i - 1].to),
                                    "list the parts from base to tip");
    }
  });
}

}  // namespace

Type<Rod> rod() {
  return map<Rod>(
      {"a rod",
       {field<Rod>({"path", required, "the points from base to tip [m]", "[[0, 0, 0], [100 mm, 0, 0]]"}, &Rod::path,
                   points({2})),
        field<Rod>({"in", optional, "where path is given, in the object before its pose or the world", "world"},
                   &Rod::path_in, in()),
        field<Rod>(
            {"up", optional, "the direction of the base's y axis; z, or y if the path starts along z", "[0, 0, 1]"},
            &Rod::up, direction()),
        field<Rod>({"pose", optional, "where the rod stands", "{translate: [0, 20 mm, 0]}"}, &Rod::pose, pose()),
        field<Rod>({"frame", optional, "the frame that carries its base", "hand"}, &Rod::frame, name_of("frame")),
        field<Rod>({"cable", optional, "cosserat for a rod with stiffness, geometric for a massless cable without any",
                    "cosserat"},
                   &Rod::cable, word_of<Cable>({{"cosserat", Cable::cosserat}, {"geometric", Cable::geometric}})),
        field<Rod>({"sections", optional, "their number, or the ascending ends of all from 0 to the length [m]", "15"},
                   &Rod::sections, count_or_lengths(1, true)),
        field<Rod>({"strains", optional, "the strains that may vary", "[torsion, bending_y, bending_z]"}, &Rod::strains,
                   distinct<Strain>("strains", strain_words(), {1, 6})),
        order(),
        field<Rod>({"rest", optional,
                    "the stress-free shape: along the path, straight, or strains, constant or over the abscissae `at`",
                    "{at: [0, 50 mm], bending_z: [0, 20 1/m]}"},
                   &Rod::rest, rest()),
        field<Rod>({"start", optional,
                    "how it lies at the start: bent to its path, or stress-free (rest, the default if `rest` is a map)",
                    "rest"},
                   &Rod::start, word_of<Start>({{"path", Start::path}, {"rest", Start::rest}})),
        field<Rod>({"base", optional, "clamped, free, or a list of the free motions of the base", "[x, turn_z]"},
                   &Rod::base, free_motions()),
        field<Rod>({"section", optional, "the shape across", "{circle: {radius: 0.5 mm}}"}, &Rod::section,
                   cross_section()),
        material<Rod>(),
        field<Rod>({"parts", optional, "pieces with a section and a material each, instead of those of the whole rod",
                    "[{to: 0.3 m, section: {circle: {radius: 1 mm}}, material: {young: 5 GPa, poisson: 0.4, "
                    "density: 1100}}]"},
                   &Rod::parts, parts())},
       {excludes("parts", {"section", "material"}), wanted_unless("cable", "geometric", {"section", "parts"}),
        material_for_section()}});
}

}  // namespace sinew::io
