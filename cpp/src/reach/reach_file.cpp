#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <type_traits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/hash.hpp"
#include "reach/reach_data.hpp"

namespace mmgrasp {
namespace {

using Data = ReachDatabase::Data;

constexpr char kMagic[8] = {'M', 'M', 'G', 'R', 'E', 'A', 'C', 'H'};
constexpr std::uint32_t kByteOrder = 0x01020304;

/// First bytes of the file; the arrays of Data follow in the order in which they are declared.
struct Header {
  char magic[8];
  std::uint32_t format;
  std::uint32_t byte_order;
  char key[16];
  std::int64_t samples;
  double position_cell, rotation_cell, min_manipulability;
  std::int32_t max_per_cell;
  std::uint32_t seed;
  std::int64_t joints;
  std::uint64_t position_count, cell_count, size;
  std::uint64_t payload_hash;
  std::uint64_t header_hash;  ///< Of everything before it.
};
static_assert(std::is_trivially_copyable_v<Header> && sizeof(Header) == 120, "written byte for byte: no padding");

std::uint64_t hash_of(const Header& header) {
  return Hasher().add(&header, offsetof(Header, header_hash)).value();
}

template <typename Visit>
void for_each_array(Data& data, Visit visit) {
  visit(data.position_keys);
  visit(data.position_first);
  visit(data.rotation_ids);
  visit(data.cell_first);
  visit(data.configurations);
  visit(data.poses);
}

template <typename T>
std::size_t byte_count(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

Header make_header(const Data& data) {
  Header header{};
  std::memcpy(header.magic, kMagic, sizeof(kMagic));
  header.format = detail::kReachFormat;
  header.byte_order = kByteOrder;
  std::memcpy(header.key, data.key.data(), std::min(data.key.size(), sizeof(header.key)));
  header.samples = data.options.samples;
  header.position_cell = data.options.position_cell;
  header.rotation_cell = data.options.rotation_cell;
  header.min_manipulability = data.options.min_manipulability;
  header.max_per_cell = data.options.max_per_cell;
  header.seed = data.options.seed;
  header.joints = data.joints;
  header.position_count = data.position_keys.size();
  header.cell_count = data.cell_count();
  header.size = data.size();
  Hasher hasher;
  for_each_array(const_cast<Data&>(data), [&](const auto& values) { hasher.add(values.data(), byte_count(values)); });
  header.payload_hash = hasher.value();
  header.header_hash = hash_of(header);
  return header;
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw IoError(path + ": " + what);
}

/// Checks what can be checked before the arrays are read, so that a forged count cannot ask for all memory.
void check_header(const Header& header, std::uint64_t file_size, const std::string& path) {
  if (std::memcmp(header.magic, kMagic, sizeof(kMagic)) != 0) refuse(path, "not a reachability database");
  if (header.byte_order != kByteOrder) refuse(path, "written on a machine with another byte order");
  if (header.format != detail::kReachFormat)
    refuse(path, "format version " + std::to_string(header.format) + ", this library reads " +
                     std::to_string(detail::kReachFormat));
  if (header.header_hash != hash_of(header)) refuse(path, "corrupt: the header's checksum differs");
  constexpr std::uint64_t kMostCounted = std::uint64_t{1} << 40;  // keeps the sum below within 64 bits
  if (header.joints <= 0 || header.joints > 1000 || header.position_count > kMostCounted ||
      header.cell_count > kMostCounted || header.size > kMostCounted)
    refuse(path, "corrupt: impossible counts in the header");
  const std::uint64_t expected =
      sizeof(Header) + header.position_count * 8 + (header.position_count + 1) * 4 + header.cell_count * 4 +
      (header.cell_count + 1) * 4 +
      header.size * (4 * static_cast<std::uint64_t>(header.joints) + sizeof(detail::StoredPose));
  if (file_size != expected)
    refuse(path, (file_size < expected ? "truncated: " : "bytes after the end: ") + std::to_string(file_size) +
                     " bytes, " + std::to_string(expected) + " expected");
}

void check_tables(const Data& data, const std::string& path) {
  bool sound = data.position_first.front() == 0 && data.position_first.back() == data.rotation_ids.size() &&
               data.cell_first.front() == 0 &&
               data.configurations.size() == data.cell_first.back() * static_cast<std::size_t>(data.joints);
  for (std::size_t i = 0; i + 1 < data.position_first.size(); ++i)
    sound = sound && data.position_first[i] < data.position_first[i + 1];
  for (std::size_t i = 0; i + 1 < data.position_keys.size(); ++i)
    sound = sound && data.position_keys[i] < data.position_keys[i + 1];
  for (std::size_t i = 0; i + 1 < data.cell_first.size(); ++i)
    sound = sound && data.cell_first[i] < data.cell_first[i + 1];
  if (!sound) refuse(path, "corrupt: the tables contradict each other");
}

void write_file(const Data& data, const std::string& path, const std::string& named) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) throw IoError(named + ": cannot write (" + std::strerror(errno) + ")");
  const Header header = make_header(data);
  file.write(reinterpret_cast<const char*>(&header), sizeof(header));
  for_each_array(const_cast<Data&>(data), [&](const auto& values) {
    file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(byte_count(values)));
  });
  file.close();
  if (!file) throw IoError(named + ": cannot write all of it (is the disk full?)");
}

}  // namespace

void ReachDatabase::save(const std::string& path) const {
  // Unique among processes and threads that save the same file at once: the last rename wins, each a whole file.
  static std::atomic<unsigned> counter{0};
  const std::string temporary =
      path + ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(counter.fetch_add(1));
  std::error_code error;
  try {
    write_file(*data_, temporary, path);
    std::filesystem::rename(temporary, path, error);
    if (error) throw IoError(path + ": cannot put the written file in place (" + error.message() + ")");
  } catch (...) {
    std::filesystem::remove(temporary, error);
    throw;
  }
}

ReachDatabase ReachDatabase::load(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) refuse(path, "no such file");
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) refuse(path, "cannot be opened");
  const auto file_size = static_cast<std::uint64_t>(file.tellg());
  if (file_size < sizeof(Header))
    refuse(path, "truncated: " + std::to_string(file_size) + " bytes are too few for a reachability database");
  file.seekg(0);
  Header header;
  file.read(reinterpret_cast<char*>(&header), sizeof(header));
  if (!file) refuse(path, "cannot be read");
  check_header(header, file_size, path);

  auto data = std::make_shared<Data>();
  data->key.assign(header.key, strnlen(header.key, sizeof(header.key)));
  data->options.samples = header.samples;
  data->options.position_cell = header.position_cell;
  data->options.rotation_cell = header.rotation_cell;
  data->options.min_manipulability = header.min_manipulability;
  data->options.max_per_cell = header.max_per_cell;
  data->options.seed = header.seed;
  data->joints = static_cast<int>(header.joints);
  data->position_keys.resize(header.position_count);
  data->position_first.resize(header.position_count + 1);
  data->rotation_ids.resize(header.cell_count);
  data->cell_first.resize(header.cell_count + 1);
  data->configurations.resize(header.size * static_cast<std::uint64_t>(header.joints));
  data->poses.resize(header.size);
  Hasher hasher;
  for_each_array(*data, [&](auto& values) {
    file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(byte_count(values)));
    hasher.add(values.data(), byte_count(values));
  });
  if (!file) refuse(path, "cannot be read to its end");
  if (hasher.value() != header.payload_hash) refuse(path, "corrupt: the checksum of the contents differs");
  try {
    data->options.check();
  } catch (const InvalidInput& invalid) {
    refuse(path, std::string("corrupt: ") + invalid.what());
  }
  check_tables(*data, path);
  data->complete();
  return ReachDatabase(std::move(data));
}

}  // namespace mmgrasp
