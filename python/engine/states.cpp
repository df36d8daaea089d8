// States as arrays.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "docs.hpp"
#include "engine.hpp"
#include "sinew/sim/contact_places.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/sim/view.hpp"

namespace sinew::python {

LiveState LiveState::of(ModelPointer model, State state) {
  LiveState own{std::move(model), std::make_shared<State>(std::move(state))};
  own.command = command_of(own.model->model, *own.now);
  own.goal = goal_at(own.model->model, own.now->time);
  return own;
}

const State& LiveState::state() const {
  if (busy) throw std::runtime_error("this state is being stepped by another thread; step a copy of it instead");
  return *now;
}

State& LiveState::own() {
  state();
  if (now.use_count() > 1) now = std::make_shared<State>(*now);  // arrays look at it, or another state
  return *now;
}

namespace {

/// A part of a state, under its name.
template <class Part>
struct PartOf {
  std::shared_ptr<const State> whole;
  const Part* part;
};
using SolidPartOf = PartOf<SolidState>;
using RodPartOf = PartOf<RodState>;

struct BodyOf {
  std::shared_ptr<const State> whole;
  const rigid::Motion* part;
};

struct ContactOf {
  std::string first, second;
  double gap, slip;
  bool slides;
  Vec3 force, point, normal;
};

template <class Entry>
nb::dict by_name(const auto& models, const auto& entry) {
  nb::dict all;
  for (std::size_t i = 0; i < models.size(); ++i) all[models[i].name.c_str()] = entry(i);
  return all;
}

Numbers of_vector3(const Vec3& value) { return vector_of(std::vector<double>{value[0], value[1], value[2]}); }

nb::dict signals_of(const LiveState& own) {
  const Model& model = own.model->model;
  const std::vector<double> values = signal_values(model, own.state());
  nb::dict all;
  std::size_t i = 0;
  for (const std::string& name : signal_names(model)) all[name.c_str()] = values[i++];
  return all;
}

Numbers output_of(const LiveState& own, const std::string& name) {
  const Model& model = own.model->model;
  const OutputModel& output = model.outputs[place_of(name, names_of(model.outputs), "outputs")];
  return vector_of(kind_of(output).values(model, own.state(), output));
}

LiveState unpacked(ModelPointer model, const std::vector<double>& numbers, std::vector<double> actuators,
                   std::vector<double> loads, const std::vector<double>& goal) {
  LiveState own = LiveState::of(model, unpack(model->model, numbers));
  if (actuators.size() != own.command.actuators.size() || loads.size() != own.command.loads.size() ||
      static_cast<Eigen::Index>(goal.size()) != own.goal.at.size())
    throw nb::value_error("a state of another model");
  own.command = {std::move(actuators), std::move(loads)};
  own.goal.at = Eigen::Map<const Eigen::VectorXd>(goal.data(), static_cast<Eigen::Index>(goal.size()));
  return own;
}

}  // namespace

void bind_states(nb::module_& module) {
  nb::class_<SolidPartOf>(module, "SolidState", "A solid in a state; arrays are read only and never change.")
      .def_prop_ro(
          "x", [](const SolidPartOf& own) { return columns_of(own.part->x, own.whole); },
          "[m] positions of the nodes, (nodes, 3).")
      .def_prop_ro(
          "v", [](const SolidPartOf& own) { return columns_of(own.part->v, own.whole); },
          "[m/s] their velocities, (nodes, 3).")
      .def_prop_ro(
          "reaction",
          [](const SolidPartOf& own) {
            return numbers_of(own.part->reaction.data(), own.part->reaction.size(), own.whole);
          },
          doc::SolidState_reaction);
  nb::class_<RodPartOf>(module, "RodState", "A rod in a state; arrays are read only and never change.")
      .def_prop_ro(
          "q", [](const RodPartOf& own) { return numbers_of(own.part->q.data(), own.part->q.size(), own.whole); },
          doc::RodState_q)
      .def_prop_ro(
          "masses", [](const RodPartOf& own) { return columns_of(own.part->masses, own.whole); },
          "[m] where its mass points are, (points, 3).")
      .def_prop_ro(
          "velocity", [](const RodPartOf& own) { return columns_of(own.part->velocity, own.whole); },
          "[m/s] of the mass points, (points, 3).");
  nb::class_<BodyOf>(module, "BodyState", "A rigid body in a state.")
      .def_prop_ro(
          "position", [](const BodyOf& own) { return of_vector3(own.part->p); }, "[m] of its centre of mass, (3,).")
      .def_prop_ro(
          "rotation", [](const BodyOf& own) { return matrix_of(own.part->R); },
          "How its axes are turned in the world, a matrix (3, 3).")
      .def_prop_ro(
          "velocity", [](const BodyOf& own) { return of_vector3(own.part->v); }, "[m/s] of its centre of mass, (3,).")
      .def_prop_ro(
          "spin", [](const BodyOf& own) { return of_vector3(own.part->w); }, "[rad/s] in its own axes, (3,).");
  nb::class_<ContactOf>(module, "Contact", doc::ContactState)
      .def_ro("first", &ContactOf::first, "One of the two that touch ...")
      .def_ro("second", &ContactOf::second, "... and the other, which `force` acts on.")
      .def_prop_ro(
          "force", [](const ContactOf& own) { return of_vector3(own.force); }, "[N] on the second, (3,).")
      .def_prop_ro(
          "point", [](const ContactOf& own) { return of_vector3(own.point); }, "[m] where, (3,).")
      .def_prop_ro(
          "normal", [](const ContactOf& own) { return of_vector3(own.normal); },
          "Unit vector from the first to the second, (3,).")
      .def_ro("gap", &ContactOf::gap, doc::ContactState_gap)
      .def_ro("slip", &ContactOf::slip, doc::ContactState_slip)
      .def_ro("slides", &ContactOf::slides, doc::slides);
  nb::class_<EnergyBalance>(module, "EnergyBalance", doc::EnergyBalance)
      .def_ro("kinetic", &EnergyBalance::kinetic, "[J]")
      .def_ro("elastic", &EnergyBalance::elastic, "[J]")
      .def_ro("weight", &EnergyBalance::weight, "[J] potential in gravity, 0 at the start")
      .def_prop_ro("total", &EnergyBalance::total, "[J] the sum");

  nb::class_<LiveState>(
      module, "State",
      "Everything that changes, as a value: `copy` is a checkpoint, and a step from it gives the same "
      "bits every time. `step` changes it in place; arrays taken from it before never change.")
      .def(
          "copy",
          [](const LiveState& own) {
            own.state();
            return own;
          },
          "A state of its own; costs nothing until one of the two is stepped.")
      .def("__copy__",
           [](const LiveState& own) {
             own.state();
             return own;
           })
      .def(
          "__deepcopy__",
          [](const LiveState& own, nb::handle) {
            own.state();
            return own;
          },
          "memo"_a)
      .def_ro("model", &LiveState::model, "The model it is a state of.")
      .def_prop_ro(
          "time", [](const LiveState& own) { return own.state().time; }, doc::State_time)
      .def_prop_ro(
          "grid", [](const LiveState& own) { return own.state().grid; }, doc::State_grid)
      .def_prop_ro(
          "frequency", [](const LiveState& own) { return own.state().frequency; }, doc::State_frequency)
      .def_prop_ro(
          "solids",
          [](const LiveState& own) {
            const State& state = own.state();
            return by_name<SolidPartOf>(own.model->model.solids, [&](std::size_t i) {
              return SolidPartOf{own.now, &state.solids[i]};
            });
          },
          nb::sig("def solids(self) -> dict[str, SolidState]"), "The solids by their names.")
      .def_prop_ro(
          "rods",
          [](const LiveState& own) {
            const State& state = own.state();
            return by_name<RodPartOf>(own.model->model.rods, [&](std::size_t i) {
              return RodPartOf{own.now, &state.rods[i]};
            });
          },
          nb::sig("def rods(self) -> dict[str, RodState]"), "The rods by their names.")
      .def_prop_ro(
          "bodies",
          [](const LiveState& own) {
            const State& state = own.state();
            return by_name<BodyOf>(own.model->model.bodies, [&](std::size_t i) {
              return BodyOf{own.now, &state.bodies[i]};
            });
          },
          nb::sig("def bodies(self) -> dict[str, BodyState]"), "The rigid bodies by their names.")
      .def_prop_ro(
          "contacts",
          [](const LiveState& own) {
            const Model& model = own.model->model;
            std::vector<ContactOf> all;
            for (const ContactState& one : own.state().contacts) {
              const PairModel& pair = model.pairs[one.pair];
              const double side = one.on_second ? 1.0 : -1.0;
              all.push_back({name_of(model, pair.a), name_of(model, pair.b), one.gap, one.slip, slides(model, one),
                             force_on_second(one), one.point, side * one.normal});
            }
            return all;
          },
          "What touches, or is near.")
      .def_prop_ro(
          "abscissae",
          [](const LiveState& own) {
            std::vector<double> all;
            for (const PointState& point : own.state().points) all.push_back(point.s);
            return vector_of(std::move(all));
          },
          "[m] of every sliding point on its rod, (points,).")
      .def_prop_ro(
          "multipliers",
          [](const LiveState& own) {
            const State& state = own.state();
            return numbers_of(state.lambda.data(), state.lambda.size(), own.now);
          },
          doc::State_lambda)
      .def_prop_ro(
          "forces",
          [](const LiveState& own) {
            const State& state = own.state();
            return numbers_of(state.actuators.data(), static_cast<Eigen::Index>(state.actuators.size()), own.now);
          },
          "[N] or [N m] of each motor, (actuators,).")
      .def_prop_ro(
          "displacements",
          [](const LiveState& own) { return vector_of(motor_positions(own.model->model, own.state())); },
          "[m] or [rad] that each motor has moved, (actuators,).")
      .def("output", &output_of, "name"_a, "The numbers of an output, in SI: (3,) of a position.")
      .def_prop_ro("signals", &signals_of, nb::sig("def signals(self) -> dict[str, float]"),
                   "All signals by their names, in SI.")
      .def_prop_ro(
          "energies", [](const LiveState& own) { return energy_balance(own.model->model, own.state()); },
          doc::EnergyBalance)
      .def(
          "snapshot",
          [](const LiveState& own, const std::string& status) {
            return std::make_shared<const Snapshot>(snapshot(own.model->model, own.state(), status));
          },
          "status"_a = "", doc::snapshot)
      .def(
          "numbers", [](const LiveState& own) { return vector_of(pack(own.state())); },
          "All of it as plain numbers; `State.from_numbers` takes them.")
      .def_static(
          "from_numbers",
          [](ModelPointer model, const std::vector<double>& numbers) {
            return LiveState::of(model, unpack(model->model, numbers));
          },
          "model"_a, "numbers"_a,
          "The state of these `numbers`, told what it obeys. Throws ValueError if they are not of this model.")
      .def(
          "__reduce__",
          [](const LiveState& own) {
            const std::vector<double> goal(own.goal.at.begin(), own.goal.at.end());
            return nb::make_tuple(nb::module_::import_("sinew.running").attr("_state_again"),
                                  nb::make_tuple(own.model, vector_of(pack(own.state())), own.command.actuators,
                                                 own.command.loads, goal));
          },
          nb::sig("def __reduce__(self) -> tuple[typing.Any, ...]"))
      .def("__repr__",
           [](const LiveState& own) { return "<sinew.State at " + when(own.model->model, own.state()) + ">"; });
  module.def("unpacked", &unpacked, "The state of a pickle.");
}

}  // namespace sinew::python
