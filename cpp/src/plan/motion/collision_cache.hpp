#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace mmgrasp::detail {

/// Answers of collision checks by configurations (a, a) and edges (a, b), whichever way round, and whom they are about:
/// the robot with its fingers at an opening, shared by all its grasps, or one grasp.
class CollisionCache {
 public:
  CollisionCache() : entries_(kFirst) {}

  /// 1: free, 0: blocked, -1: never looked at.
  int recall(int whom, int a, int b) const {
    const Entry& entry = entries_[slot({whom, std::min(a, b), std::max(a, b)})];
    return entry.whom < 0 ? -1 : entry.free;
  }

  void keep(int whom, int a, int b, bool free) {
    if (2 * (count_ + 1) > entries_.size()) grow();
    const Entry own{whom, std::min(a, b), std::max(a, b), free ? 1 : 0};
    Entry& entry = entries_[slot(own)];
    if (entry.whom < 0) ++count_;
    entry = own;
  }

 private:
  struct Entry {
    int whom = -1;
    int low = 0, high = 0;
    int free = 0;
  };
  static constexpr std::size_t kFirst = 1024;

  std::size_t slot(const Entry& wanted) const {
    std::uint64_t hash = static_cast<std::uint64_t>(wanted.low) << 32 | static_cast<std::uint32_t>(wanted.high);
    hash = (hash ^ static_cast<std::uint64_t>(wanted.whom) * 0xbf58476d1ce4e5b9ull) * 0x9e3779b97f4a7c15ull;
    std::size_t at = static_cast<std::size_t>(hash >> 32) & (entries_.size() - 1);
    for (;;) {
      const Entry& entry = entries_[at];
      if (entry.whom < 0 || (entry.whom == wanted.whom && entry.low == wanted.low && entry.high == wanted.high))
        return at;
      at = (at + 1) & (entries_.size() - 1);
    }
  }

  void grow() {
    std::vector<Entry> entries(2 * entries_.size());
    entries.swap(entries_);
    for (const Entry& entry : entries)
      if (entry.whom >= 0) entries_[slot(entry)] = entry;
  }

  std::vector<Entry> entries_;
  std::size_t count_ = 0;
};

}  // namespace mmgrasp::detail
