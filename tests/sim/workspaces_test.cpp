#include "sinew/sim/workspaces.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "support/scenes.hpp"

namespace sinew {
namespace {

/// Where a block pulled by its cable gets in ten steps, each robot a little more.
std::vector<double> end_of(const Model& model, Workspaces& workspaces, int robot) {
  State state = initial_state(model);
  Command command = command_at(model, 0.0);
  for (int k = 0; k < 10; ++k) {
    const Told told{&command, nullptr};
    command.actuators[0] = 1e-4 * (k + 1) * (1 + 0.1 * robot);
    Workspaces::Loan workspace = workspaces.lend(1 + robot % 2);
    EXPECT_TRUE(accepted(advance(model, *workspace, state, {}, told).status));
  }
  return pack(state);
}

TEST(Workspaces, LetThreadsStepStatesOfOneModelAtTheSameTime) {
  constexpr int kRobots = 6;
  const Model model = build(test::cable_block(), test::read_block);
  Workspaces workspaces(model);
  std::vector<std::vector<double>> alone(kRobots), together(kRobots);
  for (int i = 0; i < kRobots; ++i) alone[i] = end_of(model, workspaces, i);
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < kRobots; ++i) threads.emplace_back([&, i] { together[i] = end_of(model, workspaces, i); });
  }
  for (int i = 0; i < kRobots; ++i) EXPECT_EQ(alone[i], together[i]);
  EXPECT_NE(alone[0], alone[1]);
}

TEST(Workspaces, AreUsedAgain) {
  const Model model = build(test::cable_block(), test::read_block);
  Workspaces workspaces(model);
  const Workspace* first = nullptr;
  {
    Workspaces::Loan one = workspaces.lend();
    first = &*one;
    Workspaces::Loan other = workspaces.lend();
    EXPECT_NE(&*other, first);
  }
  Workspaces::Loan again = workspaces.lend();
  Workspaces::Loan last = workspaces.lend();
  EXPECT_TRUE(&*again == first || &*last == first);
  EXPECT_NE(&*workspaces.lend(2), first);
}

}  // namespace
}  // namespace sinew
