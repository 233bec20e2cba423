#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

/// How many configurations a ReachDatabase samples, into which cells it sorts them, and which it keeps.
struct MMGRASP_EXPORT ReachOptions {
  std::int64_t samples = 2'000'000;  ///< Arm configurations drawn; > 0.
  double position_cell = 0.10;       ///< Edge of a position cell [m]; > 0.
  double rotation_cell = 0.55;       ///< Approximate diameter of a rotation cell [rad]; in (0.05, 3].
  int max_per_cell = 16;             ///< Configurations kept a cell: the first drawn; > 0.
  double min_manipulability = 0.02;  ///< Dropped below this fraction of the largest manipulability sampled; in [0, 1).
  /// Below this fraction of the largest manipulability a sample is kept with a chance that falls linearly to 0, which
  /// evens out the crowds near singularities (P1 3.2.1); 0: all are kept; in [0, 1].
  double thinning = 0;
  unsigned seed = 1;
  int threads = 0;  ///< 0: all. Does not change the answer.
  void check() const;
};

/// Sampled arm configurations, free of self-collision, binned by tool pose into six-dimensional cells (P1 3.2.1): good
/// first guesses for inverse kinematics, and quick answers to "out of reach".
///
///     const ReachDatabase database = ReachDatabase::load_or_build(arm, {}, "cache");
///     Eigen::MatrixXd seeds;
///     const int found = database.nearest(T_base_tip, 8, seeds);  // one configuration a column; 0: out of reach
///
/// - Positions are floored (the cell at 0 is no wider than the others); rotations are binned in cells of nearly equal
///   size that stay neighbourhoods everywhere, unlike roll-pitch-yaw voxels near pitch +-90 degrees.
/// - A joint takes 16 bits between its limits (continuous joints: in [-pi, pi]), and it is these configurations that
///   are drawn, checked and binned: nothing is rounded afterwards.
/// - On disk a database is a folder of numpy arrays with a meta.json (docs/methods/reach.md), mapped into memory.
/// - Immutable after build or load; safe to share between threads.
class MMGRASP_EXPORT ReachDatabase {
 public:
  /// `arm` must not have base joints; poses are in the robot's root frame, wherever the arm's root stands. Samples
  /// whose manipulability is below the threshold, whose cell is full or who are in self-collision are dropped, in this
  /// order. The largest manipulability is taken from the first samples. Throws InvalidInput. Returns an empty database
  /// when stopped.
  static ReachDatabase build(const JointGroup& arm, const ReachOptions& options = {}, const Monitor& monitor = {});
  /// The same database, built through files: `path`.partial keeps finished parts, and a build of the same arm and
  /// options that was stopped goes on from them, with the same result bit for bit. Parts leave memory, so that the
  /// largest builds fit. Empty when stopped; else what stands at `path` (replaced as by save()). Throws IoError.
  static ReachDatabase build_to(const std::string& path, const JointGroup& arm, const ReachOptions& options = {},
                                const Monitor& monitor = {});
  /// Writes a folder to a temporary name and renames it. Replaces a database only; throws IoError when something else
  /// stands at `path`.
  void save(const std::string& path) const;
  /// Maps the folder: quick whatever the size. Checks names, sizes, types, meta.json and the tables by their checksums;
  /// configurations are compared with theirs when they are first used, and a difference then throws. Throws IoError on
  /// a truncated, foreign or corrupt database, naming the file and what is wrong. The options loaded are those of the
  /// build (threads: 0).
  static ReachDatabase load(const std::string& path);
  /// The same, and throws IoError unless it was built for just this arm, saying what of the robot is another.
  static ReachDatabase load(const std::string& path, const JointGroup& arm);
  /// Compares all files with their checksums. Throws IoError naming the file and the place; false when stopped.
  bool verify(const Monitor& monitor = {}) const;
  /// What of this arm is not as it was when the database was built, in words; empty when nothing.
  std::string difference(const JointGroup& arm) const;
  /// Key under which a database of this arm with these options is cached: a hash of the robot (shapes, limits, disabled
  /// pairs), the group's joints and tip, the values at which the other joints are held, and every option but threads.
  static std::string cache_key(const JointGroup& arm, const ReachOptions& options);
  /// Loads `cache_dir`/<key>.reach when it is there and sound, else builds and saves it (not when stopped; in the place
  /// of a damaged one, as its stage says). The folder is made when missing; throws IoError first when it cannot be.
  /// What cannot be saved in it then, on a full disk, is returned all the same, and the stage says why it was not kept.
  static ReachDatabase load_or_build(const JointGroup& arm, const ReachOptions& options, const std::string& cache_dir,
                                     const Monitor& monitor = {});

  const std::string& key() const;
  int joint_count() const;
  std::int64_t size() const;        ///< Configurations stored.
  std::int64_t cell_count() const;  ///< Non-empty cells.
  const ReachOptions& options() const;

  /// Stored configurations whose tool pose lies in the pose's cell (one column each, the most different ones first); no
  /// columns when the cell is empty.
  Eigen::MatrixXd cell(const Pose& T_base_tip) const;
  /// First and last + 1 index of the stored configurations in the pose's cell; the same twice when it is empty.
  std::pair<std::int64_t, std::int64_t> voxel(const Pose& T_base_tip) const;
  /// Up to `count` stored configurations near the pose, from its cell and the adjacent ones, nearest first (position
  /// distance in units of position_cell plus angle in units of rotation_cell). Adjacent are the 27 position cells
  /// around, the directions of the tool's z axis whose cells touch the pose's, and the three nearest rolls about it:
  /// nothing within half a cell (0.5 of this distance) is ever missed. Distances are distinguished down to about 2e-4.
  /// Columns of `out`; returns how many were written. `out` is resized only when too small: no allocation in the steady
  /// state.
  int nearest(const Pose& T_base_tip, int count, Eigen::MatrixXd& out) const;
  /// The configuration at an index in [0, size()), sorted by cell; and its tool pose.
  Eigen::VectorXd configuration(std::int64_t index) const;
  Pose tool_pose(std::int64_t index) const;
  /// Largest distance from the root frame's origin to a stored tool position [m].
  double reach() const;
  /// Bounds of stored tool positions; empty when the database is.
  Eigen::AlignedBox3d bounds() const;
  const std::string& path() const;  ///< The folder it was loaded from; empty for one in memory only.

  struct Data;
  explicit ReachDatabase(std::shared_ptr<const Data> data);
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

}  // namespace mmgrasp
