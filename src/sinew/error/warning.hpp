// Warnings as data: what a user should know of a scene or a run that is accepted all the same.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace sinew {

/// One kind of trouble with one object. A kind has a `code` that stays the same from version to version
/// (docs/warnings.md lists them); the same kind on the same object is one warning however often it is seen.
struct Warning {
  std::string code = {};     ///< its kind: "tendon_pushes"
  std::string where = {};    ///< path of the object in the scene, "actuators.pull"; empty: the whole scene
  std::string message = {};  ///< what is wrong, at its worst: "the tendon pushes with 0.3 N"
  std::string remedy = {};   ///< what to change; may be empty
  double time = NAN;         ///< [s] at which it was first seen; NaN: of the scene itself
  double value = NAN;        ///< at its worst, in `unit`; NaN where nothing is measured
  double limit = NAN;        ///< beyond which it is warned of, in `unit`
  std::string unit = {};
  long steps = 0;       ///< accepted steps in which it was seen
  bool latest = false;  ///< of what adds up over a run: the latest value is told, not the worst

  bool operator==(const Warning& other) const;  ///< NaN equals NaN
};

/// "actuators.pull: the tendon pushes with 0.3 N (from t = 0.2 s); a real one goes slack".
std::string to_string(const Warning& warning);
std::vector<std::string> to_strings(const std::vector<Warning>& warnings);

/// Adds a warning to a list. If the list has its kind on its object already, that keeps its first time, counts both
/// numbers of steps and takes message, value and limit of the one that is further beyond its limit (larger value in
/// size).
void merge(const Warning& warning, std::vector<Warning>& list);
void merge(const std::vector<Warning>& warnings, std::vector<Warning>& list);

/// The warning of a kind, on an object if that is named; null if the list has none.
const Warning* find_warning(const std::vector<Warning>& list, const std::string& code, const std::string& where = "");

}  // namespace sinew
