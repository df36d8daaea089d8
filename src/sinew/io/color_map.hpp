// Colours for values: viridis, even in brightness and told apart by colour-blind people, also in print.
#pragma once

#include <array>
#include <cstdint>

namespace sinew::io {

struct Rgb {
  double red = 0.0, green = 0.0, blue = 0.0;  ///< each 0 ... 1, sRGB
};

/// "#rrggbb" as a number, 0xrrggbb.
constexpr Rgb rgb(std::uint32_t code) {
  return {(code >> 16 & 255) / 255.0, (code >> 8 & 255) / 255.0, (code & 255) / 255.0};
}

/// Of what has no value.
inline constexpr Rgb kMissing = rgb(0xb0b0b0);

/// Viridis at `value` in [0, 1], held outside; grey for NaN.
Rgb viridis(double value);

/// 256 even samples of a map, or one colour throughout.
using Palette = std::array<Rgb, 256>;
Palette viridis_palette();
Palette plain_palette(const Rgb& color);

}  // namespace sinew::io
