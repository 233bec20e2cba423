#include "reach/database/sample_shard.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/kinematics_batch.hpp"
#include "reach/database/reach_data.hpp"

namespace mmgrasp::detail {
namespace {

/// sqrt(det(J J^T)) (Yoshikawa), and sqrt(det(J^T J)) for fewer than six joints, for which the former is always 0.
double manipulability(const double* J, int joints) {
  if (joints < 6) {
    const Eigen::Map<const Matrix6Xd> jacobian(J, 6, joints);
    return std::sqrt(std::max(0.0, Eigen::MatrixXd(jacobian.transpose() * jacobian).determinant()));
  }
  // The product of the pivots of L D L^T: thresholds lie far from where squaring loses digits.
  double A[6][6] = {};
  for (int k = 0; k < joints; ++k, J += 6)
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) A[r][c] += J[r] * J[c];
  double product = 1;
  for (int k = 0; k < 6; ++k) {
    product *= A[k][k];
    if (!(product > 0)) return 0;
    const double inverse = 1 / A[k][k];
    for (int r = k + 1; r < 6; ++r) {
      const double factor = A[r][k] * inverse;
      for (int c = k + 1; c < 6; ++c) A[r][c] -= factor * A[k][c];
    }
  }
  return std::sqrt(product);
}

}  // namespace

ShardSampler::ShardSampler(const JointGroup& arm, const StoredArm& stored, const ReachOptions& options,
                           const RotationCells& rotations, CollisionChecker checker)
    : arm_(arm),
      stored_(stored),
      options_(options),
      rotations_(rotations),
      checker_(std::move(checker)),
      weighs_(options.min_manipulability > 0 || options.thinning > 0),
      numbers_(kBatch * arm.size()),
      q_(arm.size(), kBatch),
      chances_(kBatch),
      one_(arm.size()) {}

std::int64_t ShardSampler::block_size(std::int64_t block) const {
  return std::min(kBlock, options_.samples - block * kBlock);
}

void ShardSampler::draw(Rng& rng, int count) {
  const int joints = arm_.size();
  std::uint16_t* number = numbers_.data();
  for (int i = 0; i < count; ++i) {
    std::uint64_t bits = 0;
    for (int k = 0; k < joints; ++k, bits >>= 16) {
      if (k % 4 == 0) bits = rng.next();
      *number++ = static_cast<std::uint16_t>(bits);
    }
    if (options_.thinning > 0) chances_[i] = rng.uniform();
  }
  stored_.decode(numbers_.data(), count, q_.data());
  if (weighs_)
    fk_jacobian_batch(arm_, q_.leftCols(count), poses_, J_);
  else
    fk_batch(arm_, q_.leftCols(count), poses_);
}

double ShardSampler::largest_manipulability(std::int64_t block) {
  Rng rng(options_.seed, static_cast<std::uint64_t>(block));
  double largest = 0;
  for (std::int64_t left = block_size(block); left > 0; left -= kBatch) {
    const int count = static_cast<int>(std::min<std::int64_t>(kBatch, left));
    draw(rng, count);
    for (int i = 0; i < count; ++i)
      largest = std::max(largest, manipulability(J_.data() + 6 * arm_.size() * i, arm_.size()));
  }
  return largest;
}

bool ShardSampler::passes_manipulability(int i) const {
  if (!weighs_) return true;
  const double value = manipulability(J_.data() + 6 * arm_.size() * i, arm_.size());
  return value >= options_.min_manipulability * largest_ &&
         (options_.thinning <= 0 || value >= chances_[i] * options_.thinning * largest_);
}

void ShardSampler::sample_block(std::int64_t block, const FillTable* full) {
  Rng rng(options_.seed, static_cast<std::uint64_t>(block));
  const std::size_t joints = arm_.size();
  std::shared_lock<std::shared_mutex> reading;
  if (full != nullptr) reading = full->reading();
  for (std::int64_t left = block_size(block); left > 0; left -= kBatch) {
    const int count = static_cast<int>(std::min<std::int64_t>(kBatch, left));
    draw(rng, count);
    for (int i = 0; i < count; ++i) {
      if (!passes_manipulability(i)) continue;
      const Pose& T = poses_[i];
      const auto cell = position_cell(T.translation(), options_.position_cell);
      if (!cell)
        require(false, "position_cell", options_.position_cell,
                "too small: the arm reaches more than 8192 cells from the root [m]");
      const std::uint64_t position = position_key(*cell);
      const std::uint32_t rotation = rotations_.id(T.linear());
      if (full != nullptr && full->full(position << kRotationBits | rotation)) continue;
      one_ = q_.col(i);
      if (!checker_.is_free(one_)) continue;
      keys_.push_back(position);
      rotation_ids_.push_back(rotation);
      const auto* number = numbers_.data() + static_cast<std::size_t>(i) * joints;
      kept_.insert(kept_.end(), number, number + joints);
    }
  }
}

bool ShardSampler::sample(std::int64_t first, std::int64_t count, const FillTable* full,
                          const std::function<bool()>& step, ShardRecords& out) {
  keys_.clear();
  rotation_ids_.clear();
  kept_.clear();
  for (std::int64_t block = first; block < first + count; ++block) {
    sample_block(block, full);
    if (!step()) return false;
  }
  group(out);
  return true;
}

/// Brings records of one position cell together (counting sort: their order stays).
void ShardSampler::group(ShardRecords& out) const {
  std::unordered_map<std::uint64_t, std::uint32_t> number;
  std::vector<std::uint32_t> cell_of(keys_.size()), count;
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const auto [it, is_new] = number.emplace(keys_[i], static_cast<std::uint32_t>(keys.size()));
    if (is_new) {
      keys.push_back(keys_[i]);
      count.push_back(0);
    }
    cell_of[i] = it->second;
    ++count[it->second];
  }
  std::vector<std::uint32_t> order(keys.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  out.position_keys.clear();
  out.counts.clear();
  std::vector<std::uint32_t> next(keys.size());
  std::uint32_t begin = 0;
  for (const std::uint32_t cell : order) {
    out.position_keys.push_back(keys[cell]);
    out.counts.push_back(count[cell]);
    next[cell] = begin;
    begin += count[cell];
  }
  const std::size_t joints = arm_.size();
  out.rotation_ids.resize(keys_.size());
  out.configurations.resize(keys_.size() * joints);
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const std::size_t at = next[cell_of[i]]++;
    out.rotation_ids[at] = rotation_ids_[i];
    std::copy_n(&kept_[i * joints], joints, &out.configurations[at * joints]);
  }
}

}  // namespace mmgrasp::detail
