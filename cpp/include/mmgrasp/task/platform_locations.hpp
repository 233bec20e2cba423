#pragma once

#include <Eigen/Core>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/mapping/camera.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp {

/// Past solutions that seed the next IK searches (P3 3.6): grows with use, can be saved, belongs to one group. When
/// full, the oldest are removed. Threads may share one; what it answers then depends on who came first.
///
///     IkSeedDatabase database(group);
///     database.add(q);  // a solution found elsewhere
///     for (const Eigen::VectorXd& seed : database.seeds(T_world_tip, 5)) try_from(seed);
class MMGRASP_EXPORT IkSeedDatabase {
 public:
  /// The group must have base joints; capacity > 0. Throws InvalidInput.
  explicit IkSeedDatabase(const JointGroup& group, int capacity = 10000);
  /// Configurations are kept with the base taken out: where the tool stood relative to the root, and the arm's joints.
  void add(const Eigen::VectorXd& q);
  /// Up to `count` whole configurations whose tool stands at T_world_tip, best match first: the base is put where the
  /// remembered arm posture reaches the pose (height and tilt may remain wrong: IK corrects that).
  std::vector<Eigen::VectorXd> seeds(const Pose& T_world_tip, int count) const;
  std::size_t size() const;
  const JointGroup& group() const { return group_; }
  /// Writes text: robot hash, joint names, one arm posture a line, checksum. Throws IoError.
  void save(const std::string& path) const;
  /// Throws IoError for a file that is none, damaged, or made for another robot or other joints.
  static IkSeedDatabase load(const std::string& path, const JointGroup& group, int capacity = 10000);

 private:
  struct Entry {
    Pose T_root_tip;
    Eigen::VectorXd q;  // the arm's joints
  };
  std::string body() const;
  JointGroup group_;
  int capacity_;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  // guards entries_
  std::deque<Entry> entries_;
};

/// A camera that moves with a link.
struct MMGRASP_EXPORT MountedCamera {
  PinholeCamera camera;
  int link = 0;
  Pose T_link_camera = Pose::Identity();
};

/// Two tool poses of one job, and what a camera must see at each (p_1 to p_4 of P3 3.6), in the world.
struct MMGRASP_EXPORT PlatformLocationsProblem {
  Pose T_world_pick = Pose::Identity();                   ///< p_1: tool pose that picks the part.
  Pose T_world_place = Pose::Identity();                  ///< p_2: tool pose that places or inserts it.
  Eigen::Vector3d pick_point = Eigen::Vector3d::Zero();   ///< p_3: must be in view at the pick [m].
  Eigen::Vector3d place_point = Eigen::Vector3d::Zero();  ///< p_4: must be in view at the placing [m].
  std::optional<MountedCamera> camera;                    ///< None (or one in the hand): the view is not checked.
};

/// How many configurations are drawn for the two tool poses, and what a turn of the base counts as.
struct MMGRASP_EXPORT PlatformLocationsOptions {
  int samples = 100;                   ///< Valid configurations drawn for each of the two poses (P3's n); > 0
  int max_draws = 2000;                ///< Searches run for each pose, valid or not; > 0
  double least_manipulability = 0.02;  ///< epsilon of P3 3.1, over the arm's joints; >= 0
  double turn_weight = 0.3;            ///< What one radian of base turn counts as [m]: |h_1 - h_2| mixes units; >= 0
  unsigned seed = 1;
  double time_limit = 10;  ///< Wall-clock cap [s]; > 0
  void check() const;
};

/// How many draws fell at which constraint.
struct MMGRASP_EXPORT PlatformLocationsCounts {
  std::size_t draws = 0;       ///< IK searches run.
  Rejections rejections;       ///< Reach, limits, self-collision, scene.
  std::size_t view = 0;        ///< Point outside the image.
  std::size_t singular = 0;    ///< Manipulability below the bound.
  std::size_t iterations = 0;  ///< IK iterations of all draws.
};

/// Configurations of base and arm at the two tool poses, and how far the base travels between them.
struct MMGRASP_EXPORT PlatformLocations {
  Outcome outcome = Outcome::not_found;
  Eigen::VectorXd q_pick, q_place;  ///< Base and arm; set if and only if solved, every constraint checked again.
  double cost = 0;                  ///< Base travel [m] + turn_weight x turn [rad].
  double travel = 0, turn = 0;      ///< [m], [rad]
  PlatformLocationsCounts pick, place;
};

/// Two base + arm configurations for two tool poses with the least base travel (P3 3.6, Algorithm 2, equation 3.1, with
/// its errata: both ends are drawn again and again, not c_1 once; travel and turn have their weights). Beyond the paper
/// the two ends know of each other: each is also sought from the other's base pose, since one stop often serves both
/// poses (cost 0, which ends the search), and the best pairs are drawn together along the solutions of their poses. The
/// checker's group must have the base. Solutions found are added to `database`, which starts the searches when given.
MMGRASP_EXPORT PlatformLocations plan_platform_locations(CollisionChecker& checker,
                                                         const PlatformLocationsProblem& problem,
                                                         const PlatformLocationsOptions& options = {},
                                                         IkSeedDatabase* database = nullptr,
                                                         const Monitor& monitor = {});

}  // namespace mmgrasp
