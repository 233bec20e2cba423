#pragma once

#include <pybind11/pybind11.h>

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "options.hpp"

namespace mmgrasp::python {

namespace py = pybind11;

/// Without the GIL while it lives, for work of at most some tenths of a second: as with a LongCall, the end of the
/// interpreter waits for it, and its thread goes to sleep then.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* state_;
};

/// Runs a long call on a thread of its own, without the GIL. The calling thread waits, hands progress to Python and
/// looks for signals every 30 ms: Ctrl-C sets the cancel token, waits for the call to end, and then raises
/// KeyboardInterrupt. While the call says nothing new, Python hears what it said last once a second.
class LongCall {
 public:
  explicit LongCall(py::object progress) : progress_(function_argument(std::move(progress), "progress")) {
    monitor_.progress = [this](const std::string& stage, double fraction) {
      std::lock_guard lock(mutex_);
      latest_ = {stage, fraction};
    };
  }

  template <typename Function>
  auto run(Function&& work) -> decltype(work(std::declval<const Monitor&>())) {
    using Result = decltype(work(std::declval<const Monitor&>()));
    constexpr bool kNothing = std::is_void_v<Result>;
    std::optional<std::conditional_t<kNothing, bool, Result>> result;
    std::exception_ptr error;
    std::thread thread([&] {
      const detail::InterruptionScope scope(monitor_.stop);
      try {
        if constexpr (kNothing)
          work(monitor_);
        else
          result.emplace(work(monitor_));
      } catch (...) {
        error = std::current_exception();
      }
      std::lock_guard lock(mutex_);
      done_ = true;
      changed_.notify_all();
    });
    const bool python_error = !wait();
    {
      const Unlocked unlocked;
      thread.join();
    }
    if (python_error) throw py::error_already_set();
    if (error) std::rethrow_exception(error);
    hand_over_progress();
    if constexpr (!kNothing) return std::move(*result);
  }

 private:
  /// False when a signal handler or the progress callback raised; the Python error is then set and the call asked to
  /// stop.
  bool wait();
  /// For a thread that the interpreter's end would kill: without the GIL.
  [[noreturn]] void leave();
  void hand_over_progress();

  py::object progress_;
  Monitor monitor_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::optional<std::pair<std::string, double>> latest_;
};

/// Runs work that may take long and reports no progress, so that Ctrl-C ends it: what takes a Monitor by that, all
/// other by detail::throw_if_interrupted(). Work must not touch Python's objects.
template <typename Work>
auto interruptible(Work&& work) {
  return LongCall(py::none()).run([&](const Monitor& monitor) {
    if constexpr (std::is_invocable_v<Work, const Monitor&>)
      return work(monitor);
    else
      return work();
  });
}

/// Registers with Python's atexit that long calls of other threads end before the interpreter does.
void end_calls_at_exit();

}  // namespace mmgrasp::python
