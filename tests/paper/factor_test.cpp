// Factors of the robots' own matrices: backward errors, and compliances beside dense ones. The worst are those of
// equilibria near incompressibility, which no inertia props up, and those with points of which all nodes are held.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "sinew/io/mesh_file.hpp"
#include "sinew/sim/linearization.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/solid_matrix.hpp"
#include "sinew/solve/border_order.hpp"
#include "support/meshes.hpp"
#include "support/robots.hpp"

namespace sinew::test {
namespace {

struct Sample {
  const char* name;
  Scene scene;
  MeshReader meshes;
};

Scene nearly_incompressible(Scene scene) {
  scene.analysis = Analysis::quasi_static;
  scene.solids[0].second.material.law = solid::corotational(500e3, 0.4999);
  return scene;
}

std::vector<Sample> samples() {
  Scene sprung = block();
  sprung.solids[0].second.springs.push_back({Plane{Vec3(0.05, 0, 0), Vec3::UnitX()}, Vec3::Constant(1e9)});
  Scene guided = block();  // points with one coordinate, or two, of their nodes held
  guided.solids[0].second.fixed.push_back({Plane{Vec3::Zero(), Vec3::UnitY()}, {false, true, false}});
  guided.solids[0].second.fixed.push_back({Plane{Vec3(0, 0, 0.01), Vec3::UnitZ()}, {false, false, true}});
  const MeshReader small = block_of(1500);
  return {
      {"finger", finger(SINEW_SHARED_MESHES, 15, 15, Cable::cosserat), io::read_mesh},
      {"finger at rest", nearly_incompressible(finger(SINEW_SHARED_MESHES, 15, 15, Cable::cosserat)), io::read_mesh},
      {"trunk", trunk(SINEW_SHARED_MESHES, 21), io::read_mesh},
      {"trunk at rest", nearly_incompressible(trunk(SINEW_SHARED_MESHES, 10)), io::read_mesh},
      {"block beside stiff springs", sprung, small},
      {"block on guides", guided, small}};
}

TEST(Factor, OfScenesHasSmallBackwardErrors) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const Model model = build(sample.scene, sample.meshes);
    const SolidModel& solid = model.solids[0];
    State state = initial_state(model);
    Workspace workspace = make_workspace(model);
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(accepted(advance(model, workspace, state).status));
    const StepContext context =
        make_context(model, state, command_at(model, state.time + model.scene.time.step), model.scene.time.step);
    linalg::SparseFactor factor(solid.fronts);
    assemble(solid, context.start_of(0), state.solids[0].x, solid::Tangent::definite, factor.values());
    const Eigen::MatrixXd A = Eigen::MatrixXd(factor.assembled()).selfadjointView<Eigen::Lower>();
    std::copy_n(solid.border.valuePtr(), solid.border.nonZeros(), factor.border_values());
    ASSERT_TRUE(factor.factor());
    std::srand(1);
    const Eigen::VectorXd b = Eigen::VectorXd::Random(A.rows()), x = factor.solve(b);
    const double norm = A.cwiseAbs().rowwise().sum().maxCoeff();
    const double error =
        (A * x - b).lpNorm<Eigen::Infinity>() / (norm * x.lpNorm<Eigen::Infinity>() + b.lpNorm<Eigen::Infinity>());
    EXPECT_LT(error, 1e-12);
    Eigen::MatrixXd W;
    W = factor.compliance();
    // Beside a dense factor, refined. At a condition of 1e9 and more any factor is off by more than 1e-10: then no
    // further than a dense one by itself.
    const Eigen::MatrixXd H = solid.border;
    const Eigen::LLT<Eigen::MatrixXd> dense(A);
    Eigen::MatrixXd X = dense.solve(H.transpose());
    const Eigen::MatrixXd unrefined = H * X;
    X += dense.solve(H.transpose() - A * X);
    const double apart = (W - H * X).norm() / W.norm();
    const double dense_apart = (unrefined - H * X).norm() / W.norm();
    EXPECT_LT(apart, std::max(1e-10, 4.0 * dense_apart));
    if (sample.scene.analysis == Analysis::dynamic) EXPECT_LT(apart, 1e-10);
    RecordProperty(std::string("backward_") + sample.name, std::to_string(error * 1e16) + "e-16");
    RecordProperty(std::string("W_") + sample.name, std::to_string(apart * 1e12) + "e-12");

    StageTimes times;
    Linearization here;
    here.evaluate(context, state, times);
    std::string failed;
    ASSERT_TRUE(here.factor(solid::Tangent::definite, Linearization::Wanted::any, failed)) << failed;
    const Eigen::MatrixXd& own = here.reduced().problem.volumes[0].W;
    const Eigen::MatrixXd rest = own - W.topLeftCorner(own.rows(), own.cols());
    EXPECT_LT(Eigen::MatrixXd(rest.triangularView<Eigen::Lower>()).norm(), 1e-12 * W.norm());
    ASSERT_TRUE(here.factor(solid::Tangent::exact, Linearization::Wanted::any, failed)) << failed;
    Increment increment;
    here.solve(increment);
    EXPECT_TRUE(increment.reduced.ok);
    EXPECT_LT(increment.reduced.residual, 1e-12);
    RecordProperty(std::string("dense_") + sample.name, std::to_string(dense_apart * 1e12) + "e-12");
    RecordProperty(std::string("coupled_") + sample.name, std::to_string(increment.reduced.residual * 1e16) + "e-16");
  }
}

/// The abscissae of a cable are tied to its own points alone. Where these follow one another in the border, a third of
/// its factorisation falls away.
TEST(Border, CablesFollowOneAnother) {
  const Model model = build(trunk(SINEW_SHARED_MESHES, 10), io::read_mesh);
  const State state = initial_state(model);
  const StepContext context = make_context(model, state, command_at(model, 0.0), model.scene.time.step);
  StageTimes times;
  Linearization here;
  here.evaluate(context, state, times);
  std::string failed;
  ASSERT_TRUE(here.factor(solid::Tangent::exact, Linearization::Wanted::any, failed)) << failed;
  const solve::CoupledProblem& problem = here.reduced().problem;
  ASSERT_EQ(problem.chains.size(), 4U);
  solve::BorderOrder order;
  order.set(problem);
  int next = 0;
  for (const solve::ChainPart& part : problem.chains) {
    std::vector<int> rows;
    for (const int own : part.at) {
      if (order.yields(own)) rows.push_back(order.place()[static_cast<std::size_t>(own)]);
    }
    std::sort(rows.begin(), rows.end());
    ASSERT_EQ(rows.size(), 30U);
    EXPECT_EQ(rows.front(), next);
    EXPECT_EQ(rows.back(), next + 29);
    for (const int own : part.at) {
      const auto place = static_cast<std::size_t>(order.place()[static_cast<std::size_t>(own)]);
      if (!order.yields(own)) EXPECT_EQ(order.begin()[place], next);
    }
    next += 30;
  }
}

}  // namespace
}  // namespace sinew::test
