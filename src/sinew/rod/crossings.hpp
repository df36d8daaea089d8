// What the loads beyond up to eight exponentials of one section do to its coordinates, all at once: the formulas of
// rod/forces for a section of constant strain, written out for registers. README.md derives them.
#pragma once

namespace sinew::rod {

inline constexpr int kCrossings = 8;

/// A number of each crossing.
using Eight = double[kCrossings];
inline constexpr int kLine = 64;  ///< [bytes] of the cache

/// Where exponentials of one section of constant strain begin, and the strain.
struct Beginning {
  double R[3][3], p[3];                ///< columns
  double rotation[3], translation[3];  ///< [1/m], [-]
};

/// Exponentials to points of the section and the sums of the loads beyond each: dead loads only, of forces and weights,
/// which have a potential.
struct alignas(kLine) Crossings {
  Eight length;                               ///< [m]; the others' are zero
  Eight moment[3], force[3];                  ///< the wrench, about the origin
  Eight bending_moment[3], bending_force[3];  ///< the part of it that takes part in the tangent
  Eight turning[3][3];                        ///< K of rod/forces: its upper left, by columns
  Eight lever[3], weight;                     ///< and the sums in its other parts
  Beginning from;                             ///< its p from the origin
  int count = 0;
};

/// Sums over the crossings, by the three rates of rotation.
struct Crossed {
  double gradient[3];
  double KT[3][6];       ///< columns
  double tangent[3][3];  ///< columns
};

/// The largest angle [rad] of an exponential.
inline constexpr double kLargestTurn = 3.0;

/// Frames at the ends of exponentials.
struct alignas(kLine) Reached {
  Eight R[3][3], p[3];  ///< columns
};

struct RodKernels {
  const char* name;
  void (*cross)(const Crossings& crossings, Crossed& crossed);
  /// For the first `count` lengths.
  void (*reach)(const Beginning& from, const Eight& length, int count, Reached& reached);
};

const RodKernels& rod_kernels();
/// By name (linalg/processor); null where it does not run here.
const RodKernels* rod_kernels(const char* name);

}  // namespace sinew::rod
