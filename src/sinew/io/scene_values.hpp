// Values that several objects of a scene file share: vectors, poses, tapers, lists of lengths, drives over time.
#pragma once

#include "sinew/io/fields.hpp"
#include "sinew/sim/scene.hpp"

namespace sinew::io {

inline Range above(double lower) { return {.lower = lower, .above = true}; }
inline Range at_least(double lower) { return {.lower = lower}; }

Type<Vec3> vec3(Dimension dimension);
Type<Vec3> direction();                       ///< any vector but zero
Type<std::vector<Vec3>> points(Count count);  ///< [m], no two neighbours the same
Type<In> in();
Words<Strain> strain_words();
Type<Pose> pose();
Type<std::filesystem::path> file_name();
/// The `time` of the document.
Time time_of_run(const At& at);
Type<Time> time_of_run();
Type<std::vector<double>> times();               ///< ascending
Type<std::vector<double>> lengths(Count count);  ///< ascending, not negative
Type<Drive> drive(Dimension dimension);
/// The same of a motor, of which the command may be `inverse`.
Type<Drive> motor_drive(Dimension dimension);
/// [least, most], or a map with one of them.
Type<Span> span(Dimension dimension);
/// Numbers over time: of three components, or of one.
Type<Track> track(Dimension dimension, int components);

/// One value, or a pair of values for the two ends.
Type<Taper> taper(Dimension dimension, Range range);

/// Of a point on a rod [m]; none: its tip, for which the file says `tip`, or nothing.
Type<std::optional<double>> abscissa();

/// A count up to 10000, or a list of ascending lengths.
Type<std::variant<int, std::vector<double>>> count_or_lengths(int least, bool from_zero);

/// Of a list `at` of so many entries: one for each of so many `times`.
void check_one_per_time(std::size_t size, std::size_t times, const At& at);
/// Of an object `at` that has a key `to`: it must be beyond `from`.
void check_from_to(double from, double to, const At& at);

}  // namespace sinew::io
