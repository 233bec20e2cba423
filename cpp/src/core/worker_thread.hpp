#pragma once

#include <pthread.h>

#include <functional>

namespace mmgrasp::detail {

/// Whether this machine has a processor for each of `more` threads beside all that run now. False where that is not
/// known.
bool processors_idle(int more);

/// A thread that may begin beside its creator. Linux often starts new threads on their creator's processor, where they
/// wait for some milliseconds: loops that are shorter than that then take as long as on one thread.
class WorkerThread {
 public:
  /// The `number`-th of `all` workers that run `work` at once, its creator being number 0. `beside`: it begins on
  /// another of the processors that the creator may use; it may be moved to any of them from then on. Throws
  /// std::system_error when the system gives no more threads.
  WorkerThread(int number, int all, bool beside, std::function<void()> work);
  WorkerThread(const WorkerThread&) = delete;
  WorkerThread& operator=(const WorkerThread&) = delete;
  /// Waits for its end.
  ~WorkerThread();

 private:
  static void* run(void* self);

  std::function<void()> work_;
  cpu_set_t usable_;  ///< Processors that the creator may use.
  bool placed_ = false;
  pthread_t thread_{};
};

}  // namespace mmgrasp::detail
