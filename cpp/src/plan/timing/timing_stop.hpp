#pragma once

#include "mmgrasp/core/monitor.hpp"

namespace mmgrasp::detail {

/// Carries a set stop token out of the inner loops of timing; never leaves time_parameterize() and its kin.
struct TimingStopped {};

inline void end_if_stopped(const StopToken& stop) {
  if (stop.stopped()) throw TimingStopped{};
}

}  // namespace mmgrasp::detail
