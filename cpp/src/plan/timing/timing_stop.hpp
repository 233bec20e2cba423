#pragma once

#include "mmgrasp/core/monitor.hpp"

namespace mmgrasp::detail {

/// Carries a set cancel token out of the inner loops of timing; never leaves time_parameterize() and its kin.
struct TimingStopped {};

inline void end_if_stopped(const CancelToken& stop) {
  if (stop.stopped()) throw TimingStopped{};
}

}  // namespace mmgrasp::detail
