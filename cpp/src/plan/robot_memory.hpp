#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace mmgrasp::detail {

/// What was found out about the robot alone: yes or no for configurations (a, a) and edges (a, b), by the numbers of
/// their configurations and the opening of the fingers. Shared by all grasps with that opening.
class RobotMemory {
 public:
  RobotMemory() : keys_(kFirst, kNone), free_(kFirst, 0) {}

  /// 1: free, 0: blocked, -1: never looked at.
  int recall(int opening, int a, int b) const {
    const std::size_t at = slot(key(opening, a, b));
    return keys_[at] == kNone ? -1 : free_[at];
  }

  void keep(int opening, int a, int b, bool free) {
    if (2 * (count_ + 1) > keys_.size()) grow();
    const std::uint64_t own = key(opening, a, b);
    const std::size_t at = slot(own);
    if (keys_[at] == kNone) ++count_;
    keys_[at] = own;
    free_[at] = free ? 1 : 0;
  }

 private:
  static constexpr std::size_t kFirst = 1024;
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  static std::uint64_t key(int opening, int a, int b) {
    const auto low = static_cast<std::uint64_t>(std::min(a, b)), high = static_cast<std::uint64_t>(std::max(a, b));
    return (static_cast<std::uint64_t>(opening) << 52) | (low << 26) | high;
  }
  std::size_t slot(std::uint64_t key) const {
    const std::size_t mask = keys_.size() - 1;
    std::size_t at = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ull) >> 32) & mask;
    while (keys_[at] != kNone && keys_[at] != key) at = (at + 1) & mask;
    return at;
  }
  void grow() {
    std::vector<std::uint64_t> keys(2 * keys_.size(), kNone);
    std::vector<std::uint8_t> free(keys.size(), 0);
    keys.swap(keys_);
    free.swap(free_);
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (keys[i] == kNone) continue;
      const std::size_t at = slot(keys[i]);
      keys_[at] = keys[i];
      free_[at] = free[i];
    }
  }

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint8_t> free_;
  std::size_t count_ = 0;
};

}  // namespace mmgrasp::detail
