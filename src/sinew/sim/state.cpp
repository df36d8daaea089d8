#include "sinew/sim/state.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "sinew/linalg/finite.hpp"
#include "sinew/rod/kinematics.hpp"
#include "sinew/sim/internal.hpp"

namespace sinew {

namespace {

/// All that a static path is measured in: nodes, coordinates of rods and the border's unknowns.
Eigen::Index path_size(const Model& model) {
  Eigen::Index size = model.unknowns;
  for (const SolidModel& solid : model.solids) size += 3 * solid.body.nodes();
  for (const RodModel& rod : model.rods) size += rod.rod.strain_coordinates();
  return size;
}

}  // namespace

State initial_state(const Model& model) {
  State state;
  for (const SolidModel& solid : model.solids) {
    state.solids.push_back(
        {solid.body.rest, Eigen::Matrix3Xd::Zero(3, solid.body.nodes()), Eigen::VectorXd::Zero(solid.held())});
  }
  for (const RodModel& rod : model.rods) {
    RodState& own = state.rods.emplace_back();
    own.q = rod.start;
    const auto shape = rod::configure(rod.rod, rod.base, own.q);
    own.masses = rod::mass_positions(shape);
    own.velocity.setZero(3, own.masses.cols());
    own.q_rate.setZero(own.q.size());
    own.internal = no_internal(rod);
  }
  for (const GeometricCableModel& cable : model.cables)
    state.cables.push_back({Eigen::VectorXd::Zero(cable.cable.coordinates())});
  for (const BodyModel& body : model.bodies) state.bodies.push_back(body.start);
  state.lambda.setZero(model.rows);
  for (const PointModel& point : model.points) {
    const bool waits = point.line.rod >= 0 && point.abscissa > model.rods[point.line.rod].rod.length();
    state.points.push_back({point.abscissa, 0.0, !waits});
    if (point.cable_point >= 0) {
      const SolidModel& solid = model.solids[point.solid];
      state.cables[point.line.cable].z.segment<3>(1 + 3 * point.cable_point) =
          solid::position(point.where, solid.body.cells, solid.body.rest);
    }
  }
  state.followed.setZero(model.followed);
  for (const TieModel& tie : model.ties) {
    if (tie.unknown < 0) continue;
    const int at = tie.unknown - model.first_followed;
    state.followed.segment<3>(at) = tie.holder.p;
    if (!tie.directors) continue;
    for (int i = 0; i < 3; ++i) state.followed.segment<3>(at + 3 + 3 * i) = tie.length * tie.holder.R.col(i);
  }
  state.actuators.assign(model.actuators.size(), 0.0);
  state.loads.assign(model.loads.size(), 0.0);
  if (model.scene.analysis == Analysis::statics) state.path.direction.setZero(path_size(model));
  return state;
}

Vec3 force_on_second(const ContactState& contact) { return contact.on_second ? contact.force : Vec3(-contact.force); }

bool slides(const Model& model, const ContactState& contact) {
  const double pressed = contact.force.dot(contact.normal);
  const Vec3 along = contact.force - pressed * contact.normal;
  return contact.slip > 1e-8 * model.size &&
         along.norm() >= (1.0 - 1e-6) * model.pairs[contact.pair].friction * pressed;
}

namespace {

/// Visits every number of a state in the order of the record (kStateLayout); sizes are the model's. A visitor that
/// takes arrays is given these as they are.
template <class StateType, class Visit>
void each_number(StateType& state, const Visit& visit) {
  visit(state.time);
  const auto array = [&visit](auto& values) {
    if constexpr (requires { visit(values); }) {
      visit(values);
    } else {
      for (Eigen::Index i = 0; i < values.size(); ++i) visit(values.data()[i]);
    }
  };
  for (auto& solid : state.solids) {
    array(solid.x);
    array(solid.v);
    array(solid.reaction);
  }
  for (auto& rod : state.rods) {
    array(rod.q);
    array(rod.turned);
    array(rod.masses);
    array(rod.velocity);
    array(rod.q_rate);
    array(rod.internal);
  }
  for (auto& cable : state.cables) array(cable.z);
  for (auto& body : state.bodies) {
    array(body.p);
    array(body.R);
    array(body.v);
    array(body.w);
  }
  for (auto& point : state.points) {
    visit(point.s);
    visit(point.friction);
  }
  array(state.followed);
  array(state.lambda);
  for (auto& value : state.actuators) visit(value);
  for (auto& value : state.loads) visit(value);
  visit(state.energies.work);
  visit(state.energies.work_bound);
  visit(state.path.step);
  visit(state.path.rate);
  visit(state.path.count);
  visit(state.path.farthest);
  visit(state.path.work);
  visit(state.path.work_at_farthest);
  array(state.path.direction);
  visit(state.frequency);
}

/// The same of a contact, but for what it is between.
template <class Contact, class Visit>
void each_number_of(Contact& contact, const Visit& visit) {
  for (auto* three : {&contact.force, &contact.point, &contact.normal}) {
    for (auto& value : *three) visit(value);
  }
  visit(contact.gap);
  visit(contact.slip);
}
constexpr std::size_t kContactNumbers = 14;

}  // namespace

bool finite(const State& state) {
  bool all = true;
  const auto look = [&all](const auto& what) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(what)>>) {
      all &= std::isfinite(static_cast<double>(what));
    } else {
      all &= linalg::finite(what);
    }
  };
  each_number(state, look);
  for (const ContactState& contact : state.contacts) all &= contact.force.allFinite();
  return all;
}

bool moves(const State& state) {
  const auto any = [](const auto& parts, const auto& moves) { return std::any_of(parts.begin(), parts.end(), moves); };
  return any(state.solids, [](const SolidState& own) { return !own.v.isZero(0.0); }) ||
         any(state.rods, [](const RodState& own) { return !own.q_rate.isZero(0.0); }) ||
         any(state.bodies, [](const rigid::Motion& own) { return !own.v.isZero(0.0) || !own.w.isZero(0.0); });
}

std::vector<double> pack(const State& state) {
  std::vector<double> numbers{static_cast<double>(state.grid), static_cast<double>(state.contacts.size()),
                              static_cast<double>(state.halvings), static_cast<double>(state.spent)};
  for (const PointState& point : state.points) numbers.push_back(point.on ? 1.0 : 0.0);
  numbers.push_back(state.path.stable ? 1.0 : 0.0);
  each_number(state, [&numbers](double value) { numbers.push_back(value); });
  for (const ContactState& contact : state.contacts) {
    numbers.push_back(contact.pair);
    numbers.push_back(static_cast<double>(contact.part));
    numbers.push_back(contact.on_second ? 1.0 : 0.0);
    each_number_of(contact, [&numbers](double value) { numbers.push_back(value); });
  }
  return numbers;
}

State unpack(const Model& model, const std::vector<double>& numbers) {
  State state = initial_state(model);
  const std::size_t plain = pack(state).size(), more = numbers.size() < plain ? 0 : numbers.size() - plain;
  const std::size_t contacts = more / kContactNumbers;
  if (numbers.size() < plain || more % kContactNumbers != 0 || numbers[1] != static_cast<double>(contacts))
    throw std::invalid_argument("the recorded state does not belong to this model");
  if (!std::all_of(numbers.begin(), numbers.end(), [](double value) { return std::isfinite(value); }) ||
      !(numbers[0] >= 0.0 && numbers[0] < 0x1p53 && numbers[2] >= 0.0 && numbers[2] < 64.0 && numbers[3] >= 0.0 &&
        numbers[3] < 0x1p31))
    throw std::invalid_argument("the recorded state is none: its numbers are not finite, or it has no place in time");
  std::size_t at = 0;
  state.grid = static_cast<long>(numbers[at++]);
  state.contacts.resize(static_cast<std::size_t>(numbers[at++]));
  state.halvings = static_cast<int>(numbers[at++]);
  state.spent = static_cast<int>(numbers[at++]);
  for (PointState& point : state.points) point.on = numbers[at++] != 0.0;
  state.path.stable = numbers[at++] != 0.0;
  each_number(state, [&](double& value) { value = numbers[at++]; });
  for (ContactState& contact : state.contacts) {
    const double pair = numbers[at++], part = numbers[at++];
    if (!(pair >= 0.0 && pair < static_cast<double>(model.pairs.size()) && part >= 0.0 && part < 0x1p53))
      throw std::invalid_argument("the recorded contacts do not belong to this model");
    contact.pair = static_cast<int>(pair);
    contact.part = static_cast<std::uint64_t>(part);
    contact.on_second = numbers[at++] != 0.0;
    each_number_of(contact, [&](double& value) { value = numbers[at++]; });
  }
  return state;
}

}  // namespace sinew
