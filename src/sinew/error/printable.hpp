// Text of files and visitors as a terminal may have it.
#pragma once

#include <string>
#include <string_view>

namespace sinew {

/// With `?` for all that could act on a terminal instead of being shown by it: control characters, those that turn the
/// direction of writing, and bytes that are not UTF-8. Ends of lines stay where `lines` says so.
std::string printable(std::string_view text, bool lines = false);

}  // namespace sinew
