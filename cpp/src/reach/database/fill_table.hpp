#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <shared_mutex>
#include <vector>

#include "reach/database/cell_counter.hpp"

namespace mmgrasp::detail {

/// Which cells are full already, so that no work is spent on what would be dropped in the end. Shards count in their
/// order only, whatever the order they finish in: whoever asks for a shard hears of earlier ones alone, and the answer
/// changes nothing but the time.
class FillTable {
 public:
  explicit FillTable(int limit) : limit_(limit), counter_(1 << 16) {}

  /// Keeps the table as it is while it is asked.
  std::shared_lock<std::shared_mutex> reading() const { return std::shared_lock<std::shared_mutex>(mutex_); }
  bool full(std::uint64_t cell_key) const { return counter_.count(cell_key) >= limit_; }

  void finish(std::int64_t shard, std::vector<std::uint64_t> cell_keys) {
    const std::unique_lock<std::shared_mutex> lock(mutex_);
    waiting_.emplace(shard, std::move(cell_keys));
    for (auto it = waiting_.begin(); it != waiting_.end() && it->first == next_; it = waiting_.erase(it), ++next_)
      for (const std::uint64_t key : it->second) counter_.increment(key, limit_);
  }

 private:
  int limit_;
  mutable std::shared_mutex mutex_;
  CellCounter counter_;
  std::map<std::int64_t, std::vector<std::uint64_t>> waiting_;
  std::int64_t next_ = 0;
};

}  // namespace mmgrasp::detail
