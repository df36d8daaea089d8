#include "sinew/live/scenery.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sinew/sim/internal.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/view.hpp"

namespace sinew::live {

using Json = nlohmann::ordered_json;

namespace {

/// Ends of sections and places between: as many as make a smooth curve.
std::vector<double> samples_of(const rod::Rod& rod) {
  const int per_section = std::max(2, 48 / rod.count());
  std::vector<double> all;
  for (const rod::Section& section : rod.sections) {
    for (int i = 0; i < per_section; ++i) all.push_back(section.begin + section.length() * i / per_section);
  }
  all.push_back(rod.length());
  return all;
}

Json numbers(const Vec3& own) { return {own.x(), own.y(), own.z()}; }

/// An infinite end is none.
Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json units_of(const std::vector<Field>& fields) {
  Json all = Json::array();
  for (const Field& own : fields) all.push_back({{"name", own.name}, {"unit", own.unit}});
  return all;
}

double rod_field(const Model& model, const State& state, int number, double s, const std::string& field) {
  const rod::Rod& rod = model.rods[number].rod;
  if (field == "von_mises") return rod::stress_at(rod.profile, s, internal_wrench(model, state, number, s)).von_mises;
  const rod::Vec6 strain = rod::strain(rod, state.rods[number].q, s);
  if (field == "bending") return std::hypot(strain[1], strain[2]);
  return field == "torsion" ? strain[0] : strain[3];
}

/// The position of an output, if a page can take hold of it: which is the case of targets for positions.
bool placed(const OutputModel& output) { return output.quantity == Quantity::position; }

void put(std::vector<float>& floats, const Vec3& own) {
  for (const double value : own) floats.push_back(static_cast<float>(value));
}

}  // namespace

Span slider_span(const Model& model, const ActuatorModel& actuator) {
  Span span = told_span(actuator);
  double least = 0.0, most = 0.0;
  if (const Table* table = std::get_if<Table>(&actuator.drive)) {
    for (const double value : table->values) least = std::min(least, value), most = std::max(most, value);
  }
  if (least == most) most = actuator.turns() ? 3.14 : actuator.told_force() ? 5.0 : 0.2 * model.size;
  const double beyond = 0.5 * (most - least);
  if (!std::isfinite(span.most)) span.most = most > 0.0 ? most + beyond : 0.0;
  if (!std::isfinite(span.least))
    span.least = least < 0.0 || actuator.turns() ? least - beyond : std::min(0.0, span.most);
  return span;
}

Scenery::Scenery(const Model& model) : model_(model) {
  for (const SolidModel& solid : model.solids) {
    Skin skin;
    std::vector<int> number(static_cast<std::size_t>(solid.body.nodes()), -1);
    for (const solid::Triangle& triangle : solid.surface) {
      for (const int node : triangle) {
        int& own = number[static_cast<std::size_t>(node)];
        if (own < 0) {
          own = static_cast<int>(skin.nodes.size());
          skin.nodes.push_back(node);
        }
        skin.triangles.push_back(static_cast<std::uint32_t>(own));
      }
    }
    skin.around.resize(skin.nodes.size());
    for (int cell = 0; cell < solid.body.elements(); ++cell) {
      bool near = false;
      for (const int node : solid.body.cells[static_cast<std::size_t>(cell)].nodes()) {
        const int own = number[static_cast<std::size_t>(node)];
        if (own < 0) continue;
        skin.around[static_cast<std::size_t>(own)].push_back(static_cast<int>(skin.cells.size()));
        near = true;
      }
      if (near) skin.cells.push_back(cell);
    }
    skins_.push_back(std::move(skin));
  }
  for (const RodModel& rod : model.rods) abscissae_.push_back(samples_of(rod.rod));
  signals_ = signal_groups(model);
  const std::vector<std::string> names = signal_names(model);
  for (const EffectorModel& own : model.effectors) {
    const std::string first = model.outputs[own.output].name + ".target";
    const auto at = std::find_if(names.begin(), names.end(), [&](const auto& name) { return name.starts_with(first); });
    target_signals_.push_back(static_cast<std::size_t>(at - names.begin()));
  }
}

std::string Scenery::scene(const Json& more, const History& history) {
  const Model& model = model_;
  message_.begin(Kind::scene);
  message_.add("history.times", std::span<const double>(history.times));
  message_.add("history.values", std::span<const double>(history.values));
  Json head = more;
  head["title"] = model.scene.title;
  head["warnings"] = to_strings(model.warnings);
  head["size"] = model.size;
  head["middle"] = numbers(model.middle);
  head["up"] =
      numbers(model.scene.gravity.norm() > 0.0 ? Vec3(-model.scene.gravity.normalized()) : Vec3(Vec3::UnitZ()));
  const auto add = [&](const std::string& name, const auto& points) {
    floats_.clear();
    for (const Vec3& own : points) put(floats_, own);
    message_.add(name, std::span<const float>(floats_));
  };
  Json& solids = head["solids"] = Json::array();
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const SolidModel& solid = model.solids[i];
    const std::string name = "solid" + std::to_string(i);
    std::vector<Vec3> rest;
    std::vector<std::uint32_t> nodes;
    for (const int node : skins_[i].nodes) {
      rest.emplace_back(solid.body.rest.col(node));
      nodes.push_back(static_cast<std::uint32_t>(node));
    }
    add(name + ".rest", rest);
    message_.add(name + ".nodes", std::span<const std::uint32_t>(nodes));
    message_.add(name + ".triangles", std::span<const std::uint32_t>(skins_[i].triangles));
    solids.push_back({{"name", solid.name}});
  }
  Json& rods = head["rods"] = Json::array();
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    floats_.clear();
    for (const double s : abscissae_[i]) {
      floats_.push_back(static_cast<float>(s));
      floats_.push_back(static_cast<float>(rod::radius_at(model.rods[i].rod.profile, s)));
    }
    message_.add("rod" + std::to_string(i) + ".radius", std::span<const float>(floats_));
    rods.push_back({{"name", model.rods[i].name}, {"samples", abscissae_[i].size()}});
  }
  for (const GeometricCableModel& cable : model.cables)
    rods.push_back({{"name", cable.name}, {"samples", cable.cable.points + 1}});
  Json& bodies = head["bodies"] = Json::array();
  const auto add_body = [&](const std::string& name, const contact::Shape& shape, const Placement& place, bool fixed) {
    const contact::Skin skin = sample_shape(model, shape, place);
    const std::string own = "body" + std::to_string(bodies.size());
    add(own + ".points", skin.points);
    std::vector<std::uint32_t> corners;
    for (const auto& triangle : skin.triangles) {
      for (const int corner : triangle) corners.push_back(static_cast<std::uint32_t>(corner));
    }
    message_.add(own + ".triangles", std::span<const std::uint32_t>(corners));
    bodies.push_back({{"name", name},
                      {"fixed", fixed},
                      {"ground", std::holds_alternative<contact::HalfSpace>(shape)},
                      {"round", std::holds_alternative<contact::Ball>(shape)}});
  };
  for (const BodyModel& own : model.bodies) add_body(own.name, own.shape, {own.start.R, own.start.p}, false);
  for (const ObstacleModel& own : model.obstacles) add_body(own.name, own.shape, own.pose, true);
  Json& actuators = head["actuators"] = Json::array();
  for (const ActuatorModel& own : model.actuators) {
    const MotorWords words = words_of(own);
    const Span span = slider_span(model, own);
    actuators.push_back({{"name", own.name},
                         {"what", own.told_force() ? words.force : words.position},
                         {"unit", own.told_force() ? words.force_unit : words.position_unit},
                         {"least", span.least},
                         {"most", span.most},
                         {"sought", own.sought()},
                         {"limit", {finite_or_null(told_span(own).least), finite_or_null(told_span(own).most)}}});
  }
  Json& targets = head["targets"] = Json::array();
  for (const EffectorModel& own : model.effectors) {
    const OutputModel& output = model.outputs[own.output];
    targets.push_back({{"name", output.name},
                       {"first", own.first},
                       {"size", own.size},
                       {"unit", measure_of(model, own).si},
                       {"position", placed(output)},
                       {"weights", std::vector<double>(own.weights.begin(), own.weights.end())}});
  }
  Json& outputs = head["outputs"] = Json::array();
  for (const OutputModel& own : model.outputs) {
    if (placed(own)) outputs.push_back(own.name);
  }
  Json& signals = head["signals"] = Json::array();
  for (const Column& column : signal_columns(model)) signals.push_back({{"name", column.name}, {"unit", column.unit}});
  head["solid_fields"] = units_of(solid_fields());
  head["rod_fields"] = units_of(rod_fields());
  return message_.bytes(std::move(head));
}

void Scenery::add_solid_field(const State& state, int number, const std::string& field) {
  const Skin& skin = skins_[static_cast<std::size_t>(number)];
  const solid::Body& body = model_.solids[number].body;
  std::vector<double> cells;
  for (const int cell : skin.cells) {
    const solid::CellMeans means = solid::cell_means(body, cell, state.solids[number].x);
    cells.push_back(field == "volume_ratio" ? means.volume_ratio
                    : field == "von_mises"  ? solid::von_mises(means.stress)
                                            : solid::principal_values(means.stress)[0]);
  }
  floats_.clear();
  for (const std::vector<int>& around : skin.around) {
    double sum = 0.0;
    for (const int cell : around) sum += cells[static_cast<std::size_t>(cell)];
    floats_.push_back(static_cast<float>(sum / static_cast<double>(around.size())));
  }
  message_.add("solid" + std::to_string(number) + "." + field, std::span<const float>(floats_));
}

/// Signals know the scene's own goals; these are what people have made of them.
void Scenery::tell_goal(const State& state, const Goal& goal, std::vector<double>& signals) const {
  if (goal.at.size() == 0) return;
  Eigen::VectorXd errors;
  effector_errors(model_, state, goal, errors);
  for (std::size_t i = 0; i < model_.effectors.size(); ++i) {
    const EffectorModel& own = model_.effectors[i];
    for (int k = 0; k < own.size; ++k)
      signals[target_signals_[i] + static_cast<std::size_t>(k)] = goal.at[own.first + k];
    signals[target_signals_[i] + static_cast<std::size_t>(own.size)] = error_of(own, errors);
  }
}

std::string Scenery::frame(const State& state, const Show& show, const Goal& goal, const Json& more) {
  const Model& model = model_;
  message_.begin(Kind::frame);
  Json head = more;
  head["time"] = state.time;
  head["when"] = when(model, state);
  Json& scales = head["scales"] = Json::array();
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const Eigen::Matrix3Xd &x = state.solids[i].x, &rest = model.solids[i].body.rest;
    double farthest = 0.0;
    for (const int node : skins_[i].nodes)
      farthest = std::max(farthest, (x.col(node) - rest.col(node)).cwiseAbs().maxCoeff());
    const double scale = std::max(farthest, 1e-30) / 32767.0;
    shorts_.clear();
    for (const int node : skins_[i].nodes) {
      for (int axis = 0; axis < 3; ++axis)
        shorts_.push_back(static_cast<std::int16_t>(std::lround((x(axis, node) - rest(axis, node)) / scale)));
    }
    message_.add("solid" + std::to_string(i), std::span<const std::int16_t>(shorts_));
    scales.push_back(scale);
    for (const std::string& field : show.solids) add_solid_field(state, static_cast<int>(i), field);
  }
  const auto add = [&](const std::string& name) { message_.add(name, std::span<const float>(floats_)); };
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    const std::string name = "rod" + std::to_string(i);
    const rod::Configuration shape = rod_shape(model, state, static_cast<int>(i));
    floats_.clear();
    for (const double s : abscissae_[i]) put(floats_, rod::curve_point(shape, s).position);
    add(name);
    for (const std::string& field : show.rods) {
      floats_.clear();
      for (const double s : abscissae_[i])
        floats_.push_back(static_cast<float>(rod_field(model, state, static_cast<int>(i), s, field)));
      add(name + "." + field);
    }
  }
  for (std::size_t i = 0; i < model.cables.size(); ++i) {
    const RodSnapshot cable = sample_cable(model, state, static_cast<int>(i));
    floats_.clear();
    for (Eigen::Index j = 0; j < cable.points.cols(); ++j) put(floats_, cable.points.col(j));
    add("rod" + std::to_string(model.rods.size() + i));
  }
  floats_.clear();
  const auto add_pose = [&](const Placement& own) {
    put(floats_, own.p);
    const Eigen::Quaterniond turn(own.R);
    for (const double value : turn.coeffs()) floats_.push_back(static_cast<float>(value));
  };
  for (const rigid::Motion& own : state.bodies) add_pose({own.R, own.p});
  for (const ObstacleModel& own : model.obstacles) add_pose(compose(moved(model, state, own.frame), own.pose));
  add("bodies");
  floats_.clear();
  for (const ContactState& own : state.contacts) {
    if (own.force.isZero()) continue;
    put(floats_, own.point);
    put(floats_, force_on_second(own));
  }
  add("contacts");
  floats_.clear();
  for (std::size_t k = 0; k < model.points.size(); ++k) {
    if (state.points[k].on) put(floats_, solid_point(model, state, model.points[k].solid, model.points[k].where));
  }
  add("points");
  floats_.clear();
  for (const OutputModel& own : model.outputs) {
    if (placed(own)) put(floats_, output_position(model, state, own));
  }
  add("outputs");
  std::vector<double> signals;
  for (const SignalGroup& group : signals_) {
    const bool energies = !group.columns.empty() && group.columns.front().name.starts_with("energy.");
    if (energies && !show.energies) {
      signals.insert(signals.end(), group.columns.size(), NAN);
      continue;
    }
    const std::vector<double> values = group.values(model, state);
    signals.insert(signals.end(), values.begin(), values.end());
  }
  tell_goal(state, goal, signals);
  message_.add("signals", std::span<const double>(signals));
  std::vector<double> told;
  for (std::size_t i = 0; i < model.actuators.size(); ++i) told.push_back(told_to(model, state, static_cast<int>(i)));
  message_.add("told", std::span<const double>(told));
  message_.add("goals", std::span<const double>(goal.at.data(), static_cast<std::size_t>(goal.at.size())));
  return message_.bytes(std::move(head));
}

}  // namespace sinew::live
