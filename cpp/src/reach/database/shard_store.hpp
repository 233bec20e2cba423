#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reach/database/sample_shard.hpp"

namespace mmgrasp::detail {

/// The shards of a build: in memory, or each in a file of its own, so that an interrupted build goes on where it was.
class ShardStore {
 public:
  /// An empty folder name keeps everything in memory. Files of another key or with damage are not taken for shards.
  ShardStore(const std::string& folder, const std::string& key, std::int64_t shards, int joints);

  bool has(std::int64_t shard) const { return present_[shard] != 0; }
  /// Different shards may be put by different threads at once. A file is whole or not there.
  void put(std::int64_t shard, ShardRecords&& records);
  /// Cells of a shard's position cells and their records; in files the arrays of records are empty.
  const ShardRecords& directory(std::int64_t shard) const { return shards_[shard]; }
  /// Keys of the cells of all records.
  std::vector<std::uint64_t> cell_keys(std::int64_t shard) const;
  void read(std::int64_t shard, std::size_t first, std::size_t count, std::uint32_t* rotation_ids,
            std::uint16_t* configurations) const;

 private:
  std::string path_of(std::int64_t shard) const;
  bool load(std::int64_t shard);

  std::string folder_, key_;
  std::size_t joints_;
  std::vector<ShardRecords> shards_;
  std::vector<std::size_t> records_;
  std::vector<char> present_;
};

}  // namespace mmgrasp::detail
