// What the program says: every text for people goes through here.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <utility>

namespace sinew::app {

/// Writes a text with nothing in it that acts on a terminal (error/printable). What cannot be written is lost;
/// `standard_output_failed` knows of it.
void write(std::FILE* stream, std::string_view text);

/// On standard output.
template <class... T>
void say(fmt::format_string<T...> format, T&&... parts) {
  write(stdout, fmt::format(format, std::forward<T>(parts)...));
}

/// On standard error.
template <class... T>
void complain(fmt::format_string<T...> format, T&&... parts) {
  write(stderr, fmt::format(format, std::forward<T>(parts)...));
}

/// Why not all of what was said reached standard output (a full disc); empty: all did, or nobody reads it any more.
std::string standard_output_failed();

}  // namespace sinew::app
