#pragma once

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/verify/plan_check.hpp"
#include "verify/robot/kinematics.hpp"
#include "verify/robot/robot_model.hpp"
#include "verify/robot/solid.hpp"

namespace mmgrasp::verify::detail {

/// A scene body placed once and for all.
struct PlacedBody {
  std::string name;
  std::vector<Solid> solids;
  Poses T_world_shape;         ///< One a solid.
  std::vector<Bounds> bounds;  ///< One a solid.
  Bounds total;
};

PlacedBody place_body(const std::string& name, const std::vector<LinkShape>& shapes, const Pose& T_world_body);

/// What does not change while a plan is checked: the robot's solids, the pairs of links to test, the scene.
struct Stage {
  std::shared_ptr<const RobotModel> robot;
  ArmSetup setup;
  std::vector<std::vector<Solid>> link_solids;  ///< Solids of each link, by index.
  std::vector<std::pair<int, int>> self_pairs;
  std::vector<bool> is_finger;     ///< Whether a link is a finger, by index.
  std::vector<PlacedBody> bodies;  ///< Obstacles, then parts.
  std::size_t first_part = 0;
  double reach = 0;               ///< No point of the robot is farther than this from its root [m].
  std::set<CheckedPair> allowed;  ///< Names that may touch, each pair in both orders.

  bool may_touch(const std::string& a, const std::string& b) const {
    return !allowed.empty() && allowed.count({a, b}) > 0;
  }
};

/// The name of the ground among the bodies.
inline constexpr char kFloor[] = "floor";

/// Which links the arm's and the hand's joints move.
std::vector<bool> links_of_the_arm(const RobotModel& robot, const ArmSetup& setup);

/// Solids of the links, pairs but the allowed ones, and reach. Bodies are added by the caller.
Stage make_stage(std::shared_ptr<const RobotModel> robot, const ArmSetup& setup, const std::vector<int>& finger_links,
                 const std::vector<CheckedPair>& allowed);

enum class TouchKind { none, self, scene, attached };

struct Touch {
  TouchKind kind = TouchKind::none;
  std::string a, b;
  explicit operator bool() const { return kind != TouchKind::none; }
};

/// Answers "does anything touch?" for one robot in one state of the scene. One a thread.
class Judge {
 public:
  explicit Judge(std::shared_ptr<const Stage> stage);

  Kinematics& kinematics() { return kinematics_; }
  const Stage& stage() const { return *stage_; }

  void set_base(const Eigen::Vector3d& x_y_theta);
  const Pose& T_world_root() const { return T_world_root_; }
  void set_present(std::size_t body, bool present);
  /// The body leaves the scene and moves with the tip from now on.
  void hold(std::size_t body, const Pose& T_tip_body);
  /// The attached body vanishes.
  void drop();

  Touch touch(const Eigen::VectorXd& arm, double opening);
  /// What the robot's links or the attached body touch or come closer to than `margin` [m]: bodies of the scene, the
  /// ground left out.
  Touch comes_near(const Eigen::VectorXd& arm, double opening, double margin);
  /// From how many sides, 0 to 2, finger links touch the attached body: either side of the middle between the outermost
  /// of them, along the closing axis of the open hand.
  int sides_touching_attached(const Eigen::VectorXd& arm, double opening);
  Pose tip(const Eigen::VectorXd& arm) { return T_world_root_ * kinematics_.tip(arm); }
  std::size_t queries() const { return queries_; }

 private:
  void place(const Eigen::VectorXd& arm, double opening);
  void find_near_bodies();
  void find_sides(const Eigen::VectorXd& arm);
  Touch self_touch() const;
  Touch scene_touch() const;
  Touch attached_touch() const;
  bool link_comes_near(int link, const PlacedBody& body, double margin) const;
  bool attached_comes_near(const PlacedBody& body, double margin) const;
  bool link_touches(int link, const Solid& solid, const Pose& T, const Bounds& bounds) const;

  std::shared_ptr<const Stage> stage_;
  Kinematics kinematics_;
  Pose T_world_root_ = Pose::Identity();
  std::vector<bool> present_;
  std::vector<std::size_t> near_;   ///< Bodies within the robot's reach of the base.
  std::map<int, bool> side_;        ///< On which side each finger link is; found when first asked for.
  std::vector<Poses> solid_poses_;  ///< [link][solid], world.
  std::vector<std::vector<Bounds>> solid_bounds_;
  std::vector<Bounds> link_bounds_;
  std::vector<int> solid_links_;  ///< Links that have solids.
  int attached_ = -1;
  Pose T_tip_attached_ = Pose::Identity();
  PlacedBody attached_body_;
  std::size_t queries_ = 0;
};

}  // namespace mmgrasp::verify::detail
