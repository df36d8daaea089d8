// Targets: what effectors, the outputs that have one, are to be, how far off they are, and what came of it.
#pragma once

#include "sinew/sim/quantities.hpp"
#include "sinew/sim/step.hpp"

namespace sinew {

/// Where effectors are to be at the end of a step: their components one after the other, in the order of the model's
/// effectors. Positions [m], turns since the start as rotation vectors [rad] in the axes of the world, strains [1/m] or
/// 1, normal forces between two [N].
struct Goal {
  Eigen::VectorXd at;
};

/// What the scene's targets ask for at a time; where effectors are at the start, of targets set from outside.
Goal goal_at(const Model& model, double time);
void goal_at(const Model& model, double time, Goal& goal);

/// An effector's components: what counts as much as 1 mm of a position [SI]; in what a person speaks of them, and how
/// much that is; the name of the SI unit.
struct Measure {
  double unit = 1e-3;
  const char* name = "mm";
  double shown = 1e-3;
  const char* si = "m";
};
Measure measure_of(const Model& model, const EffectorModel& effector);

/// Name and SI unit of each of its components: "tip.x", "m".
std::vector<Column> effector_columns(const Model& model, const EffectorModel& effector);

/// How many components all effectors have.
int effector_size(const Model& model);

/// What an output of such a quantity has for a target.
Eigen::VectorXd effector_value(const Model& model, const State& state, const EffectorModel& effector);

/// How far effectors are off their goals: position, strain and force by their difference, turns by the rotation vector
/// from the goal to where they are. Two that are to be pressed together and are still apart lack 0.1 N more for every
/// mm between them (kPerGap), so that what is to press comes nearer.
inline constexpr double kPerGap = 100.0;  // [N/m]
void effector_errors(const Model& model, const State& state, const Goal& goal, Eigen::VectorXd& errors);

/// The place that is a part of the way from where effectors are to their goals: straight, by an even turn, by forces
/// that change in proportion.
Goal part_of_goal(const Model& model, const State& from, const Goal& goal, double part);

/// How far off one is in the components that matter [SI].
double error_of(const EffectorModel& own, const Eigen::VectorXd& errors);

/// Errors in units of tolerances, the largest of all effectors: reached if not above 1.
double farthest(const Model& model, const Eigen::VectorXd& errors);

/// "actuators.pull: force at most 10 N"
std::string describe(const Model& model, const Bound& bound);

/// "reached", or what keeps the effectors from their goals; empty without targets.
std::string describe(const Model& model, const Aim& aim);

}  // namespace sinew
