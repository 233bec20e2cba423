#include "mmgrasp/core/parallel.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <chrono>
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

namespace {

cpu_set_t usable_processors() {
  cpu_set_t usable;
  CPU_ZERO(&usable);
  EXPECT_EQ(pthread_getaffinity_np(pthread_self(), sizeof usable, &usable), 0);
  return usable;
}

/// How many workers took part, each of which may run on the processors of its caller and no others.
int workers_at_home(int threads) {
  const cpu_set_t home = usable_processors();
  std::atomic<int> started{0};
  std::vector<std::atomic<bool>> took_part(threads);
  const auto begin = std::chrono::steady_clock::now();
  parallel_for(1000, threads, [&](std::size_t, int worker) {
    const cpu_set_t usable = usable_processors();
    EXPECT_TRUE(CPU_EQUAL(&home, &usable));
    if (!took_part[worker].exchange(true)) ++started;
    // Long enough for all to begin, however busy the machine.
    while (started < threads && std::chrono::steady_clock::now() - begin < std::chrono::seconds(20))
      std::this_thread::yield();
  });
  return started;
}

}  // namespace

TEST(ParallelFor, WorkersMayRunWhereTheirCallerMay) {
  for (int round = 0; round < 10; ++round) {
    for (const int threads : {2, 3, 8}) EXPECT_EQ(workers_at_home(threads), threads);
  }
  std::thread([] {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    ASSERT_EQ(pthread_setaffinity_np(pthread_self(), sizeof one, &one), 0);
    EXPECT_EQ(workers_at_home(3), 3);
  }).join();
}
