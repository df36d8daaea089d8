#include "sinew/sim/building.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace sinew::building {

std::string text(double value) {
  std::ostringstream out;
  out.precision(6);
  out << value;
  return out.str();
}

std::string text(const Vec3& v) { return "[" + text(v.x()) + ", " + text(v.y()) + ", " + text(v.z()) + "]"; }

[[noreturn]] void reject(const std::string& path, const std::string& value, const std::string& rule,
                         const std::string& remedy) {
  throw InputError({"", 0, path, value, rule, remedy});
}

void require_positive(double value, const std::string& path, const std::string& remedy) {
  if (!(value > 0.0) || !std::isfinite(value))
    reject(path, text(value), "must be a finite number greater than 0", remedy);
}

void require_not_negative(double value, const std::string& path, const std::string& remedy) {
  if (!(value >= 0.0) || !std::isfinite(value)) reject(path, text(value), "must be a finite number, 0 or more", remedy);
}

void require_size(double value, const std::string& path) {
  require_positive(value, path, "give it in metres, or with a unit: 20 mm");
  if (!(value > kSmallest && value < kLargest))
    reject(path, text(value) + " m", "must be between 1e-9 m and 1e6 m", "check its unit");
}

int find_frame(const Scene& scene, const std::optional<std::string>& name, const std::string& path) {
  return name ? find(scene.frames, *name, path + ".frame", "frame") : -1;
}

Line find_line(const Model& model, const std::string& name, const std::string& path) {
  find(model.scene.rods, name, path, "rod");
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    if (model.rods[i].name == name) return {static_cast<int>(i), -1};
  }
  for (std::size_t i = 0; i < model.cables.size(); ++i) {
    if (model.cables[i].name == name) return {-1, static_cast<int>(i)};
  }
  return {};
}

int find_rod(const Model& model, const std::string& name, const std::string& path) {
  const Line line = find_line(model, name, path);
  if (line.rod < 0)
    reject(path, name, "a geometric cable has no material points", "use `cable: cosserat`, or a point of the solid");
  return line.rod;
}

double length_of(const Model& model, const Line& line) {
  return line.rod >= 0 ? model.rods[line.rod].rod.length() : model.cables[line.cable].cable.length;
}

/// People write the length of a path to about so many digits.
constexpr double kLastDigit = 1e-6;

double abscissa_on(const Model& model, int rod, const std::optional<double>& at, const std::string& path) {
  const double length = model.rods[rod].rod.length();
  if (!at) return length;
  if (!(*at >= 0.0 && *at <= length * (1.0 + kLastDigit)))
    reject(path, text(*at) + " m", "must lie on the rod, from 0 to " + text(length) + " m", "measure from the base");
  return std::min(*at, length);
}

Stretch stretch_on(const Model& model, int rod, const std::optional<double>& from, const std::optional<double>& to,
                   const std::string& path, const std::string& remedy) {
  const Stretch own{abscissa_on(model, rod, from, path + ".from"), abscissa_on(model, rod, to, path + ".to")};
  if (!(own.to > own.from))
    reject(path + ".to", text(own.to) + " m", "must be greater than `from`, " + text(own.from) + " m", remedy);
  return own;
}

rod::Configuration start_shape(const RodModel& rod) { return rod::configure(rod.rod, rod.base, rod.start); }

Placement stand(const Scene& scene, int frame, const Pose& pose) {
  const Placement own = placement(pose);
  return frame < 0 ? own : compose(frame_at(scene.frames[frame].second, 0.0), own);
}

}  // namespace sinew::building
