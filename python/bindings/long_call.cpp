#include "long_call.hpp"

#include <pthread.h>
#include <atomic>
#include <chrono>
#include <thread>

#include "mmgrasp/core/detail/stopwatch.hpp"

namespace mmgrasp::python {
namespace {

// When the interpreter ends, threads of Python's own that come back from a long call are killed by unwinding their
// stacks, which no C++ frame survives. So the calls of other threads are ended before, and their threads go to sleep.
std::atomic<bool> g_closing{false};
std::atomic<std::thread::id> g_closer;  // the thread that ends the interpreter: it never sleeps
std::atomic<int> g_waiting{0};          // calls of any thread that have not gone to sleep

struct Waiting {
  Waiting() { ++g_waiting; }
  ~Waiting() { --g_waiting; }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;
};

constexpr std::chrono::milliseconds kPoll(30);
constexpr int kMostPolls = 100;  // The interpreter waits this often for calls that do not end.
constexpr double kSilence = 1;   // [s]

void end_calls() {
  g_closer = std::this_thread::get_id();
  g_closing = true;
  const py::gil_scoped_release release;
  for (int i = 0; i < kMostPolls && g_waiting > 0; ++i) std::this_thread::sleep_for(kPoll);
}

bool must_sleep() {
  return g_closing && g_closer.load() != std::this_thread::get_id();
}

/// What a call said last: heard again after a second without news, so that a silent stage is seen to go on.
class RepeatedProgress {
 public:
  /// `news`: what is to be handed over, if anything.
  void repeat_if_silent(std::optional<std::pair<std::string, double>>& news) {
    if (news)
      said_ = news;
    else if (silence_.seconds() >= kSilence)
      news = said_;
    if (news) silence_ = detail::Stopwatch();
  }

 private:
  std::optional<std::pair<std::string, double>> said_;
  detail::Stopwatch silence_;
};

[[noreturn]] void sleep_for_ever() {
  --g_waiting;
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

}  // namespace

void end_calls_at_exit() {
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_calls));
  pthread_atfork(nullptr, nullptr, [] { g_waiting = 0; });  // a forked child has none of the other threads
}

bool LongCall::wait() {
  const Waiting waiting;
  RepeatedProgress last;
  try {  // all that runs Python may raise KeyboardInterrupt, and nothing may leave before the thread has ended
    while (true) {
      {
        py::gil_scoped_release release;
        if (must_sleep()) leave();
        std::unique_lock lock(mutex_);
        if (changed_.wait_for(lock, kPoll, [this] { return done_; })) return true;
        last.repeat_if_silent(latest_);
      }
      if (PyErr_CheckSignals() != 0) break;
      hand_over_progress();
    }
  } catch (py::error_already_set& error) {
    error.restore();
  }
  monitor_.stop.stop();
  return false;
}

void LongCall::leave() {
  monitor_.stop.stop();
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return done_; });
  }
  sleep_for_ever();
}

Unlocked::Unlocked() : state_(PyEval_SaveThread()) {
  ++g_waiting;
}

Unlocked::~Unlocked() {
  if (must_sleep()) sleep_for_ever();
  PyEval_RestoreThread(state_);
  --g_waiting;  // not before: while it counts, the interpreter does not end, and a thread that it kills here is a crash
}

void LongCall::hand_over_progress() {
  std::optional<std::pair<std::string, double>> latest;
  {
    std::lock_guard lock(mutex_);
    std::swap(latest, latest_);
  }
  if (latest && !progress_.is_none()) progress_(latest->first, latest->second);
}

}  // namespace mmgrasp::python
