#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "reach/reach_data.hpp"

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
  Nearest(std::vector<Near>& storage, int count) : found_(storage), count_(static_cast<std::size_t>(count)) {
    found_.clear();
    found_.reserve(count_);
  }
  float worst() const {
    return found_.size() < count_ ? std::numeric_limits<float>::infinity() : found_.back().distance;
  }
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

/// A position cell next to the query's, and how far away it begins [cells].
struct PositionCell {
  std::uint64_t key;
  float distance;
};

/// Rotation cells of one direction cell with rolls next to the query's: up to two runs of ids, and how far they begin.
struct DirectionCell {
  std::array<std::pair<std::uint32_t, std::uint32_t>, 2> runs;  ///< First and last id, both included.
  int run_count;
  float distance;                                               ///< [rotation cells]
};

int position_cells(const Eigen::Vector3d& position, double edge, std::array<PositionCell, 27>& cells) {
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
    double squared = 0;
    for (int i = 0; i < 3; ++i) {
      const double gap = step[i] < 0 ? inside[i] : step[i] > 0 ? 1 - inside[i] : 0;
      squared += gap * gap;
    }
    cells[count++] = {detail::position_key(own + step), static_cast<float>(std::sqrt(squared))};
  }
  std::sort(cells.begin(), cells.begin() + count,
            [](const PositionCell& a, const PositionCell& b) { return a.distance < b.distance; });
  return count;
}

DirectionCell direction_cell(const detail::RotationCells& rotations, const Eigen::Matrix3d& R, std::uint32_t direction,
                             bool own, double rotation_cell) {
  const std::uint32_t rolls = rotations.rolls(), roll = rotations.roll_id(R, direction), base = direction * rolls;
  DirectionCell cell;
  cell.distance = own ? 0.0f : static_cast<float>(rotations.angle_to(R.col(2), direction) / rotation_cell);
  cell.run_count = 1;
  if (rolls == 3) {
    cell.runs[0] = {base, base + 2};
  } else if (roll == 0) {
    cell.runs = {{{base, base + 1}, {base + rolls - 1, base + rolls - 1}}};
    cell.run_count = 2;
  } else if (roll == rolls - 1) {
    cell.runs = {{{base + roll - 1, base + roll}, {base, base}}};
    cell.run_count = 2;
  } else {
    cell.runs[0] = {base + roll - 1, base + roll + 1};
  }
  return cell;
}

int direction_cells(const detail::RotationCells& rotations, const Eigen::Matrix3d& R, double rotation_cell,
                    std::array<DirectionCell, detail::RotationCells::kMaxNeighbours>& cells) {
  const std::uint32_t own = rotations.direction_id(R.col(2));
  int count = 0;
  for (const std::uint32_t* n = rotations.neighbours_begin(own); n != rotations.neighbours_end(own); ++n)
    cells[count++] = direction_cell(rotations, R, *n, *n == own, rotation_cell);
  std::sort(cells.begin(), cells.begin() + count,
            [](const DirectionCell& a, const DirectionCell& b) { return a.distance < b.distance; });
  return count;
}

/// Measures stored poses against the query.
struct Query {
  const Data& data;
  Eigen::Vector3f position;
  Eigen::Vector4f quaternion;
  float per_metre, per_radian;

  void visit(std::size_t begin, std::size_t end, Nearest& nearest) const {
    for (std::size_t i = begin; i < end; ++i) {
      const float* pose = &data.poses[i * Data::kPoseSize];
      const float shift = (Eigen::Map<const Eigen::Vector3f>(pose) - position).norm() * per_metre;
      const float worst = nearest.worst();
      if (shift > worst) continue;
      // q and -q are one rotation; the chord between unit quaternions is exact for small angles where 2 acos is not.
      const Eigen::Vector4f other = Eigen::Map<const Eigen::Vector4f>(pose + 3);
      const float chord = std::sqrt(std::min((other - quaternion).squaredNorm(), (other + quaternion).squaredNorm()));
      if (shift + 2 * chord * per_radian > worst) continue;
      nearest.add({shift + 4 * std::asin(std::min(chord / 2, 1.0f)) * per_radian, i});
    }
  }

  void visit(std::int64_t position_cell, const DirectionCell& direction, Nearest& nearest) const {
    const auto begin = data.rotation_ids.begin() + data.position_first[position_cell];
    const auto end = data.rotation_ids.begin() + data.position_first[position_cell + 1];
    for (int run = 0; run < direction.run_count; ++run) {
      const auto first = std::lower_bound(begin, end, direction.runs[run].first);
      auto last = first;
      while (last != end && *last <= direction.runs[run].second) ++last;
      if (first == last) continue;
      visit(data.cell_first[first - data.rotation_ids.begin()], data.cell_first[last - data.rotation_ids.begin()],
            nearest);
    }
  }
};

}  // namespace

int ReachDatabase::nearest(const Pose& T_base_tip, int count, Eigen::MatrixXd& out) const {
  // Tested before the messages are made: strings would allocate on every call.
  if (count <= 0) require(false, "count", count, "must be positive");
  if (!T_base_tip.matrix().allFinite()) require(false, "T_base_tip", "not finite", "must be a pose");
  if (out.rows() != data_->joints || out.cols() < count) out.resize(data_->joints, count);
  if (data_->size() == 0) return 0;

  std::array<PositionCell, 27> positions;
  const int position_count = position_cells(T_base_tip.translation(), data_->options.position_cell, positions);
  if (position_count == 0) return 0;
  std::array<DirectionCell, detail::RotationCells::kMaxNeighbours> directions;
  const int direction_count =
      direction_cells(data_->rotations, T_base_tip.linear(), data_->options.rotation_cell, directions);

  const Query query{*data_, T_base_tip.translation().cast<float>(),
                    Eigen::Quaterniond(T_base_tip.linear()).normalized().coeffs().cast<float>(),
                    static_cast<float>(1 / data_->options.position_cell),
                    static_cast<float>(1 / data_->options.rotation_cell)};
  thread_local std::vector<Near> found;
  Nearest nearest(found, count);
  constexpr float kSlack = 1e-5f;  // the bounds are exact, the stored poses are rounded
  for (int p = 0; p < position_count && positions[p].distance <= nearest.worst() + kSlack; ++p) {
    const std::int64_t cell = data_->find_position(positions[p].key);
    if (cell < 0) continue;
    for (int d = 0; d < direction_count; ++d) {
      if (positions[p].distance + directions[d].distance > nearest.worst() + kSlack) break;
      query.visit(cell, directions[d], nearest);
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i)
    out.col(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::VectorXf>(&data_->configurations[found[i].index * data_->joints], data_->joints)
            .cast<double>();
  return static_cast<int>(found.size());
}

}  // namespace mmgrasp
