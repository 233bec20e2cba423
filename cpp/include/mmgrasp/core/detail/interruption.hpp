#pragma once

#include <exception>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"

namespace mmgrasp::detail {

/// A call without an outcome to say so ended early. Leaves the library where an InterruptionScope was opened only.
class MMGRASP_EXPORT Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

/// While it lives, long work on this thread that takes no Monitor of its own (reading and building of meshes, solids,
/// cells) ends with Interrupted soon after `stop` is set. parallel_for() hands it on to its workers.
class MMGRASP_EXPORT InterruptionScope {
 public:
  explicit InterruptionScope(const CancelToken& stop);
  ~InterruptionScope();
  InterruptionScope(const InterruptionScope&) = delete;
  InterruptionScope& operator=(const InterruptionScope&) = delete;

 private:
  CancelToken stop_;
  const CancelToken* outer_;
};

/// The token of the innermost scope on this thread, or null.
MMGRASP_EXPORT const CancelToken* interruption_token();

/// Throws Interrupted once the scope's token is set: for loops, after some 0.1 ms of work each time.
MMGRASP_EXPORT void throw_if_interrupted();

/// The same for loops whose steps are short: asks once in `every` calls.
class InterruptionPoll {
 public:
  explicit InterruptionPoll(unsigned every = 4096) : every_(every) {}
  void operator()() {
    if (++calls_ % every_ == 0) throw_if_interrupted();
  }

 private:
  unsigned every_, calls_ = 0;
};

}  // namespace mmgrasp::detail
