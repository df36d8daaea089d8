// What a page asks for: a small JSON object, {"do": "tell", "actuator": "pull", "value": 0.01}.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sinew/sim/model.hpp"
#include "sinew/sim/step.hpp"

namespace sinew::live {

/// Requests longer than this are refused [bytes].
inline constexpr std::size_t kLongestRequest = 16 * 1024;

/// {"do": "play"}, "pause", "step": one step, "reset": to the start.
struct Play {};
struct Pause {};
struct Step {};
struct Reset {};
/// {"do": "speed", "value": 0.5}: of the time of the scene by that of the wall; from 0.001 to 1000.
struct Speed {
  double value = 1.0;
};
/// {"do": "tell", "actuator": name, "value": SI or null}: what a motor is to do; null: what the scene says.
struct Tell {
  int actuator = 0;
  std::optional<double> value;
};
/// {"do": "aim", "target": name, "at": [x, y, z] or null}: where an output is to be [SI]; null: what the scene says.
struct Aim {
  int effector = 0;
  std::optional<Eigen::VectorXd> at;
};
/// {"do": "grip", "solid": name, "node": of its surface, "to": [x, y, z], "stiffness": N/m}.
struct Grab {
  Grip grip;
};
/// {"do": "release"}: the grip.
struct Release {};
/// {"do": "seek", "frame": n}: of a recorded run.
struct Seek {
  long frame = 0;
};
/// {"do": "show", "solids": field, "rods": field, "energies": yes or no}: what is to be told besides where things are;
/// "" nothing. Of several pages, together, all that any of them asks for.
struct Show {
  std::vector<std::string> solids, rods;
  bool energies = false;
};
/// {"do": "ack", "frame": n}: it has been drawn.
struct Ack {
  long frame = 0;
};
using Request = std::variant<Play, Pause, Step, Reset, Speed, Tell, Aim, Grab, Release, Seek, Show, Ack>;

/// What can be shown of solids and rods, in colours: name and unit.
struct Field {
  const char *name, *unit;
};
const std::vector<Field>& solid_fields();
const std::vector<Field>& rod_fields();

/// What either asks for.
Show together(Show one, const Show& other);
/// All there is.
Show everything();

/// Throws InputError where it is none, names what is not there, or holds numbers that are not finite or out of range.
Request read_request(std::string_view text, const Model& model);

}  // namespace sinew::live
