#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "sinew/commands.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/append_file.hpp"
#include "sinew/io/picture.hpp"
#include "sinew/io/readable.hpp"
#include "sinew/progress.hpp"
#include "sinew/runs/loaded_scene.hpp"
#include "sinew/signals.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/reach.hpp"
#include "sinew/sim/targets.hpp"
#include "sinew/sim/view.hpp"
#include "sinew/terminal.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew::app {

namespace {

/// The motors' columns and those of every effector.
std::string header_of(const Model& model) {
  std::string row = "status,within";
  for (const int sought : model.sought) {
    const ActuatorModel& own = model.actuators[sought];
    const MotorWords words = words_of(own);
    row += "," + own.name + "." + words.position + "," + own.name + "." + words.force;
  }
  for (const EffectorModel& own : model.effectors) {
    const std::string& name = model.outputs[own.output].name;
    row += own.size == 1 ? "," + name : "," + name + ".x," + name + ".y," + name + ".z";
  }
  return row + "\n";
}

std::string row_of(const Model& model, const ReachSample& sample) {
  std::string row = fmt::format("{},{}", to_string(sample.status), sample.within ? 1 : 0);
  const bool known = accepted(sample.status);
  for (std::size_t a = 0; a < model.sought.size(); ++a) {
    const bool force = model.actuators[model.sought[a]].told_force();
    row += !known
               ? (force ? fmt::format(",,{:.17g}", sample.commands[a]) : fmt::format(",{:.17g},", sample.commands[a]))
               : fmt::format(",{:.17g},{:.17g}", sample.positions[a], sample.forces[a]);
  }
  for (const EffectorModel& own : model.effectors) {
    if (known) {
      const Eigen::VectorXd value = effector_value(model, sample.state, own);
      for (const double number : value) row += fmt::format(",{:.17g}", number);
    } else {
      row += std::string(static_cast<std::size_t>(own.size), ',');
    }
  }
  return row + "\n";
}

}  // namespace

int map_workspace(const WorkspaceOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  overrides.emplace_back("analysis=quasi_static");
  overrides.emplace_back("newton.iterations=converged");
  const io::SceneFile file = io::read_scene(options.scene, options.overrides);
  if (!file.lines.contains("newton.limit") && !file.lines.contains("newton.tolerance"))
    overrides.back() = "newton=converged";
  runs::LoadedScene loaded = runs::load(io::read_scene(options.scene, overrides));
  const Model& model = loaded.model;
  std::vector<std::vector<double>> commands;
  try {
    commands = spread_commands(model, options.samples);
  } catch (const InputError& error) {
    InputFault fault = error.fault();
    fault.file = options.scene.string();
    fault.line = io::line_of(file, fault.path);
    throw InputError(fault);
  }
  std::error_code failed;
  std::filesystem::create_directories(options.output, failed);
  if (failed)
    throw InputError({options.output.string(), 0, "", "", "the folder cannot be made: " + failed.message(),
                      "give another one with -o"});
  const auto shown = std::find_if(model.effectors.begin(), model.effectors.end(), [&](const EffectorModel& own) {
    return model.outputs[own.output].quantity == Quantity::position;
  });
  Progress progress("sinew workspace " + options.scene.filename().string(), static_cast<double>(commands.size()),
                    options.quiet);
  io::AppendFile table(options.output / "workspace.csv", io::AppendFile::Start::empty);
  table.append(header_of(model));
  io::PictureOptions picture;
  picture.title =
      (model.scene.title.empty() ? options.scene.stem().string() : model.scene.title) + ": what can be reached";
  picture.up = -model.scene.gravity;
  int tried = 0, found = 0, within = 0;
  note_signals();
  const auto take = [&](const ReachSample& sample) {
    table.append(row_of(model, sample));
    ++tried;
    found += accepted(sample.status) ? 1 : 0;
    within += sample.within ? 1 : 0;
    if (sample.within && shown != model.effectors.end()) {
      double force = 0.0;
      for (const double own : sample.forces) force = std::max(force, std::abs(own));
      picture.cloud.push_back({effector_value(model, sample.state, *shown), force});
    }
    progress.update(tried, fmt::format("{} of {}", tried, commands.size()));
    return !signalled();
  };
  try {
    const threads::Interruption interruption(signalled);
    sample_reach(model, commands, take, options.threads);
  } catch (const threads::Interrupted&) {
  }
  progress.finish(fmt::format("{} equilibria of {}, {} within all limits", found, tried, within));
  if (found < tried)
    complain("warning: {} of {} equilibria were not found; their rows in workspace.csv say why\n", tried - found,
             tried);
  const bool interrupted = signalled(), draws = !interrupted && !picture.cloud.empty();
  if (draws) {
    Snapshot rest = snapshot(model, initial_state(model), "rest");
    rest.outputs.clear();
    rest.sliding_points.clear();
    const MotorWords words = words_of(model.actuators[model.sought[0]]);
    picture.cloud_name = std::string("largest ") + words.force;
    picture.cloud_unit = words.force_unit;
    io::draw_picture(options.output / "workspace.png", rest, rest, picture);
  }
  if (!options.quiet) {
    say("Results in {}/\n  workspace.csv      motors and outputs of every equilibrium\n", options.output.string());
    if (draws) say("  workspace.png      where {} was brought\n", model.outputs[shown->output].name);
  }
  return interrupted ? kInterrupted : found > 0 ? kDone : kNumericalStop;
}

}  // namespace sinew::app
