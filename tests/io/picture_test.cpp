#include "sinew/io/picture.hpp"

#include <cairo/cairo.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>

#include "sinew/io/append_file.hpp"
#include "sinew/io/color_map.hpp"
#include "sinew/io/picture_page.hpp"
#include "sinew/io/picture_shapes.hpp"
#include "sinew/io/readable.hpp"

namespace sinew::io {
namespace {

using Vec3 = Eigen::Vector3d;

/// Pixels of a PNG file, read by Cairo.
class Image {
 public:
  explicit Image(const std::filesystem::path& png) : surface_(cairo_image_surface_create_from_png(png.c_str())) {
    EXPECT_EQ(cairo_surface_status(surface_), CAIRO_STATUS_SUCCESS) << png;
  }
  ~Image() { cairo_surface_destroy(surface_); }
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;

  int width() const { return cairo_image_surface_get_width(surface_); }
  int height() const { return cairo_image_surface_get_height(surface_); }
  std::uint32_t at(double x, double y) const {
    const unsigned char* row = cairo_image_surface_get_data(surface_) +
                               static_cast<std::ptrdiff_t>(y) * cairo_image_surface_get_stride(surface_);
    return reinterpret_cast<const std::uint32_t*>(row)[static_cast<int>(x)] & 0xffffffu;
  }
  /// How many pixels within `tolerance` of a colour, in an area.
  int count(std::uint32_t color, int tolerance, const Area& area = {0, 0, kPictureWidth, kPictureHeight}) const {
    int found = 0;
    for (int y = static_cast<int>(area.top); y < area.bottom; ++y)
      for (int x = static_cast<int>(area.left); x < area.right; ++x) found += near(at(x, y), color, tolerance);
    return found;
  }
  static bool near(std::uint32_t a, std::uint32_t b, int tolerance) {
    for (const int shift : {0, 8, 16})
      if (std::abs(static_cast<int>(a >> shift & 255) - static_cast<int>(b >> shift & 255)) > tolerance) return false;
    return true;
  }

 private:
  cairo_surface_t* surface_;
};

constexpr std::uint32_t kMarkColor = 0xd0104c, kWhitePixel = 0xffffff;
constexpr Area kMiddle{40, 118, 1400, 865};  // robots and their names

/// A beam of cubes along x, with a rod through it that sticks out at its base, one output, three sliding points.
Snapshot beam(double size = 1.0, int cubes = 8) {
  SolidSnapshot solid;
  solid.name = "beam";
  solid.rest.resize(3, 4 * (cubes + 1));
  for (int i = 0; i <= cubes; ++i)
    for (int k = 0; k < 4; ++k)
      solid.rest.col(4 * i + k) = size * Vec3(0.02 * i, 0.02 * ((k == 1 || k == 2) ? 1 : 0), 0.02 * (k / 2));
  solid.nodes = solid.rest;
  const auto quad = [&](int a, int b, int c, int d) {
    solid.surface.push_back({a, b, c});
    solid.surface.push_back({a, c, d});
  };
  quad(0, 3, 2, 1);
  quad(4 * cubes, 4 * cubes + 1, 4 * cubes + 2, 4 * cubes + 3);
  for (int i = 0; i < cubes; ++i)
    for (int k = 0; k < 4; ++k) quad(4 * i + k, 4 * i + (k + 1) % 4, 4 * i + 4 + (k + 1) % 4, 4 * i + 4 + k);
  RodSnapshot rod;
  rod.name = "cable";
  rod.radius.setConstant(100, 0.0015 * size);
  rod.points.resize(3, 100);
  for (int i = 0; i < 100; ++i) rod.points.col(i) = size * Vec3(-0.04 + 0.002 * i, 0.01, 0.01);
  Snapshot snapshot;
  snapshot.status = "converged";
  snapshot.solids = {solid};
  snapshot.rods = {rod};
  for (const double x : {0.02, 0.06, 0.1}) snapshot.sliding_points.push_back({"p", size * Vec3(x, 0.01, 0.01)});
  snapshot.outputs = {{"tip", size * Vec3(0.16, 0.02, 0.02)}};
  return snapshot;
}

Snapshot moved(Snapshot snapshot, const std::function<Vec3(const Vec3&)>& map) {
  for (auto& solid : snapshot.solids)
    for (int i = 0; i < solid.nodes.cols(); ++i) solid.nodes.col(i) = map(solid.nodes.col(i));
  for (auto& rod : snapshot.rods)
    for (int i = 0; i < rod.points.cols(); ++i) rod.points.col(i) = map(rod.points.col(i));
  for (auto* marks : {&snapshot.outputs, &snapshot.sliding_points})
    for (auto& mark : *marks) mark.position = map(mark.position);
  snapshot.time = 0.5;
  return snapshot;
}

Vec3 bent(const Vec3& p) { return p.x() < 0 ? p : Vec3(p + Vec3(0, 5 * p.x() * p.x(), 0)); }

class Picture : public testing::Test {
 protected:
  Picture() {
    char name[] = "/tmp/sinew_picture_XXXXXX";
    folder_ = mkdtemp(name);
    png_ = folder_ / "end.png";
  }
  ~Picture() override { std::filesystem::remove_all(folder_); }

  /// Draws, and expects of every picture that nothing is cut off by the margin.
  void draw(const Snapshot& rest, const Snapshot& end, const PictureOptions& options = {}) {
    ASSERT_NO_THROW(draw_picture(png_, rest, end, options));
    const Image image(png_);
    ASSERT_EQ(image.width(), kPictureWidth);
    ASSERT_EQ(image.height(), kPictureHeight);
    const double w = kPictureWidth, h = kPictureHeight;
    for (const Area& rim : {Area{0, 0, w, 20}, Area{0, h - 20, w, h}, Area{0, 0, 20, h}, Area{w - 10, 0, w, h}})
      EXPECT_EQ(image.count(kWhitePixel, 0, rim), (rim.right - rim.left) * (rim.bottom - rim.top));
  }
  std::filesystem::path folder_, png_;
};

TEST_F(Picture, shows_the_robot_its_rod_its_rest_and_its_colours) {
  const Snapshot rest = beam(), end = moved(rest, bent);
  draw(rest, end, {.title = "Beam"});
  const Image image(png_);
  const double inked = 1.0 - image.count(kWhitePixel, 0) / (1.0 * kPictureWidth * kPictureHeight);
  EXPECT_GT(inked, 0.05);
  EXPECT_LT(inked, 0.6);
  EXPECT_GT(image.count(0xf07c12, 30, kMiddle), 300);  // the rod
  EXPECT_GT(image.count(0xfde725, 4), 5);              // the legend's ends
  EXPECT_GT(image.count(0x440154, 4), 5);
  EXPECT_GT(image.count(0xeaeaea, 6, kMiddle), 2000);                         // the silhouette of the rest shape
  EXPECT_LT(image.count(kWhitePixel, 0, {60, 30, 400, 70}), 340 * 40 - 500);  // the title
}

TEST_F(Picture, marks_stand_where_the_view_puts_them) {
  const Snapshot rest = beam(), end = moved(rest, bent);
  draw(rest, end);
  const Image image(png_);
  const PictureView view = picture_view(rest, end, {});
  const Vec3 tip = view.project(end.outputs[0].position), from = view.project(rest.outputs[0].position);
  EXPECT_LT(tip.y(), from.y() - 100);  // it went up
  EXPECT_EQ(image.at(tip.x(), tip.y()), kMarkColor);
  EXPECT_EQ(image.at(tip.x() + 5.5, tip.y()), kWhitePixel);                      // its ring
  EXPECT_EQ(image.at(from.x(), from.y()), kWhitePixel);                          // the hollow sign where it was,
  EXPECT_TRUE(Image::near(image.at(from.x() + 4.5, from.y()), kMarkColor, 60));  // with its rim
  for (const auto& point : end.sliding_points) {
    const Vec3 place = view.project(point.position);
    EXPECT_EQ(image.at(place.x(), place.y()), kWhitePixel);
  }
}

TEST_F(Picture, a_rod_is_bright_outside_a_body_and_shines_through_it) {
  const Snapshot rest = beam();
  draw(rest, rest);
  const Image image(png_);
  const PictureView view = picture_view(rest, rest, {});
  const Vec3 outside = view.project({-0.02, 0.01, 0.01}), inside = view.project({0.041, 0.01, 0.01});
  const Vec3 beside = view.project({0.041, 0.01, 0.004});
  EXPECT_TRUE(Image::near(image.at(outside.x(), outside.y()), 0xf07c12, 40));
  const auto red = [&](const Vec3& p) { return static_cast<int>(image.at(p.x(), p.y()) >> 16); };
  const auto blue = [&](const Vec3& p) { return static_cast<int>(image.at(p.x(), p.y()) & 255); };
  EXPECT_GT(red(inside) - blue(inside), 40);                                 // orange,
  EXPECT_LT(red(inside) - blue(inside), red(outside) - blue(outside) - 40);  // but less so
  EXPECT_LT(red(beside) - blue(beside), 0);
}

TEST_F(Picture, looks_along_the_axis_in_which_least_happens) {
  const Snapshot rest = beam();
  const struct {
    Vec3 motion, up;
    int right, upright;  // world axes that run to the right and upwards
  } cases[] = {{Vec3(0, 5, 0), Vec3(0, 0, 0), 0, 1},
               {Vec3(0, 0, 5), Vec3(0, 0, 0), 0, 2},
               {Vec3(0, 5, 0), Vec3(0, 9.81, 0), 0, 1},
               {Vec3(0, 5, 0), Vec3(0, 0, 1), 0, 1},
               {Vec3(0, 5, 0), Vec3(1, 0, 0), 1, 0}};
  for (const auto& c : cases) {
    const Snapshot end = moved(rest, [&](const Vec3& p) -> Vec3 { return p + p.x() * p.x() * c.motion; });
    const PictureView view = picture_view(rest, end, {.title = "", .up = c.up});
    EXPECT_GT(view.axes(0, c.right), 0.9);
    EXPECT_GT(view.axes(1, c.upright), 0.9);
    EXPECT_LT((view.axes * view.axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(view.axes.determinant(), 1.0, 1e-12);
    double left = INFINITY, right = 0, top = INFINITY, bottom = 0;
    for (const Snapshot* snapshot : {&rest, &end}) {
      for (const Eigen::Matrix3Xd* points : {&snapshot->solids[0].nodes, &snapshot->rods[0].points}) {
        for (int i = 0; i < points->cols(); ++i) {
          const Vec3 place = view.project(points->col(i));
          left = std::min(left, place.x());
          right = std::max(right, place.x());
          top = std::min(top, place.y());
          bottom = std::max(bottom, place.y());
        }
      }
    }
    EXPECT_TRUE(kMiddle.holds({left, top, right, bottom}));
    EXPECT_TRUE(right - left > 1230 || bottom - top > 640);  // fills the page one way
  }
}

TEST_F(Picture, size_and_place_change_nothing_but_the_labels) {
  const Snapshot rest = beam(), end = moved(rest, bent);
  const PictureView view = picture_view(rest, end, {});
  const Vec3 tip = view.project(end.outputs[0].position);
  for (const double size : {1e-20, 1e-6, 1e3, 1e20}) {
    const Snapshot other_rest = beam(size);
    const Snapshot other = moved(other_rest, [&](const Vec3& p) -> Vec3 { return size * bent(p / size); });
    draw(other_rest, other);
    const Vec3 place = picture_view(other_rest, other, {}).project(other.outputs[0].position);
    EXPECT_LT((place - tip).norm(), 1e-6) << size;
    EXPECT_EQ(Image(png_).at(tip.x(), tip.y()), kMarkColor) << size;
  }
}

TEST_F(Picture, stress_is_that_of_the_cell_behind_each_face) {
  Snapshot rest;
  SolidSnapshot solid;
  solid.rest.resize(3, 5);
  solid.rest << 0, 1, 0, 0, -1,  //
      0, 0, 1, 0, 0,             //
      0, 0, 0, 1, 0;
  solid.nodes = solid.rest;
  solid.cells = {{solid::Kind::tet4, {3, 2, 1, 0}}, {solid::Kind::tet4, {4, 0, 3, 2}}};
  solid.surface = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 4, 2}, {2, 4, 3}, {4, 0, 3}};
  solid.von_mises.resize(2);
  solid.von_mises << 0.0, 5e3;
  rest.solids = {solid};
  draw(rest, rest, {.title = "", .color = PictureColor::von_mises});
  const Image image(png_);
  const PictureView view = picture_view(rest, rest, {});
  const Vec3 low = view.project({1.0 / 3, 0, 1.0 / 3}), high = view.project({-1.0 / 3, 0, 1.0 / 3});
  const auto green = [&](const Vec3& p) { return static_cast<int>(image.at(p.x(), p.y()) >> 8 & 255); };
  EXPECT_LT(green(low), 80);                // purple
  EXPECT_GT(green(high), green(low) + 60);  // yellow
}

/// A cube and on its face x = 1 a 10-node tetrahedron, which does not fit to it: both surfaces are whole.
SolidSnapshot cube_and_tetrahedron() {
  SolidSnapshot solid;
  solid.rest.resize(3, 18);
  solid.rest.leftCols(12) << 0, 1, 1, 0, 0, 1, 1, 0, 1, 2, 1, 1,  //
      0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 0,                         //
      0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 1;
  const int edges[6][2] = {{8, 9}, {9, 10}, {10, 8}, {8, 11}, {9, 11}, {10, 11}};
  for (int e = 0; e < 6; ++e) solid.rest.col(12 + e) = (solid.rest.col(edges[e][0]) + solid.rest.col(edges[e][1])) / 2;
  solid.nodes = solid.rest;
  solid.cells = {{solid::Kind::hex8, {0, 1, 2, 3, 4, 5, 6, 7}},
                 {solid::Kind::tet10, {8, 9, 10, 11, 12, 13, 14, 15, 16, 17}}};
  solid.surface = solid::surface(solid.cells);
  solid.von_mises.resize(2);
  solid.von_mises << 1e3, 5e3;
  return solid;
}

TEST(PictureShapes, have_the_stress_of_the_cell_behind_whatever_its_kind) {
  const SolidSnapshot solid = cube_and_tetrahedron();
  ASSERT_EQ(solid.surface.size(), 6u * 2 + 4u * 4);
  const std::vector<double> values = surface_values(solid, PictureColor::von_mises);
  ASSERT_EQ(values.size(), 3 * solid.surface.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], solid.surface[i / 3][0] < 8 ? 1e3 : 5e3) << i;
}

TEST_F(Picture, shows_edges_of_cells_and_none_within_their_faces) {
  const SolidSnapshot solid = cube_and_tetrahedron();
  const PictureView view{.middle = {100, 300}, .scale = 150.0};  // from above
  Raster raster({0, 0, 400, 400}, viridis_palette());
  add_surface(raster, solid.nodes, solid, {}, {}, view, 0.5);
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 400, 400);
  cairo_t* page = cairo_create(surface);
  raster.paint(page, {.width = 0.0});
  cairo_surface_write_to_png(surface, png_.c_str());
  cairo_destroy(page);
  cairo_surface_destroy(surface);
  const Image image(png_);
  const auto blue = [&](const Vec3& point) {
    const Vec3 place = view.project(point);
    return static_cast<int>(image.at(place.x(), place.y()) & 255);
  };
  const auto node = [&](int i) -> Vec3 { return solid.nodes.col(i); };
  const int top = blue(Vec3(0.7, 0.3, 1));
  EXPECT_GT(top, 40);
  EXPECT_EQ(blue(Vec3(0.5, 0.5, 1)), top);            // the diagonal
  EXPECT_LT(blue(Vec3(0.5, 0.001, 1)), top * 3 / 4);  // the rim
  const int slope = blue((node(9) + node(13) + node(16)) / 3);
  EXPECT_GT(slope, 40);
  EXPECT_EQ(blue((node(13) + node(16)) / 2), slope);
  EXPECT_EQ(blue((node(13) + node(17)) / 2), slope);
  EXPECT_LT(blue(0.5 * node(9) + 0.5 * node(13) - Vec3(0.001, 0.001, 0)), slope * 3 / 4);
}

TEST_F(Picture, faces_seen_nearly_edge_on_are_no_outlines) {
  Raster raster({0, 0, 100, 100}, viridis_palette());  // 40 px deeper with every px to the right, and a rim on the left
  raster.add({{{{20, 10, 3200}, 1.0, 1.0}, {{90, 10, 400}, 1.0, 1.0}, {{20, 90, 3200}, 1.0, 1.0}}}, {0.0, 0.0, 0.0});
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 100, 100);
  cairo_t* page = cairo_create(surface);
  raster.paint(page, {});
  cairo_surface_write_to_png(surface, png_.c_str());
  cairo_destroy(page);
  cairo_surface_destroy(surface);
  const Image image(png_);
  const auto green = [&image](double x, double y) { return static_cast<int>(image.at(x, y) >> 8 & 255); };
  EXPECT_GT(green(40, 40), 150);
  EXPECT_LT(green(20.5, 40), 60);
}

TEST_F(Picture, rods_alone_are_coloured_by_what_they_moved) {
  Snapshot rest = beam();
  rest.solids.clear();
  draw(rest, moved(rest, bent));
  const Image image(png_);
  EXPECT_EQ(image.count(0xf07c12, 10, kMiddle), 0);
  EXPECT_GT(image.count(0x440154, 25, kMiddle), 50);
  EXPECT_GT(image.count(0xfde725, 25, kMiddle), 20);
}

TEST_F(Picture, a_robot_that_only_rounds_has_one_colour) {
  const Snapshot rest = beam();
  const auto yellow = [&](double by) {
    draw(rest, moved(rest, [&](const Vec3& p) -> Vec3 { return p + Vec3(0, by * p.x(), 0); }));
    return Image(png_).count(0xfde725, 60, kMiddle);
  };
  EXPECT_EQ(yellow(1e-14), 0);
  EXPECT_GT(yellow(1e-8), 50);
}

TEST_F(Picture, forces_of_contacts_point_to_where_they_push) {
  const Snapshot rest = beam();
  Snapshot end = moved(rest, bent);
  end.contacts = {{Vec3(0.08, 0.1, 0.02), Vec3(0, 2, 0), Vec3::UnitY()},
                  {Vec3(0.12, 0.1, 0.02), Vec3(0, -1, 0), Vec3::UnitY()}};
  draw(rest, end);
  const Image image(png_);
  const PictureView view = picture_view(rest, end, {});
  const auto inked = [&](double x, double forward) {  // from y = 0.1 m on, in pixels
    const Vec3 place = view.project(Vec3(x, 0.1, 0.02) + Vec3(0, forward / view.scale, 0));
    return image.count(0x1446a0, 30, {place.x() - 2, place.y() - 2, place.x() + 2, place.y() + 2}) > 0;
  };
  EXPECT_TRUE(inked(0.08, 80));
  EXPECT_FALSE(inked(0.08, -20));
  EXPECT_TRUE(inked(0.12, -40));  // half as long
  EXPECT_FALSE(inked(0.12, -60));
  EXPECT_FALSE(inked(0.12, 20));
}

TEST_F(Picture, outputs_leave_their_ways_and_targets_stand_where_they_are) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Snapshot rest = beam(), end = moved(rest, bent);
  Course course{"tip", Eigen::Matrix3Xd(3, 50), Eigen::Matrix3Xd(3, 3), 0.03};
  const Vec3 from = rest.outputs[0].position, to = end.outputs[0].position;
  for (int i = 0; i < 50; ++i) {  // half a circle from one to the other
    const double angle = std::numbers::pi * i / 49;
    const Vec3 across = Vec3::UnitX() * 0.5 * (to - from).norm();
    course.way.col(i) = 0.5 * (from + to) - 0.5 * std::cos(angle) * (to - from) + std::sin(angle) * across;
  }
  course.way.col(40).setConstant(nan);
  course.wanted << Vec3::Constant(nan), to + Vec3(0.08, 0, 0), to + Vec3(0.08, 0.03, 0);
  PictureOptions options;
  options.courses = {course};
  options.outcome = "limited by a motor";
  draw(rest, end, options);
  const Image image(png_);
  const PictureView view = picture_view(rest, end, options);
  const auto inked = [&](const Vec3& place, std::uint32_t color, double forward = 0.0) {
    const Vec3 at = view.project(place) + Vec3(forward, 0, 0);
    return image.count(color, 80, {at.x() - 2, at.y() - 2, at.x() + 2, at.y() + 2}) > 0;
  };
  EXPECT_TRUE(inked(course.way.col(25), kMarkColor));
  EXPECT_TRUE(inked(course.way.col(10), kMarkColor));
  const Vec3 goal = course.wanted.col(2);
  EXPECT_TRUE(inked(goal, 0x222222, 12));  // its ring
  EXPECT_TRUE(inked(goal, 0x222222, -12));
  EXPECT_FALSE(inked(goal, 0x222222, 6));
  EXPECT_TRUE(inked(0.5 * (goal + course.wanted.col(1)), 0x222222));  // its way
  EXPECT_GT(image.count(0x6b6b6b, 60, {400, 90, 500, 110}), 0);       // the outcome, behind the status
}

TEST_F(Picture, the_dot_is_green_only_without_warnings) {
  constexpr std::uint32_t kGreen = 0x1b8a5a, kOrange = 0xc04000;
  const Area header{60, 85, 700, 110};
  PictureOptions options;
  draw(beam(), beam(), options);
  EXPECT_GT(Image(png_).count(kGreen, 20, header), 50);
  EXPECT_EQ(Image(png_).count(kOrange, 20, header), 0);
  options.warnings = 2;
  draw(beam(), beam(), options);
  EXPECT_EQ(Image(png_).count(kGreen, 20, header), 0);
  EXPECT_GT(Image(png_).count(kOrange, 20, header), 50);
}

TEST_F(Picture, far_targets_do_not_make_the_robot_small) {
  const Snapshot rest = beam(), end = moved(rest, bent);
  PictureOptions options;
  options.courses = {{"tip", Eigen::Matrix3Xd(3, 0), end.outputs[0].position + Vec3(100, 0, 0), 100.0}};
  draw(rest, end, options);
  EXPECT_EQ(picture_view(rest, end, options).scale, picture_view(rest, end, {}).scale);
}

TEST_F(Picture, a_long_key_stays_off_the_scale_bar) {
  const Snapshot rest = beam();
  Snapshot end = moved(rest, bent);
  end.contacts = {{Vec3(0.08, 0.1, 0.02), Vec3(0, 0.234, 0), Vec3::UnitY()}};
  end.bodies.push_back({"ball", Eigen::Matrix3Xd::Zero(3, 3), {{0, 1, 2}}, false});
  PictureOptions options;
  options.courses = {{"tip", Eigen::Matrix3Xd(3, 0), end.outputs[0].position, 0.0}};
  draw(rest, end, options);
  const double scale = picture_view(rest, end, options).scale, bar = std::ceil(230 + scale * round_below(220 / scale));
  EXPECT_EQ(Image(png_).count(kWhitePixel, 0, {bar + 4, 900, bar + 28, 950}), 24 * 50);
  EXPECT_LT(Image(png_).count(kWhitePixel, 0, {480, 890, 1540, 915}), 1060 * 25);  // a row above
}

TEST_F(Picture, equal_states_give_equal_files) {
  const Snapshot rest = beam(), end = moved(rest, bent);
  const auto bytes = [&] {
    draw(rest, end);
    std::ifstream stream(png_, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  EXPECT_EQ(bytes(), bytes());
}

TEST_F(Picture, takes_whatever_numbers_there_are) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Snapshot rest = beam();
  draw({}, {});
  draw(rest, {});
  draw({}, rest);
  for (const double bad : {nan, inf, 1e29, 1e300, 1e-300, 0.0}) {
    draw(rest, moved(rest, [&](const Vec3& p) -> Vec3 { return p.x() > 0.1 ? Vec3(bad, p.y(), -bad) : p; }));
    Snapshot end = moved(rest, [&](const Vec3& p) -> Vec3 { return p * bad; });
    end.time = bad;
    end.rods[0].radius.setConstant(bad);
    end.solids[0].rest = end.solids[0].nodes;
    draw(end, end, {.title = "", .up = Vec3(bad, 0, bad)});
    end.solids[0].cells = {{solid::Kind::tet4, {0, 1, 2, 3}}, {solid::Kind::tet4, {0, 3, 2, 5}}};
    end.solids[0].von_mises = Eigen::VectorXd::Constant(2, bad);
    draw(rest, end, {.title = "", .color = PictureColor::von_mises});
  }
  for (const Vec3& place : {Vec3(0, 0, 0), Vec3(1e6, 2, 3)}) {  // all in one point, or on one line
    Snapshot point;
    point.outputs = {{"here", place}};
    draw(point, point);
    const Vec3 seen = picture_view(point, point, {}).project(place);
    EXPECT_EQ(Image(png_).at(seen.x(), seen.y()), kMarkColor);
    for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ()), Vec3(1, 1, 1)}) {
      Snapshot line = rest;
      line.solids.clear();
      draw(line, moved(line, [&](const Vec3& p) -> Vec3 { return place + p.x() * axis; }));
    }
  }
}

TEST_F(Picture, takes_objects_that_do_not_fit_together) {
  Snapshot end = beam();
  end.solids[0].surface.push_back({-1, 5, 100000});
  end.solids[0].rest.resize(3, 4);
  end.solids[0].von_mises = Eigen::VectorXd::Ones(2);
  end.solids[0].cells = {{solid::Kind::tet4, {0, 1, 2, 900}}, {solid::Kind::hex8, {-7, 1, 2, 3}}};
  end.rods.push_back({});
  end.rods[0].points.conservativeResize(3, 1);
  for (const auto color : {PictureColor::displacement, PictureColor::von_mises})
    draw(beam(), end, {.title = "", .color = color});
}

TEST_F(Picture, takes_any_text_and_crowds_of_names) {
  Snapshot end = beam();
  end.status = "\xff\xfe line\nbreak";
  for (int i = 0; i < 150; ++i)
    end.outputs.push_back({"output_number_" + std::to_string(i), Vec3(0.001 * i, 0.01, 0.01)});
  end.outputs.push_back({std::string(5000, 'w'), Vec3(0, 0, 0)});
  std::string title;
  for (int i = 0; i < 400; ++i) title += "\xc3\xa9\xed\xa0\x80\xf0\x9f\x98\x80 ";
  draw(end, end, {.title = title});
}

TEST_F(Picture, says_where_it_cannot_write) {
  EXPECT_THROW(draw_picture(folder_ / "no" / "where.png", beam(), beam()), WriteError);
}

TEST(Page, names_find_room_beside_each_other_and_off_the_ink) {
  const Page page(800, 600);
  page.line({300, 300}, {420, 300}, 60, kInk);
  const Area area{10, 10, 790, 590};
  std::vector<Area> taken;
  for (int i = 0; i < 20; ++i) {
    Area room;
    if (!find_room(page, {400, 300}, {120, 34}, area, taken, &room)) break;
    EXPECT_TRUE(area.holds(room));
    EXPECT_NEAR(room.right - room.left, 120, 1e-9);
    EXPECT_LT(page.inked(room), i < 8 ? 1e-12 : 0.02) << i;
    for (const Area& other : taken) EXPECT_FALSE(other.meets(room));
    taken.push_back(room);
  }
  EXPECT_GE(taken.size(), 8u);
  Area room;
  EXPECT_FALSE(find_room(page, {400, 300}, {120, 34}, area, {area}, &room));
  EXPECT_FALSE(find_room(page, {400, 300}, {900, 34}, area, {}, &room));
}

TEST(Page, text_is_made_to_fit_and_to_be_valid) {
  const Page page(100, 100);
  const TextStyle style{.size = 20};
  EXPECT_EQ(page.fitted("tip", style, 100), "tip");
  const std::string cut = page.fitted(std::string(300, 'w'), style, 100);
  EXPECT_LE(page.text_width(cut, style), 100);
  EXPECT_GT(page.text_width(cut, style), 70);
  EXPECT_EQ(printable("a\xc3\xa9\xff\n\xed\xa0\x80"
                      "b"),
            "a\xc3\xa9? ???b");
}

TEST(Readable, has_three_digits_and_a_unit_that_fits) {
  EXPECT_EQ(readable_length(0.0342), "34.2 mm");
  EXPECT_EQ(readable_length(0.000999), "999 µm");
  EXPECT_EQ(readable_length(0.0009996), "1.00 mm");
  EXPECT_EQ(readable_length(1.5), "1.50 m");
  EXPECT_EQ(readable_length(0.0), "0 mm");
  EXPECT_EQ(readable_length(1e-15), "1e-06 nm");
  EXPECT_EQ(readable_force(0.35), "350 mN");
  EXPECT_EQ(readable_force(-1234.0), "-1.23 kN");
  EXPECT_EQ(readable_force(0.0), "0 N");
  EXPECT_EQ(stress_unit(2.5e5).symbol, "kPa");
  EXPECT_EQ(stress_unit(0).symbol, "kPa");
  EXPECT_EQ(stress_unit(std::nan("")).symbol, "kPa");
  EXPECT_EQ(readable(1234.0), "1234");
  EXPECT_EQ(round_below(0.0734), 0.05);
  EXPECT_EQ(round_below(200), 200);
  EXPECT_EQ(round_below(-1), 0);
  EXPECT_EQ(round_ticks(71.5, 6), (std::vector<double>{0, 20, 40, 60}));
  EXPECT_EQ(round_ticks(100, 6), (std::vector<double>{0, 20, 40, 60, 80, 100}));
  EXPECT_EQ(round_ticks(0, 6), (std::vector<double>{0}));
  for (const double largest : {1.0, 1.7, 3.3, 9.99, 1e-7, 123456.0}) {
    EXPECT_GE(round_ticks(largest, 6).size(), 3u) << largest;
    EXPECT_LE(round_ticks(largest, 6).size(), 7u) << largest;
  }
}

TEST(ColorMap, runs_from_purple_to_yellow_ever_brighter) {
  const auto brightness = [](const Rgb& c) { return 0.2126 * c.red + 0.7152 * c.green + 0.0722 * c.blue; };
  double last = -1;
  for (const Rgb& color : viridis_palette()) {
    EXPECT_GT(brightness(color), last);
    last = brightness(color);
  }
  EXPECT_EQ(viridis(-3).red, rgb(0x440154).red);
  EXPECT_EQ(viridis(7).green, rgb(0xfde725).green);
  EXPECT_NEAR(viridis(0.5).green, 0x91 / 255.0, 1e-12);
  EXPECT_EQ(viridis(std::nan("")).red, viridis(std::nan("")).blue);  // grey
}

}  // namespace
}  // namespace sinew::io
