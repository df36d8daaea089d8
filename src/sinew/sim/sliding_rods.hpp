// How well sections resolve a rod that bends and slides through points, and how much its friction owes to them.
//
// Where a rod of bending stiffness B leaves a channel with the moment M, a configurational force M^2 / (2 B) draws it
// out (D. Bigoni et al., "Eshelby-like forces acting on elastic structures", Mechanics of Materials 80 (2015)
// 368-374). The strains of a section are polynomials, and a section that reaches through a point smooths what changes
// there: as the rod slides, that force swings about its mean, the more the fewer sections there are between two points.
// Measured for sections of order p, n of them between two points (docs/points.md), the swing depends on 2^p n alone.
//
// And a moment that points hold is held by forces of opposite signs, M / spacing at most: a clamped beam on supports a
// distance d apart presses on them with 2 sqrt(3) M / d in all (three-moment equation, an end moment on infinitely many
// supports), so the friction of a rod that bends at the end of a channel of points has no limit as they come closer.
#pragma once

#include <vector>

#include "sinew/error/warning.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// How a rod's sections and sliding points lie.
struct SlideResolution {
  double spacing = 0.0;   ///< [m] between neighbouring points, the smallest
  double sections = 0.0;  ///< between two points where these are the fewest, as a fraction if less than one
  int order = 0;          ///< of the bending strains there
  /// Sections between two points that would do the same at order 0; infinite of fewer than two points.
  double equivalent() const;
};

/// Of points at these abscissae [m], ascending, on a rod.
SlideResolution slide_resolution(const rod::Rod& rod, const std::vector<double>& abscissae);

/// The same of a coupling of the model. Where its solid is soft, what the points hold is spread over the length
/// (4 B / E)^(1/4) of a beam on an elastic foundation, if that is longer than the distance of two points, and so are
/// the changes that the sections must follow.
double equivalent_sections(const Model& model, int coupling);

/// The swing of the configurational force about its mean, as a part of it, of so many equivalent sections an interval.
double ripple_of(double equivalent);

/// Below so many equivalent sections an interval the swing is beyond a tenth of the force.
inline constexpr double kFewSections = 2.0;

/// [1/m] normal force that a moment at the end of a channel presses on its points with, over the moment.
double pressed_by_moment(double spacing);

/// Of half a wave: sections of a pushed rod that are longer make its force 6 % too large, and more.
inline constexpr double kLongInWaves = 0.2;

/// Warnings of rods whose sliding forces hang on their sections or points: `sliding_force_ripples`, `coarse_under_push`
/// and `friction_of_points`. Time and number of steps are left to the caller.
std::vector<Warning> assess_sliding_rods(const Model& model, const State& state);

}  // namespace sinew
