// Frames, and how they move.
#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_values.hpp"

namespace sinew::io {
namespace {

using enum Need;

Type<FrameMotion> frame_motion() {
  const auto check = [](const FrameMotion& motion, const At& at) {
    if (at.has("rotate")) check_one_per_time(motion.rotate.size(), motion.times.size(), at.child("rotate"));
    if (at.has("translate")) check_one_per_time(motion.translate.size(), motion.times.size(), at.child("translate"));
    if (!at.has("rotate") && !at.has("translate")) {
      at.refuse_key("translate", "is missing: a motion needs rotate, translate or both",
                    "add one, for example `translate: [[0, 0, 0], [0, 20 mm, 0]]`");
    }
  };
  return map<FrameMotion>(
      {"a motion",
       {field<FrameMotion>({"times", required, "the ascending times of the entries below [s]", "[0, 2]"},
                           &FrameMotion::times, times()),
        field<FrameMotion>({"rotate", optional, "the angles [a, b, c] at each time [rad]", "[[0, 0, 0], [0, 0, 1]]"},
                           &FrameMotion::rotate, list<Vec3>("angles, one per time", vec3(Dimension::angle), {1})),
        field<FrameMotion>({"translate", optional, "the shift at each time [m]", "[[0, 0, 0], [0, 20 mm, 0]]"},
                           &FrameMotion::translate, list<Vec3>("shifts, one per time", vec3(Dimension::length), {1}))},
       {},
       check});
}

}  // namespace

Type<Frame> frame() {
  return map<Frame>({"a frame",
                     {field<Frame>({"pose", optional, "where the frame stands at rest", "{translate: [0, 20 mm, 0]}"},
                                   &Frame::pose, pose()),
                      field<Frame>({"motion", optional, "how the frame moves over time",
                                    "{times: [0, 1], translate: [[0, 0, 0], [0, 20 mm, 0]]}"},
                                   &Frame::motion, frame_motion())}});
}

}  // namespace sinew::io
