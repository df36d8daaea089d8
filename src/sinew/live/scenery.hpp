// What can be seen of a model, once, and of its states, again and again.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sinew/live/message.hpp"
#include "sinew/live/request.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/sim/state.hpp"
#include "sinew/sim/targets.hpp"

namespace sinew::live {

/// Surfaces, rods, bodies and names of a model, as messages. Keeps memory; one thread at a time.
class Scenery {
 public:
  explicit Scenery(const Model& model);

  /// All signals of a run: of each time those in their order.
  struct History {
    std::vector<double> times, values;
  };
  /// Rest positions of surfaces, triangles, names, units, what motors can do. `more` joins its head.
  std::string scene(const nlohmann::ordered_json& more, const History& history = {});

  /// Where everything is: of solids 16 bits per coordinate of how far surface nodes have moved since t = 0, to 1/32767
  /// of the farthest; rods, bodies, contacts, points, outputs; fields that are shown, under their own names; signals,
  /// those of energies NaN unless they are shown: they cost more than all else. `more` joins its head.
  std::string frame(const State& state, const Show& show, const Goal& goal, const nlohmann::ordered_json& more);

 private:
  struct Skin {
    std::vector<int> nodes;                ///< of the surface, in their order
    std::vector<std::uint32_t> triangles;  ///< over these
    std::vector<int> cells;                ///< that have one of these
    std::vector<std::vector<int>> around;  ///< per node: numbers among `cells`
    int front = 0;
  };
  void tell_goal(const State& state, const Goal& goal, std::vector<double>& signals) const;
  void add_solid_field(const State& state, int number, const std::string& field);

  const Model& model_;
  std::vector<Skin> skins_;
  std::vector<std::vector<double>> abscissae_;  ///< [m] at which rods are shown
  std::vector<std::size_t> target_signals_;     ///< first of each effector's signals: its components, then how far off
  std::vector<SignalGroup> signals_;
  Message message_;
  std::vector<float> floats_;
  std::vector<std::int16_t> shorts_;
};

/// [SI] range of what a motor is told, for a slider: its limits, else what the scene tells it and somewhat beyond.
Span slider_span(const Model& model, const ActuatorModel& actuator);

}  // namespace sinew::live
