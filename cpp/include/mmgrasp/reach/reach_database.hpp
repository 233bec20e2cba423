#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

struct MMGRASP_EXPORT ReachOptions {
  std::int64_t samples = 2'000'000;    ///< Arm configurations drawn; > 0.
  double position_cell = 0.10;         ///< Edge of a position cell [m]; > 0.
  double rotation_cell = 0.55;         ///< Approximate diameter of a rotation cell [rad]; in (0.05, 3].
  int max_per_cell = 16;               ///< Configurations kept a cell (the most different ones first come); > 0.
  double min_manipulability = 0.02;    ///< Dropped below this fraction of the largest manipulability sampled; in [0, 1).
  unsigned seed = 1;
  int threads = 0;                     ///< 0: all. Does not change the answer.
  void check() const;
};

/// Sampled arm configurations, free of self-collision, binned by tool pose into six-dimensional cells (P1 3.2.1).
/// Positions are floored (the cell at 0 is no wider than the others); rotations are binned in cells of nearly equal size
/// that stay neighbourhoods everywhere, unlike roll-pitch-yaw voxels near pitch +-90 degrees. Immutable after build or load.
class MMGRASP_EXPORT ReachDatabase {
 public:
  /// `arm` must not have base joints; poses are in the robot's root frame. Returns an empty database when stopped.
  static ReachDatabase build(const JointGroup& arm, const ReachOptions& options = {}, const Monitor& monitor = {});
  /// Writes to a temporary name and renames. Throws IoError.
  void save(const std::string& path) const;
  /// Throws IoError on a truncated, foreign or corrupt file (checksum), naming it and what is wrong.
  static ReachDatabase load(const std::string& path);
  /// Key under which a database of this arm with these options is cached.
  static std::string cache_key(const JointGroup& arm, const ReachOptions& options);
  /// Loads `cache_dir`/<key>.reach when it is there and sound, else builds and saves it.
  static ReachDatabase load_or_build(const JointGroup& arm, const ReachOptions& options, const std::string& cache_dir,
                                     const Monitor& monitor = {});

  const std::string& key() const;
  int joint_count() const;
  std::int64_t size() const;         ///< Configurations stored.
  std::int64_t cell_count() const;   ///< Non-empty cells.
  const ReachOptions& options() const;

  /// Stored configurations whose tool pose lies in the pose's cell (one column each); no columns when the cell is empty.
  Eigen::MatrixXd cell(const Pose& T_base_tip) const;
  /// Up to `count` stored configurations near the pose, from its cell and the adjacent ones, nearest first (position
  /// distance in units of position_cell plus angle in units of rotation_cell). Columns of `out`; returns how many were written.
  /// `out` is resized only when too small: no allocation in the steady state.
  int nearest(const Pose& T_base_tip, int count, Eigen::MatrixXd& out) const;
  /// Largest distance from the root frame's origin to a stored tool position [m].
  double reach() const;
  /// Bounds of stored tool positions.
  Eigen::AlignedBox3d bounds() const;

  struct Data;
  explicit ReachDatabase(std::shared_ptr<const Data> data);

 private:
  std::shared_ptr<const Data> data_;
};

}  // namespace mmgrasp
