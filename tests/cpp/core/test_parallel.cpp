#include "mmgrasp/core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

using namespace mmgrasp;

TEST(ParallelFor, RunsEachItemOnceAndIsTheSameAtAnyThreadCount) {
  std::vector<double> expected;
  for (const int threads : {1, 2, 5}) {
    std::vector<double> values(1000, -1);
    std::atomic<int> calls{0};
    std::atomic<bool> worker_in_range{true};
    EXPECT_TRUE(parallel_for(values.size(), threads, [&](std::size_t item, int worker) {
      ++calls;
      if (worker < 0 || worker >= threads) worker_in_range = false;
      values[item] = Rng(42, item).uniform();
    }));
    EXPECT_EQ(calls, 1000);
    EXPECT_TRUE(worker_in_range);
    if (expected.empty()) expected = values;
    EXPECT_EQ(values, expected);
  }
}

TEST(ParallelFor, RethrowsTheLowestItemThatThrew) {
  for (const int threads : {1, 2, 4}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      std::string message;
      try {
        parallel_for(200, threads, [](std::size_t item, int) {
          if (item % 50 == 17) throw std::runtime_error("item " + std::to_string(item));
        });
      } catch (const std::runtime_error& error) {
        message = error.what();
      }
      EXPECT_EQ(message, "item 17");
    }
  }
}

TEST(ParallelFor, StopsEarlyAndSaysSo) {
  Monitor monitor;
  std::atomic<int> calls{0};
  EXPECT_FALSE(parallel_for(
      100000, 2,
      [&](std::size_t, int) {
        if (++calls == 10) monitor.stop.stop();
      },
      monitor));
  EXPECT_LT(calls, 20);
}

TEST(ParallelFor, ReportsFromTheCallingThreadUpToOne) {
  Monitor monitor;
  const auto caller = std::this_thread::get_id();
  double last = 0;
  bool ordered = true, same_thread = true;
  monitor.progress = [&](const std::string& stage, double fraction) {
    ordered = ordered && fraction >= last && fraction <= 1 && stage == "sampling";
    same_thread = same_thread && std::this_thread::get_id() == caller;
    last = fraction;
  };
  EXPECT_TRUE(parallel_for(
      5000, 3, [](std::size_t, int) {}, monitor, "sampling"));
  EXPECT_TRUE(ordered);
  EXPECT_TRUE(same_thread);
  EXPECT_EQ(last, 1.0);
}

TEST(ParallelFor, EmptyAndBadThreads) {
  EXPECT_TRUE(parallel_for(0, 4, [](std::size_t, int) { FAIL(); }));
  EXPECT_THROW(parallel_for(1, -1, [](std::size_t, int) {}), InvalidInput);
  EXPECT_GE(resolve_threads(0), 1);
  EXPECT_EQ(resolve_threads(3), 3);
}
