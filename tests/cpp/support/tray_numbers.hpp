#pragma once

#include <vector>

#include "mmgrasp/task/ids.hpp"

namespace mmgrasp::testing_support {

/// Trays as plain numbers, to compare them with lists written out.
inline std::vector<int> numbers(const std::vector<TrayId>& trays) {
  return {trays.begin(), trays.end()};
}

}  // namespace mmgrasp::testing_support
