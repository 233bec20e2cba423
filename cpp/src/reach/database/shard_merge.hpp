#pragma once

#include <cstdint>
#include <vector>

#include "reach/database/shard_store.hpp"

namespace mmgrasp::detail {

/// Some neighbouring position cells as they go into the database.
struct MergedCells {
  std::vector<std::int32_t> positions;         ///< Three indices each.
  std::vector<std::uint32_t> position_counts;  ///< 6-D cells of each position cell.
  std::vector<std::uint32_t> rotation_ids, cell_counts;
  std::vector<std::uint16_t> configurations;
};

/// Puts the shards' records together, by ranges of position cells that fit into memory.
class ShardMerge {
 public:
  ShardMerge(const ShardStore& store, std::int64_t shards, std::uint32_t rotation_count, int joints, int max_per_cell);

  std::size_t part_count() const { return first_of_part_.size() - 1; }
  std::uint64_t record_count() const { return total_; }
  /// Independent of all other parts; for several threads.
  MergedCells merge(std::size_t part) const;

 private:
  struct Record {
    std::uint64_t cell;   ///< Position cell within the part, and rotation cell.
    std::uint32_t index;  ///< Place in the order of sampling.
  };
  void append_cell(const std::vector<Record>& records, std::size_t begin, std::size_t end,
                   const std::vector<std::uint16_t>& configurations, MergedCells& out) const;

  const ShardStore& store_;
  std::int64_t shards_;
  std::uint64_t rotation_count_;
  std::size_t joints_;
  std::size_t max_per_cell_;
  std::vector<std::uint64_t> keys_;                ///< Keys of all non-empty position cells, ascending.
  std::vector<std::size_t> first_of_part_;         ///< Indices into keys_, and the end.
  std::vector<std::vector<std::size_t>> starts_;   ///< Each shard's first position cell, by part.
  std::vector<std::vector<std::size_t>> records_;  ///< Each shard's first record, by part.
  std::uint64_t total_ = 0;
};

}  // namespace mmgrasp::detail
