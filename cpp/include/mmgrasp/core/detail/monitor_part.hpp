#pragma once

#include <algorithm>
#include <string>

#include "mmgrasp/core/monitor.hpp"

namespace mmgrasp::detail {

/// A monitor for part of a longer work: what the part reports moves the whole from one fraction to another, and never
/// back. The whole must outlive it.
inline Monitor monitor_part(const Monitor& whole, const std::string& stage, double from, double to) {
  Monitor part;
  part.stop = whole.stop;
  part.progress = [&whole, stage, from, to, most = 0.0](const std::string&, double fraction) mutable {
    most = std::max(most, fraction);
    whole.report(stage, from + (to - from) * most);
  };
  return part;
}

}  // namespace mmgrasp::detail
