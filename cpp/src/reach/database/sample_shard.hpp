#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "reach/database/fill_table.hpp"
#include "reach/database/rotation_cells.hpp"
#include "reach/database/stored_arm.hpp"

namespace mmgrasp::detail {

constexpr std::int64_t kBlock = 2048;  ///< Samples of one random stream: what is drawn depends on the block alone.

/// What passed of some blocks: by position cell, within it in the order of sampling.
struct ShardRecords {
  std::vector<std::uint64_t> position_keys;  ///< Ascending.
  std::vector<std::uint32_t> counts;         ///< One per position cell.
  std::vector<std::uint32_t> rotation_ids;   ///< One per record.
  std::vector<std::uint16_t> configurations;
  std::size_t size() const { return rotation_ids.size(); }
};

/// Draws configurations of one arm; one per thread.
class ShardSampler {
 public:
  /// All but the checker are shared and must outlive the sampler.
  ShardSampler(const JointGroup& arm, const StoredArm& stored, const ReachOptions& options,
               const RotationCells& rotations, CollisionChecker checker);

  /// Largest manipulability of a block's samples.
  double largest_manipulability(std::int64_t block);
  void set_largest_manipulability(double largest) { largest_ = largest; }

  /// Draws blocks first .. first + count - 1. `step` is called after each block and ends the work by returning false
  /// (then this does too). `full` may be null.
  bool sample(std::int64_t first, std::int64_t count, const FillTable* full, const std::function<bool()>& step,
              ShardRecords& out);

 private:
  static constexpr int kBatch = 64;  // stays in the first-level cache

  std::int64_t block_size(std::int64_t block) const;
  void draw(Rng& rng, int count);
  void sample_block(std::int64_t block, const FillTable* full);
  bool passes_manipulability(int i) const;
  void group(ShardRecords& out) const;

  const JointGroup& arm_;
  const StoredArm& stored_;
  const ReachOptions& options_;
  const RotationCells& rotations_;
  CollisionChecker checker_;
  bool weighs_;  ///< Manipulability matters.
  double largest_ = 0;

  std::vector<std::uint16_t> numbers_;  // of a batch
  Eigen::MatrixXd q_;
  std::vector<double> chances_;
  Poses poses_;
  Matrix6Xd J_;
  Eigen::VectorXd one_;

  // What a shard holds, in the order of sampling.
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> rotation_ids_;
  std::vector<std::uint16_t> kept_;
};

}  // namespace mmgrasp::detail
