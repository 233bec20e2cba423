#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>

namespace mmgrasp::detail {

/// Passes callbacks from a solver that cannot be interrupted, in a thread of its own, to its caller, in whose thread
/// they run.
/// The caller may leave while the solver computes: the solver then ends at its next callback.
class Handoff {
 public:
  /// Called by the solver: has the caller run `work` meanwhile. False, and nothing was run: the caller has left.
  bool ask(const std::function<void()>& work) {
    std::unique_lock lock(mutex_);
    work_ = &work;
    changed_.notify_all();
    changed_.wait(lock, [&] { return left_ || !work_; });
    return !left_;
  }
  void finish() {
    const std::lock_guard lock(mutex_);
    finished_ = true;
    changed_.notify_all();
  }
  /// Called by the caller: runs what it is asked until the solver has finished (true), or `over` is true while it
  /// computes (false).
  bool serve(const std::function<bool()>& over) {
    std::unique_lock lock(mutex_);
    while (!finished_) {
      if (work_) {
        lock.unlock();
        (*work_)();
        lock.lock();
        work_ = nullptr;
        changed_.notify_all();
      } else if (over()) {
        left_ = true;
        changed_.notify_all();
        return false;
      }
      changed_.wait_for(lock, std::chrono::milliseconds(10), [&] { return finished_ || work_; });
    }
    return true;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  const std::function<void()>* work_ = nullptr;
  bool finished_ = false, left_ = false;
};

}  // namespace mmgrasp::detail
