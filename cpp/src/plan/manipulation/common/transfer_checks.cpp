#include "plan/manipulation/common/transfer_checks.hpp"

#include <algorithm>
#include <map>

#include "mmgrasp/collision/detail/edge_steps.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/grasp/detail/with_fingers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kFinalStep = 0.005;     // Largest joint step of paths that callers check [rad or m],
constexpr double kFinalResolution = 16;  // ... and by this share of all steps the final check is finer.

/// The nearest joint above a link that the group moves; -1: none.
int moved_by(const JointGroup& group, int link) {
  const Robot& robot = group.robot();
  const std::vector<int>& driven = group.joints();
  for (int joint = robot.links()[link].parent_joint; joint >= 0;) {
    const Joint& j = robot.joints()[joint];
    const int leader = j.mimic_joint >= 0 ? j.mimic_joint : joint;
    if (std::find(driven.begin(), driven.end(), leader) != driven.end()) return joint;
    joint = robot.links()[j.parent_link].parent_joint;
  }
  return -1;
}

}  // namespace

TransferChecks::TransferChecks(const ManipulationProblem& problem, const EdgeOptions& edge, int workers,
                               const CollisionChecker* prepared)
    : problem_(problem),
      prepared_(prepared),
      group_(prepared ? prepared->group() : problem.group),
      edge_(edge),
      path_edge_(edge),
      robot_(workers),
      attached_(robot_.size()) {
  path_edge_.joint_step = std::min(path_edge_.joint_step, kFinalStep) / kFinalResolution;
  path_edge_.workspace_step /= kFinalResolution;
  std::map<std::pair<double, std::vector<double>>, int> openings;  // by opening and posture
  for (const Grasp& grasp : problem.grasps) {
    const bool fingers = problem.gripper.has_value();
    const auto [at, added] =
        openings.emplace(fingers ? std::pair(grasp.opening, grasp.posture) : std::pair(0.0, std::vector<double>{}),
                         static_cast<int>(groups_.size()));
    if (added) {
      groups_.push_back(fingers ? with_fingers(group_, *problem.gripper, grasp) : group_);
    }
    opening_of_.push_back(at->second);
  }
  tip_ = problem.group.robot().links()[problem.group.tip_link()].name;
  const std::vector<Link>& links = problem.group.robot().links();
  const int mover = moved_by(problem.group, problem.group.tip_link());
  for (std::size_t i = 0; i < links.size(); ++i)
    if (moved_by(problem.group, static_cast<int>(i)) == mover) tool_.insert(links[i].name);
  for (auto& own : robot_) own.resize(groups_.size());
  for (auto& own : attached_) own.resize(groups_.size());
  whole_.resize(groups_.size());
}

TransferChecks::RobotAlone& TransferChecks::robot(int worker, int opening) {
  auto& slot = robot_[worker][opening];
  if (!slot) {
    World world = problem_.world;
    world.forget(problem_.object_name);  // a checker refuses names that are not there
    CollisionChecker checker =
        prepared_ ? prepared_->with_group(group(opening)) : CollisionChecker(group(opening), world);
    Eigen::VectorXd motion = motion_bounds(checker);
    slot.emplace(RobotAlone{std::move(checker), std::move(motion)});
  }
  return *slot;
}

CheckerOptions TransferChecks::options() const {
  return prepared_ ? prepared_->options() : CheckerOptions();
}

Pose TransferChecks::T_tool_object(int grasp) const {
  return problem_.grasps[grasp].T_object_hand.inverse();
}

World TransferChecks::world_with(int grasp) const {
  World world = problem_.world;
  world.add(problem_.object_name, WorldObject{problem_.object, problem_.T_world_start});
  world.attach(problem_.object_name, tip_, T_tool_object(grasp), problem_.touch_links);
  return world;
}

CollisionChecker TransferChecks::whole(int grasp) const {
  return CollisionChecker(group(opening_of(grasp)), world_with(grasp), options());
}

AttachedChecker& TransferChecks::holding(std::optional<WithObject>& slot, int grasp, bool attached_only) {
  if (!slot) {
    CheckerOptions options = this->options();
    options.attached_only = attached_only;
    slot.emplace(WithObject{AttachedChecker(group(opening_of(grasp)), world_with(grasp), options), grasp});
  } else if (slot->grasp != grasp) {
    slot->checker.place_attached(T_tool_object(grasp));
    slot->grasp = grasp;
  }
  return slot->checker;
}

AttachedChecker& TransferChecks::attached(int worker, int grasp) {
  return holding(attached_[worker][opening_of(grasp)], grasp, true);
}

bool TransferChecks::edge_is_free(int grasp, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return holding(whole_[opening_of(grasp)], grasp, false).edge_is_free(a, b, edge_);
}

bool TransferChecks::path_edge_is_free(int grasp, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  AttachedChecker& checker = holding(whole_[opening_of(grasp)], grasp, false);
  // Optimal paths graze obstacles, and a caller who checks by joint steps alone checks other configurations.
  EdgeOptions by_joints = path_edge_;
  by_joints.workspace_step = kInfinity;
  return checker.edge_is_free(a, b, path_edge_) && checker.edge_is_free(a, b, by_joints);
}

int TransferChecks::blocked_edge(int grasp, const JointPath& path) {
  for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i)
    if (!path_edge_is_free(grasp, path.waypoints[i], path.waypoints[i + 1])) return static_cast<int>(i);
  return -1;
}

bool TransferChecks::robot_is_free(int worker, int opening, const Eigen::VectorXd& q) {
  return robot(worker, opening).checker.is_free(q);
}
bool TransferChecks::robot_edge_is_free(int worker, int opening, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  RobotAlone& own = robot(worker, opening);
  if (edge_.continuous) return check_edge(own.checker, a, b, edge_).free;
  return own.checker.edge_is_free(a, b, edge_step(b - a, own.motion, edge_.joint_step, edge_.workspace_step));
}
Rejection TransferChecks::robot_rejection(int worker, int opening, const Eigen::VectorXd& q) {
  return robot(worker, opening).checker.rejection(q);
}
bool TransferChecks::tool_hits_scene(int worker, int opening, const Eigen::VectorXd& q) {
  const std::vector<Contact> contacts = robot(worker, opening).checker.contacts(q);
  return std::any_of(contacts.begin(), contacts.end(),
                     [&](const Contact& c) { return c.with_scene && tool_.count(c.a) > 0; });
}
bool TransferChecks::attached_is_free(int worker, int grasp, const Eigen::VectorXd& q) {
  return attached(worker, grasp).is_free(q);
}
bool TransferChecks::attached_edge_is_free(int worker, int grasp, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return attached(worker, grasp).edge_is_free(a, b, edge_);
}
Rejection TransferChecks::attached_rejection(int worker, int grasp, const Eigen::VectorXd& q) {
  return attached(worker, grasp).rejection(q);
}

}  // namespace mmgrasp::detail
