#include "sinew/sim/first_step.hpp"

#include "sinew/sim/modal.hpp"
#include "sinew/sim/run.hpp"

namespace sinew {

FirstSolve begin_run(const Model& model, Workspace& workspace) {
  if (model.scene.analysis == Analysis::dynamic) return {};
  FirstSolve first = first_solve(model, workspace);
  State start = initial_state(model);
  // (A pendulum that starts level is one whose weight does nothing at first.)
  if (model.scene.analysis == Analysis::quasi_static && first.report.status == Status::singular)
    first.report = advance(model, workspace, start);
  if (model.scene.analysis == Analysis::modal) first.report = modal_step(model, workspace, start).report;
  return first;
}

}  // namespace sinew
