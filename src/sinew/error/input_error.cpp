#include "sinew/error/input_error.hpp"

#include <utility>

#include "sinew/error/printable.hpp"

namespace sinew {

std::string to_string(const InputFault& fault) {
  std::string text;
  const auto append = [&text](const std::string& part, const char* separator) {
    if (part.empty()) return;
    if (!text.empty()) text += separator;
    text += part;
  };
  append(fault.file, "");
  if (fault.line > 0) {
    text += ':';
    text += std::to_string(fault.line);
  }
  append(fault.path, ": ");
  append(fault.value, fault.path.empty() ? ": " : " = ");
  append(fault.rule, ": ");
  if (!fault.remedy.empty()) text += "\n    " + fault.remedy;
  return printable(text, true);
}

InputError::InputError(InputFault fault) : std::runtime_error(to_string(fault)), fault_(std::move(fault)) {}

}  // namespace sinew
