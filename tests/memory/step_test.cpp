// Steps ask for no memory after the first ones. Counted where the C library hands it out, so that nothing is missed;
// a program of its own, since it stands in for malloc. Sanitizers do so, too, and leave this out.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict"  // GCC 12 sees overlaps in std::string where malloc is not its own
#endif

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

#include "sinew/io/mesh_file.hpp"
#include "sinew/sim/inverse.hpp"
#include "sinew/solve/border_order.hpp"
#include "support/robots.hpp"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SINEW_COUNTS_MEMORY
#endif

#ifdef SINEW_COUNTS_MEMORY
namespace {
bool counting = false;
constexpr long kAll = std::numeric_limits<long>::max();
long counted = 0, granted = kAll;  ///< pieces, and how many there are

/// False where there is no more.
bool count() {
  if (!counting) return true;
  return counted++ < granted;
}
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) { return count() ? __libc_malloc(size) : nullptr; }
void* calloc(std::size_t number, std::size_t size) { return count() ? __libc_calloc(number, size) : nullptr; }
void* realloc(void* old, std::size_t size) { return count() ? __libc_realloc(old, size) : nullptr; }
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return count() ? __libc_memalign(alignment, size) : nullptr;
}
}

namespace sinew::test {
namespace {

/// What five steps ask for after the first, in pieces.
template <class Step>
long pieces_of(const Step& step) {
  EXPECT_TRUE(accepted(step().status));
  counted = 0;
  for (int i = 0; i < 5; ++i) {
    counting = true;
    const StepReport report = step();
    counting = false;
    EXPECT_TRUE(accepted(report.status)) << to_string(report.status);
    EXPECT_FALSE(report.rotated);
  }
  return counted;
}

long pieces(const Scene& scene, const MeshReader& meshes, Evaluation evaluation, int threads = 1) {
  const Model model = build(scene, meshes);
  Workspace workspace = make_workspace(model, threads);
  State state = initial_state(model);
  return pieces_of([&] { return advance(model, workspace, state, {evaluation}); });
}

TEST(Memory, IsCounted) {
  counted = 0;
  counting = true;
  void* volatile own = std::malloc(8);
  delete new int;
  counting = false;
  std::free(own);
  EXPECT_EQ(counted, 2);
}

TEST(Memory, SolidsWithCablesAskForNone) {
  for (const Cable kind : {Cable::cosserat, Cable::geometric}) {
    for (const int iterations : {1, 2, 0}) {
      Scene scene = cable_block();
      scene.rods[0].second.cable = kind;
      scene.newton.iterations = iterations;
      EXPECT_EQ(pieces(scene, read_block, Evaluation::full), 0) << iterations;
      if (iterations > 0) EXPECT_EQ(pieces(scene, read_block, Evaluation::motion), 0) << iterations;
    }
  }
}

TEST(Memory, RobotsAskForNone) {
  const std::filesystem::path meshes = SINEW_SHARED_MESHES;
  EXPECT_EQ(pieces(block(), block_of(300), Evaluation::motion), 0);
  Scene single = block();
  single.newton.precision = linalg::Precision::float32;
  EXPECT_EQ(pieces(single, block_of(300), Evaluation::full), 0);
  if (!std::filesystem::exists(meshes / "finger.vtk")) GTEST_SKIP() << "no finger.vtk in " << meshes;
  EXPECT_EQ(pieces(finger(meshes, 6, 7, Cable::cosserat), io::read_mesh, Evaluation::motion), 0);
  EXPECT_EQ(pieces(finger(meshes, 1, 15, Cable::geometric), io::read_mesh, Evaluation::motion), 0);
  // (Steps that are judged ask for some where there is something to warn of: here two cables push.)
  EXPECT_EQ(pieces(trunk(meshes, 10), io::read_mesh, Evaluation::motion), 0);
}

TEST(Memory, ThreadsAskForNone) { EXPECT_EQ(pieces(block(), block_of(4000), Evaluation::motion, 2), 0); }

TEST(Memory, InverseStepsAskForNone) {
  Scene scene = block();
  const Vec3 tip(50 * mm, 5 * mm, 5 * mm);
  add_target(scene, tip, 10.0);
  const Model model = build(scene, block_of(300));
  Workspace workspace = make_workspace(model);
  State state = initial_state(model);
  const Command command{{0.0}, {}};
  Goal goal = {tip + 0.1 * mm * Vec3::UnitY()};
  const auto pieces = [&] {
    return pieces_of([&] { return inverse_step(model, workspace, goal, command, scene.time.step, state); });
  };
  EXPECT_EQ(pieces(), 0);
  // But to list the limits that are in the way.
  goal.at.y() -= 10 * mm;
  EXPECT_LE(pieces(), 5);
}

/// A step that finds ever more memory, until it is enough: the state stays, and the workspace can be used again. (But
/// for matrices that change their size: Eigen 3.4 loses track of one that finds no memory then.)
void expect_to_stay(const Model& model, const State& start, const Told& told = {}) {
  const std::vector<double> before = pack(start);
  Workspace other = make_workspace(model);
  State expected = start;
  ASSERT_TRUE(accepted(advance(model, other, expected, {}, told).status));
  const std::vector<double> after = pack(expected);
  long refused = 0;
  for (bool done = false; !done; ++refused) {
    Workspace workspace = make_workspace(model);
    State state = start;
    counted = 0;
    granted = refused;
    counting = true;
    try {
      const StepReport report = advance(model, workspace, state, {}, told);
      counting = false;
      done = accepted(report.status);
      EXPECT_TRUE(done) << to_string(report.status) << " for want of memory";
    } catch (const std::bad_alloc&) {
      counting = false;
      ASSERT_EQ(pack(state), before) << refused;
    }
    granted = kAll;
    if (!done) ASSERT_TRUE(accepted(advance(model, workspace, state, {}, told).status)) << refused;
    ASSERT_EQ(pack(state), after) << refused;
  }
  EXPECT_GT(refused, 50);
}

TEST(Memory, StatesStayWhereThereIsNoMore) {
  for (const int iterations : {1, 0}) {
    Scene scene = cable_block();
    scene.newton.iterations = iterations;
    const Model model = build(scene, read_block);
    expect_to_stay(model, initial_state(model));
  }
}

/// Also where there is a limit in the way, and the report lists it.
TEST(Memory, StatesOfInverseStepsStayWhereThereIsNoMore) {
  Scene scene = block();
  const Vec3 tip(50 * mm, 5 * mm, 5 * mm);
  add_target(scene, tip, 0.01);
  const Model model = build(scene, block_of(300));
  const Goal goal = {tip + 10 * mm * Vec3::UnitY()}, other = {tip - 10 * mm * Vec3::UnitY()};
  State state = initial_state(model);
  Workspace workspace = make_workspace(model);
  const std::size_t one = advance(model, workspace, state, {}, {nullptr, &goal}).aim.binding.size();
  state = initial_state(model);
  EXPECT_EQ(one + advance(model, workspace, state, {}, {nullptr, &other}).aim.binding.size(), 2);
  for (const Goal* own : {&goal, &other}) expect_to_stay(model, initial_state(model), {nullptr, own});
}

/// An abscissa that reaches another section of its rod is attached elsewhere.
TEST(Memory, OtherOrdersOfABorderAskForNone) {
  std::array<solve::CoupledProblem, 2> problems;
  for (std::size_t n = 0; n < 2; ++n) {
    solve::CoupledProblem& own = problems[n];
    own.r.setZero(40);
    own.c.setZero(40);
    own.chains.resize(1);
    for (int i = 0; i < 80; ++i) own.chains[0].at.push_back(n == 0 ? i : 79 - i);
  }
  solve::BorderOrder order;
  for (const solve::CoupledProblem& own : problems) order.set(own);
  const std::vector<int> before = order.place();
  counted = 0;
  counting = true;
  for (const solve::CoupledProblem& own : problems) order.set(own);
  counting = false;
  EXPECT_EQ(counted, 0);
  EXPECT_EQ(order.place(), before);
}

TEST(Memory, SolidsOfAllKindsAskForNone) {
  for (const solid::Kind kind : {solid::Kind::tet4, solid::Kind::tet10, solid::Kind::hex8}) {
    for (const solid::Law& law :
         {solid::Law(solid::corotational(1e5, 0.3)), solid::Law(solid::neo_hookean(1e5, 0.3))}) {
      Scene scene;
      scene.time = {0.01, 1.0};
      Solid body;
      body.mesh = "block";
      body.material.law = law;
      body.density = 1000.0;
      body.rayleigh = {0.1, 0.02};
      body.fixed.push_back({Plane{Vec3::Zero(), Vec3::UnitX()}});
      scene.solids.emplace_back("body", body);
      const auto mesh = [&](const auto&) { return block_mesh(3, 2, 2, Vec3(0.05, 0.01, 0.01), kind); };
      EXPECT_EQ(pieces(scene, mesh, Evaluation::full), 0);
    }
  }
}

TEST(Memory, RodsAloneAskForNone) {
  for (const int order : {0, 2}) {
    Scene scene;
    scene.time = {0.01, 1.0};
    Rod rod;
    rod.path = {Vec3::Zero(), Vec3(0.3, 0, 0)};
    rod.sections = 5;
    rod.order = {order, order, order, 0, 0, 0};
    rod.section = Circle{1e-3};
    rod.material = {1e8, 0.4, 1100.0};
    scene.rods.emplace_back("rod", rod);
    EXPECT_EQ(pieces(scene, read_block, Evaluation::full), 0) << order;
  }
}

}  // namespace
}  // namespace sinew::test
#endif
