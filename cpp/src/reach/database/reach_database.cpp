#include "mmgrasp/reach/reach_database.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "reach/database/reach_data.hpp"

namespace mmgrasp {
namespace detail {

std::optional<CellIndex> position_cell(const Eigen::Vector3d& position, double edge) {
  CellIndex index;
  for (int i = 0; i < 3; ++i) {
    const double at = std::floor(position[i] / edge);
    if (!(std::abs(at) <= static_cast<double>(kPositionLimit))) return std::nullopt;
    index[i] = static_cast<std::int64_t>(at);
  }
  if (!in_range(index)) return std::nullopt;
  return index;
}

bool in_range(const CellIndex& index) {
  return index.minCoeff() >= -kPositionLimit && index.maxCoeff() < kPositionLimit;
}

std::uint64_t position_key(const CellIndex& index) {
  std::uint64_t key = 0;
  for (int i = 0; i < 3; ++i) key = (key << kPositionBits) | static_cast<std::uint64_t>(index[i] + kPositionLimit);
  return key;
}

CellIndex cell_of_key(std::uint64_t key) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kPositionBits) - 1;
  CellIndex index;
  for (int i = 2; i >= 0; --i, key >>= kPositionBits)
    index[i] = static_cast<std::int64_t>(key & kMask) - kPositionLimit;
  return index;
}

StoredPose::StoredPose(const Pose& T, const CellIndex& cell, double edge) : unused(0) {
  const Eigen::Vector4d rounded = (Eigen::Quaterniond(T.linear()).normalized().coeffs() * 32767).array().round();
  for (int i = 0; i < 4; ++i) quaternion[i] = static_cast<std::int16_t>(rounded[i]);
  for (int i = 0; i < 3; ++i) {
    const double place = T.translation()[i] / edge - static_cast<double>(cell[i]);
    position[i] = static_cast<std::uint16_t>(std::clamp(std::floor(place * 65536), 0.0, 65535.0));
  }
}

}  // namespace detail

void ReachOptions::check() const {
  require_count(samples, "samples");
  require_positive(position_cell, "position_cell", "m");
  require(rotation_cell > 0.05 && rotation_cell <= 3, "rotation_cell", rotation_cell, "must lie in (0.05, 3] [rad]");
  require_count(max_per_cell, "max_per_cell", 1, 1'000'000);
  require(min_manipulability >= 0 && min_manipulability < 1, "min_manipulability", min_manipulability,
          "must lie in [0, 1)");
  require(thinning >= 0 && thinning <= 1, "thinning", thinning, "must lie in [0, 1]");
  resolve_threads(threads);  // says what is wrong
}

ReachDatabase::ReachDatabase(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

const std::string& ReachDatabase::key() const {
  return data_->key;
}
int ReachDatabase::joint_count() const {
  return data_->joints;
}
std::int64_t ReachDatabase::size() const {
  return static_cast<std::int64_t>(data_->size());
}
std::int64_t ReachDatabase::cell_count() const {
  return static_cast<std::int64_t>(data_->cell_count());
}
const ReachOptions& ReachDatabase::options() const {
  return data_->options;
}
double ReachDatabase::reach() const {
  return data_->reach;
}
const std::string& ReachDatabase::path() const {
  return data_->folder;
}
Eigen::AlignedBox3d ReachDatabase::bounds() const {
  return data_->bounds;
}

Eigen::VectorXd ReachDatabase::configuration(std::int64_t index) const {
  require(index >= 0 && index < size(), "index", static_cast<double>(index),
          "must lie in [0, " + std::to_string(size()) + ")");
  const std::size_t i = index;
  Eigen::VectorXd q(data_->joints);
  data_->arm.decode(data_->stored(i, i + 1), 1, q.data());
  return q;
}

Pose ReachDatabase::tool_pose(std::int64_t index) const {
  require(index >= 0 && index < size(), "index", static_cast<double>(index),
          "must lie in [0, " + std::to_string(size()) + ")");
  const std::size_t i = index;
  Pose T;
  data_->arm.tool_poses(data_->stored(i, i + 1), 1, &T);
  return T;
}

std::pair<std::int64_t, std::int64_t> ReachDatabase::voxel(const Pose& T_base_tip) const {
  if (!T_base_tip.matrix().allFinite()) require(false, "T_base_tip", "not finite", "must be a pose");
  const auto [begin, end] = data_->find_cell(T_base_tip);
  return {static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end)};
}

Eigen::MatrixXd ReachDatabase::cell(const Pose& T_base_tip) const {
  const auto [begin, end] = voxel(T_base_tip);
  Eigen::MatrixXd out(data_->joints, end - begin);
  if (begin == end) return out;
  const std::size_t first = begin, last = end;
  data_->arm.decode(data_->stored(first, last), last - first, out.data());
  return out;
}

}  // namespace mmgrasp
