#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "reach/cell_counter.hpp"
#include "reach/reach_data.hpp"

namespace mmgrasp {
namespace {

using Data = ReachDatabase::Data;

constexpr std::int64_t kBlock = 2048;       // samples of one random stream: the unit of parallel work
constexpr std::int64_t kBlocksABatch = 32;  // between batches the counts of full cells are brought up to date
constexpr std::int64_t kManipulabilityBlocks = 8;
constexpr const char* kStage = "reachability database";

/// Configurations that passed, in the order of sampling.
struct Kept {
  std::vector<std::uint64_t> keys;
  std::vector<float> configurations;
  std::vector<detail::StoredPose> poses;

  void append(const Kept& other, std::size_t index, int joints) {
    keys.push_back(other.keys[index]);
    const auto q = other.configurations.begin() + index * joints;
    configurations.insert(configurations.end(), q, q + joints);
    poses.push_back(other.poses[index]);
  }
};

/// Largest float not above, or smallest not below a bound: rounding must not leave the limits.
float round_inwards(double value, double lower, double upper) {
  float rounded = static_cast<float>(value);
  if (rounded > upper) rounded = std::nextafter(rounded, -std::numeric_limits<float>::infinity());
  if (rounded < lower) rounded = std::nextafter(rounded, std::numeric_limits<float>::infinity());
  return rounded;
}

/// sqrt(det(J J^T)) (Yoshikawa), and sqrt(det(J^T J)) for fewer than six joints, for which the former is always 0.
double manipulability(const Matrix6Xd& J) {
  const double determinant = J.cols() >= 6 ? Eigen::Matrix<double, 6, 6>(J * J.transpose()).determinant()
                                           : Eigen::MatrixXd(J.transpose() * J).determinant();
  return std::sqrt(std::max(0.0, determinant));
}

/// Draws configurations of one arm; one per thread.
class Sampler {
 public:
  explicit Sampler(const JointGroup& arm)
      : arm_(arm), lower_(arm.sample_lower()), upper_(arm.sample_upper()), q_(arm.size()), J_(6, arm.size()) {}

  void draw(Rng& rng) {
    for (Eigen::Index i = 0; i < q_.size(); ++i)
      q_[i] = round_inwards(rng.uniform(lower_[i], upper_[i]), lower_[i], upper_[i]);
    arm_.fk_jacobian(q_, T_, J_);
  }
  const Eigen::VectorXd& q() const { return q_; }
  const Pose& pose() const { return T_; }
  Eigen::VectorXd range() const { return upper_ - lower_; }
  double manipulability() const { return mmgrasp::manipulability(J_); }

 private:
  const JointGroup& arm_;
  Eigen::VectorXd lower_, upper_, q_;
  Matrix6Xd J_;
  Pose T_ = Pose::Identity();
};

class Builder {
 public:
  Builder(const JointGroup& arm, const ReachOptions& options, const Monitor& monitor)
      : arm_(arm),
        options_(options),
        monitor_(monitor),
        threads_(resolve_threads(options.threads)),
        rotations_(options.rotation_cell),
        counter_(1 << 16),
        joint_scale_(Sampler(arm).range().cwiseMax(1e-9).cwiseInverse().cast<float>()) {
    CheckerOptions checking;
    checking.check_scene = false;
    const CollisionChecker checker(arm_, World{}, checking);
    for (int i = 0; i < threads_; ++i) {
      checkers_.push_back(checker.clone());
      samplers_.emplace_back(arm_);
    }
  }

  /// False when stopped.
  bool run(Data& data) {
    if (!estimate_manipulability()) return false;
    const std::int64_t blocks = (options_.samples + kBlock - 1) / kBlock;
    std::vector<Kept> batch(kBlocksABatch);
    for (std::int64_t first = 0; first < blocks; first += kBlocksABatch) {
      monitor_.report(kStage, static_cast<double>(first) / static_cast<double>(blocks));
      const std::int64_t count = std::min(kBlocksABatch, blocks - first);
      const auto work = [&](std::size_t item, int worker) {
        sample_block(first + static_cast<std::int64_t>(item), worker, batch[item]);
      };
      if (!parallel_for(static_cast<std::size_t>(count), threads_, work, silent())) return false;
      for (std::int64_t i = 0; i < count; ++i) merge(batch[i]);
    }
    if (!store(data)) return false;
    monitor_.report(kStage, 1.0);
    return true;
  }

 private:
  Monitor silent() const { return Monitor{monitor_.stop, {}}; }

  std::int64_t block_size(std::int64_t block) const { return std::min(kBlock, options_.samples - block * kBlock); }

  /// From the first blocks, so that every sample is measured against the same threshold.
  bool estimate_manipulability() {
    if (options_.min_manipulability <= 0) return !monitor_.stopped();
    std::vector<double> largest(kManipulabilityBlocks, 0);
    const std::int64_t blocks = std::min(kManipulabilityBlocks, (options_.samples + kBlock - 1) / kBlock);
    const auto work = [&](std::size_t block, int worker) {
      Rng rng(options_.seed, block);
      for (std::int64_t i = 0; i < block_size(static_cast<std::int64_t>(block)); ++i) {
        samplers_[worker].draw(rng);
        largest[block] = std::max(largest[block], samplers_[worker].manipulability());
      }
    };
    if (!parallel_for(static_cast<std::size_t>(blocks), threads_, work, silent())) return false;
    threshold_ = options_.min_manipulability * *std::max_element(largest.begin(), largest.end());
    return true;
  }

  detail::CellIndex checked_cell(const Pose& T) const {
    const auto index = detail::position_cell(T.translation(), options_.position_cell);
    require(index.has_value(), "position_cell", options_.position_cell,
            "too small: the arm reaches more than 8192 cells from the root [m]");
    return *index;
  }

  /// Reads the counter as the batches before left it; so what passes depends on the block alone, not on the threads.
  void sample_block(std::int64_t block, int worker, Kept& kept) {
    kept = {};
    Rng rng(options_.seed, static_cast<std::uint64_t>(block));
    Sampler& sampler = samplers_[worker];
    for (std::int64_t i = 0; i < block_size(block); ++i) {
      sampler.draw(rng);
      if (threshold_ > 0 && sampler.manipulability() < threshold_) continue;
      const detail::CellIndex cell = checked_cell(sampler.pose());
      const std::uint64_t key =
          (detail::position_key(cell) << detail::kRotationBits) | rotations_.id(sampler.pose().linear());
      if (counter_.count(key) >= options_.max_per_cell) continue;
      if (!checkers_[worker].is_free(sampler.q())) continue;
      kept.keys.push_back(key);
      for (const double value : sampler.q()) kept.configurations.push_back(static_cast<float>(value));
      kept.poses.emplace_back(sampler.pose(), cell, options_.position_cell);
    }
  }

  void merge(const Kept& block) {
    for (std::size_t i = 0; i < block.keys.size(); ++i)
      if (counter_.increment(block.keys[i], options_.max_per_cell)) kept_.append(block, i, arm_.size());
  }

  /// Sorts by cell, and within each cell puts the most different configurations first.
  bool store(Data& data) {
    std::vector<std::uint64_t> order(kept_.keys.size());
    std::iota(order.begin(), order.end(), std::uint64_t{0});
    std::sort(order.begin(), order.end(), [&](std::uint64_t a, std::uint64_t b) {
      return kept_.keys[a] != kept_.keys[b] ? kept_.keys[a] < kept_.keys[b] : a < b;
    });
    constexpr std::uint64_t kRotationMask = (std::uint64_t{1} << detail::kRotationBits) - 1;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const std::uint64_t key = kept_.keys[order[i]];
      if (i > 0 && key == kept_.keys[order[i - 1]]) continue;
      if (data.position_keys.empty() || data.position_keys.back() != key >> detail::kRotationBits) {
        data.position_keys.push_back(key >> detail::kRotationBits);
        data.position_first.push_back(static_cast<std::uint32_t>(data.rotation_ids.size()));
      }
      data.rotation_ids.push_back(static_cast<std::uint32_t>(key & kRotationMask));
      data.cell_first.push_back(static_cast<std::uint32_t>(i));
    }
    data.position_first.push_back(static_cast<std::uint32_t>(data.rotation_ids.size()));
    data.cell_first.push_back(static_cast<std::uint32_t>(order.size()));

    const std::size_t cells = data.rotation_ids.size(), chunk = 4096;
    const auto spread = [&](std::size_t item, int) {
      for (std::size_t cell = item * chunk; cell < std::min(cells, (item + 1) * chunk); ++cell)
        most_different_first(order, data.cell_first[cell], data.cell_first[cell + 1]);
    };
    if (!parallel_for((cells + chunk - 1) / chunk, threads_, spread, silent())) return false;

    const std::size_t joints = static_cast<std::size_t>(arm_.size());
    data.configurations.resize(order.size() * joints);
    data.poses.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      std::copy_n(&kept_.configurations[order[i] * joints], joints, &data.configurations[i * joints]);
      data.poses[i] = kept_.poses[order[i]];
    }
    return true;
  }

  /// Farthest-point order over joint values scaled by their ranges, starting with the first drawn.
  void most_different_first(std::vector<std::uint64_t>& order, std::size_t begin, std::size_t end) const {
    const auto joints = static_cast<Eigen::Index>(arm_.size());
    const auto at = [&](std::size_t place) {
      return Eigen::Map<const Eigen::VectorXf>(&kept_.configurations[order[place] * joints], joints);
    };
    std::vector<float> apart(end - begin, std::numeric_limits<float>::infinity());
    for (std::size_t chosen = begin; chosen + 2 < end; ++chosen) {
      std::size_t farthest = chosen + 1;
      for (std::size_t i = chosen + 1; i < end; ++i) {
        const float distance = (at(i) - at(chosen)).cwiseProduct(joint_scale_).squaredNorm();
        apart[i - begin] = std::min(apart[i - begin], distance);
        if (apart[i - begin] > apart[farthest - begin]) farthest = i;
      }
      std::swap(order[chosen + 1], order[farthest]);
      std::swap(apart[chosen + 1 - begin], apart[farthest - begin]);
    }
  }

  const JointGroup& arm_;
  const ReachOptions& options_;
  const Monitor& monitor_;
  int threads_;
  detail::RotationCells rotations_;
  detail::CellCounter counter_;
  Eigen::VectorXf joint_scale_;  ///< One over each joint's range.
  std::vector<CollisionChecker> checkers_;
  std::vector<Sampler> samplers_;
  double threshold_ = 0;
  Kept kept_;
};

}  // namespace

ReachDatabase ReachDatabase::build(const JointGroup& arm, const ReachOptions& options, const Monitor& monitor) {
  options.check();
  const JointGroup at_root = detail::checked_arm(arm);
  auto data = std::make_shared<Data>();
  data->options = options;
  data->options.threads = 0;
  data->key = cache_key(arm, options);
  data->joints = arm.size();
  if (!Builder(at_root, options, monitor).run(*data)) data->clear();
  data->complete();
  return ReachDatabase(std::move(data));
}

}  // namespace mmgrasp
