// Scenes and models.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "docs.hpp"
#include "engine.hpp"
#include "sinew/io/mesh_file.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"

namespace sinew::python {

namespace {

ModelPointer built(io::SceneFile file, runs::HeldFiles held = {}) {
  const nb::gil_scoped_release release;
  return std::make_shared<SharedModel>(runs::load(std::move(file), std::move(held)));
}

/// Meshes by their names, as bytes.
runs::HeldFiles files_of(const nb::typed<nb::dict, nb::str, nb::bytes>& meshes) {
  runs::HeldFiles held;
  for (const auto& [name, own] : meshes) {
    const nb::bytes bytes = nb::cast<nb::bytes>(own);
    held.emplace(text_of(nb::str(name)), std::string(bytes.c_str(), bytes.size()));
  }
  return held;
}

std::vector<std::pair<std::string, std::string>> motor_commands(const Model& model) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const ActuatorModel& own : model.actuators) {
    const MotorWords words = words_of(own);
    all.emplace_back(command_name(own), own.told_force() ? words.force_unit : words.position_unit);
  }
  return all;
}

}  // namespace

void bind_models(nb::module_& module) {
  nb::class_<SharedModel>(module, "Model",
                          "A scene that has been judged, turned into bodies, rows and numbers. Immutable; steps only "
                          "read it, so threads may share it.",
                          nb::is_weak_referenceable())
      .def(
          "initial_state", [](ModelPointer own) { return LiveState::of(own, sinew::initial_state(own->model)); },
          "The state at t = 0.")
      .def(
          "__reduce__",
          [](nb::handle_t<SharedModel> own) {
            return nb::module_::import_("sinew.running").attr("_reduced_model")(own);
          },
          nb::sig("def __reduce__(self) -> tuple[typing.Any, ...]"))
      .def("__repr__",
           [](const SharedModel& own) {
             const Model& model = own.model;
             std::string text = "<sinew.Model";
             if (!model.scene.title.empty()) text += " " + model.scene.title;
             const auto tell = [&text](const char* what, const std::vector<std::string>& names) {
               if (!names.empty()) text += fmt::format(", {}: {}", what, fmt::join(names, " "));
             };
             tell("solids", names_of(model.solids));
             tell("rods", names_of(model.rods));
             tell("cables", names_of(model.cables));
             tell("bodies", names_of(model.bodies));
             tell("actuators", names_of(model.actuators));
             tell("outputs", names_of(model.outputs));
             return text + ">";
           })
      .def_prop_ro(
          "title", [](const SharedModel& own) { return own.model.scene.title; }, "The scene's title.")
      .def_prop_ro(
          "time_step", [](const SharedModel& own) { return own.model.scene.time.step; },
          "[s] from one point of the time grid to the next.")
      .def_prop_ro(
          "duration", [](const SharedModel& own) { return run_duration(own.model.scene); }, doc::run_duration)
      .def_prop_ro(
          "steps", [](const SharedModel& own) { return grid_steps(own.model.scene); }, doc::grid_steps)
      .def_prop_ro(
          "solids", [](const SharedModel& own) { return names_of(own.model.solids); }, "Names of the solids.")
      .def_prop_ro(
          "rods", [](const SharedModel& own) { return names_of(own.model.rods); }, "Names of the Cosserat rods.")
      .def_prop_ro(
          "cables", [](const SharedModel& own) { return names_of(own.model.cables); }, "Names of the geometric cables.")
      .def_prop_ro(
          "bodies", [](const SharedModel& own) { return names_of(own.model.bodies); }, "Names of the rigid bodies.")
      .def_prop_ro(
          "actuators", [](const SharedModel& own) { return names_of(own.model.actuators); },
          "Names of the motors, in the order of commands.")
      .def_prop_ro(
          "commands", [](const SharedModel& own) { return motor_commands(own.model); },
          "What each motor is told, as signals call it, and the unit: [('pull.displacement', 'm')].")
      .def_prop_ro(
          "loads", [](const SharedModel& own) { return names_of(own.model.loads); }, "Names of the loads.")
      .def_prop_ro(
          "outputs", [](const SharedModel& own) { return names_of(own.model.outputs); }, "Names of the outputs.")
      .def_prop_ro(
          "targets", [](const SharedModel& own) { return effector_names(own.model); },
          "Names of the outputs that have a target.")
      .def_prop_ro(
          "signals",
          [](const SharedModel& own) {
            std::vector<std::pair<std::string, std::string>> all;
            for (const Column& column : signal_columns(own.model)) all.emplace_back(column.name, column.unit);
            return all;
          },
          "Name and SI unit of every signal, the columns of signals.csv after time, status and newton.")
      .def_prop_ro(
          "rows", [](const SharedModel& own) { return own.model.rows; }, doc::Model_rows)
      .def_prop_ro(
          "unknowns",
          [](const SharedModel& own) {
            int all = own.model.unknowns;
            for (const SolidModel& solid : own.model.solids) all += solid.body.unknowns;
            for (const RodModel& rod : own.model.rods) all += rod.rod.strain_coordinates();
            return all;
          },
          "Coordinates that a step solves for: of solids, rods, cables, bodies and sliding points.")
      .def_prop_ro(
          "size", [](const SharedModel& own) { return own.model.size; }, doc::Model_size)
      .def_prop_ro(
          "warnings", [](const SharedModel& own) { return own.model.warnings; }, "What `build` finds worth telling.")
      .def_prop_ro(
          "text", [](const SharedModel& own) { return own.loaded.file.text; }, "The scene as YAML.")
      .def_prop_ro(
          "folder", [](const SharedModel& own) { return own.model.scene.folder; },
          "Where the scene's files are looked for.")
      .def_prop_ro(
          "inputs_hash", [](const SharedModel& own) { return own.loaded.inputs_hash; },
          "Content hash of the scene and all files it reads.")
      .def_prop_ro(
          "meshes",
          [](const SharedModel& own) {
            nb::dict all;
            for (const auto& [name, bytes] : own.loaded.held) all[name.c_str()] = nb::bytes(bytes.data(), bytes.size());
            return all;
          },
          nb::sig("def meshes(self) -> dict[str, bytes]"),
          "Meshes that were handed over as arrays: files of Gmsh by the names that the scene has for them.");

  module.def(
      "build",
      [](nb::handle tree, const std::string& folder, const std::vector<std::string>& changes,
         const nb::typed<nb::dict, nb::str, nb::bytes>& meshes) {
        return built(io::scene_of(node_of(tree), folder, changes), files_of(meshes));
      },
      "tree"_a, "folder"_a, "changes"_a, "meshes"_a, "Builds a scene given as dicts and lists.");
  module.def(
      "build_file",
      [](const std::string& file, const std::vector<std::string>& changes) {
        return built(io::read_scene(file, changes));
      },
      "file"_a, "changes"_a, "Builds the scene of a file.");
  module.def(
      "build_text",
      [](const std::string& text, const std::string& folder, const nb::typed<nb::dict, nb::str, nb::bytes>& meshes) {
        return built(io::parse_scene(text, "", folder), files_of(meshes));
      },
      "text"_a, "folder"_a, "meshes"_a, "Builds a scene given as YAML.");
  module.def(
      "read_tree",
      [](const std::string& file, const std::vector<std::string>& changes) {
        const io::SceneFile scene = io::read_scene(file, changes);
        return object_of(io::parse_document(scene.text, file));
      },
      "file"_a, "changes"_a,
      nb::sig("def read_tree(file: str, changes: collections.abc.Sequence[str]) -> dict[str, typing.Any]"),
      "A scene file as dicts and lists, once it has been found to be one.");
  module.def(
      "check_tree", [](nb::handle tree, const std::string& folder) { io::scene_of(node_of(tree), folder); }, "tree"_a,
      "folder"_a, "Reads a scene given as dicts and lists, without building it.");
  module.def(
      "write_tree", [](nb::handle tree) { return io::write_document(node_of(tree)); }, "tree"_a,
      "Dicts and lists as YAML.");
  module.def("scene_schema", &io::scene_schema, doc::scene_schema);
  module.def(
      "driven_by",
      [](const std::string& table, const std::string& file, const std::vector<std::string>& changes) {
        return runs::driven_by(table, io::read_scene(file, changes));
      },
      "table"_a, "file"_a, "changes"_a, doc::driven_by);
}

}  // namespace sinew::python
