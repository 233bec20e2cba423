#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mmgrasp::detail {

/// Counts by key in open addressing. count() may be called from many threads while nobody calls increment().
class CellCounter {
 public:
  explicit CellCounter(std::size_t capacity) : slots_(capacity) {}

  int count(std::uint64_t key) const { return slots_[find(key)].count; }

  /// Adds one unless the key has `limit` already; tells whether it did.
  bool increment(std::uint64_t key, int limit) {
    if (2 * (used_ + 1) > slots_.size()) grow();
    Slot& slot = slots_[find(key)];
    if (slot.count >= limit) return false;
    if (slot.count == 0) ++used_;
    slot.key = key;
    ++slot.count;
    return true;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    int count = 0;  ///< 0: free.
  };

  /// The key's slot, or the free one where it belongs. The capacity is a power of two.
  std::size_t find(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = (key * 0x9e3779b97f4a7c15ull) >> 20 & mask;
    while (slots_[slot].count != 0 && slots_[slot].key != key) slot = (slot + 1) & mask;
    return slot;
  }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.count != 0) slots_[find(slot.key)] = slot;
  }

  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

}  // namespace mmgrasp::detail
