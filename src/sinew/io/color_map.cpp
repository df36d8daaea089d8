#include "sinew/io/color_map.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::io {
namespace {

/// Viridis (S. van der Walt, N. Smith; released to the public domain) at 17 even places.
constexpr std::array<std::uint32_t, 17> kViridis = {0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d,
                                                    0x2c728e, 0x26828e, 0x21918c, 0x1fa088, 0x28ae80, 0x3fbc73,
                                                    0x5ec962, 0x84d44b, 0xaddc30, 0xd8e219, 0xfde725};

}  // namespace

Rgb viridis(double value) {
  if (std::isnan(value)) return kMissing;
  const double place = std::clamp(value, 0.0, 1.0) * (kViridis.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), kViridis.size() - 2);
  const double t = place - static_cast<double>(below);
  const Rgb a = rgb(kViridis[below]), b = rgb(kViridis[below + 1]);
  return {a.red + t * (b.red - a.red), a.green + t * (b.green - a.green), a.blue + t * (b.blue - a.blue)};
}

Palette viridis_palette() {
  Palette palette;
  for (std::size_t i = 0; i < palette.size(); ++i) palette[i] = viridis(static_cast<double>(i) / (palette.size() - 1));
  return palette;
}

Palette plain_palette(const Rgb& color) {
  Palette palette;
  palette.fill(color);
  return palette;
}

}  // namespace sinew::io
