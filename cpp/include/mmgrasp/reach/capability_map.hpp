#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

/// Where a capability map looks, which tool poses it tries there, and how hard.
struct MMGRASP_EXPORT CapabilityOptions {
  Eigen::Vector3d lower{-1, -1, 0};   ///< Corner of the grid in the robot's root frame [m].
  Eigen::Vector3d upper{1, 1, 2.6};   ///< The opposite corner [m]; a whole number of voxels away from `lower`.
  double voxel = 0.10;                ///< Edge of a voxel and diameter of its inscribed sphere [m]; > 0.
  int poses = 200;                    ///< Tool poses a voxel; a multiple of `rolls`, in [1, 10000].
  int rolls = 1;                      ///< Rolls about each approach direction; in [1, poses].
  Eigen::Vector3d approach{0, 0, 1};  ///< Where the tool points, in the tip's frame; not zero.
  int samples = 0;                    ///< Values tried of joints a pose leaves free; 0: 64 for one, 128 for two; >= 0.
  int sweeps = 4;                     ///< Times that solutions spread from pose to neighbouring pose; >= 0.
  int restarts = 0;                   ///< Further random descents for poses that border reached ones; >= 0.
  double padding = 0;                 ///< Robot links are grown by this against the scene [m]; >= 0.
  unsigned seed = 1;
  int threads = 0;  ///< 0: all. Does not change the answer.
  void check() const;
};

/// How many of the tool poses around a point the arm reaches (P3 3.9.2).
///
///     const CapabilityMap map = CapabilityMap::build(arm, world);
///     const double share = map.index_at({0.6, 0.0, 0.8});          // reachability index (3.13), in [0, 1]
///     const CapabilityMap later = map.restricted(arm, fuller_world);  // an obstacle has come
///
/// - Space is cut into voxels with an inscribed sphere each. Tool poses stand on the sphere, spread evenly, pointing at
///   its centre; each is tried by inverse kinematics that minds joint limits, self-collision and the scene.
/// - What counts as reached carries a configuration that was checked. What does not was searched in closed form over
///   sampled values of the joints that a pose leaves free, from the solutions of neighbouring poses, and along the
///   border of what is reached by further values and by Newton's method from what stuck out of the limits least
///   (docs/methods/capability_map.md). Arms without closed form are searched by Newton's method from a reachability
///   database.
/// - Directions follow a spherical Fibonacci lattice. Each takes `rolls` rolls evenly apart, and their start goes round
///   by an irrational step from one direction to the next, so that with one roll a voxel's poses sample rolls evenly,
///   too (P3 says nothing of rolls).
/// - All poses are in the root frame of the robot; the map moves with it. Immutable; safe to share.
class MMGRASP_EXPORT CapabilityMap {
 public:
  /// `arm` must not have base joints; a lift may be among its joints. What the robot holds is the world's. Throws
  /// InvalidInput. Returns an empty map (no voxels) when stopped.
  static CapabilityMap build(const JointGroup& arm, const World& world = {}, const CapabilityOptions& options = {},
                             const Monitor& monitor = {});
  /// The map of the same arm in a world that has more in it than the one of this map: only what is reached here is
  /// checked again, so that nothing is reached that is not reached here, for a fraction of the time. `padding` grows
  /// the links. Throws InvalidInput when the map was made for another arm.
  CapabilityMap restricted(const JointGroup& arm, const World& world, const Monitor& monitor = {}) const;

  /// Writes the folder `path`: index.npy (float32, x y z), classes.npy (uint8, x y z pose; the values of Rejection),
  /// configurations.npy (float32, one row for each reached pose in the order of `classes`), tool_poses.npy (float64,
  /// (poses, 4, 4) around a voxel's centre) and meta.json. Written beside and renamed. Throws IoError.
  void save(const std::string& path) const;
  /// Throws IoError on a foreign, truncated or corrupt folder, naming the file and what is wrong.
  static CapabilityMap load(const std::string& path);

  const CapabilityOptions& options() const;
  /// Names the robot, the group and where the other joints are held: what restricted() compares.
  const std::string& arm_key() const;
  const std::array<int, 3>& shape() const;  ///< Voxels along x, y, z.
  std::int64_t voxel_count() const;
  /// Number of the voxel (x slowest, z fastest). Throws InvalidInput when outside.
  std::int64_t voxel(int x, int y, int z) const;
  /// Number of the voxel that contains a point in the root frame (lower faces belong to it), or -1 outside.
  std::int64_t voxel_at(const Eigen::Vector3d& p_root_point) const;
  Eigen::Vector3d centre(std::int64_t voxel) const;          ///< A voxel's centre in the root frame [m].
  Pose tool_pose(std::int64_t voxel, int pose) const;        ///< T_root_tip.
  Rejection classified(std::int64_t voxel, int pose) const;  ///< none: reached.
  /// The configuration that reaches the pose, within limits and free; empty when it is not reached.
  Eigen::VectorXd configuration(std::int64_t voxel, int pose) const;
  int joint_count() const;

  const std::vector<float>& index() const;                     ///< Reachability index of each voxel, in [0, 1].
  const std::vector<std::uint8_t>& classes() const;            ///< voxel_count() x poses; the values of Rejection.
  const std::vector<float>& configurations() const;            ///< joint_count() for each reached pose, in order.
  std::int64_t reached() const;                                ///< Poses reached.
  const Rejections& rejections() const;                        ///< Poses not reached, by cause.
  double index_at(const Eigen::Vector3d& p_root_point) const;  ///< 0 outside the grid.
  double maximum() const;
  std::int64_t best_voxel() const;  ///< The first with the largest index; -1 in an empty map.
  /// Mean over poses of the voxel they lie in, with the robot's root at T_world_root: how well it stands for them.
  /// With `cone` < pi only tool poses whose approach lies within `cone` [rad] of the pose's own count.
  double score(const Poses& T_world_tip, const Pose& T_world_root, double cone = 4) const;

  struct Data;
  explicit CapabilityMap(std::shared_ptr<const Data> data);

 private:
  std::shared_ptr<const Data> data_;
};

/// How well the robot stands at each of several distances.
struct MMGRASP_EXPORT BaseDistance {
  double distance = 0;         ///< The best [m]; of equal ones the shortest.
  double score = 0;            ///< CapabilityMap::score there.
  std::vector<double> scores;  ///< The score of every candidate.
};

/// Which of `distances` [m] to stand behind the poses' middle, facing along `heading` [rad], on the floor (P3 3.9.3:
/// how near to put the robot). Throws InvalidInput on empty or non-finite arguments.
MMGRASP_EXPORT BaseDistance best_base_distance(const CapabilityMap& map, const Poses& T_world_tip, double heading,
                                               const std::vector<double>& distances, double cone = 4);

}  // namespace mmgrasp
