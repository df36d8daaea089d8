// What loads do to the coordinates of sections of constant strain that only turn, for eight sections at once: the
// formulas of rod/forces, written out for registers with a section in each lane. README.md derives them.
#pragma once

namespace sinew::rod {

inline constexpr int kLanes = 8;

/// A number of each section.
using Eight = double[kLanes];
inline constexpr int kLine = 64;  ///< [bytes] of the cache

/// The largest angle [rad] of an exponential.
inline constexpr double kLargestTurn = 3.0;

/// Where sections begin, from the origin, and their strains. Lanes from `count` on are anything, here and below, but
/// must hold numbers.
struct alignas(kLine) SectionLanes {
  Eight R[3][3], p[3];                ///< columns
  Eight rotation[3], translation[3];  ///< [1/m], [-]
  int count = 0;
};

/// Sums over loads, as rod/beyond has them: of forces and weights alone, which have a potential.
struct alignas(kLine) LoadLanes {
  Eight moment[3], force[3];                  ///< the wrench, about the origin
  Eight bending_moment[3], bending_force[3];  ///< the part of it that takes part in the tangent
  Eight second[3][3], lever[3], weight;       ///< columns
};

/// Exponentials from where the sections begin, of length [m], and the loads beyond them.
struct alignas(kLine) CrossingLanes {
  Eight length;
  LoadLanes beyond;
};

/// The mass points of a station in each section (rod/forces, StationInertia).
struct alignas(kLine) StationLanes {
  Eight length;        ///< [m] from the section's beginning
  Eight mass;          ///< [kg]
  Eight weight[3][3];  ///< columns
  Eight pull[3][3];    ///< columns
  LoadLanes loads;     ///< what they are where the station is
};

/// Sums over crossings, by the three rates of rotation.
struct alignas(kLine) CrossedLanes {
  Eight gradient[3];
  Eight KT[3][6];       ///< columns
  Eight tangent[3][3];  ///< columns
};

/// Exponentials of one section: where they begin, and its strain.
struct Beginning {
  double R[3][3], p[3];                ///< columns
  double rotation[3], translation[3];  ///< [1/m], [-]
};

/// Frames at their ends.
struct alignas(kLine) Reached {
  Eight R[3][3], p[3];  ///< columns
};

struct RodKernels {
  const char* name;
  /// Adds to `crossed`.
  void (*cross)(const SectionLanes& sections, const CrossingLanes& crossing, CrossedLanes& crossed);
  /// Fills in the stations' loads and adds to `crossed`, and to `acting` [N] inertia and weight, each by itself.
  /// Without `bends` they have no part in the tangent but for their weights.
  void (*meet)(const SectionLanes& sections, const double (&gravity)[3], bool bends, StationLanes& station,
               CrossedLanes& crossed, Eight& acting);
  /// For the first `count` lengths.
  void (*reach)(const Beginning& from, const Eight& length, int count, Reached& reached);
};

const RodKernels& rod_kernels();
/// By name (linalg/processor); null where it does not run here.
const RodKernels* rod_kernels(const char* name);

}  // namespace sinew::rod
