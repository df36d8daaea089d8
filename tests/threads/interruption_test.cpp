#include "sinew/threads/interruption.hpp"

#include <gtest/gtest.h>

#include "sinew/threads/crew.hpp"

namespace sinew::threads {
namespace {

TEST(Interruption, WithoutOneNothingIsInterrupted) {
  EXPECT_EQ(Interruption::current(), nullptr);
  EXPECT_FALSE(Interruption::asked_to_end());
  EXPECT_NO_THROW(Interruption::check());
}

TEST(Interruption, EndsLoopsOfItsThreadAndStays) {
  std::atomic<bool> asked = false;
  {
    const Interruption interruption([&] { return asked.load(); });
    EXPECT_NO_THROW(Interruption::check());
    asked = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(25));  // (it asks every 20 ms)
    EXPECT_THROW(Interruption::check(), Interrupted);
    asked = false;
    EXPECT_THROW(Interruption::check(), Interrupted) << "who was interrupted does not go on";
  }
  EXPECT_NO_THROW(Interruption::check());
}

TEST(Interruption, AsksRarely) {
  int times = 0;
  const Interruption interruption([&] {
    ++times;
    return false;
  });
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
  int checks = 0;
  for (; std::chrono::steady_clock::now() < end; ++checks) Interruption::check();
  EXPECT_GE(times, 1);
  EXPECT_LE(times, 4);
  EXPECT_GT(checks, 100);
}

TEST(Interruption, TheInnermostCounts) {
  const Interruption outer([] { return true; });
  {
    const Interruption inner([] { return false; });
    EXPECT_NO_THROW(Interruption::check());
  }
  EXPECT_THROW(Interruption::check(), Interrupted);
}

TEST(Interruption, EndsWorkThatACrewShares) {
  for (const int size : {1, 2, 4}) {
    Crew crew(size);
    std::atomic<int> done = 0;
    std::atomic<bool> asked = false;
    const auto work = [&] {
      const Interruption interruption([&] { return asked.load(); });
      crew.each(1000, [&](int) {
        crew.each(2, [](int) { std::this_thread::sleep_for(std::chrono::microseconds(500)); });
        if (++done == 10) asked = true;
      });
    };
    EXPECT_THROW(work(), Interrupted);
    EXPECT_LT(done, 400) << size << " threads";  // 1000 take a second and more; it asks every 20 ms
    std::atomic<int> afterwards = 0;
    crew.each(50, [&](int) { ++afterwards; });
    EXPECT_EQ(afterwards, 50) << "helpers work on for others";
  }
}

}  // namespace
}  // namespace sinew::threads
