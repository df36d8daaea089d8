// Natural frequencies and modes of a scene about an equilibrium.
#pragma once

#include "sinew/sim/linearization.hpp"

namespace sinew {

struct NaturalMode {
  double frequency = 0.0;  ///< [Hz]; negative where the equilibrium is unstable: the rate of growth over 2 pi
  Increment shape;         ///< of unit modal mass
};

/// Solves K v = omega^2 M v for all coordinates v that the rows leave free, lowest first; at most `count` modes, with
/// solids those nearest to zero. K is the exact tangent at the state, gravity, loads, tendons and multipliers included;
/// M the mass matrix (solid/body, rod/dynamics).
/// The scene's analysis must be modal. Empty, with the reason in `failed`, where rods have no mass, or loads no
/// potential.
std::vector<NaturalMode> natural_modes(const Model& model, Workspace& workspace, const State& equilibrium, int count,
                                       std::string& failed);

/// Mode number state.grid + 1 as a state: the equilibrium under the loads of t = 0, moved along the mode by a tenth of
/// the scene's size. On failure `next` is `state`.
StepResult modal_step(const Model& model, Workspace& workspace, const State& state);

}  // namespace sinew
