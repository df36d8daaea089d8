#include "sinew/runs/digest.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "sinew/runs/results.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/targets.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew::runs {

namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

std::size_t column_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? kNone : static_cast<std::size_t>(found - names.begin());
}

/// Energy that comes from nowhere: kinetic, elastic and weight less the most that work may have been rises above what
/// it was (sim/work.hpp). It does not in short steps; in long ones rods that snap or buckle gain energy, bodies that
/// turn while they touch, and all that is linearised.
class EnergyBalance {
 public:
  EnergyBalance(const Model& model, const std::vector<std::string>& names, bool overlaps)
      : model_(&model),
        kinetic_(column_of(names, "energy.kinetic")),
        elastic_(column_of(names, "energy.elastic")),
        weight_(column_of(names, "energy.weight")),
        work_(column_of(names, "energy.work_bound")),
        // What overlaps at the start is lifted apart, slowly, and warned of already.
        small_(overlaps ? 1e-6 : 1e-14),
        least_(model.start_energy) {}

  void add(const io::RecordedStep& step, std::vector<Warning>& warnings) {
    constexpr double kGain = 1e-3;  // of the largest kinetic and elastic energy so far
    if (model_->scene.analysis != Analysis::dynamic || work_ == kNone) return;
    const double stored = step.signals[kinetic_] + step.signals[elastic_],
                 energy = stored + step.signals[weight_] - step.signals[work_];
    largest_ = std::max(largest_, stored);
    least_ = std::min(least_, energy);
    const double gain = energy - least_;
    if (!(gain > kGain * largest_) || !(largest_ > small_ * model_->bearing * model_->size)) return;
    const bool linearised = model_->scene.newton.iterations > 0;
    merge({.code = "energy_gain",
           .where = "energy",
           .message = fmt::format("{:.3g} J have come from nowhere, {:.3g} of the largest kinetic and elastic energy",
                                  gain, gain / largest_),
           .remedy = linearised ? "take shorter steps, or leave `newton` out" : "take shorter steps",
           .time = step.time,
           .value = gain / largest_,
           .limit = kGain,
           .steps = 1},
          warnings);
  }

 private:
  const Model* model_;
  std::size_t kinetic_, elastic_, weight_, work_;
  double small_, largest_ = 0.0, least_;
};

/// The way of an output of position, and of its target if it has one, as columns of the signals.
struct CourseColumns {
  std::size_t way = kNone, wanted = kNone, error = kNone;
  Eigen::Vector3d weights = Eigen::Vector3d::Ones();
  std::vector<double> ways, targets;  // x, y, z one after the other
};

/// Where a target does not care, it is where its output is.
void add(const io::RecordedStep& step, CourseColumns& columns) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = step.signals[columns.way + axis];
    columns.ways.push_back(at);
    if (columns.wanted == kNone) continue;
    const bool cares = columns.weights[static_cast<Eigen::Index>(axis)] != 0.0;
    columns.targets.push_back(cares ? step.signals[columns.wanted + axis] : at);
  }
}

std::vector<io::Course> begin_courses(const Model& model, const std::vector<std::string>& names,
                                      std::vector<CourseColumns>& all) {
  std::vector<io::Course> found;
  if (model.scene.analysis == Analysis::modal) return found;  // (modes do not follow each other)
  for (int i = 0; i < static_cast<int>(model.outputs.size()); ++i) {
    const OutputModel& output = model.outputs[i];
    if (output.quantity != Quantity::position) continue;
    CourseColumns columns;
    columns.way = column_of(names, output.name + ".x");
    if (columns.way == kNone) continue;
    const auto aims = [i](const EffectorModel& effector) { return effector.output == i; };
    const auto effector = std::find_if(model.effectors.begin(), model.effectors.end(), aims);
    if (effector != model.effectors.end()) {
      columns.wanted = column_of(names, output.name + ".target.x");
      columns.error = column_of(names, output.name + ".error");
      for (Eigen::Index axis = 0; axis < 3; ++axis) columns.weights[axis] = effector->weights[axis];
    }
    found.push_back({output.name, {}, Eigen::Matrix3Xd(3, 0), 0.0});
    all.push_back(std::move(columns));
  }
  return found;
}

Eigen::Matrix3Xd columns_from(const std::vector<double>& numbers) {
  return Eigen::Map<const Eigen::Matrix3Xd>(numbers.data(), 3, std::ssize(numbers) / 3);
}

void add(const io::StepCounts& counts, Digest& all) {
  all.rotated += counts.rotated ? 1 : 0;
  all.redundant += counts.redundant ? 1 : 0;
  all.halved += counts.halvings > 0 ? 1 : 0;
  all.floors += counts.at_floor ? 1 : 0;
  ContactReport& contact = all.contact;
  contact.contacts = std::max(contact.contacts, static_cast<int>(counts.contacts));
  contact.penetration = std::max(contact.penetration, counts.penetration);
  contact.sweeps += static_cast<int>(counts.sweeps);
  contact.newton += static_cast<int>(counts.contact_newton);
  contact.unsolved += static_cast<int>(counts.unsolved);
  contact.left.complementarity = std::max(contact.left.complementarity, counts.complementarity);
  contact.left.cone = std::max(contact.left.cone, counts.cone);
  contact.left.dissipation = std::max(contact.left.dissipation, counts.dissipation);
}

}  // namespace

StepSource steps_of(const std::filesystem::path& recording) {
  return [recording](const StepVisitor& visit) {
    io::RecordingReader reader(recording);
    while (const std::optional<io::RecordedStep> step = reader.next()) {
      threads::Interruption::check();
      visit(*step);
    }
  };
}

StepSource steps_of(const std::vector<io::RecordedStep>& steps) {
  return [&steps](const StepVisitor& visit) { std::for_each(steps.begin(), steps.end(), visit); };
}

Digest digest(const Model& model, const RunSummary& summary, const std::vector<std::string>& signal_names,
              const StepSource& steps) {
  Digest all;
  all.warnings = summary.warnings;
  EnergyBalance energy(model, signal_names, find_warning(summary.warnings, "overlap_at_start") != nullptr);
  std::vector<Warning> gained;
  std::vector<CourseColumns> columns;
  all.courses = begin_courses(model, signal_names, columns);
  std::vector<std::size_t> errors;
  for (const EffectorModel& effector : model.effectors)
    errors.push_back(column_of(signal_names, model.outputs[effector.output].name + ".error"));
  all.worst.resize(errors.size());
  steps([&](const io::RecordedStep& step) {
    const bool starts = all.rows.empty();
    if (starts) all.first = step;
    const auto status = std::find(all.statuses.begin(), all.statuses.end(), step.status);
    const auto number = static_cast<std::uint32_t>(status - all.statuses.begin());
    if (status == all.statuses.end()) all.statuses.push_back(step.status);
    all.rows.push_back({step.time, step.residual, step.violation, step.newton, number});
    if (!step.targets.empty()) ++all.targets[step.targets];
    merge(step.warnings, all.warnings);
    if (const Warning* inverted = find_warning(step.warnings, "elements_inverted"))
      all.most_inverted = std::max(all.most_inverted, static_cast<int>(inverted->value));
    energy.add(step, gained);
    for (CourseColumns& course : columns) add(step, course);
    if (!starts) {
      for (std::size_t i = 0; i < errors.size(); ++i) {
        if (errors[i] == kNone) continue;
        const double error = step.signals[errors[i]];
        if (all.rows.size() == 2 || error > all.worst[i].error) all.worst[i] = {error, step.time, step.targets};
      }
      add(step.counts, all);
      ++(!step.counts.stability_known ? all.not_known : step.counts.unstable ? all.unstable : all.stable);
    }
    all.last = step;
  });
  merge(gained, all.warnings);
  for (std::size_t i = 0; i < columns.size() && !all.rows.empty(); ++i) {
    all.courses[i].way = columns_from(columns[i].ways);
    if (columns[i].wanted == kNone) continue;
    all.courses[i].wanted = columns_from(columns[i].targets);
    if (columns[i].error != kNone) all.courses[i].off = all.last.signals[columns[i].error];
  }
  return all;
}

}  // namespace sinew::runs
