// ReachDatabase::nearest: the stored configurations whose tool is nearest to a pose.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "reach/database/reach_data.hpp"

namespace mmgrasp {
namespace {

using Data = ReachDatabase::Data;

struct Near {
  float distance;
  std::size_t index;
  bool operator<(const Near& other) const {
    return distance != other.distance ? distance < other.distance : index < other.index;
  }
};

/// The `count` nearest seen so far, sorted.
class Nearest {
 public:
  Nearest(std::vector<Near>& storage, int count) : found_(storage), count_(count) {
    found_.clear();
    found_.reserve(count_);
  }
  /// Finite while there is room, so that cells out of bounds (at infinity) stay out.
  float worst() const { return found_.size() < count_ ? std::numeric_limits<float>::max() : found_.back().distance; }
  void add(const Near& near) {
    if (found_.size() == count_) {
      if (!(near < found_.back())) return;
      found_.pop_back();
    }
    found_.insert(std::upper_bound(found_.begin(), found_.end(), near), near);
  }

 private:
  std::vector<Near>& found_;
  std::size_t count_;
};

/// A non-empty position cell next to the query's.
struct PositionCell {
  std::int64_t index;
  float distance;         ///< How far from the query the cell begins [cells].
  Eigen::Vector3f query;  ///< The query from the cell's lower corner [cells].
};

int position_cells(const Data& data, const Eigen::Vector3d& position, std::array<PositionCell, 27>& cells) {
  const double edge = data.options.position_cell;
  detail::CellIndex own;
  Eigen::Vector3d inside;
  for (int i = 0; i < 3; ++i) {
    const double at = position[i] / edge, floor = std::floor(at);
    if (!(std::abs(floor) <= 2.0 * static_cast<double>(detail::kPositionLimit))) return 0;
    own[i] = static_cast<std::int64_t>(floor);
    inside[i] = at - floor;
  }
  int count = 0;
  for (int n = 0; n < 27; ++n) {
    const detail::CellIndex step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
    if (!detail::in_range(own + step)) continue;
    const std::int64_t index = data.find_position(detail::position_key(own + step));
    if (index < 0) continue;
    double squared = 0;
    for (int i = 0; i < 3; ++i) {
      const double gap = step[i] < 0 ? inside[i] : step[i] > 0 ? 1 - inside[i] : 0;
      squared += gap * gap;
    }
    cells[count++] = {index, static_cast<float>(std::sqrt(squared)), (inside - step.cast<double>()).cast<float>()};
  }
  std::sort(cells.begin(), cells.begin() + count,
            [](const PositionCell& a, const PositionCell& b) { return a.distance < b.distance; });
  return count;
}

/// Lower bounds of rotation distances [rotation cells], by rotation cell. A table, because looking every id of a
/// position cell up is quicker than searching the ids for each of 27 rotation cells.
class RotationBounds {
 public:
  void set(const Data& data, const Eigen::Matrix3d& R) {
    for (int i = 0; i < count_; ++i) table_[cells_[i].id] = kFar;
    if (table_.size() < data.rotations.count()) table_.resize(data.rotations.count(), kFar);
    count_ = data.rotations.near_cells(R, cells_);
    for (int i = 0; i < count_; ++i) {
      cells_[i].angle /= data.options.rotation_cell;
      table_[cells_[i].id] = static_cast<float>(cells_[i].angle);
    }
  }
  const float* table() const { return table_.data(); }
  /// Nearest first.
  const detail::RotationCells::NearCell* begin() const { return cells_.data(); }
  const detail::RotationCells::NearCell* end() const { return cells_.data() + count_; }

 private:
  static constexpr float kFar = std::numeric_limits<float>::infinity();
  std::vector<float> table_;
  detail::RotationCells::NearCells cells_;
  int count_ = 0;
};

constexpr float kSlack = 2e-4f;  // bounds are exact, stored poses rounded

/// Measures stored poses against the query.
struct Query {
  const Data& data;
  Eigen::Vector4f quaternion;
  float per_radian;

  void measure(const detail::StoredPose* poses, const PositionCell& position, std::size_t begin, std::size_t end,
               Nearest& nearest) const {
    for (std::size_t i = begin; i < end; ++i) {
      const detail::StoredPose& pose = poses[i];
      const float shift = (pose.place() - position.query).norm();
      // q and -q are one rotation; the chord between unit quaternions is exact for small angles where 2 acos is not.
      const Eigen::Vector4f other = pose.coefficients();
      const float chord = std::sqrt(std::min((other - quaternion).squaredNorm(), (other + quaternion).squaredNorm()));
      if (shift + 2 * chord * per_radian > nearest.worst()) continue;
      nearest.add({shift + 4 * std::asin(std::min(chord / 2, 1.0f)) * per_radian, i});
    }
  }

  /// Has the memory fetch a position cell's tables (their first lines) while another one is worked on. Inlined, since
  /// GCC removes calls of functions that do nothing but prefetch.
  [[gnu::always_inline]] void ask_for(const PositionCell& position) const {
    constexpr std::uint32_t kLine = 16, kLines = 8;
    const std::uint32_t begin = data.position_first[position.index];
    const std::uint32_t end = std::min(begin + kLine * kLines, data.position_first[position.index + 1]);
    for (std::uint32_t cell = begin; cell < end; cell += kLine) {
      __builtin_prefetch(&data.rotation_ids[cell]);
      __builtin_prefetch(&data.cell_first[cell]);
    }
  }

  /// Looks at every cell of a position cell, some at a time: first those within bounds are picked and their poses asked
  /// from memory, then measured, so that the waits overlap.
  void scan(const detail::StoredPose* poses, const PositionCell& position, const float* bounds,
            Nearest& nearest) const {
    constexpr std::size_t kChunk = 64;
    std::array<std::uint32_t, kChunk> picked;
    const std::uint32_t end = data.position_first[position.index + 1];
    for (std::uint32_t cell = data.position_first[position.index]; cell < end;) {
      const float limit = nearest.worst() + kSlack - position.distance;
      std::size_t count = 0;
      for (const std::uint32_t stop = std::min<std::uint32_t>(end, cell + kChunk); cell < stop; ++cell) {
        picked[count] = cell;
        count += bounds[data.rotation_ids[cell]] <= limit ? 1 : 0;
      }
      for (std::size_t i = 0; i < count; ++i) __builtin_prefetch(&poses[data.cell_first[picked[i]]]);
      for (std::size_t i = 0; i < count; ++i)
        measure(poses, position, data.cell_first[picked[i]], data.cell_first[picked[i] + 1], nearest);
    }
  }

  /// Searches the adjacent rotation cells one by one: for position cells with very many rotation cells.
  void search(const detail::StoredPose* poses, const PositionCell& position, const RotationBounds& bounds,
              Nearest& nearest) const {
    const auto* begin = data.rotation_ids.begin() + data.position_first[position.index];
    const auto* end = data.rotation_ids.begin() + data.position_first[position.index + 1];
    for (const auto& rotation_cell : bounds) {
      if (position.distance + static_cast<float>(rotation_cell.angle) > nearest.worst() + kSlack) break;
      const auto* found = std::lower_bound(begin, end, rotation_cell.id);
      if (found == end || *found != rotation_cell.id) continue;
      const std::size_t cell = found - data.rotation_ids.begin();
      measure(poses, position, data.cell_first[cell], data.cell_first[cell + 1], nearest);
    }
  }

  void visit(const PositionCell& position, const RotationBounds& bounds, Nearest& nearest) const {
    constexpr std::uint32_t kWorthScanning = 1024;
    const detail::StoredPose* poses = data.poses_of(position.index);
    if (data.position_first[position.index + 1] - data.position_first[position.index] <= kWorthScanning)
      scan(poses, position, bounds.table(), nearest);
    else
      search(poses, position, bounds, nearest);
  }
};

}  // namespace

int ReachDatabase::nearest(const Pose& T_base_tip, int count, Eigen::MatrixXd& out) const {
  // Tested before the messages are made: strings would allocate on every call.
  if (count <= 0) require(false, "count", count, "must be positive");
  if (!T_base_tip.matrix().allFinite()) require(false, "T_base_tip", "not finite", "must be a pose");
  count = static_cast<int>(std::min<std::int64_t>(count, std::max<std::int64_t>(size(), 1)));
  if (out.rows() != data_->joints || out.cols() < count) out.resize(data_->joints, count);
  if (data_->size() == 0) return 0;

  std::array<PositionCell, 27> positions;
  const int position_count = position_cells(*data_, T_base_tip.translation(), positions);
  if (position_count == 0) return 0;
  thread_local RotationBounds bounds;
  bounds.set(*data_, T_base_tip.linear());

  const Query query{*data_, Eigen::Quaterniond(T_base_tip.linear()).normalized().coeffs().cast<float>(),
                    static_cast<float>(1 / data_->options.rotation_cell)};
  thread_local std::vector<Near> found;
  Nearest nearest(found, count);
  query.ask_for(positions[0]);
  for (int p = 0; p < position_count && positions[p].distance <= nearest.worst() + kSlack; ++p) {
    if (p + 1 < position_count) query.ask_for(positions[p + 1]);
    query.visit(positions[p], bounds, nearest);
  }
  for (std::size_t i = 0; i < found.size(); ++i)
    data_->arm.decode(data_->stored(found[i].index, found[i].index + 1), 1,
                      out.col(static_cast<Eigen::Index>(i)).data());
  return static_cast<int>(found.size());
}

}  // namespace mmgrasp
