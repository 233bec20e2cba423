#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace mmgrasp::detail {

/// Answers of collision checks of numbered configurations (a, a) and of edges (a, b), the same in both directions, each
/// for a `subject`: an opening (the robot with its fingers there, shared by all grasps with it) or a grasp. A hash
/// table with open addressing, for it is queried millions of times.
class CollisionCache {
 public:
  CollisionCache() : entries_(kInitialCapacity) {}

  /// True: free, false: blocked; nothing: not in the cache.
  std::optional<bool> find(int subject, int a, int b) const {
    const Entry& entry = entries_[slot({subject, std::min(a, b), std::max(a, b)})];
    if (entry.subject < 0) return std::nullopt;
    return entry.free;
  }

  /// Overwrites what was there.
  void insert(int subject, int a, int b, bool free) {
    if (2 * (count_ + 1) > entries_.size()) grow();
    const Entry own{subject, std::min(a, b), std::max(a, b), free};
    Entry& entry = entries_[slot(own)];
    if (entry.subject < 0) ++count_;
    entry = own;
  }

 private:
  struct Entry {
    int subject = -1;  ///< -1: an empty slot.
    int low = 0, high = 0;
    bool free = false;
  };
  static constexpr std::size_t kInitialCapacity = 1024;  ///< A power of two, as all capacities.

  /// The slot that holds the entry, or the empty one where it belongs.
  std::size_t slot(const Entry& wanted) const {
    std::uint64_t hash = static_cast<std::uint64_t>(wanted.low) << 32 | static_cast<std::uint32_t>(wanted.high);
    hash = (hash ^ static_cast<std::uint64_t>(wanted.subject) * 0xbf58476d1ce4e5b9ull) * 0x9e3779b97f4a7c15ull;
    std::size_t at = hash >> 32 & (entries_.size() - 1);
    for (;;) {
      const Entry& entry = entries_[at];
      if (entry.subject < 0 ||
          (entry.subject == wanted.subject && entry.low == wanted.low && entry.high == wanted.high))
        return at;
      at = (at + 1) & (entries_.size() - 1);
    }
  }

  void grow() {
    std::vector<Entry> entries(2 * entries_.size());
    entries.swap(entries_);
    for (const Entry& entry : entries)
      if (entry.subject >= 0) entries_[slot(entry)] = entry;
  }

  std::vector<Entry> entries_;
  std::size_t count_ = 0;
};

}  // namespace mmgrasp::detail
