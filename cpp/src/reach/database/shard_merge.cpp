#include "reach/database/shard_merge.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "reach/database/reach_data.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::uint64_t kPartRecords = 1 << 18;
/// So many of a cell are spread over the joints' ranges, the rest follows as drawn: the cost grows with the cell only.
constexpr std::size_t kSpread = 16;

/// Sorts by `cell`, keeping the order of equal ones: least digits first, eleven bits at a time.
template <class Record>
void sort_by_cell(std::vector<Record>& records, std::vector<Record>& spare, std::uint64_t cells) {
  constexpr int kBits = 11;
  constexpr std::size_t kDigits = std::size_t{1} << kBits;
  spare.resize(records.size());
  std::array<std::uint32_t, kDigits> next;
  for (int shift = 0; shift < 64 && (cells - 1) >> shift != 0; shift += kBits) {
    next.fill(0);
    for (const Record& record : records) ++next[record.cell >> shift & (kDigits - 1)];
    std::uint32_t begin = 0;
    for (std::uint32_t& entry : next) {
      const std::uint32_t count = entry;
      entry = begin;
      begin += count;
    }
    for (const Record& record : records) spare[next[record.cell >> shift & (kDigits - 1)]++] = record;
    records.swap(spare);
  }
}

/// Farthest-point order of the first `kSpread`, beginning with the first drawn; joints count by their ranges.
void most_different_first(const std::uint16_t* configurations, std::size_t joints, std::uint32_t* order,
                          std::size_t count) {
  const std::size_t width = (joints + 3) / 4 * 4;
  thread_local std::vector<float> values, apart;
  values.assign(count * width, 0.0f);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < joints; ++k) values[i * width + k] = configurations[order[i] * joints + k];
  apart.assign(count, std::numeric_limits<float>::max());
  thread_local std::vector<std::uint32_t> place;  // where the values of each entry of `order` stand
  place.resize(count);
  for (std::size_t i = 0; i < count; ++i) place[i] = static_cast<std::uint32_t>(i);
  for (std::size_t chosen = 0; chosen + 2 < count && chosen + 1 < kSpread; ++chosen) {
    const float* from = &values[place[chosen] * width];
    std::size_t farthest = chosen + 1;
    for (std::size_t i = chosen + 1; i < count; ++i) {
      const float* at = &values[place[i] * width];
      std::array<float, 4> sums{};
      for (std::size_t k = 0; k < width; k += 4)
        for (std::size_t lane = 0; lane < 4; ++lane) {
          const float difference = at[k + lane] - from[k + lane];
          sums[lane] += difference * difference;
        }
      apart[i] = std::min(apart[i], (sums[0] + sums[1]) + (sums[2] + sums[3]));
      if (apart[i] > apart[farthest]) farthest = i;
    }
    // The others keep their order.
    const auto next = static_cast<std::ptrdiff_t>(chosen + 1), far = static_cast<std::ptrdiff_t>(farthest);
    std::rotate(order + next, order + far, order + far + 1);
    std::rotate(place.begin() + next, place.begin() + far, place.begin() + far + 1);
    std::rotate(apart.begin() + next, apart.begin() + far, apart.begin() + far + 1);
  }
}

}  // namespace

ShardMerge::ShardMerge(const ShardStore& store, std::int64_t shards, std::uint32_t rotation_count, int joints,
                       int max_per_cell)
    : store_(store), shards_(shards), rotation_count_(rotation_count), joints_(joints), max_per_cell_(max_per_cell) {
  std::map<std::uint64_t, std::uint64_t> records;
  for (std::int64_t shard = 0; shard < shards; ++shard) {
    const ShardRecords& directory = store.directory(shard);
    for (std::size_t p = 0; p < directory.position_keys.size(); ++p)
      records[directory.position_keys[p]] += directory.counts[p];
  }
  std::vector<std::size_t> cell(shards, 0), record(shards, 0);
  std::uint64_t in_part = kPartRecords;
  for (const auto& [key, count] : records) {
    if (in_part >= kPartRecords) {
      first_of_part_.push_back(keys_.size());
      starts_.push_back(cell);
      records_.push_back(record);
      in_part = 0;
    }
    for (std::int64_t shard = 0; shard < shards; ++shard) {
      const std::size_t s = shard;
      const ShardRecords& directory = store.directory(shard);
      if (cell[s] >= directory.position_keys.size() || directory.position_keys[cell[s]] != key) continue;
      record[s] += directory.counts[cell[s]++];
    }
    keys_.push_back(key);
    in_part += count;
    total_ += count;
  }
  first_of_part_.push_back(keys_.size());
  starts_.push_back(cell);
  records_.push_back(record);
}

MergedCells ShardMerge::merge(std::size_t part) const {
  const std::size_t first_key = first_of_part_[part], end_key = first_of_part_[part + 1];
  std::size_t total = 0;
  for (std::size_t s = 0; s < static_cast<std::size_t>(shards_); ++s)
    total += records_[part + 1][s] - records_[part][s];
  std::vector<std::uint32_t> rotations(total);
  std::vector<std::uint16_t> configurations(total * joints_);
  std::vector<Record> records(total), spare;
  std::size_t at = 0;
  for (std::int64_t shard = 0; shard < shards_; ++shard) {
    const std::size_t s = shard;
    const std::size_t first = records_[part][s], count = records_[part + 1][s] - first;
    if (count == 0) continue;
    store_.read(shard, first, count, &rotations[at], &configurations[at * joints_]);
    const ShardRecords& directory = store_.directory(shard);
    std::uint64_t position = 0;
    for (std::size_t cell = starts_[part][s]; cell < starts_[part + 1][s]; ++cell) {
      while (keys_[first_key + position] != directory.position_keys[cell]) ++position;
      for (std::uint32_t i = 0; i < directory.counts[cell]; ++i, ++at)
        records[at] = {position * rotation_count_ + rotations[at], static_cast<std::uint32_t>(at)};
    }
  }
  sort_by_cell(records, spare, (end_key - first_key) * rotation_count_);

  MergedCells out;
  out.configurations.reserve(total * joints_);
  for (std::size_t key = first_key; key < end_key; ++key) {
    const CellIndex index = cell_of_key(keys_[key]);
    for (int axis = 0; axis < 3; ++axis) out.positions.push_back(static_cast<std::int32_t>(index[axis]));
  }
  out.position_counts.assign(end_key - first_key, 0);
  for (std::size_t begin = 0; begin < total;) {
    std::size_t end = begin + 1;
    while (end < total && records[end].cell == records[begin].cell) ++end;
    ++out.position_counts[records[begin].cell / rotation_count_];
    append_cell(records, begin, end, configurations, out);
    begin = end;
  }
  return out;
}

void ShardMerge::append_cell(const std::vector<Record>& records, std::size_t begin, std::size_t end,
                             const std::vector<std::uint16_t>& configurations, MergedCells& out) const {
  const std::size_t count = std::min(end - begin, max_per_cell_);
  thread_local std::vector<std::uint32_t> order;
  order.resize(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = records[begin + i].index;
  most_different_first(configurations.data(), joints_, order.data(), count);
  out.rotation_ids.push_back(static_cast<std::uint32_t>(records[begin].cell % rotation_count_));
  out.cell_counts.push_back(static_cast<std::uint32_t>(count));
  for (const std::uint32_t index : order) {
    const auto* from = &configurations[index * joints_];
    out.configurations.insert(out.configurations.end(), from, from + joints_);
  }
}

}  // namespace mmgrasp::detail
