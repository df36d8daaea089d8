// Contacts: which parts of bodies, solids and rods are near each other in a step, how near, and how they move them.
//
// Each contact is a pair of simplices (contact/simplex) that the motion of their bodies carries. Which ones is found
// once a step; where they are nearest, the normal and the gap follow the iterate.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "sinew/sim/contact_search.hpp"

namespace sinew {

/// A contact at an iterate: x_a - x_b are its material points, u = (gap, slip along the two tangents) what Signorini's
/// and Coulomb's laws are about.
struct Touch {
  contact::Nearest nearest;
  Eigen::Matrix3d frame;      ///< normal (from b to a) and two tangents, as columns
  Vec3 point_a, point_b;      ///< [m] on the two surfaces
  Vec3 force = Vec3::Zero();  ///< [N] on a, turned with the normal since it was set
  Vec3 u = Vec3::Zero();      ///< [m] gap, and slip since the start of the step
  /// What the turning of the normal adds to the tangent, - lambda_n d2gap, of a rod on an obstacle, by how its point
  /// turns and moves; or zero.
  rod::Mat6 of_rod = rod::Mat6::Zero();
  /// The same over the corners of a and then of b where a solid is pressed on (`add_contact_curvature`), or empty.
  contact::GapHessian stiffness;
};

/// By which a contact is known again: the number of its pair in the model, and its part of that (ContactState::part).
using ContactKey = std::pair<int, std::uint64_t>;

/// What contacts of a step are evaluated with; memory of the last time.
struct ContactRoom {
  std::vector<rod::Configuration> start, now;  ///< of rods that touch something
  Surfaces surfaces;                           ///< at the start
  std::vector<contact::Facing> facings;        ///< of each contact, as it is at the start
  std::vector<ContactKey> found;               ///< ascending
  std::vector<int> left_out;                   ///< pairs of which a contact is not met in this step
  /// Contacts of corners and edges that fly past the other object, and of rigid shapes that fly past each other: they
  /// are not met in this step.
  std::vector<ContactState> passing;
  std::vector<Touch> touches;
  /// Contacts that have come near enough in this step to matter, ascending; the others are open and only watched.
  std::vector<int> playing;
  std::vector<double> gaps;  ///< [m] of each contact at the start of the step
  std::vector<double> thin;  ///< [m] of each pair of the model the thickness of its thinner object
  /// [m] least gap of each at the end of the step: 0, or below while bodies that overlap are moved apart, or above
  /// where one bounces.
  std::vector<double> least;
  /// Part of the step after which, with the velocities of its start, something has come a tenth of the thinner object's
  /// thickness into something; at most 1.
  double clear = 1.0;
};

/// What earlier looks at a step have found (sim/contact_passage).
struct EarlierLooks {
  std::vector<ContactKey> left_behind;  ///< contacts that pressed where the two were apart: they take no part
  std::vector<int> met;                 ///< pairs that met after all, or were not looked for: nothing of them passes
  bool nothing_passes = false;          ///< nothing is taken to fly past
};

/// Finds what may touch within the step, starting from where the step starts, within `alarm` [m] of each other, or what
/// a pair's targets ask for; forces that the iterate has are kept.
///
/// A contact holds along a direction that is chosen at the start. Of a corner ahead of an edge that is the one from the
/// edge to the corner, which would stop what passes above or beside it in this step. Corners that the velocities of the
/// start lead past the whole other object, clear of it, take no part, nor do edges that they lead past all of its edges
/// (`ContactRoom::passing`), unless `earlier` looks know better. The iterate is the first guess of the step, without
/// those velocities.
void find_contacts(const StepContext& context, State& iterate, ContactRoom& room, double alarm,
                   const EarlierLooks& earlier = {});

/// Where the contacts of an iterate are.
void evaluate_contacts(const StepContext& context, const State& iterate, ContactRoom& room);

/// How the normals of those that press on solids turn, for an exact tangent; not of pieces of rods. `room` must hold
/// the contacts of this iterate, as `evaluate_contacts` left them.
void add_contact_curvature(const StepContext& context, const State& iterate, ContactRoom& room);

/// Writes where contacts are into an accepted state, and drops those that are open, but for the nearest of a pair that
/// is sought and does not touch.
void finish_contacts(const StepContext& context, const ContactRoom& room, State& next);

/// [m] by which a contact of the last iterate overlaps; 0 where it does not. Of a pair that overlapped when the run
/// began, beyond what it may on its way apart.
inline double overlap_of(const Model& model, const State& iterate, const ContactRoom& room, std::size_t contact) {
  const double at_start = model.pairs[iterate.contacts[contact].pair].depth;
  return std::max(0.0, std::clamp(room.least[contact], -at_start, 0.0) - room.touches[contact].u[0]);
}

/// Visits the two sides of a contact: side, weights of its corners, its material point, and 1 for what feels the force,
/// -1 for what feels the opposite.
template <class Visit>
void each_side(const ContactState& contact, const Touch& touch, const Visit& visit) {
  visit(contact.a, touch.nearest.a, touch.point_a, 1.0);
  visit(contact.b, touch.nearest.b, touch.point_b, -1.0);
}

/// A pair whose objects overlap.
struct Overlap {
  int pair = 0;        ///< of the model's
  double depth = 0.0;  ///< [m] > 0, of the deepest place
};
/// All pairs that overlap by more than a millionth of the model's size at the start of a run.
std::vector<Overlap> overlaps(const Model& model, const State& start);

/// How far parts may be apart at the start of a step to be looked at [m], as velocities have it; sim/contact_passage
/// looks again once the motion is known.
double alarm_distance(const StepContext& context);

}  // namespace sinew
