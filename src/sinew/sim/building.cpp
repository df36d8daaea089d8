#include "sinew/sim/building.hpp"

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

int find_frame(const Scene& scene, const std::optional<std::string>& name, const std::string& path) {
  return name ? find(scene.frames, *name, path + ".frame", "frame") : -1;
}

Placement stand(const Scene& scene, int frame, const Pose& pose) {
  const Placement own = placement(pose);
  return frame < 0 ? own : compose(frame_at(scene.frames[frame].second, 0.0), own);
}

}  // namespace sinew::building
