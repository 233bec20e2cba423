#include "mmgrasp/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/worker_thread.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

constexpr int kMostThreads = 1024;  // Workers have scratch of their own: more would only fill the memory.

/// What the workers of one call share.
struct Loop {
  std::size_t count;
  const std::function<void(std::size_t, int)>& work;
  const Monitor& monitor;
  const char* stage;
  const CancelToken* interruption;  ///< Token of the calling thread.
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  std::atomic<bool> failed{false};
  std::mutex mutex{};
  std::exception_ptr exception{};
  std::size_t exception_item = 0;

  /// Items are handed out in order and every one handed out is finished, so the lowest item that throws always runs:
  /// keeping its exception makes the error the same at any thread count.
  void keep_exception(std::size_t item) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (!exception || item < exception_item) {
      exception = std::current_exception();
      exception_item = item;
    }
    failed.store(true);
  }

  void run_elsewhere(int worker) {
    std::optional<detail::InterruptionScope> scope;
    if (interruption != nullptr) scope.emplace(*interruption);
    run(worker);
  }

  void run(int worker) {
    double reported = -1;
    while (!failed.load(std::memory_order_relaxed) && !monitor.stopped()) {
      if (interruption != nullptr && interruption->stopped()) break;
      const std::size_t item = next.fetch_add(1);
      if (item >= count) break;
      try {
        work(item, worker);
      } catch (...) {
        keep_exception(item);
        break;
      }
      const double fraction = static_cast<double>(done.fetch_add(1) + 1) / static_cast<double>(count);
      if (worker == 0 && fraction - reported >= 0.005) {
        monitor.report(stage, fraction);
        reported = fraction;
      }
    }
  }
};

}  // namespace

int resolve_threads(int threads) {
  require(threads >= 0 && threads <= kMostThreads, "threads", std::to_string(threads),
          "must be 0 (all) or positive, at most " + std::to_string(kMostThreads));
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

bool parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, int)>& work,
                  const Monitor& monitor, const char* stage) {
  const int workers = static_cast<int>(std::min<std::size_t>(resolve_threads(threads), count));
  Loop loop{count, work, monitor, stage, detail::interruption_token()};
  {
    const bool beside = workers > 1 && detail::processors_idle(workers - 1);
    std::deque<detail::WorkerThread> pool;
    try {
      for (int worker = 1; worker < workers; ++worker)
        pool.emplace_back(worker, workers, beside, [&loop, worker] { loop.run_elsewhere(worker); });
    } catch (...) {  // the system gives no more threads: go on with those that started
    }
    loop.run(0);
  }
  if (loop.exception) std::rethrow_exception(loop.exception);
  if (loop.done.load() < count) {
    if (!monitor.stopped()) detail::throw_if_interrupted();  // nobody looks whether a silent loop was stopped
    return false;
  }
  monitor.report(stage, 1.0);
  return true;
}

}  // namespace mmgrasp
