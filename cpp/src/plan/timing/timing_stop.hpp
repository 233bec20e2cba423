#pragma once

#include "mmgrasp/core/monitor.hpp"

namespace mmgrasp::detail {

/// Thrown out of the inner loops of timing when the cancel token is set; never leaves the public functions.
struct TimingStopped {};

inline void end_if_stopped(const CancelToken& stop) {
  if (stop.stopped()) throw TimingStopped{};
}

}  // namespace mmgrasp::detail
