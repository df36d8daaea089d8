#include "sinew/io/picture_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "sinew/io/atomic_file.hpp"

#if defined(__SANITIZE_ADDRESS__)
// Fontconfig keeps its patterns behind encoded pointers, which the leak checker does not follow.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig\n"; }
#endif

namespace sinew::io {
namespace {

using Vec2 = Eigen::Vector2d;

/// Bytes of the UTF-8 character at `at`; 0 if there is none that is valid.
std::size_t character(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  const std::size_t size = first < 0x80                    ? 1
                           : first >= 0xc2 && first < 0xe0 ? 2
                           : first >= 0xe0 && first < 0xf0 ? 3
                           : first >= 0xf0 && first < 0xf5 ? 4
                                                           : 0;
  if (size == 0 || at + size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(at + i) & 0xc0) != 0x80) return 0;
  if (size > 2) {  // too long for its code, a surrogate, or beyond the last
    const unsigned char second = byte(at + 1);
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) || (first == 0xf0 && second < 0x90) ||
        (first == 0xf4 && second >= 0x90))
      return 0;
  }
  return size;
}

}  // namespace

std::string printable(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = character(text, at);
    if (size == 0)
      out += "?";
    else if (size == 1 && (static_cast<unsigned char>(text[at]) < 0x20 || text[at] == 0x7f))
      out += " ";
    else
      out += text.substr(at, size);
    at += std::max<std::size_t>(1, size);
  }
  return out;
}

Page::Page(int width, int height)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
      cairo_(cairo_create(surface_)),
      width_(width),
      height_(height) {
  color(kWhite);
  cairo_paint(cairo_);
  cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
}

Page::~Page() {
  cairo_destroy(cairo_);
  cairo_surface_destroy(surface_);
}

void Page::font(const TextStyle& style) const {
  cairo_select_font_face(cairo_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_, style.size);
}

double Page::text_width(const std::string& text, const TextStyle& style) const {
  font(style);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_, text.c_str(), &extents);
  return extents.x_advance;
}

void Page::text(double x, double baseline, const std::string& text, const TextStyle& style) const {
  const double width = text_width(text, style);
  color(style.color);
  cairo_move_to(cairo_, x - style.align * width, baseline);
  cairo_show_text(cairo_, text.c_str());
  cairo_new_path(cairo_);
}

std::string Page::fitted(const std::string& text, const TextStyle& style, double width) const {
  if (text.size() <= 1000 && text_width(text, style) <= width) return text;
  std::string kept;
  for (std::size_t at = 0; at < std::min<std::size_t>(text.size(), 1000);) {
    const std::size_t size = std::max<std::size_t>(1, character(text, at));
    if (text_width(kept + text.substr(at, size) + "…", style) > width) break;
    kept += text.substr(at, size);
    at += size;
  }
  return kept + "…";
}

void Page::color(const Rgb& color, double alpha) const {
  cairo_set_source_rgba(cairo_, color.red, color.green, color.blue, alpha);
}

void Page::line(const Vec2& from, const Vec2& to, double width, const Rgb& line_color) const {
  color(line_color);
  cairo_set_line_width(cairo_, width);
  cairo_move_to(cairo_, from.x(), from.y());
  cairo_line_to(cairo_, to.x(), to.y());
  cairo_stroke(cairo_);
}

void Page::disc(const Vec2& centre, double radius, const Rgb& fill, double rim, const Rgb& rim_color) const {
  cairo_new_path(cairo_);
  cairo_arc(cairo_, centre.x(), centre.y(), radius, 0.0, 2 * std::numbers::pi);
  color(fill);
  cairo_fill_preserve(cairo_);
  if (rim > 0.0) {
    color(rim_color);
    cairo_set_line_width(cairo_, rim);
    cairo_stroke_preserve(cairo_);
  }
  cairo_new_path(cairo_);
}

double Page::inked(const Area& area) const {
  cairo_surface_flush(surface_);
  const unsigned char* bytes = cairo_image_surface_get_data(surface_);
  if (bytes == nullptr) return 0.0;
  const int stride = cairo_image_surface_get_stride(surface_);
  int seen = 0, dark = 0;
  for (int y = std::max(0, static_cast<int>(area.top)); y < std::min<double>(height_, area.bottom); y += 2) {
    const auto* row = reinterpret_cast<const std::uint32_t*>(bytes + static_cast<std::ptrdiff_t>(y) * stride);
    for (int x = std::max(0, static_cast<int>(area.left)); x < std::min<double>(width_, area.right); x += 2) {
      ++seen;
      dark += (row[x] & 0xffffffu) != 0xffffffu;
    }
  }
  return seen == 0 ? 0.0 : static_cast<double>(dark) / seen;
}

void Page::save(const std::filesystem::path& png) const {
  const cairo_status_t drawn = cairo_status(cairo_);
  const cairo_status_t status =
      drawn != CAIRO_STATUS_SUCCESS ? drawn : cairo_surface_write_to_png(surface_, partial_path(png).c_str());
  if (status != CAIRO_STATUS_SUCCESS)
    throw WriteError(fmt::format("cannot write {}: {}", png.string(), cairo_status_to_string(status)));
  rename_to(partial_path(png), png);
}

void draw_triad(const Page& page, const PictureView& view, const Vec2& centre) {
  constexpr double kLength = 46.0;
  constexpr std::array<Rgb, 3> kColors = {rgb(0xc8371b), rgb(0x1b8a5a), rgb(0x2462b8)};
  std::array<int, 3> order = {0, 1, 2};  // what points away is drawn first
  std::sort(order.begin(), order.end(), [&](int a, int b) { return view.axes(2, a) < view.axes(2, b); });
  for (const int axis : order) {
    const Vec2 direction(view.axes(0, axis), -view.axes(1, axis));
    const Vec2 tip = centre + kLength * direction;
    page.line(centre, tip, 3.0, kColors[axis]);
    const double length = direction.norm();
    if (length > 0.15) {  // an arrow's head
      const Vec2 along = direction / length, across(-along.y(), along.x());
      const double head = std::min(11.0, 0.7 * length * kLength);
      cairo_t* cairo = page.cairo();
      const Vec2 a = tip - head * along + 0.45 * head * across, b = tip - head * along - 0.45 * head * across;
      const Vec2 point = tip + 4.0 * along;
      cairo_move_to(cairo, point.x(), point.y());
      cairo_line_to(cairo, a.x(), a.y());
      cairo_line_to(cairo, b.x(), b.y());
      cairo_close_path(cairo);
      cairo_fill(cairo);
    } else {
      page.disc(tip, 4.0, kColors[axis]);
    }
    // The letter stands off the tip; of an axis that is seen end on, where the other two leave room.
    Vec2 away = direction;
    if (length < 0.35) {
      away = Vec2::Zero();
      for (const int other : order)
        if (other != axis) away -= Vec2(view.axes(0, other), -view.axes(1, other));
      if (away.norm() < 1e-6) away = Vec2(-1, 0);
    }
    const Vec2 letter = tip + 17.0 * away.normalized();
    page.text(letter.x(), letter.y() + 6.0, std::string(1, "xyz"[axis]),
              {.size = 18, .color = kColors[axis], .bold = true, .align = 0.5});
  }
  page.disc(centre, 3.5, kInk);
}

double draw_scale_bar(const Page& page, const PictureView& view, double left, double y) {
  const double length = round_below(220.0 / view.scale);
  const double width = length * view.scale;
  if (!(width > 1.0) || !std::isfinite(width)) return left;
  page.line({left, y}, {left + width, y}, 3.0, kInk);
  for (const double x : {left, left + width}) page.line({x, y - 7}, {x, y + 7}, 3.0, kInk);
  const ShownUnit unit = length_unit(length);
  page.text(left + width / 2, y - 16, fmt::format("{:g} {}", length / unit.factor, unit.symbol),
            {.size = 19, .align = 0.5});
  return left + width;
}

void draw_legend(const Page& page, const Area& area, const std::string& what, double largest, const ShownUnit& unit,
                 bool open) {
  const double right = area.right + 62;
  page.text(right, area.top - 54, what, {.size = 19, .bold = true, .align = 1.0});
  if (!(largest > 0.0)) {
    page.text(right, area.top - 28, "none", {.size = 19, .align = 1.0});
    return;
  }
  page.text(right, area.top - 28, "[" + unit.symbol + "]", {.size = 19, .align = 1.0});
  cairo_t* cairo = page.cairo();
  const int rows = static_cast<int>(area.bottom - area.top);
  for (int i = 0; i < rows; ++i) {
    page.color(viridis(1.0 - (i + 0.5) / rows));
    cairo_rectangle(cairo, area.left, area.top + i, area.right - area.left, 1.0);
    cairo_fill(cairo);
  }
  page.color(kInk);
  cairo_set_line_width(cairo, 1.2);
  cairo_rectangle(cairo, area.left, area.top, area.right - area.left, area.bottom - area.top);
  cairo_stroke(cairo);

  const auto tick = [&](double value, const std::string& text, bool bold) {
    const double y = area.bottom - (area.bottom - area.top) * value / largest;
    page.line({area.right, y}, {area.right + 6, y}, 1.5, kInk);
    page.text(area.right + 12, y + 6, text, {.size = 18, .bold = bold});
  };
  tick(largest, (open ? "≥ " : "") + readable(largest / unit.factor), true);
  for (const double shown : round_ticks(largest / unit.factor, 6)) {
    const double height = (area.bottom - area.top) * shown * unit.factor / largest;
    if (area.bottom - area.top - height > 26) tick(shown * unit.factor, fmt::format("{:.6g}", shown), false);
  }
}

bool find_room(const Page& page, const Vec2& point, const Vec2& size, const Area& area, const std::vector<Area>& taken,
               Area* room) {
  double best = INFINITY;
  for (const double distance : {14.0, 30.0, 55.0, 90.0, 130.0, 180.0, 250.0, 330.0}) {
    for (int k = 0; k < 16; ++k) {
      const double angle = (k + 0.5) * std::numbers::pi / 8;
      const Vec2 off(std::cos(angle), -std::sin(angle));
      const Vec2 centre = point + distance * off + 0.5 * off.cwiseProduct(size);
      const Area box{centre.x() - size.x() / 2, centre.y() - size.y() / 2, centre.x() + size.x() / 2,
                     centre.y() + size.y() / 2};
      if (!area.holds(box)) continue;
      if (std::any_of(taken.begin(), taken.end(), [&](const Area& other) { return other.meets(box); })) continue;
      const double cost = distance + 4000.0 * page.inked(box);
      if (cost >= best) continue;
      best = cost;
      *room = box;
    }
  }
  return std::isfinite(best);
}

}  // namespace sinew::io
