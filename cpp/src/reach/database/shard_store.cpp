#include "reach/database/shard_store.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "mmgrasp/core/detail/crc32.hpp"
#include "mmgrasp/core/error.hpp"
#include "reach/database/reach_data.hpp"

namespace mmgrasp::detail {
namespace {

/// Stands in front of a shard's arrays: position keys, counts, rotation ids, configurations.
struct ShardHeader {
  char magic[8];
  char key[16];
  std::int64_t shard;
  std::uint64_t positions, records;
  std::uint32_t joints;
  std::uint32_t sum;  ///< Checksum of the arrays.
  std::uint32_t header_sum, unused;
};
static_assert(sizeof(ShardHeader) == 64, "written byte for byte: no padding");
constexpr char kMagic[8] = {'M', 'M', 'G', 'R', 'P', 'A', 'R', 'T'};

ShardHeader make_header(const std::string& key, std::int64_t shard, const ShardRecords& records, std::size_t joints) {
  ShardHeader header{};
  std::memcpy(header.magic, kMagic, sizeof(kMagic));
  std::memcpy(header.key, key.data(), std::min(key.size(), sizeof(header.key)));
  header.shard = shard;
  header.positions = records.position_keys.size();
  header.records = records.size();
  header.joints = static_cast<std::uint32_t>(joints);
  return header;
}

template <class Visit>
void each_array(ShardRecords& records, const Visit& visit) {
  visit(records.position_keys);
  visit(records.counts);
  visit(records.rotation_ids);
  visit(records.configurations);
}

std::uint32_t sum_of(ShardRecords& records) {
  std::uint32_t sum = 0;
  each_array(records, [&](const auto& values) { sum = crc32(values.data(), values.size() * sizeof(values[0]), sum); });
  return sum;
}

std::uint32_t header_sum(const ShardHeader& header) {
  return crc32(&header, offsetof(ShardHeader, header_sum));
}

void release(ShardRecords& records) {
  std::vector<std::uint32_t>().swap(records.rotation_ids);
  std::vector<std::uint16_t>().swap(records.configurations);
}

void read_at(int file, void* to, std::size_t size, std::uint64_t offset, const std::string& path) {
  for (auto* at = static_cast<char*>(to); size > 0;) {
    const ssize_t got = ::pread(file, at, size, static_cast<off_t>(offset));
    if (got <= 0) throw IoError(path + ": cannot be read (" + (got < 0 ? std::strerror(errno) : "truncated") + ")");
    at += got;
    size -= got;
    offset += static_cast<std::uint64_t>(got);
  }
}

}  // namespace

ShardStore::ShardStore(const std::string& folder, const std::string& key, std::int64_t shards, int joints)
    : folder_(folder), key_(key), joints_(joints), shards_(shards), records_(shards, 0), present_(shards, 0) {
  if (folder_.empty()) return;
  for (std::int64_t shard = 0; shard < shards; ++shard) present_[shard] = load(shard);
}

std::string ShardStore::path_of(std::int64_t shard) const {
  char name[32];
  std::snprintf(name, sizeof(name), "%06lld.part", static_cast<long long>(shard));
  return (std::filesystem::path(folder_) / name).string();
}

bool ShardStore::load(std::int64_t shard) {
  const std::string path = path_of(shard);
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return false;
  const auto size = static_cast<std::uint64_t>(file.tellg());
  ShardHeader header{};
  file.seekg(0);
  file.read(reinterpret_cast<char*>(&header), sizeof(header));
  const ShardHeader expected = make_header(key_, shard, {}, joints_);
  if (!file || std::memcmp(header.magic, expected.magic, 8) != 0 || std::memcmp(header.key, expected.key, 16) != 0 ||
      header.shard != shard || header.joints != expected.joints || header.header_sum != header_sum(header))
    return false;
  if (size != sizeof(header) + 12 * header.positions + header.records * (4 + 2 * joints_)) return false;
  ShardRecords& records = shards_[shard];
  records.position_keys.resize(header.positions);
  records.counts.resize(header.positions);
  records.rotation_ids.resize(header.records);
  records.configurations.resize(header.records * joints_);
  each_array(records, [&](auto& values) {
    file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(values[0])));
  });
  const bool sound = file && sum_of(records) == header.sum;
  records_[shard] = records.size();
  release(records);
  return sound;
}

void ShardStore::put(std::int64_t shard, ShardRecords&& records) {
  const std::size_t at = shard;
  shards_[at] = std::move(records);
  ShardRecords& kept = shards_[at];
  records_[at] = kept.size();
  if (!folder_.empty()) {
    ShardHeader header = make_header(key_, shard, kept, joints_);
    header.sum = sum_of(kept);
    header.header_sum = header_sum(header);
    const std::string path = path_of(shard), temporary = detail::temporary_beside(path);  // others may write it, too
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(&header), sizeof(header));
    each_array(kept, [&](const auto& values) {
      file.write(reinterpret_cast<const char*>(values.data()),
                 static_cast<std::streamsize>(values.size() * sizeof(values[0])));
    });
    file.close();
    std::error_code error;
    if (file) std::filesystem::rename(temporary, path, error);
    if (!file || error) throw IoError(path + ": cannot be written (is the disk full?)");
    release(kept);
  }
  present_[at] = 1;
}

std::vector<std::uint64_t> ShardStore::cell_keys(std::int64_t shard) const {
  const ShardRecords& records = directory(shard);
  const std::size_t count = records_[shard];
  std::vector<std::uint32_t> rotations(count);
  read(shard, 0, count, rotations.data(), nullptr);
  std::vector<std::uint64_t> keys;
  keys.reserve(count);
  for (std::size_t p = 0; p < records.position_keys.size(); ++p)
    for (std::uint32_t i = 0; i < records.counts[p]; ++i)
      keys.push_back(records.position_keys[p] << kRotationBits | rotations[keys.size()]);
  return keys;
}

void ShardStore::read(std::int64_t shard, std::size_t first, std::size_t count, std::uint32_t* rotation_ids,
                      std::uint16_t* configurations) const {
  const ShardRecords& records = directory(shard);
  if (folder_.empty()) {
    std::copy_n(records.rotation_ids.begin() + static_cast<std::ptrdiff_t>(first), count, rotation_ids);
    if (configurations != nullptr)
      std::copy_n(records.configurations.begin() + static_cast<std::ptrdiff_t>(first * joints_), count * joints_,
                  configurations);
    return;
  }
  const std::string path = path_of(shard);
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw IoError(path + ": cannot be opened (" + std::strerror(errno) + ")");
  try {
    const std::uint64_t rotations_at = sizeof(ShardHeader) + 12 * records.position_keys.size();
    const std::uint64_t configurations_at = rotations_at + 4 * records_[shard];
    read_at(file, rotation_ids, 4 * count, rotations_at + 4 * first, path);
    if (configurations != nullptr)
      read_at(file, configurations, 2 * joints_ * count, configurations_at + 2 * joints_ * first, path);
  } catch (...) {
    ::close(file);
    throw;
  }
  ::close(file);
}

}  // namespace mmgrasp::detail
