#include "mmgrasp/reach/reach_database.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "reach/reach_data.hpp"

namespace mmgrasp {
namespace detail {
namespace {

/// Spreads neighbouring keys over the table (Fibonacci hashing).
std::size_t slot_of(std::uint64_t key, std::size_t mask) {
  return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ull) >> 32) & mask;
}

}  // namespace

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

void ReachDatabase::Data::complete() {
  rotations = detail::RotationCells(options.rotation_cell);
  std::size_t capacity = 2;
  while (capacity < 2 * position_keys.size() + 1) capacity *= 2;
  slots.assign(capacity, 0);
  for (std::size_t i = 0; i < position_keys.size(); ++i) {
    std::size_t slot = detail::slot_of(position_keys[i], capacity - 1);
    while (slots[slot] != 0) slot = (slot + 1) & (capacity - 1);
    slots[slot] = static_cast<std::uint32_t>(i + 1);
  }
  bounds.setEmpty();
  double farthest = 0;
  for (std::size_t p = 0; p < position_keys.size(); ++p) {
    for (std::size_t i = cell_first[position_first[p]]; i < cell_first[position_first[p + 1]]; ++i) {
      const Eigen::Vector3d position = position_of(i, p);
      bounds.extend(position);
      farthest = std::max(farthest, position.squaredNorm());
    }
  }
  if (size() == 0) {
    reach = 0;
    return;
  }
  // Stored positions are rounded to the middle of 65536ths: half of one more holds what was sampled.
  const double rounding = options.position_cell / 131072;
  bounds.min().array() -= rounding;
  bounds.max().array() += rounding;
  reach = std::sqrt(farthest) + std::sqrt(3.0) * rounding;
}

Eigen::Vector3d ReachDatabase::Data::position_of(std::size_t index, std::size_t position_cell) const {
  const Eigen::Vector3d corner = detail::cell_of_key(position_keys[position_cell]).cast<double>();
  return options.position_cell * (corner + poses[index].place().cast<double>());
}

void ReachDatabase::Data::clear() {
  position_keys.clear();
  rotation_ids.clear();
  configurations.clear();
  poses.clear();
  position_first.assign(1, 0);
  cell_first.assign(1, 0);
}

std::int64_t ReachDatabase::Data::find_position(std::uint64_t key) const {
  const std::size_t mask = slots.size() - 1;
  for (std::size_t slot = detail::slot_of(key, mask); slots[slot] != 0; slot = (slot + 1) & mask)
    if (position_keys[slots[slot] - 1] == key) return static_cast<std::int64_t>(slots[slot]) - 1;
  return -1;
}

std::pair<std::size_t, std::size_t> ReachDatabase::Data::find_cell(const Pose& T_base_tip) const {
  const auto index = detail::position_cell(T_base_tip.translation(), options.position_cell);
  if (!index || size() == 0) return {0, 0};
  const std::int64_t position = find_position(detail::position_key(*index));
  if (position < 0) return {0, 0};
  const auto begin = rotation_ids.begin() + position_first[position];
  const auto end = rotation_ids.begin() + position_first[position + 1];
  const std::uint32_t id = rotations.id(T_base_tip.linear());
  const auto found = std::lower_bound(begin, end, id);
  if (found == end || *found != id) return {0, 0};
  const std::size_t cell = static_cast<std::size_t>(found - rotation_ids.begin());
  return {cell_first[cell], cell_first[cell + 1]};
}

void ReachOptions::check() const {
  require(samples > 0, "samples", static_cast<double>(samples), "must be positive");
  require(std::isfinite(position_cell) && position_cell > 0, "position_cell", position_cell,
          "must be positive and finite [m]");
  require(rotation_cell > 0.05 && rotation_cell <= 3, "rotation_cell", rotation_cell, "must lie in (0.05, 3] [rad]");
  require(max_per_cell > 0, "max_per_cell", max_per_cell, "must be positive");
  require(min_manipulability >= 0 && min_manipulability < 1, "min_manipulability", min_manipulability,
          "must lie in [0, 1)");
  require(threads >= 0, "threads", threads, "must be 0 (all) or positive");
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
Eigen::AlignedBox3d ReachDatabase::bounds() const {
  return data_->bounds;
}

Eigen::VectorXd ReachDatabase::configuration(std::int64_t index) const {
  require(index >= 0 && index < size(), "index", static_cast<double>(index),
          "must lie in [0, " + std::to_string(size()) + ")");
  return Eigen::Map<const Eigen::VectorXf>(&data_->configurations[index * data_->joints], data_->joints).cast<double>();
}

Pose ReachDatabase::tool_pose(std::int64_t index) const {
  require(index >= 0 && index < size(), "index", static_cast<double>(index),
          "must lie in [0, " + std::to_string(size()) + ")");
  const auto i = static_cast<std::size_t>(index);
  const auto cell =
      std::upper_bound(data_->cell_first.begin(), data_->cell_first.end(), i) - data_->cell_first.begin() - 1;
  const auto position = std::upper_bound(data_->position_first.begin(), data_->position_first.end(), cell) -
                        data_->position_first.begin() - 1;
  Pose T = Pose::Identity();
  T.translation() = data_->position_of(i, static_cast<std::size_t>(position));
  T.linear() = Eigen::Quaterniond(data_->poses[i].coefficients().cast<double>()).normalized().toRotationMatrix();
  return T;
}

Eigen::MatrixXd ReachDatabase::cell(const Pose& T_base_tip) const {
  require(T_base_tip.matrix().allFinite(), "T_base_tip", "not finite", "must be a pose");
  const auto [begin, end] = data_->find_cell(T_base_tip);
  if (begin == end) return Eigen::MatrixXd(data_->joints, 0);
  return Eigen::Map<const Eigen::MatrixXf>(&data_->configurations[begin * data_->joints], data_->joints,
                                           static_cast<Eigen::Index>(end - begin))
      .cast<double>();
}

}  // namespace mmgrasp
