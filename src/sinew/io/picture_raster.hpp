// Triangles with hidden parts removed: a depth buffer with several samples a pixel, painted onto a Cairo page.
#pragma once

#include <cairo/cairo.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "sinew/io/color_map.hpp"
#include "sinew/io/picture_view.hpp"

namespace sinew::io {

/// A corner on the page: x, y, depth [px]; `value` picks the colour (0 ... 1, NaN: missing); `light` multiplies it.
struct Corner {
  Eigen::Vector3d place;
  double value = 0.0;
  double light = 1.0;
};

class Raster {
 public:
  /// Covers the part of the page that lies in `area` (rounded outwards).
  Raster(const Area& area, const Palette& palette);

  /// Adds a triangle; `edge` in [0, 1] is how much its rim is darkened, opposite to each of its corners. Nothing
  /// happens for corners that are not finite.
  void add(const std::array<Corner, 3>& corners, const std::array<double, 3>& edge);

  /// How it is painted.
  struct Paint {
    double fill = 1.0;   ///< opacity of faces
    double line = 1.0;   ///< opacity of outlines
    double width = 1.2;  ///< [px] of outlines: rims against nothing or against what lies far behind; 0: none
    Rgb line_color = rgb(0x202020);
    const Raster* before = nullptr;  ///< of the same area: where it is nearer, opacities are multiplied by `hidden`
    double hidden = 1.0;
  };
  void paint(cairo_t* page, const Paint& paint) const;

 private:
  static constexpr int kSamples = 3;  ///< each way, in a pixel

  struct Sample {  // all zero: nothing is there
    float depth;   ///< of what is covered; see depth_of
    std::uint8_t red, green, blue, covered;
  };
  static float depth_of(const Sample& sample) { return sample.covered ? sample.depth : -INFINITY; }
  const Sample& at(int x, int y) const { return samples_[static_cast<std::size_t>(y) * columns_ + x]; }
  bool outlined(int x, int y, int reach) const;

  int left_, top_, width_, height_;  ///< [px]
  int columns_, rows_;               ///< samples
  Palette palette_;
  struct Free {
    void operator()(Sample* samples) const { std::free(samples); }
  };
  std::unique_ptr<Sample[], Free> samples_;  ///< fresh memory is zero, and costs nothing where nothing is drawn
  int least_x_, least_y_, most_x_ = -1, most_y_ = -1;  ///< [samples] what triangles have come to
};

}  // namespace sinew::io
