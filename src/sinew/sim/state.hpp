// The state: everything that changes, as a value. A copy is a checkpoint; a step from it gives the same bits every
// time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sinew/sim/model.hpp"

namespace sinew {

struct SolidState {
  Eigen::Matrix3Xd x, v;     ///< [m], [m/s], 3 x nodes
  Eigen::VectorXd reaction;  ///< [N] with which each held coordinate is held, nodes in their order, x y z
};

struct RodState {
  Eigen::VectorXd q;                         ///< coordinates of base and strains
  rod::Mat3 turned = rod::Mat3::Identity();  ///< how far a floating base has turned
  Eigen::Matrix3Xd masses;                   ///< [m] where the mass points are
  Eigen::Matrix3Xd velocity;                 ///< [m/s] of the mass points
  Eigen::VectorXd q_rate;                    ///< of q per second, in the last step
  Eigen::MatrixXd internal;                  ///< internal forces, see sim/internal.hpp
};

struct CableState {
  Eigen::VectorXd z;  ///< [m] (how far its base is out, points)
};

/// One side of a contact: a part of a collider, carried by its motion.
struct ContactSide {
  Collider on;
  contact::Simplex local;             ///< of a rigid body in its axes, of an obstacle in the world at t = 0; its kind
  std::array<int, 3> nodes{};         ///< or its corners: of a solid; also of a rigid mesh
  std::array<double, 3> abscissae{};  ///< [m] of a rod
};

/// What touches, or may touch, at the end of a step.
struct ContactState {
  int pair = 0;                ///< of the model's
  std::uint64_t part = 0;      ///< of the two, by which a contact is known again in the next step
  ContactSide a, b;            ///< of a contact in the making; those of a finished step are found again
  bool on_second = false;      ///< a is of the pair's second object
  Vec3 grazed = Vec3::Zero();  ///< of a contact in the making: normal of the plane in which both lie beside each other
  Vec3 force = Vec3::Zero();   ///< [N] on a; b feels the opposite
  Vec3 point = Vec3::Zero(), normal = Vec3::Zero();  ///< [m] on b; from b to a
  double gap = 0.0;                                  ///< [m]
  double slip = 0.0;                                 ///< [m] in the step
};

/// [N] on the second object of its pair.
Vec3 force_on_second(const ContactState& contact);
/// Whether it slides: against all the friction there is, and by more than what a step leaves undecided.
bool slides(const Model& model, const ContactState& contact);

struct PointState {
  double s = 0.0;         ///< [m] abscissa
  double friction = 0.0;  ///< [N] of the rod on its channel, along the rod towards its tip
  /// False: the rod's end has passed it, and its rows are off. sim/step_ends switches it; sim/reduced leaves its rows
  /// empty, sim/free_motion its force and its part of H, sim/view does not show it.
  bool on = true;
};

/// What has been put into the rods and solids since the start [J].
struct Energies {
  double work = 0.0;        ///< by all that does work (sim/work.hpp)
  double work_bound = 0.0;  ///< the most that it may have been
};

/// Where a static analysis stands on its path (sim/statics.hpp); as it is made in other analyses.
struct PathState {
  double step = 0.0;      ///< arc length to try next
  double rate = 0.0;      ///< last change of the load factor over the arc
  double count = 0.0;     ///< steps taken
  double farthest = 0.0;  ///< largest load factor so far
  double work = 0.0;      ///< spent on the path (`iteration_work`), and when `farthest` last grew
  double work_at_farthest = 0.0;
  bool stable = true;         ///< the equilibrium there
  Eigen::VectorXd direction;  ///< and of everything else; empty before the first step and in other analyses
};

/// Everything that changes, as a value.
struct State {
  long grid = 0;      ///< steps of the scene's time grid that are behind it
  double time = 0.0;  ///< [s]; of a modal analysis the number of the mode
  int halvings = 0;   ///< of the scene's step, with which the next part of it is to be tried
  int spent = 0;      ///< iterations of Newton that steps of the grid have not paid back yet (sim/run.cpp)
  std::vector<SolidState> solids;
  std::vector<RodState> rods;
  std::vector<CableState> cables;
  std::vector<rigid::Motion> bodies;
  std::vector<ContactState> contacts;
  std::vector<PointState> points;
  Eigen::VectorXd followed;       ///< [m] what ties to bodies follow, in the order of their unknowns
  Eigen::VectorXd lambda;         ///< [N] multipliers of all rows; of an angle [N m]
  std::vector<double> actuators;  ///< [N] or [N m] force of each motor
  std::vector<double> loads;      ///< factor of each load
  Energies energies;
  PathState path;
  double frequency = 0.0;  ///< [Hz] of the mode that this state shows, in a modal analysis
};

State initial_state(const Model& model);

/// All numbers are.
bool finite(const State& state);

/// Whether anything has a velocity.
bool moves(const State& state);

/// Names the numbers of `pack` and their order. To be raised with any change of theirs: recordings of another one are
/// refused.
inline constexpr std::uint64_t kStateLayout = 9;
/// The state as plain numbers in a fixed order, contacts at the end, and back. unpack throws std::invalid_argument if
/// their number, or a contact's pair, is not this model's.
std::vector<double> pack(const State& state);
State unpack(const Model& model, const std::vector<double>& numbers);

}  // namespace sinew
