#include "sinew/threads/crew.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <vector>

namespace sinew::threads {
namespace {

class EveryCrew : public testing::TestWithParam<int> {};

TEST_P(EveryCrew, DoesEachTaskOnceAndThoseOfTasks) {
  Crew crew(GetParam());
  EXPECT_EQ(crew.size(), GetParam());
  for (int turn = 0; turn < 300; ++turn) {
    std::vector<int> done(40, 0);
    crew.each(5, [&](int i) { crew.each(8, [&](int j) { ++done[static_cast<std::size_t>(8 * i + j)]; }); });
    EXPECT_EQ(done, std::vector<int>(40, 1));
  }
  crew.each(0, [](int) { FAIL(); });
}

TEST_P(EveryCrew, WakesAfterARest) {
  Crew crew(GetParam());
  for (int turn = 0; turn < 3; ++turn) {
    std::atomic<int> sum = 0;
    crew.each(100, [&](int i) { sum += i; });
    EXPECT_EQ(sum, 4950);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST_P(EveryCrew, PassesExceptionsOn) {
  Crew crew(GetParam());
  const auto bad = [](int i) {
    if (i == 7) throw std::runtime_error("seven");
  };
  EXPECT_THROW(crew.each(20, bad), std::runtime_error);
  int done = 0;
  crew.each(1, [&](int) { ++done; });
  EXPECT_EQ(done, 1);
}

INSTANTIATE_TEST_SUITE_P(Sizes, EveryCrew, testing::Values(1, 2, 3, 8));

TEST(Crew, HasNoMoreThanItCanCount) { EXPECT_EQ(Crew(1000).size(), Crew::kMost); }

TEST(Crew, HelpersDoHelp) {
  Crew crew(2);
  std::vector<std::thread::id> by(2);
  // Both tasks wait for each other, so that they cannot be one thread's.
  std::atomic<int> there = 0;
  crew.each(2, [&](int i) {
    by[static_cast<std::size_t>(i)] = std::this_thread::get_id();
    ++there;
    while (there < 2) std::this_thread::yield();
  });
  EXPECT_NE(by[0], by[1]);
}

}  // namespace
}  // namespace sinew::threads
