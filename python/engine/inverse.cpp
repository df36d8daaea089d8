// How motors move effectors.
#include "sinew/sim/inverse.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "docs.hpp"
#include "engine.hpp"

namespace sinew::python {

namespace {

JacobianOf wanted_of(const Model& model, const std::optional<std::string>& of) {
  if (!of) return model.scene.analysis == Analysis::dynamic ? JacobianOf::step : JacobianOf::equilibrium;
  if (*of == "step") return JacobianOf::step;
  if (*of == "equilibrium") return JacobianOf::equilibrium;
  throw nb::value_error("of: must be 'step' or 'equilibrium'");
}

ActuatorJacobian jacobian(SharedModel& shared, const LiveState& live, const std::optional<std::string>& of) {
  if (live.model.get() != &shared) throw nb::value_error("this is a state of another model");
  const JacobianOf wanted = wanted_of(shared.model, of);
  const State state = live.state();
  const nb::gil_scoped_release release;
  Workspaces::Loan workspace = shared.workspaces.lend();
  return actuator_jacobian(shared.model, *workspace, state, wanted, shared.model.scene.time.step);
}

Rows compliance(SharedModel& shared, const LiveState& live, const std::optional<std::string>& of) {
  if (live.model.get() != &shared) throw nb::value_error("this is a state of another model");
  const JacobianOf wanted = wanted_of(shared.model, of);
  const State state = live.state();
  Eigen::MatrixXd W;
  {
    const nb::gil_scoped_release release;
    Workspaces::Loan workspace = shared.workspaces.lend();
    W = volume_compliance(shared.model, *workspace, state, wanted, shared.model.scene.time.step);
  }
  return matrix_of(W);
}

template <class T>
auto matrix(Eigen::MatrixXd T::*member) {
  return [member](const T& own) { return matrix_of(own.*member); };
}

}  // namespace

void bind_inverse(nb::module_& module) {
  nb::class_<ActuatorJacobian>(module, "ActuatorJacobian", doc::ActuatorJacobian)
      .def_prop_ro("effectors", matrix(&ActuatorJacobian::effectors), doc::ActuatorJacobian_effectors)
      .def_prop_ro("compliance", matrix(&ActuatorJacobian::compliance), doc::ActuatorJacobian_compliance)
      .def_prop_ro("forces", matrix(&ActuatorJacobian::forces), doc::ActuatorJacobian_forces)
      .def_prop_ro("positions", matrix(&ActuatorJacobian::positions), doc::ActuatorJacobian_positions)
      .def_ro("rows", &ActuatorJacobian::rows, "Name and unit of each row, as in 'tip.x [m]'.")
      .def_ro("columns", &ActuatorJacobian::columns, "Name and unit of each column, as in 'pull.force [N]'.");
  nb::class_<Manipulability>(module, "Manipulability", doc::Manipulability)
      .def_prop_ro(
          "gains", [](const Manipulability& own) { return vector_of(own.gains); }, doc::Manipulability_gains)
      .def_prop_ro("directions", matrix(&Manipulability::directions), doc::Manipulability_directions)
      .def_prop_ro("commands", matrix(&Manipulability::commands), doc::Manipulability_commands)
      .def_ro("measure", &Manipulability::measure, doc::Manipulability_measure);
  module.def(
      "jacobian", &jacobian, "model"_a, "state"_a, "of"_a = nb::none(),
      "How commands of the motors that are sought (`inverse` in the scene) move the outputs that have a "
      "target.\n\n"
      "of: 'step', where one linearised step from the state takes them, (14), which is the derivative of a step of "
      "a scene with `newton: 1`; that of a converged step grows beyond it with the tension of cables, by 1.3 at "
      "1.3 N in the example finger. 'equilibrium': where they come to rest, the exact tangent at an equilibrium. If "
      "left out, 'step' of dynamic scenes and 'equilibrium' of all others. Throws ValueError where the scene has "
      "no targets, or no motor is `inverse`, and RuntimeError where a matrix is singular.");
  module.def("compliance", &compliance, "model"_a, "state"_a, "of"_a = nb::none(), doc::volume_compliance);
  module.def(
      "manipulability",
      [](const nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>& jacobian) {
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        const Eigen::Map<const RowMajor> own(jacobian.data(), static_cast<Eigen::Index>(jacobian.shape(0)),
                                             static_cast<Eigen::Index>(jacobian.shape(1)));
        if (own.size() == 0 || !own.allFinite())
          throw nb::value_error("jacobian: must have rows and columns, and finite numbers");
        return manipulability(own);
      },
      "jacobian"_a, doc::Manipulability);
}

}  // namespace sinew::python
