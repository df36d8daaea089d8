#include "sinew/io/scene_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/io/nearest.hpp"
#include "sinew/io/samples.hpp"
#include "sinew/sim/quantities.hpp"

namespace sinew::io {
namespace {

using enum Need;

/// Neighbours must ascend; the fault stands at the later one.
void check_ascending(const std::vector<double>& values, const At& at) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (!(values[i] > values[i - 1])) at.item(i).refuse("must be greater than the value before it");
  }
}

}  // namespace

Type<Vec3> vec3(Dimension dimension) {
  const Type<std::vector<double>> three =
      list<double>(dimension == Dimension::number
                       ? "numbers [x, y, z]"
                       : std::string(name(dimension).substr(name(dimension).find(' ') + 1)) + " values [x, y, z]",
                   quantity(dimension), {3, 3});
  const auto read = [=](const At& at) {
    const std::vector<double> values = three.read(at);
    return Vec3(values[0], values[1], values[2]);
  };
  return {read, three.schema, [](const Vec3& v) { return Json{v.x(), v.y(), v.z()}; }};
}

Type<Vec3> direction() {
  const Type<Vec3> any = vec3(Dimension::number);
  const auto read = [=](const At& at) {
    Vec3 value = any.read(at);
    if (value.isZero(0.0)) at.refuse("must not be zero: it is a direction");
    return value;
  };
  return {read, any.schema};
}

Words<Strain> strain_words() {
  Words<Strain> words;
  for (std::size_t c = 0; c < rod::kStrainNames.size(); ++c)
    words.emplace_back(rod::kStrainNames[c], static_cast<Strain>(c));
  return words;
}

Type<In> in() { return word_of<In>({{"object", In::object}, {"world", In::world}}); }

Type<std::optional<double>> abscissa() {
  const Type<double> length = quantity(Dimension::length, at_least(0.0));
  return {[=](const At& at) -> std::optional<double> {
            if (at.is(Node::Kind::scalar) && at.node().text == "tip") return std::nullopt;
            return length.read(at);
          },
          [=] {
            return any_of({{{"const", "tip"}}, length.schema()});
          }};
}

Type<std::filesystem::path> file_name() {
  const Type<std::string> name = text();
  return {[=](const At& at) { return std::filesystem::path(name.read(at)); }, name.schema};
}

Type<Pose> pose() {
  const auto check = [](const Pose& own, const At& at) {
    for (int i = 0; i < 3; ++i) {
      if (std::abs(own.rotate[i]) > 2.0 * std::numbers::pi)
        at.child("rotate")
            .item(static_cast<std::size_t>(i))
            .refuse("must be within one turn, 6.283 rad",
                    "leave out whole turns; a number alone is in radians, write degrees as `90 deg`");
    }
  };
  return map<Pose>(
      {"a pose",
       {field<Pose>({"rotate", optional, "the angles [a, b, c] of R = Rz(c) Ry(b) Rx(a) [rad]", "[0, 0, 90 deg]"},
                    &Pose::rotate, vec3(Dimension::angle)),
        field<Pose>({"translate", optional, "the shift after the rotation [m]", "[0, 20 mm, 0]"}, &Pose::translate,
                    vec3(Dimension::length))},
       {},
       check});
}

Type<Time> time_of_run() {
  return map<Time>(
      {"time",
       {field<Time>({"step", optional, "the time step [s]", "10 ms"}, &Time::step,
                    quantity(Dimension::time, above(0.0))),
        field<Time>({"duration", optional, "the time at which the run ends [s]", "2 s"}, &Time::duration,
                    quantity(Dimension::time, at_least(0.0))),
        field<Time>({"smallest", optional,
                     "the smallest part of a step that is tried where the whole does not converge [s]; if not told, "
                     "1e-4 of the step, and a 64th of a linearised one (`newton: n`)",
                     "1 us"},
                    &Time::smallest, quantity(Dimension::time, above(0.0)))}});
}

Time time_of_run(const At& at) {
  const std::optional<At> own = at.top("time");
  return own ? time_of_run().read(*own) : Time{};
}

Type<std::vector<double>> times() { return list<double>("times", quantity(Dimension::time), {1}, check_ascending); }

Type<std::vector<Vec3>> points(Count count) {
  return list<Vec3>("points [x, y, z]", vec3(Dimension::length), count,
                    [](const std::vector<Vec3>& values, const At& at) {
                      for (std::size_t i = 1; i < values.size(); ++i) {
                        if (values[i] == values[i - 1])
                          at.item(i).refuse("is the same point as the one before it", "remove one of them");
                      }
                    });
}

Type<std::vector<double>> lengths(Count count) {
  return list<double>("lengths", quantity(Dimension::length, at_least(0.0)), count, check_ascending);
}

namespace {

/// Of a motor the command may be `inverse`.
Type<Drive> drive(Dimension dimension, bool motor) {
  const Type<double> value = quantity(dimension);
  const Type<Table> table = map<Table>(
      {"a table over time",
       {field<Table>({"times", required, "the ascending times of the values [s]", "[0, 1]"}, &Table::times, times()),
        field<Table>({"values", required,
                      dimension == Dimension::number
                          ? "the value at each time, linear in between"
                          : fmt::format("the value at each time [{}], linear in between", si_unit(dimension)),
                      "[0, 0.02]"},
                     &Table::values, list<double>("values, one per time", value, {1}))},
       {},
       [](const Table& t, const At& at) { check_one_per_time(t.values.size(), t.times.size(), at.child("values")); }});
  const auto read = [=](const At& at) -> Drive {
    if (const std::optional<Samples> own = samples(at, 1)) return Table{own->times, own->values[0]};
    if (at.is(Node::Kind::map)) return table.read(at);
    if (at.is(Node::Kind::scalar) && at.node().text == "external") return External{};
    if (motor && at.is(Node::Kind::scalar) && at.node().text == "inverse") return Sought{};
    const bool word = at.is(Node::Kind::scalar) && at.node().text.find_first_of("0123456789") == std::string::npos;
    if (word || !at.is(Node::Kind::scalar)) {
      const std::string words = motor ? "`inverse` or `external`" : "or `external`";
      const std::string near = at.is(Node::Kind::scalar) ? nearest(at.node().text, {"external", "inverse"}) : "";
      at.refuse(fmt::format("must be {}, {{times, values}}, {{formula}}, {{file, column}}, {}", name(dimension), words),
                near.empty() || (!motor && near == "inverse") ? "" : "did you mean `" + near + "`?");
    }
    return Table{{0.0}, {value.read(at)}};
  };
  return {read, [=] {
            std::vector<Json> any = {value.schema(), Json{{"const", "external"}}, table.schema(), samples_schema(1)};
            if (motor) any.push_back(Json{{"const", "inverse"}});
            return any_of(any);
          }};
}

}  // namespace

Type<Drive> drive(Dimension dimension) { return drive(dimension, false); }
Type<Drive> motor_drive(Dimension dimension) { return drive(dimension, true); }

Type<Span> span(Dimension dimension) {
  const Type<double> value = quantity(dimension);
  const Type<std::vector<double>> pair = list<double>("values [least, most]", value, {2, 2});
  const Type<Span> open =
      map<Span>({"limits",
                 {field<Span>({"least", optional, fmt::format("the least [{}]", si_unit(dimension)), "0"}, &Span::least,
                              Type<double>{value.read, value.schema}),
                  field<Span>({"most", optional, fmt::format("the most [{}]", si_unit(dimension)), "10"}, &Span::most,
                              Type<double>{value.read, value.schema})},
                 {at_least_one({"least", "most"})}});
  const auto read = [=](const At& at) {
    Span own;
    if (at.is(Node::Kind::map)) {
      own = open.read(at);
    } else {
      const std::vector<double> values = pair.read(at);
      own = {values[0], values[1]};
    }
    if (!(own.least <= own.most)) at.refuse("has its least above its most", "give the least first");
    return own;
  };
  return {read, [=] { return any_of({pair.schema(), open.schema()}); }};
}

Type<Track> track(Dimension dimension, int components) {
  const Type<double> one = quantity(dimension);
  const Type<Vec3> three = vec3(dimension);
  const auto read_value = [=](const At& at) -> Eigen::VectorXd {
    if (components == 3) return three.read(at);
    return Eigen::VectorXd::Constant(1, one.read(at));
  };
  const auto schema = [=] { return components == 3 ? three.schema() : one.schema(); };
  const Type<Eigen::VectorXd> value = {read_value, schema};
  const Type<Track> table = map<Track>(
      {"a table over time",
       {field<Track>({"times", required, "the ascending times of the values [s]", "[0, 1]"}, &Track::times, times()),
        field<Track>(
            {"values", required, fmt::format("the value at each time [{}], linear in between", si_unit(dimension)),
             components == 3 ? "[[0, 0, 0], [0, 10 mm, 0]]" : "[0, 1]"},
            &Track::values, list<Eigen::VectorXd>("values, one per time", value, {1}))},
       {},
       [](const Track& t, const At& at) { check_one_per_time(t.values.size(), t.times.size(), at.child("values")); }});
  const auto size = static_cast<std::size_t>(components);
  const auto read = [=](const At& at) {
    if (const std::optional<Samples> own = samples(at, size)) {
      Track track{own->times, {}};
      for (std::size_t i = 0; i < own->times.size(); ++i) {
        Eigen::VectorXd& at_time = track.values.emplace_back(components);
        for (std::size_t k = 0; k < size; ++k) at_time[static_cast<Eigen::Index>(k)] = own->values[k][i];
      }
      return track;
    }
    if (at.is(Node::Kind::map)) return table.read(at);
    return Track{{0.0}, {value.read(at)}};
  };
  return {read, [=] { return any_of({value.schema(), table.schema(), samples_schema(size)}); }};
}

Type<std::variant<int, std::vector<double>>> count_or_lengths(int least, bool from_zero) {
  using Value = std::variant<int, std::vector<double>>;
  const Type<int> count = whole_number(least, 10000);
  const Type<std::vector<double>> several = lengths({from_zero ? 2u : 1u, 10001});
  const auto read = [=](const At& at) -> Value {
    if (!at.is(Node::Kind::list)) return count.read(at);
    std::vector<double> values = several.read(at);
    if (from_zero && values[0] != 0.0) at.item(0).refuse("must be 0, where the rod starts");
    return values;
  };
  const auto show = [](const Value& value) { return Json(std::get<int>(value)); };
  return {read, [=] { return any_of({count.schema(), several.schema()}); }, show};
}

Type<Taper> taper(Dimension dimension, Range range) {
  const Type<double> value = quantity(dimension, range);
  const Type<std::vector<double>> pair = list<double>("two values [start, end]", value, {2, 2});
  const auto read = [=](const At& at) -> Taper {
    if (at.is(Node::Kind::scalar)) return value.read(at);
    if (!at.is(Node::Kind::list)) at.refuse(fmt::format("must be {}, or a pair [start, end]", name(dimension)));
    const std::vector<double> ends = pair.read(at);
    return {ends[0], ends[1]};
  };
  const auto show = [](const Taper& t) { return t.start == t.end ? Json(t.start) : Json{t.start, t.end}; };
  return {read, [=] { return any_of({value.schema(), pair.schema()}); }, show};
}

void check_one_per_time(std::size_t size, std::size_t times, const At& at) {
  if (size != times) {
    at.refuse(fmt::format("must have one entry per time, {}, not {}", times, size),
              "give one entry for each of `times`");
  }
}

void check_from_to(double from, double to, const At& at) {
  if (!(to > from))
    at.child("to").refuse(fmt::format("must be beyond `from`, {} m", from), "measure both from the base");
}

}  // namespace sinew::io
