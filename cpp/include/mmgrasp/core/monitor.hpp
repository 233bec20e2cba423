#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Shared flag that ends long calls early; copies refer to the same flag. Safe to set from any thread.
///
///     Monitor monitor;
///     std::thread watch([stop = monitor.stop]() mutable { if (user_gave_up()) stop.stop(); });
///     plan_motion(checker, start, {goal}, {}, monitor);  // ends soon after, with Outcome::stopped
class MMGRASP_EXPORT CancelToken {
 public:
  CancelToken() : flag_(std::make_shared<std::atomic<bool>>(false)) {}
  void stop() { flag_->store(true, std::memory_order_relaxed); }
  bool stopped() const { return flag_->load(std::memory_order_relaxed); }

 private:
  std::shared_ptr<std::atomic<bool>> flag_;
};

/// What a long call is handed to report and to be ended: passed by const reference, defaulted to "silent, never ends".
struct MMGRASP_EXPORT Monitor {
  CancelToken stop;
  /// Called from the calling thread only, with the stage's name and a fraction in [0, 1]. Must not throw.
  std::function<void(const std::string& stage, double fraction)> progress;

  void report(const std::string& stage, double fraction) const {
    if (progress) progress(stage, fraction);
  }
  bool stopped() const { return stop.stopped(); }
};

}  // namespace mmgrasp
