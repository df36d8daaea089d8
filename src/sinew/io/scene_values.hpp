// Values that several objects of a scene file share: vectors, regions, tables over time.
#pragma once

#include "sinew/io/fields.hpp"
#include "sinew/sim/scene.hpp"

namespace sinew::io {

inline Range above(double lower) { return {.lower = lower, .above = true}; }
inline Range at_least(double lower) { return {.lower = lower}; }

Type<Vec3> vec3(Dimension dimension);
Type<Vec3> direction();  ///< any vector but zero
Type<In> in();
Type<Pose> pose();
Type<std::vector<double>> times();
Type<FrameMotion> frame_motion();
Type<std::vector<Box>> regions();
Type<std::filesystem::path> file_name();
Type<std::vector<Vec3>> path();
Type<std::vector<Strain>> strains();
Type<Drive> drive(Dimension dimension);

/// A count up to 10000, or a list of ascending lengths.
Type<std::variant<int, std::vector<double>>> count_or_lengths(int least, bool from_zero);

}  // namespace sinew::io
