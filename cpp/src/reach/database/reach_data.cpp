#include "reach/database/reach_data.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <numeric>
#include <thread>

#include "mmgrasp/core/detail/crc32.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

/// Spreads neighbouring keys over the table (Fibonacci hashing).
std::size_t slot_of(std::uint64_t key, std::size_t mask) {
  return ((key * 0x9e3779b97f4a7c15ull) >> 32) & mask;
}

template <typename T>
detail::View<T> view(const std::vector<T>& values) {
  return {values.data(), values.size()};
}

}  // namespace

namespace detail {

CheckedFile::CheckedFile(const std::string& path_in, const NpyLayout& layout, std::vector<std::uint32_t> checksums_in)
    : path(path_in),
      copy(path_in, layout.header().size() + layout.payload_bytes()),
      header_bytes(layout.header().size()),
      checksums(std::move(checksums_in)),
      state_(checksums.size()) {
  const std::string header = layout.header();
  copy.read(0, header.size());
  if (std::memcmp(copy.data(), header.data(), header.size()) != 0)
    throw IoError(path + ": corrupt: its header is not that of an array of type " + layout.dtype +
                  " with the shape that meta.json states");
  if (checksums.size() != (copy.size() + kChecksumChunk - 1) / kChecksumChunk)
    throw IoError(path + ": corrupt: meta.json has " + std::to_string(checksums.size()) + " checksums for it");
}

std::pair<std::uint64_t, std::uint64_t> CheckedFile::bytes_of(std::size_t chunk) const {
  const std::uint64_t begin = chunk * kChecksumChunk;
  return {begin, std::min<std::uint64_t>(begin + kChecksumChunk, copy.size())};
}

void CheckedFile::compare(std::size_t chunk, const unsigned char* bytes) const {
  const auto [begin, end] = bytes_of(chunk);
  if (crc32(bytes, end - begin) != checksums[chunk])
    throw IoError(path + ": corrupt: bytes " + std::to_string(begin) + " to " + std::to_string(end - 1) +
                  " differ from their checksum");
}

void CheckedFile::check_chunk(std::size_t chunk) const {
  const auto [begin, end] = bytes_of(chunk);
  if (copy.is_whole() || state_[chunk].load(std::memory_order_acquire) == kChecked) {
    compare(chunk, copy.data() + begin);
    return;
  }
  std::vector<unsigned char> bytes(end - begin);  // not kept: all of a large file may be more than memory holds
  copy.read_to(bytes.data(), begin, end);
  compare(chunk, bytes.data());
}

void CheckedFile::read_chunk(std::size_t chunk) const {
  std::uint8_t found = kUnread;
  while (!state_[chunk].compare_exchange_weak(found, kBusy, std::memory_order_acquire)) {
    if (found == kChecked) return;
    found = kUnread;
    std::this_thread::yield();
  }
  try {
    const auto [begin, end] = bytes_of(chunk);
    copy.read(begin, end);
    compare(chunk, copy.data() + begin);
  } catch (...) {
    state_[chunk].store(kUnread, std::memory_order_release);
    throw;
  }
  state_[chunk].store(kChecked, std::memory_order_release);
}

void CheckedFile::ensure(std::uint64_t first_byte, std::uint64_t end_byte) const {
  const std::size_t last = (header_bytes + end_byte - 1) / kChecksumChunk;
  for (std::size_t chunk = (header_bytes + first_byte) / kChecksumChunk; chunk <= last; ++chunk) {
    if (state_[chunk].load(std::memory_order_acquire) != kChecked) {
      throw_if_interrupted();
      read_chunk(chunk);
    }
  }
}

}  // namespace detail

ReachDatabase::Data::~Data() {
  if (poses_ != nullptr) ::munmap(poses_, size() * sizeof(detail::StoredPose));
}

void ReachDatabase::Data::view_own() {
  positions = view(own.positions);
  position_first = view(own.position_first);
  rotation_ids = view(own.rotation_ids);
  cell_first = view(own.cell_first);
  configurations = view(own.configurations);
}

void ReachDatabase::Data::complete() {
  rotations = detail::RotationCells(options.rotation_cell);
  position_keys.clear();
  for (std::size_t i = 0; i < position_count(); ++i)
    position_keys.push_back(detail::position_key({positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]}));
  std::size_t capacity = 2;
  while (capacity < 2 * position_keys.size() + 1) capacity *= 2;
  slots.assign(capacity, 0);
  for (std::size_t i = 0; i < position_keys.size(); ++i) {
    std::size_t slot = slot_of(position_keys[i], capacity - 1);
    while (slots[slot] != 0) slot = (slot + 1) & (capacity - 1);
    slots[slot] = static_cast<std::uint32_t>(i + 1);
  }
  pose_state_ = std::vector<std::atomic<std::uint8_t>>(position_count());
  if (size() == 0) return;
  void* at = ::mmap(nullptr, size() * sizeof(detail::StoredPose), PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (at == MAP_FAILED) throw Error(std::string("no address space for tool poses: ") + std::strerror(errno));
  poses_ = static_cast<detail::StoredPose*>(at);
}

const std::uint16_t* ReachDatabase::Data::stored(std::size_t first, std::size_t end) const {
  const std::size_t n = joints;
  if (configuration_file != nullptr) configuration_file->ensure(2 * n * first, 2 * n * end);
  return configurations.data + n * first;
}

void ReachDatabase::Data::fill_poses(std::size_t position) const {
  std::uint8_t state = kAbsent;
  if (!pose_state_[position].compare_exchange_strong(state, kBusy, std::memory_order_acquire)) {
    while (state == kBusy) {
      std::this_thread::yield();
      state = pose_state_[position].load(std::memory_order_acquire);
    }
    if (state == kAbsent) fill_poses(position);  // the other one failed; so will this one, and say why
    return;
  }
  try {
    constexpr std::size_t kBlock = 64;
    std::array<Pose, kBlock> poses;
    const auto [begin, end] = configurations_of(position);
    const std::uint16_t* numbers = stored(begin, end);
    const detail::CellIndex cell(positions[3 * position], positions[3 * position + 1], positions[3 * position + 2]);
    for (std::size_t first = begin; first < end; first += kBlock) {
      const std::size_t count = std::min(kBlock, end - first);
      arm.tool_poses(numbers + (first - begin) * joints, count, poses.data());
      for (std::size_t i = 0; i < count; ++i)
        poses_[first + i] = detail::StoredPose(poses[i], cell, options.position_cell);
    }
  } catch (...) {
    pose_state_[position].store(kAbsent, std::memory_order_release);
    throw;
  }
  pose_state_[position].store(kReady, std::memory_order_release);
}

/// Only position cells that may hold something farther out than what was seen are looked into.
void ReachDatabase::Data::measure() {
  bounds.setEmpty();
  reach = 0;
  std::vector<std::size_t> order(position_count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<char> seen(order.size(), 0);
  Eigen::Vector3d low = Eigen::Vector3d::Constant(detail::kInfinity), high = -low;
  Poses poses;
  const auto corner = [&](std::size_t p, int axis) {
    return options.position_cell * static_cast<double>(positions[3 * p + axis]);
  };
  const auto look = [&](std::size_t p) {
    if (seen[p]) return;
    seen[p] = 1;
    const auto [begin, end] = configurations_of(p);
    poses.resize(end - begin);
    arm.tool_poses(stored(begin, end), end - begin, poses.data());
    for (const Pose& T : poses) {
      low = low.cwiseMin(T.translation());
      high = high.cwiseMax(T.translation());
      reach = std::max(reach, T.translation().norm());
    }
  };
  const auto farthest_first = [&](const auto& bound, const auto& best) {
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const double at_a = bound(a), at_b = bound(b);
      return at_a != at_b ? at_a > at_b : a < b;
    });
    for (const std::size_t p : order) {
      if (bound(p) < best()) break;
      look(p);
    }
  };
  const double edge = options.position_cell;
  for (int axis = 0; axis < 3; ++axis) {
    farthest_first([&](std::size_t p) { return corner(p, axis) + edge; }, [&] { return high[axis]; });
    farthest_first([&](std::size_t p) { return -corner(p, axis); }, [&] { return -low[axis]; });
  }
  farthest_first(
      [&](std::size_t p) {
        double squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
          const double far = std::max(std::abs(corner(p, axis)), std::abs(corner(p, axis) + edge));
          squared += far * far;
        }
        return std::sqrt(squared) + 1e-9;
      },
      [&] { return reach; });
  if (!order.empty()) bounds = Eigen::AlignedBox3d(low, high);
}

std::int64_t ReachDatabase::Data::find_position(std::uint64_t wanted) const {
  const std::size_t mask = slots.size() - 1;
  for (std::size_t slot = slot_of(wanted, mask); slots[slot] != 0; slot = (slot + 1) & mask)
    if (position_keys[slots[slot] - 1] == wanted) return static_cast<std::int64_t>(slots[slot]) - 1;
  return -1;
}

std::pair<std::size_t, std::size_t> ReachDatabase::Data::find_cell(const Pose& T_base_tip) const {
  const auto index = detail::position_cell(T_base_tip.translation(), options.position_cell);
  if (!index || size() == 0) return {0, 0};
  const std::int64_t position = find_position(detail::position_key(*index));
  if (position < 0) return {0, 0};
  const std::size_t p = position;
  const auto* begin = rotation_ids.begin() + position_first[p];
  const auto* end = rotation_ids.begin() + position_first[p + 1];
  const std::uint32_t id = rotations.id(T_base_tip.linear());
  const auto* found = std::lower_bound(begin, end, id);
  if (found == end || *found != id) return {0, 0};
  const std::size_t cell = found - rotation_ids.begin();
  return {cell_first[cell], cell_first[cell + 1]};
}

}  // namespace mmgrasp
