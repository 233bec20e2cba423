#pragma once

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/core/detail/npy_file.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "reach/database/rotation_cells.hpp"
#include "reach/database/stored_arm.hpp"

namespace mmgrasp::detail {

/// Three position cell indices in one number, so that sorting it sorts by x, y, z. 14 bits each.
constexpr int kPositionBits = 14;
constexpr std::int64_t kPositionLimit = std::int64_t{1} << (kPositionBits - 1);  ///< Indices lie in [-limit, limit).
constexpr int kRotationBits = 22;

/// Raised whenever sampling, cells or file layout change: older caches are then built anew.
constexpr int kReachFormat = 2;

using CellIndex = Eigen::Matrix<std::int64_t, 3, 1>;

/// A tool pose in 16 bytes, so that searching reads four from one cache line: the place within the position cell in
/// 65536ths of its edge, and the unit quaternion (x, y, z, w) in 32767ths. Right to about 1e-5 cells and 1e-4 rad.
struct StoredPose {
  std::array<std::uint16_t, 3> position;
  std::uint16_t unused;
  std::array<std::int16_t, 4> quaternion;

  StoredPose() = default;
  StoredPose(const Pose& T, const CellIndex& cell, double edge);
  /// The position in cells, from the lower corner of the cell.
  Eigen::Vector3f place() const {
    constexpr float kScale = 1.0f / 65536;
    return Eigen::Vector3f(position[0] + 0.5f, position[1] + 0.5f, position[2] + 0.5f) * kScale;
  }
  Eigen::Vector4f coefficients() const {
    constexpr float kScale = 1.0f / 32767;
    return Eigen::Vector4f(quaternion[0], quaternion[1], quaternion[2], quaternion[3]) * kScale;
  }
};
static_assert(sizeof(StoredPose) == 16, "four in a cache line");

/// The arm with its root in the origin. Throws InvalidInput when it has base joints or no joints.
JointGroup checked_arm(const JointGroup& arm);

/// Floored, so that the cell at 0 is as wide as the others; nothing when out of range or not finite.
std::optional<CellIndex> position_cell(const Eigen::Vector3d& position, double edge);
bool in_range(const CellIndex& index);
std::uint64_t position_key(const CellIndex& index);
CellIndex cell_of_key(std::uint64_t key);

}  // namespace mmgrasp::detail

namespace mmgrasp::detail {

/// Numbers that somebody else keeps.
template <typename T>
struct View {
  const T* data = nullptr;
  std::size_t count = 0;
  const T& operator[](std::size_t i) const { return data[i]; }
  const T* begin() const { return data; }
  const T* end() const { return data + count; }
};

/// The arrays of a database built in this process.
struct OwnArrays {
  std::vector<std::int32_t> positions;
  std::vector<std::uint32_t> position_first, rotation_ids, cell_first;
  std::vector<std::uint16_t> configurations;
};

/// A file of a database on disk, and which of its chunks were read and compared with their checksums.
struct CheckedFile {
  CheckedFile(const std::string& path_in, const NpyLayout& layout, std::vector<std::uint32_t> checksums_in);

  /// Reads and compares the chunks that hold these bytes of the array, unless that was done before. Throws IoError.
  /// Safe from several threads.
  void ensure(std::uint64_t first_byte, std::uint64_t end_byte) const;
  /// Compares a chunk as it is in memory or, as long as nobody asked for it, in the file. Throws IoError.
  void check_chunk(std::size_t chunk) const;
  /// Nothing but what was ensured may be looked at.
  const unsigned char* payload() const { return copy.data() + header_bytes; }

  std::string path;
  FileCopy copy;
  std::size_t header_bytes;
  std::vector<std::uint32_t> checksums;

 private:
  enum ChunkState : std::uint8_t { kUnread, kBusy, kChecked };
  std::pair<std::uint64_t, std::uint64_t> bytes_of(std::size_t chunk) const;
  void compare(std::size_t chunk, const unsigned char* bytes) const;
  void read_chunk(std::size_t chunk) const;

  mutable std::vector<std::atomic<std::uint8_t>> state_;
};

}  // namespace mmgrasp::detail

namespace mmgrasp {

/// Configurations sorted by position cell, then rotation cell, then diversity: everything of one position cell lies
/// together. Tool poses are not stored: those of a position cell are worked out when it is first looked into.
struct ReachDatabase::Data {
  Data() = default;
  ~Data();
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;

  ReachOptions options;
  std::string key;
  detail::StoredArm arm;
  int joints = 0;

  detail::View<std::int32_t> positions;        ///< Three indices for each non-empty position cell, ascending.
  detail::View<std::uint32_t> position_first;  ///< First cell of each position cell, and the end.
  detail::View<std::uint32_t> rotation_ids;    ///< One a cell, ascending within a position cell.
  detail::View<std::uint32_t> cell_first;      ///< First configuration of each cell, and the end.
  detail::View<std::uint16_t> configurations;  ///< `joints` numbers each.
  Eigen::AlignedBox3d bounds;
  double reach = 0;

  // One of these keeps the arrays.
  detail::OwnArrays own;
  std::vector<std::unique_ptr<const detail::CheckedFile>> files;
  const detail::CheckedFile* configuration_file = nullptr;  ///< Null: nothing to check.
  std::string folder;                                       ///< Empty: in memory only.

  // Made by complete().
  detail::RotationCells rotations{3.0};
  std::vector<std::uint64_t> position_keys;
  std::vector<std::uint32_t> slots;  ///< Open addressing: position cell + 1, or 0 for a free slot.

  std::size_t size() const { return cell_first.count == 0 ? 0 : cell_first.end()[-1]; }
  std::size_t cell_count() const { return rotation_ids.count; }
  std::size_t position_count() const { return position_first.count == 0 ? 0 : position_first.count - 1; }
  /// Points the views at `own`.
  void view_own();
  /// Call once the arrays are there.
  void complete();
  /// Works out bounds and reach.
  void measure();
  /// Index into position_keys, or -1.
  std::int64_t find_position(std::uint64_t key) const;
  /// First and last + 1 configuration in the pose's cell.
  std::pair<std::size_t, std::size_t> find_cell(const Pose& T_base_tip) const;

  /// The stored numbers of these configurations, checked against the file's checksums before they are first used.
  const std::uint16_t* stored(std::size_t first, std::size_t end) const;
  /// Tool poses of all configurations, those of this position cell filled in.
  const detail::StoredPose* poses_of(std::size_t position) const {
    if (pose_state_[position].load(std::memory_order_acquire) != kReady) fill_poses(position);
    return poses_;
  }
  std::pair<std::size_t, std::size_t> configurations_of(std::size_t position) const {
    return {cell_first[position_first[position]], cell_first[position_first[position + 1]]};
  }

 private:
  enum PoseState : std::uint8_t { kAbsent, kBusy, kReady };
  void fill_poses(std::size_t position) const;

  detail::StoredPose* poses_ = nullptr;  // as much as all need; memory is used for what was touched
  mutable std::vector<std::atomic<std::uint8_t>> pose_state_;
};

namespace detail {

/// Writes the folder's files, meta.json last. `data` needs everything but `own` when the writer of the configurations
/// has finished already; else null.
void write_database(const ReachDatabase::Data& data, const std::string& folder, const std::string& named,
                    const NpyWriter* configurations);
/// Puts a written folder in place of what is there, which must be a database or nothing. Throws IoError naming it.
void put_in_place(const std::string& written, const std::string& path);
/// Removes what stands there, in one step for others.
void move_away(const std::string& path);
/// Next to `path`, unique among processes and threads.
std::string temporary_beside(const std::string& path);
/// The path without slashes at its end.
std::string folder_name(const std::string& path);

}  // namespace detail

}  // namespace mmgrasp
