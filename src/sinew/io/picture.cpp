#include "sinew/io/picture.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sinew/io/picture_page.hpp"
#include "sinew/io/picture_raster.hpp"
#include "sinew/io/picture_shapes.hpp"
#include "sinew/io/readable.hpp"
#include "sinew/sim/status.hpp"

namespace sinew::io {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

constexpr Area kScene{80, 155, 1340, 825};   ///< robots are fitted into this
constexpr Area kLabels{40, 118, 1380, 862};  ///< names stay in this
constexpr Rgb kForce = rgb(0x1446a0), kOutput = rgb(0xd0104c), kTarget = kInk;
constexpr Area kLegend{1436, 230, 1464, 760};  ///< the bar

template <class Object>
const Object* named(const std::vector<Object>& objects, const std::string& name) {
  for (const Object& object : objects)
    if (object.name == name) return &object;
  return nullptr;
}

/// A line through points as they are seen; nearer than a pixel to the last one they are left out: runs have many steps.
void draw_line(const Page& page, const Eigen::Matrix3Xd& points, const PictureView& view, double width,
               const Rgb& color, double alpha = 1.0) {
  cairo_new_path(page.cairo());
  page.color(color, alpha);
  cairo_set_line_width(page.cairo(), width);
  bool started = false;
  Vec2 last;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!drawable(points.col(i))) continue;
    const Vec2 place = view.project(points.col(i)).head<2>();
    if (started && (place - last).norm() < 1.0) continue;
    started ? cairo_line_to(page.cairo(), place.x(), place.y()) : cairo_move_to(page.cairo(), place.x(), place.y());
    started = true;
    last = place;
  }
  cairo_stroke(page.cairo());
}

void draw_rest_rod(const Page& page, const RodSnapshot& rod, const PictureView& view) {
  const double dashes[] = {7, 7};
  cairo_set_dash(page.cairo(), dashes, 2, 0);
  draw_line(page, rod.points, view, 1.6, kGrey, 0.6);
  cairo_set_dash(page.cairo(), nullptr, 0, 0);
}

// ---- marks -------------------------------------------------------------------------------------------------------

void draw_sliding_points(const Page& page, const std::vector<MarkSnapshot>& marks, const PictureView& view) {
  std::vector<Vec2> places;
  for (const MarkSnapshot& mark : marks)
    if (drawable(mark.position)) places.push_back(view.project(mark.position).head<2>());
  double gap = INFINITY;  // the usual one between neighbours
  if (places.size() > 1) {
    std::vector<double> gaps;
    for (std::size_t i = 1; i < places.size(); ++i) gaps.push_back((places[i] - places[i - 1]).norm());
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2), gaps.end());
    gap = gaps[gaps.size() / 2];
  }
  const double radius = std::clamp(0.3 * gap, 2.0, 4.5);
  for (const Vec2& place : places) page.disc(place, radius, kWhite, std::min(1.6, 0.5 * radius), kInk);
}

double largest_force(const std::vector<ForceSnapshot>& contacts) {
  double largest = 0.0;
  for (const ForceSnapshot& own : contacts)
    if (drawable(own.position)) largest = std::max(largest, own.force.norm());
  return largest;
}

/// Forces as arrows on what they push, the largest as long as a tenth of the page.
void draw_contacts(const Page& page, const std::vector<ForceSnapshot>& contacts, const PictureView& view) {
  constexpr double kLongest = 90.0;  // [px]
  const double largest = largest_force(contacts);
  if (!(largest > 0.0)) return;
  for (const ForceSnapshot& own : contacts) {
    if (!drawable(own.position)) continue;
    const Vec2 from = view.project(own.position).head<2>();
    const Vec3 end = own.position + own.force * (kLongest / (view.scale * largest));
    const Vec2 to = view.project(end).head<2>(), along = to - from;
    if (along.norm() < 2.0) continue;
    const Vec2 way = along.normalized(), across(-way.y(), way.x());
    const double head = std::min(9.0, 0.5 * along.norm());
    page.line(from, to, 2.2, kForce);
    page.line(to, to - head * way + 0.5 * head * across, 2.2, kForce);
    page.line(to, to - head * way - 0.5 * head * across, 2.2, kForce);
  }
}

void draw_output_sign(const Page& page, const Vec2& place) {
  page.disc(place, 8.0, kWhite, 2.4, kInk);
  page.disc(place, 3.6, kOutput);
}

void draw_target_sign(const Page& page, const Vec2& place) {
  constexpr double kRing = 12.0, kTick = 18.0;
  cairo_new_path(page.cairo());
  page.color(kTarget);
  cairo_set_line_width(page.cairo(), 2.4);
  cairo_arc(page.cairo(), place.x(), place.y(), kRing, 0.0, 2.0 * std::numbers::pi);
  cairo_stroke(page.cairo());
  for (const Vec2& way : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)})
    page.line(place + kRing * way, place + kTick * way, 2.4, kTarget);
}

/// The way of an output from its old place: as it was, or dotted from end to end.
void draw_way(const Page& page, const Vec2& from, const Vec2& to, const Course* course, const PictureView& view) {
  const bool far = (to - from).norm() >= 14.0;
  if (course != nullptr && course->way.cols() > 2) {
    draw_line(page, course->way, view, 2.4, kOutput);
  } else if (far) {
    const double dashes[] = {1, 7};
    cairo_set_dash(page.cairo(), dashes, 2, 0);
    page.line(from, to, 3.0, kOutput);
    cairo_set_dash(page.cairo(), nullptr, 0, 0);
  }
  if (far) page.disc(from, 4.5, kWhite, 1.8, kOutput);
}

void draw_outputs(const Page& page, const Snapshot& rest, const Snapshot& end, const PictureOptions& options,
                  const PictureView& view, double roundoff) {
  struct Label {
    Vec2 place;
    std::string text;
  };
  std::vector<Label> labels;
  std::vector<Area> taken;
  std::vector<Vec2> targets;
  cairo_save(page.cairo());  // ways may lead off the page
  cairo_rectangle(page.cairo(), kLabels.left, kLabels.top, kLabels.right - kLabels.left, kLabels.bottom - kLabels.top);
  cairo_clip(page.cairo());
  for (const MarkSnapshot& output : end.outputs) {
    if (!drawable(output.position)) continue;
    const Vec2 place = view.project(output.position).head<2>();
    const MarkSnapshot* before = named(rest.outputs, output.name);
    const Course* course = named(options.courses, output.name);
    const bool aims = course != nullptr && course->wanted.cols() > 0;
    if (aims) draw_line(page, course->wanted, view, 1.8, kTarget);
    std::string text = page.fitted(printable(output.name), {.size = 20, .bold = true}, 300);
    if (before != nullptr && drawable(before->position)) {
      const double way = (output.position - before->position).norm();
      text += "  " + readable_length(way > roundoff ? way : 0.0);
      const Vec2 from = view.project(before->position).head<2>();
      draw_way(page, from, place, course, view);
      taken.push_back({from.x() - 6, from.y() - 6, from.x() + 6, from.y() + 6});
    }
    if (aims && drawable(course->wanted.rightCols<1>())) {
      text += ", " + readable_length(course->off > roundoff ? course->off : 0.0) + " off";
      const Vec2 goal = view.project(course->wanted.rightCols<1>()).head<2>();
      targets.push_back(goal);
      taken.push_back({goal.x() - 18, goal.y() - 18, goal.x() + 18, goal.y() + 18});
    }
    taken.push_back({place.x() - 11, place.y() - 11, place.x() + 11, place.y() + 11});
    labels.push_back({place, text});
  }
  for (const Label& label : labels) draw_output_sign(page, label.place);
  for (const Vec2& target : targets) draw_target_sign(page, target);
  cairo_restore(page.cairo());
  for (const Label& label : labels) {
    const TextStyle style{.size = 20, .bold = true};
    const Vec2 size(page.text_width(label.text, style) + 20, 34);
    Area room;
    if (!find_room(page, label.place, size, kLabels, taken, &room)) continue;  // (crowded: the sign alone)
    taken.push_back(room);
    const Vec2 near(std::clamp(label.place.x(), room.left, room.right),
                    std::clamp(label.place.y(), room.top, room.bottom));
    const Vec2 gap = near - label.place;
    if (gap.norm() > 16.0) page.line(label.place + 9.5 * gap.normalized(), near, 1.4, kInk);
    page.color(kWhite, 0.88);
    cairo_rectangle(page.cairo(), room.left, room.top, size.x(), size.y());
    cairo_fill(page.cairo());
    page.text(room.left + 10, room.bottom - 10, label.text, style);
  }
}

// ---- the frame around --------------------------------------------------------------------------------------------

void draw_header(const Page& page, const Snapshot& end, const PictureOptions& options) {
  const TextStyle head{.size = 34, .bold = true};
  page.text(60, 66, page.fitted(printable(options.title), head, 1480), head);
  const TextStyle plain{.size = 20, .color = kGrey};
  const std::string time = !end.when.empty()         ? end.when
                           : std::isfinite(end.time) ? fmt::format("t = {:.6g} s", end.time)
                                                     : "t unknown";
  page.text(60, 104, time, plain);
  std::string status = printable(end.status);
  std::replace(status.begin(), status.end(), '_', ' ');
  if (status.empty()) return;
  const double x = 60 + page.text_width(time, plain) + 20;
  const bool good = accepted(end.status), quiet = options.warnings == 0;
  page.disc({x + 6, 97}, 6, good && quiet ? rgb(0x1b8a5a) : kWarning);
  const TextStyle style{.size = 20, .color = good ? kGrey : kWarning, .bold = !good};
  if (!quiet) status += fmt::format("; {} warning{}", options.warnings, options.warnings == 1 ? "" : "s");
  if (!options.outcome.empty()) status += "; targets: " + printable(options.outcome);
  page.text(x + 22, 104, page.fitted(status, style, 1480 - x), style);
}

/// What the signs mean, from right to left along the foot, no further than `from`.
void draw_key(const Page& page, const Snapshot& rest, const Snapshot& end, const PictureOptions& options,
              bool rods_orange, double from) {
  const TextStyle style{.size = 18, .color = kInk, .bold = false, .align = 1.0};
  constexpr double kRight = 1540;
  double right = kRight, base = 936;
  const auto entry = [&](const std::string& text, double room, const auto& sign) {
    const double width = page.text_width(text, style) + room;
    if (right - width < from) {  // a row above
      right = kRight;
      base -= 30;
    }
    page.text(right, base, text, style);
    sign(right - width);
    right -= width + 34;
  };
  const auto swatch = [&](double x, const Rgb& color, double fill) {
    cairo_rectangle(page.cairo(), x, base - 16, 30, 19);
    page.color(color, fill);
    cairo_fill_preserve(page.cairo());
    page.color(kGrey, 0.6);
    cairo_set_line_width(page.cairo(), 1.5);
    cairo_stroke(page.cairo());
  };
  const auto aims = [](const Course& own) { return own.wanted.cols() > 0; };
  if (std::any_of(options.courses.begin(), options.courses.end(), aims))
    entry("target and its way", 48, [&](double x) { draw_target_sign(page, {x + 18, base - 6}); });
  if (!end.outputs.empty())
    entry(rest.outputs.empty() ? "output" : "output and its way", 24, [&](double x) {
      draw_output_sign(page, {x + 8, base - 6});
    });
  if (!end.contacts.empty())
    entry("contact force, up to " + readable_force(largest_force(end.contacts)), 38, [&](double x) {
      page.line({x, base - 6}, {x + 30, base - 6}, 2.2, kForce);
    });
  if (!end.sliding_points.empty())
    entry("sliding point", 18, [&](double x) { page.disc({x + 5, base - 6}, 4.5, kWhite, 1.6, kInk); });
  if (std::any_of(end.bodies.begin(), end.bodies.end(), [](const BodySnapshot& body) { return !body.ground; }))
    entry("rigid", 40, [&](double x) { swatch(x, kMissing, 1.0); });
  if (!end.rods.empty() && rods_orange)
    entry("rod", 42, [&](double x) { page.line({x + 3, base - 6}, {x + 31, base - 6}, 5.0, kRod); });
  if (!end.solids.empty()) {
    entry("at rest", 40, [&](double x) { swatch(x, kGrey, 0.16); });
  } else if (!rest.rods.empty()) {
    entry("at rest", 42, [&](double x) {
      const double dashes[] = {7, 7};
      cairo_set_dash(page.cairo(), dashes, 2, 0);
      page.line({x, base - 6}, {x + 32, base - 6}, 1.6, kGrey);
      cairo_set_dash(page.cairo(), nullptr, 0, 0);
    });
  }
}

/// Ways and targets as far as they do not make the rest small: no further from its middle than it is large.
void add_courses(const std::vector<Course>& courses, std::vector<Sight>& sights) {
  if (sights.empty()) return;
  Eigen::AlignedBox3d box;
  for (const Sight& sight : sights) box.extend(sight.point);
  const Vec3 middle = box.center();
  const double reach = box.diagonal().norm();
  for (const Course& own : courses)
    for (const Eigen::Matrix3Xd* points : {&own.way, &own.wanted})
      for (const auto& point : points->colwise())
        if (drawable(point) && (point - middle).norm() <= reach) sights.push_back({point, 0.0});
}

/// Everything that must be seen.
std::vector<Sight> sights_of(const Snapshot& rest, const Snapshot& end, const PictureOptions& options) {
  std::vector<Sight> sights;
  for (const SolidSnapshot& solid : end.solids) {
    for (const Eigen::Matrix3Xd* nodes : {&solid.rest, &solid.nodes}) {
      std::vector<bool> seen(static_cast<std::size_t>(nodes->cols()), false);
      for (const solid::Triangle& face : solid.surface)
        for (const int node : face)
          if (drawable(*nodes, node)) seen[static_cast<std::size_t>(node)] = true;
      for (std::size_t i = 0; i < seen.size(); ++i)
        if (seen[i]) sights.push_back({nodes->col(static_cast<Eigen::Index>(i)), 0.0});
    }
  }
  for (const Snapshot* snapshot : {&rest, &end}) {
    for (const RodSnapshot& rod : snapshot->rods) {
      for (Eigen::Index i = 0; i < rod.points.cols(); ++i) {
        const double radius = i < rod.radius.size() ? rod.radius(i) : 0.0;
        sights.push_back({rod.points.col(i), radius > 0.0 && radius < 1e30 ? radius : 0.0});
      }
    }
    for (const BodySnapshot& body : snapshot->bodies) {
      if (body.ground) continue;
      for (const auto& point : body.points.colwise()) sights.push_back({point, 0.0});
    }
    for (const auto* marks : {&snapshot->outputs, &snapshot->sliding_points})
      for (const MarkSnapshot& mark : *marks) sights.push_back({mark.position, 0.0});
  }
  for (const CloudPoint& own : options.cloud) sights.push_back({own.at, 0.0});
  std::erase_if(sights, [](const Sight& sight) { return !drawable(sight.point); });
  add_courses(options.courses, sights);
  return sights;
}

/// What moves by less than this [m] does not move: an atom, where everything is within a metre of the origin.
double roundoff_of(const std::vector<Sight>& sights) {
  double farthest = 0.0;
  for (const Sight& sight : sights) farthest = std::max(farthest, sight.point.lpNorm<Eigen::Infinity>());
  return 1e-10 * farthest;
}

/// Part of the page that these take, with room for lines.
Area area_of(const std::vector<Sight>& sights, const PictureView& view) {
  Area area{kScene.right, kScene.bottom, kScene.left, kScene.top};
  for (const Sight& sight : sights) {
    const Vec3 place = view.project(sight.point);
    const double reach = std::max(kThinnestRod, sight.radius * view.scale) + 4.0;
    area.left = std::min(area.left, place.x() - reach);
    area.right = std::max(area.right, place.x() + reach);
    area.top = std::min(area.top, place.y() - reach);
    area.bottom = std::max(area.bottom, place.y() + reach);
  }
  return {std::max(0.0, area.left), std::max(0.0, area.top), std::min<double>(kPictureWidth, area.right),
          std::min<double>(kPictureHeight, area.bottom)};
}

/// From the farthest to the nearest; returns the largest value.
double draw_cloud(const Page& page, const std::vector<CloudPoint>& cloud, const PictureView& view) {
  double largest = 0.0;
  std::vector<std::pair<Vec3, double>> places;
  for (const CloudPoint& own : cloud) {
    if (!drawable(own.at)) continue;
    places.emplace_back(view.project(own.at), own.value);
    largest = std::max(largest, own.value);
  }
  std::sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first.z() < b.first.z(); });
  const double radius = std::clamp(60.0 / std::sqrt(static_cast<double>(places.size()) + 1.0), 3.0, 6.0);
  for (const auto& [place, value] : places)
    page.disc(place.head<2>(), radius, viridis(largest > 0.0 ? value / largest : 0.0), 0.6, kWhite);
  return largest;
}

}  // namespace

PictureView picture_view(const Snapshot& rest, const Snapshot& end, const PictureOptions& options) {
  return choose_view(sights_of(rest, end, options), options.up, kScene);
}

void draw_picture(const std::filesystem::path& png, const Snapshot& rest, const Snapshot& end,
                  const PictureOptions& options) {
  const std::vector<Sight> sights = sights_of(rest, end, options);
  const PictureView view = choose_view(sights, options.up, kScene);
  const Area area = area_of(sights, view);
  const double roundoff = roundoff_of(sights);
  const bool rods_orange = !end.solids.empty();

  std::vector<std::vector<double>> on_solids;
  std::vector<Eigen::VectorXd> on_rods;
  std::vector<double> all;
  for (const SolidSnapshot& solid : end.solids) {
    on_solids.push_back(surface_values(solid, options.color));
    all.insert(all.end(), on_solids.back().begin(), on_solids.back().end());
  }
  for (const RodSnapshot& rod : end.rods) {
    on_rods.push_back(rods_orange ? Eigen::VectorXd(Eigen::VectorXd::Zero(rod.points.cols()))
                                  : rod_values(rod, named(rest.rods, rod.name), options.color));
    if (!rods_orange) all.insert(all.end(), on_rods.back().begin(), on_rods.back().end());
  }
  const Scale scale = scale_of(all, options.color, roundoff);

  const Page page(kPictureWidth, kPictureHeight);
  double foot = 0.0;  ///< where what stands there ends
  draw_header(page, end, options);
  if (!sights.empty()) {
    {
      Raster ghost(area, plain_palette(kGrey));
      for (const SolidSnapshot& solid : end.solids) add_surface(ghost, solid.rest, solid, {}, scale, view, 0.0);
      ghost.paint(page.cairo(), {.fill = 0.14, .line = 0.6, .width = 1.0, .line_color = kGrey});
    }
    if (!rods_orange)
      for (const RodSnapshot& rod : rest.rods) draw_rest_rod(page, rod, view);
    const Palette palette = scale.largest > 0.0 ? viridis_palette() : plain_palette(kUnmoved);
    Raster bodies(area, palette), rods(area, rods_orange ? plain_palette(kRod) : palette);
    const double edge = edge_strength(end.solids, view);
    for (std::size_t i = 0; i < end.solids.size(); ++i)
      add_surface(bodies, end.solids[i].nodes, end.solids[i], on_solids[i], scale, view, edge);
    Raster ground(area, plain_palette(kGrey));
    for (const BodySnapshot& body : end.bodies) add_body(body.ground ? ground : bodies, body, view);
    ground.paint(page.cairo(), {.fill = 0.2, .line = 0.4, .width = 1.0, .line_color = kGrey});
    for (std::size_t i = 0; i < end.rods.size(); ++i) add_tube(rods, end.rods[i], on_rods[i], scale, view);
    rods.paint(page.cairo(), {.width = 0.0});
    bodies.paint(page.cairo(), {.fill = 0.78, .line = 0.9, .width = 1.2});
    rods.paint(page.cairo(), {.width = 0.0, .before = &bodies, .hidden = 0.45});
    draw_sliding_points(page, end.sliding_points, view);
    draw_contacts(page, end.contacts, view);
    draw_outputs(page, rest, end, options, view, roundoff);
    if (!options.cloud.empty()) {
      const double largest = draw_cloud(page, options.cloud, view);
      draw_legend(page, kLegend, options.cloud_name, largest, {1.0, options.cloud_unit}, false);
    }
    draw_triad(page, view, {120, 905});
    foot = draw_scale_bar(page, view, 230, 940);
  }
  draw_key(page, rest, end, options, rods_orange, foot + 30);
  if (!all.empty() && options.cloud.empty()) {
    const bool stress = options.color == PictureColor::von_mises;
    draw_legend(page, kLegend, stress ? "von Mises" : "displacement", scale.largest,
                stress ? stress_unit(scale.largest) : length_unit(scale.largest), scale.open);
  }
  page.save(png);
}

}  // namespace sinew::io
