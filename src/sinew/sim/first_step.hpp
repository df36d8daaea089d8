// Whether a run at rest can begin: what `sinew check` looks at.
#pragma once

#include "sinew/sim/statics.hpp"

namespace sinew {

/// The first solve of an analysis at rest by the code of the run, and where its equations cannot be solved the whole
/// step, parts of it included. Status `singular`: the run cannot begin; `free` says what nothing resists, if that is
/// known. Empty for `dynamic`, where inertia resists.
FirstSolve begin_run(const Model& model, Workspace& workspace);

}  // namespace sinew
