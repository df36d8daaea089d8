// The page of a picture: text and signs, free of any robot.
#pragma once

#include <cairo/cairo.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "sinew/io/color_map.hpp"
#include "sinew/io/picture_view.hpp"
#include "sinew/io/readable.hpp"

namespace sinew::io {

inline constexpr Rgb kInk = rgb(0x222222), kGrey = rgb(0x6b6b6b), kWarning = rgb(0xc04000), kRod = rgb(0xf07c12),
                     kWhite = rgb(0xffffff), kUnmoved = rgb(0x9db4c9);

struct TextStyle {
  double size = 18.0;  ///< [px]
  Rgb color = kInk;
  bool bold = false;
  double align = 0.0;  ///< 0: `x` is its left, 0.5: its middle, 1: its right
};

/// A white page with a Cairo context on it; text is DejaVu Sans. Move it nowhere.
class Page {
 public:
  Page(int width, int height);
  ~Page();
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  cairo_t* cairo() const { return cairo_; }

  double text_width(const std::string& text, const TextStyle& style) const;
  void text(double x, double baseline, const std::string& text, const TextStyle& style) const;
  /// The text cut with "..." so that it fits in `width` [px].
  std::string fitted(const std::string& text, const TextStyle& style, double width) const;

  void color(const Rgb& color, double alpha = 1.0) const;
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width, const Rgb& color) const;
  /// Filled disc with a rim of another colour; no rim if `rim` is 0.
  void disc(const Eigen::Vector2d& centre, double radius, const Rgb& fill, double rim = 0.0,
            const Rgb& rim_color = kInk) const;

  /// Share of the pixels in the area that are not white (each second one looked at).
  double inked(const Area& area) const;

  /// Writes the file; WriteError with its name if that fails.
  void save(const std::filesystem::path& png) const;

 private:
  void font(const TextStyle& style) const;
  cairo_surface_t* surface_;
  cairo_t* cairo_;
  int width_, height_;
};

/// The text with everything that is not valid UTF-8 or does not show replaced.
std::string printable(const std::string& text);

/// Arrows x, y, z of the world as the view sees them, around `centre`.
void draw_triad(const Page& page, const PictureView& view, const Eigen::Vector2d& centre);

/// A bar of a round length with its label on top, from `left` on; returns its right end.
double draw_scale_bar(const Page& page, const PictureView& view, double left, double y);

/// The colours of values 0 ... `largest` [SI] in `unit`, in the area; `open` if there are larger ones; a word
/// instead if `largest` is 0.
void draw_legend(const Page& page, const Area& area, const std::string& what, double largest, const ShownUnit& unit,
                 bool open);

/// Finds room for a box of `size` near `point`, inside `area`, off `taken`, where there is little ink.
/// False if there is none.
bool find_room(const Page& page, const Eigen::Vector2d& point, const Eigen::Vector2d& size, const Area& area,
               const std::vector<Area>& taken, Area* room);

}  // namespace sinew::io
