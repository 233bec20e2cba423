#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/reach/reach_database.hpp"
#include "reach/rotation_cells.hpp"

namespace mmgrasp::detail {

/// Three position cell indices in one number, so that sorting it sorts by x, y, z. 14 bits each.
constexpr int kPositionBits = 14;
constexpr std::int64_t kPositionLimit = std::int64_t{1} << (kPositionBits - 1);  ///< Indices lie in [-limit, limit).
constexpr int kRotationBits = 22;

/// Raised whenever sampling, cells or file layout change: older caches are then built anew.
constexpr std::uint32_t kReachFormat = 1;

using CellIndex = Eigen::Matrix<std::int64_t, 3, 1>;

/// A tool pose in 16 bytes, so that searching reads four from one cache line: the place within the position cell in
/// 65536ths of its edge, and the unit quaternion (x, y, z, w) in 32767ths. Right to about 1e-5 cells and 1e-4 rad.
struct StoredPose {
  std::array<std::uint16_t, 3> position;
  std::uint16_t unused;
  std::array<std::int16_t, 4> quaternion;

  StoredPose() = default;
  StoredPose(const Pose& T, const CellIndex& cell, double edge);
  /// In cells from the lower corner of the cell.
  Eigen::Vector3f place() const {
    constexpr float kScale = 1.0f / 65536;
    return Eigen::Vector3f(position[0] + 0.5f, position[1] + 0.5f, position[2] + 0.5f) * kScale;
  }
  Eigen::Vector4f coefficients() const {
    constexpr float kScale = 1.0f / 32767;
    return Eigen::Vector4f(quaternion[0], quaternion[1], quaternion[2], quaternion[3]) * kScale;
  }
};
static_assert(sizeof(StoredPose) == 16, "written byte for byte: no padding");

/// The arm with its root in the origin. Throws InvalidInput when it has base joints or no joints.
JointGroup checked_arm(const JointGroup& arm);

/// Floored, so that the cell at 0 is as wide as the others; nothing when out of range or not finite.
std::optional<CellIndex> position_cell(const Eigen::Vector3d& position, double edge);
bool in_range(const CellIndex& index);
std::uint64_t position_key(const CellIndex& index);
CellIndex cell_of_key(std::uint64_t key);

}  // namespace mmgrasp::detail

namespace mmgrasp {

/// Configurations sorted by position cell, then rotation cell, then diversity: everything of one position cell lies
/// together.
struct ReachDatabase::Data {
  ReachOptions options;
  std::string key;
  int joints = 0;

  std::vector<std::uint64_t> position_keys;   ///< Non-empty position cells, ascending.
  std::vector<std::uint32_t> position_first;  ///< First cell of each position cell, and the end.
  std::vector<std::uint32_t> rotation_ids;    ///< One a cell, ascending within a position cell.
  std::vector<std::uint32_t> cell_first;      ///< First configuration of each cell, and the end.
  std::vector<float> configurations;          ///< `joints` numbers each.
  std::vector<detail::StoredPose> poses;      ///< Tool pose of each.

  // Derived when complete() is called.
  detail::RotationCells rotations{3.0};
  std::vector<std::uint32_t> slots;  ///< Open addressing: position cell + 1, or 0 for a free slot.
  Eigen::AlignedBox3d bounds;
  double reach = 0;

  std::size_t size() const { return cell_first.empty() ? 0 : static_cast<std::size_t>(cell_first.back()); }
  std::size_t cell_count() const { return rotation_ids.size(); }
  void complete();
  /// Forgets every configuration.
  void clear();
  /// Index into position_keys, or -1.
  std::int64_t find_position(std::uint64_t key) const;
  /// Tool position of a configuration that lies in this position cell [m].
  Eigen::Vector3d position_of(std::size_t index, std::size_t position_cell) const;
  /// First and last + 1 configuration in the pose's cell.
  std::pair<std::size_t, std::size_t> find_cell(const Pose& T_base_tip) const;
};

}  // namespace mmgrasp
