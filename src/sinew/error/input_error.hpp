// What a user reads when the input is wrong: where it stands, what it says, the rule it breaks, and what to do.
#pragma once

#include <stdexcept>
#include <string>

namespace sinew {

/// Bad input, found while reading a file or building a model. Every field is for the reader of the message;
/// any may be empty. `file` and `line` are filled in by whoever knows the text (the scene reader, a mesh reader, or
/// the program, which looks `path` up in the scene's source map).
struct InputFault {
  std::string file = {};    ///< file that holds the fault
  int line = 0;             ///< 1-based line in it; 0 when it has no lines (a binary mesh) or none is known
  std::string path = {};    ///< field, as in "solids.finger.material.young"
  std::string value = {};   ///< the offending value as it was given, "-5 kPa"
  std::string rule = {};    ///< what must hold, "must be greater than 0 Pa"
  std::string remedy = {};  ///< what to do, "give the modulus of the material, for example `young: 600 kPa`"
};

/// One line per fault: `file:line: path = value: rule` and a second, indented one with the remedy.
std::string to_string(const InputFault& fault);

/// Thrown by readers and by `build`, never by a step.
class InputError : public std::runtime_error {
 public:
  explicit InputError(InputFault fault);
  const InputFault& fault() const { return fault_; }

 private:
  InputFault fault_;
};

}  // namespace sinew
