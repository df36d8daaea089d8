// "Did you mean ...?"
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sinew::io {

/// Edits (insert, delete, replace, swap of neighbours) from one word to the other.
int edit_distance(std::string_view a, std::string_view b);

/// The word of `known` that `word` was most likely meant to be, in the first place one of other case; empty if
/// none is close.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace sinew::io
