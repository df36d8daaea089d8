#include "sinew/sim/placement.hpp"

#include <algorithm>

#include "sinew/lie/rotation.hpp"

namespace sinew {

Placement placement(const Pose& pose) { return {lie::from_euler_xyz(pose.rotate), pose.translate}; }

Placement compose(const Placement& a, const Placement& b) { return {a.R * b.R, a.R * b.p + a.p}; }

Placement inverse(const Placement& a) { return {a.R.transpose(), -(a.R.transpose() * a.p)}; }

namespace {

template <class Value>
Value interpolate(const std::vector<double>& times, const std::vector<Value>& values, double time) {
  if (times.size() == 1 || time <= times.front()) return values.front();
  if (time >= times.back()) return values.back();
  const std::size_t i = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  const double t = (time - times[i - 1]) / (times[i] - times[i - 1]);
  return values[i - 1] + t * (values[i] - values[i - 1]);
}

}  // namespace

double value_at(const Table& table, double time) { return interpolate(table.times, table.values, time); }
Eigen::VectorXd value_at(const Track& track, double time) { return interpolate(track.times, track.values, time); }

Placement frame_at(const Frame& frame, double time) {
  Pose motion;
  if (frame.motion) {
    if (!frame.motion->rotate.empty()) motion.rotate = interpolate(frame.motion->times, frame.motion->rotate, time);
    if (!frame.motion->translate.empty())
      motion.translate = interpolate(frame.motion->times, frame.motion->translate, time);
  }
  return compose(placement(motion), placement(frame.pose));
}

Placement frame_displacement(const Frame& frame, double time) {
  if (!frame.motion) return {};
  return compose(frame_at(frame, time), inverse(frame_at(frame, 0.0)));
}

}  // namespace sinew
