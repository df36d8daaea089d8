#include "sinew/sim/quantities.hpp"

#include <cmath>
#include <stdexcept>

#include "sinew/sim/internal.hpp"
#include "sinew/sim/places.hpp"

namespace sinew {

namespace {

using Values = std::vector<double>;

template <class Vector>
Values numbers(const Vector& v) {
  return {v.data(), v.data() + v.size()};
}

/// A symmetric tensor as xx yy zz yz xz xy.
Values six(const solid::Mat3& t) { return {t(0, 0), t(1, 1), t(2, 2), t(1, 2), t(0, 2), t(0, 1)}; }

std::vector<Column> columns(std::initializer_list<const char*> names, const char* unit) {
  std::vector<Column> all;
  for (const char* const name : names) all.push_back({name, unit});
  return all;
}
std::vector<Column> xyz(const char* unit) { return columns({"x", "y", "z"}, unit); }

Values position(const Model& model, const State& state, const OutputModel& output) {
  return numbers(output_position(model, state, output));
}
Values turn(const Model& model, const State& state, const OutputModel& output) {
  return numbers(output_turn(model, state, output));
}

Values displacement(const Model& model, const State& state, const OutputModel& output) {
  const solid::Body& body = model.solids[output.solid].body;
  return numbers(Vec3(output_position(model, state, output) - solid::position(output.where, body.cells, body.rest)));
}

Values solid_strain(const Model& model, const State& state, const OutputModel& output) {
  return six(solid::green_strain(model.solids[output.solid].body, output.where, state.solids[output.solid].x));
}

Values solid_stress(const Model& model, const State& state, const OutputModel& output) {
  const solid::Mat3 stress =
      solid::cauchy_stress(model.solids[output.solid].body, output.where, state.solids[output.solid].x);
  Values values = six(stress);
  values.push_back(solid::von_mises(stress));
  const Vec3 principal = solid::principal_values(stress);
  values.insert(values.end(), principal.begin(), principal.end());
  return values;
}

/// Sum over the chosen nodes' held coordinates.
Values reaction(const Model& model, const State& state, const OutputModel& output) {
  const solid::Body& body = model.solids[output.solid].body;
  Vec3 sum = Vec3::Zero();
  Eigen::Index held = 0;
  solid::each_held(body, [&](int axis, int node) {
    if (output.nodes[node]) sum[axis] += state.solids[output.solid].reaction[held];
    ++held;
  });
  return numbers(sum);
}

Values rod_strain(const Model& model, const State& state, const OutputModel& output) {
  return numbers(rod::strain(model.rods[output.rod].rod, state.rods[output.rod].q, output.abscissa));
}

Values rod_force(const Model& model, const State& state, const OutputModel& output) {
  return numbers(Vec3(internal_wrench(model, state, output.rod, output.abscissa).tail<3>()));
}
Values rod_moment(const Model& model, const State& state, const OutputModel& output) {
  return numbers(Vec3(internal_wrench(model, state, output.rod, output.abscissa).head<3>()));
}

Values rod_stress(const Model& model, const State& state, const OutputModel& output) {
  const rod::SectionStress stress = section_stress(model, state, output.rod, output.abscissa);
  return {stress.axial, stress.bending, stress.torsion, stress.von_mises};
}

/// Of all that touches a body.
Values body_force(const Model& model, const State& state, const OutputModel& output) {
  const Collider own{Collider::Kind::body, output.body};
  Vec3 sum = Vec3::Zero();
  for (const ContactState& contact : state.contacts) {
    const PairModel& pair = model.pairs[contact.pair];
    if (pair.b == own) sum += force_on_second(contact);
    if (pair.a == own) sum -= force_on_second(contact);
  }
  return numbers(sum);
}

Values touch(const Model& model, const State& state, const OutputModel& output) {
  const double sign = output.turned ? 1.0 : -1.0;
  Vec3 sum = Vec3::Zero();
  double contacts = 0.0, sliding = 0.0;
  for (const ContactState& own : state.contacts) {
    if (own.pair != output.pair) continue;
    sum += sign * force_on_second(own);
    if (own.force.isZero()) continue;  // only watched
    contacts += 1.0;
    sliding += slides(model, own) ? 1.0 : 0.0;
  }
  const auto [normal, gap] = pressing_of(state, output.pair);
  return {sum.x(), sum.y(), sum.z(), normal, contacts, sliding, std::isfinite(gap) ? gap : 0.0};
}

std::vector<OutputKind> list_kinds() {
  using Q = Quantity;
  const std::initializer_list<const char*> kSix = {"xx", "yy", "zz", "yz", "xz", "xy"};
  std::vector<Column> strains;
  for (std::size_t c = 0; c < rod::kStrainNames.size(); ++c)
    strains.push_back({rod::kStrainNames[c], c < 3 ? "1/m" : "1"});
  return {
      {Q::position, Subject::solid, xyz("m"), position},
      {Q::displacement, Subject::solid, xyz("m"), displacement},
      {Q::orientation, Subject::solid, xyz("rad"), turn},
      {Q::strain, Subject::solid, columns(kSix, "1"), solid_strain},
      {Q::stress, Subject::solid,
       columns({"xx", "yy", "zz", "yz", "xz", "xy", "von_mises", "principal_1", "principal_2", "principal_3"}, "Pa"),
       solid_stress},
      {Q::reaction, Subject::solid, xyz("N"), reaction},
      {Q::position, Subject::rod, xyz("m"), position},
      {Q::orientation, Subject::rod, xyz("rad"), turn},
      {Q::strain, Subject::rod, strains, rod_strain},
      {Q::force, Subject::rod, xyz("N"), rod_force},
      {Q::moment, Subject::rod, xyz("N m"), rod_moment},
      {Q::stress, Subject::rod, columns({"axial", "bending", "torsion", "von_mises"}, "Pa"), rod_stress},
      {Q::position, Subject::body, xyz("m"), position},
      {Q::orientation, Subject::body, xyz("rad"), turn},
      {Q::force, Subject::body, xyz("N"), body_force},
      {Q::touching,
       Subject::pair,
       {{"x", "N"}, {"y", "N"}, {"z", "N"}, {"normal", "N"}, {"contacts", "1"}, {"sliding", "1"}, {"gap", "m"}},
       touch},
  };
}

}  // namespace

Subject subject_of(const OutputModel& output) {
  return output.solid >= 0  ? Subject::solid
         : output.rod >= 0  ? Subject::rod
         : output.body >= 0 ? Subject::body
                            : Subject::pair;
}

const std::vector<OutputKind>& output_kinds() {
  static const std::vector<OutputKind> all = list_kinds();
  return all;
}

const OutputKind* find_kind(Quantity quantity, Subject subject) {
  for (const OutputKind& own : output_kinds()) {
    if (own.quantity == quantity && own.subject == subject) return &own;
  }
  return nullptr;
}

const OutputKind& kind_of(const OutputModel& output) {
  const OutputKind* const own = find_kind(output.quantity, subject_of(output));
  if (!own) throw std::logic_error("kind_of: build has let an output pass that is not known");
  return *own;
}

const std::vector<std::pair<std::string, Quantity>>& quantity_words() {
  using Q = Quantity;
  static const std::vector<std::pair<std::string, Quantity>> all = {{"position", Q::position},
                                                                    {"displacement", Q::displacement},
                                                                    {"orientation", Q::orientation},
                                                                    {"strain", Q::strain},
                                                                    {"force", Q::force},
                                                                    {"moment", Q::moment},
                                                                    {"stress", Q::stress},
                                                                    {"reaction", Q::reaction}};
  return all;
}

std::string known_of(Subject subject) {
  std::vector<std::string> words;
  for (const auto& [word, quantity] : quantity_words()) {
    if (find_kind(quantity, subject)) words.push_back("`" + word + "`");
  }
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

}  // namespace sinew
