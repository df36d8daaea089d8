#include "sinew/io/picture_raster.hpp"

#include <algorithm>
#include <cmath>
#include <new>

namespace sinew::io {
namespace {

constexpr float kJump = 9.0f;  ///< [px] a step in depth that is outlined
constexpr double kRim = 0.55;  ///< [px] half the width of an edge between triangles

std::uint8_t byte(double part) {
  return static_cast<std::uint8_t>(255.0 * (part > 0.0 ? part < 1.0 ? part : 1.0 : 0.0) + 0.5);
}

}  // namespace

Raster::Raster(const Area& area, const Palette& palette)
    : left_(static_cast<int>(std::floor(area.left))),
      top_(static_cast<int>(std::floor(area.top))),
      width_(std::max(1, static_cast<int>(std::ceil(area.right)) - left_)),
      height_(std::max(1, static_cast<int>(std::ceil(area.bottom)) - top_)),
      columns_(width_ * kSamples),
      rows_(height_ * kSamples),
      palette_(palette),
      samples_(static_cast<Sample*>(std::calloc(static_cast<std::size_t>(columns_) * rows_, sizeof(Sample)))),
      least_x_(columns_),
      least_y_(rows_) {
  if (!samples_) throw std::bad_alloc();
}

void Raster::add(const std::array<Corner, 3>& corners, const std::array<double, 3>& edge) {
  double px[3], py[3];  // in samples, their centres at whole numbers
  for (int i = 0; i < 3; ++i) {
    if (!corners[i].place.allFinite() || corners[i].place.cwiseAbs().maxCoeff() > 1e6) return;
    px[i] = (corners[i].place.x() - left_) * kSamples - 0.5;
    py[i] = (corners[i].place.y() - top_) * kSamples - 0.5;
  }
  const double area = (px[1] - px[0]) * (py[2] - py[0]) - (px[2] - px[0]) * (py[1] - py[0]);
  if (!(std::abs(area) > 1e-9)) return;
  // The share of corner i at (x, y) is at_x[i] x + at_y[i] y + at_0[i]; at the rim it is below rim[i].
  double at_x[3], at_y[3], at_0[3], rim[3];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    at_x[i] = (py[j] - py[k]) / area;
    at_y[i] = (px[k] - px[j]) / area;
    at_0[i] = (px[j] * py[k] - px[k] * py[j]) / area;
    rim[i] = kRim * kSamples * std::hypot(at_x[i], at_y[i]);
  }
  const int from_x = std::max(0, static_cast<int>(std::min({px[0], px[1], px[2]})));
  const int from_y = std::max(0, static_cast<int>(std::min({py[0], py[1], py[2]})));
  const int to_x = static_cast<int>(std::min(columns_ - 1.0, std::max({px[0], px[1], px[2]})));
  const int to_y = static_cast<int>(std::min(rows_ - 1.0, std::max({py[0], py[1], py[2]})));
  if (from_x > to_x || from_y > to_y) return;
  least_x_ = std::min(least_x_, from_x);
  least_y_ = std::min(least_y_, from_y);
  most_x_ = std::max(most_x_, to_x);
  most_y_ = std::max(most_y_, to_y);
  for (int y = from_y; y <= to_y; ++y) {
    Sample* row = samples_.get() + static_cast<std::size_t>(y) * columns_;
    // Where no share is negative, and one column more on both sides: what rounding leaves is judged sample by sample.
    double first = from_x, last = to_x;
    for (int i = 0; i < 3; ++i) {
      const double crossing = -(at_y[i] * y + at_0[i]) / at_x[i];
      if (at_x[i] > 0.0) first = std::max(first, crossing - 1.0);
      if (at_x[i] < 0.0) last = std::min(last, crossing + 1.0);
    }
    for (int x = static_cast<int>(std::min(first, 1e9)); x <= last; ++x) {
      const double w0 = at_x[0] * x + at_y[0] * y + at_0[0], w1 = at_x[1] * x + at_y[1] * y + at_0[1];
      const double w2 = at_x[2] * x + at_y[2] * y + at_0[2];
      if (w0 < 0.0 || w1 < 0.0 || w2 < 0.0) continue;
      const auto mean = [&](double a, double b, double c) { return w0 * a + w1 * b + w2 * c; };
      const auto depth = static_cast<float>(mean(corners[0].place.z(), corners[1].place.z(), corners[2].place.z()));
      if (depth <= depth_of(row[x])) continue;
      const double value = mean(corners[0].value, corners[1].value, corners[2].value);
      double brightness = mean(corners[0].light, corners[1].light, corners[2].light);
      brightness *=
          1.0 - std::max({w0 < rim[0] ? edge[0] : 0.0, w1 < rim[1] ? edge[1] : 0.0, w2 < rim[2] ? edge[2] : 0.0});
      const Rgb& color = std::isnan(value) ? kMissing : palette_[byte(value)];
      row[x] = {depth, byte(brightness * color.red), byte(brightness * color.green), byte(brightness * color.blue), 1};
    }
  }
}

bool Raster::outlined(int x, int y, int reach) const {
  if (x < reach || y < reach || x + reach >= columns_ || y + reach >= rows_) return true;
  const int slant = (reach * 7 + 5) / 10;
  const Sample* here = &at(x, y);
  // A step, not a slope: beyond what the other side's slope leads to. (Nothing at all is at minus infinity.)
  const auto steps_down = [&](std::ptrdiff_t way) {
    const float rise = std::max(0.0f, depth_of(here[-way]) - here->depth);
    return depth_of(here[way]) < here->depth - kJump - rise;
  };
  const std::ptrdiff_t down = static_cast<std::ptrdiff_t>(reach) * columns_;
  const std::ptrdiff_t down_slant = static_cast<std::ptrdiff_t>(slant) * columns_;
  for (const std::ptrdiff_t way : {std::ptrdiff_t{reach}, down, down_slant + slant, down_slant - slant}) {
    if (steps_down(way) || steps_down(-way)) return true;
  }
  return false;
}

void Raster::paint(cairo_t* page, const Paint& paint) const {
  cairo_surface_t* image = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width_, height_);
  unsigned char* bytes = cairo_image_surface_get_data(image);
  if (bytes == nullptr) {  // (no memory; the page shows the rest)
    cairo_surface_destroy(image);
    return;
  }
  const int stride = cairo_image_surface_get_stride(image);
  const int reach = static_cast<int>(std::lround(paint.width * kSamples));
  for (int y = least_y_ / kSamples; y <= most_y_ / kSamples && most_y_ >= 0; ++y) {
    for (int x = least_x_ / kSamples; x <= most_x_ / kSamples; ++x) {
      double red = 0.0, green = 0.0, blue = 0.0, alpha = 0.0;  // premultiplied
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const int i = x * kSamples + k % kSamples, j = y * kSamples + k / kSamples;
        const Sample& sample = at(i, j);
        if (!sample.covered) continue;
        const bool line = reach > 0 && outlined(i, j, reach);
        double opacity = line ? paint.line : paint.fill;
        if (paint.before != nullptr && depth_of(paint.before->at(i, j)) > sample.depth) opacity *= paint.hidden;
        alpha += opacity;
        red += opacity * (line ? paint.line_color.red : sample.red / 255.0);
        green += opacity * (line ? paint.line_color.green : sample.green / 255.0);
        blue += opacity * (line ? paint.line_color.blue : sample.blue / 255.0);
      }
      constexpr double share = 1.0 / (kSamples * kSamples);
      const std::uint32_t pixel = static_cast<std::uint32_t>(byte(share * alpha)) << 24 | byte(share * red) << 16 |
                                  byte(share * green) << 8 | byte(share * blue);
      reinterpret_cast<std::uint32_t*>(bytes + static_cast<std::ptrdiff_t>(y) * stride)[x] = pixel;
    }
  }
  cairo_surface_mark_dirty(image);
  cairo_set_source_surface(page, image, left_, top_);
  cairo_paint(page);
  cairo_surface_destroy(image);
}

}  // namespace sinew::io
