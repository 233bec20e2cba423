#include "plan/carry_checks.hpp"

#include <map>

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kHeldKept = 32;  // Checkers of grasps that each worker keeps.
constexpr double kFineStep = 0.005;    // Of the check of finished paths [rad or m].

JointGroup with_fingers(const JointGroup& group, const Gripper& gripper, double opening) {
  Eigen::VectorXd values = group.reference();
  const Robot& robot = group.robot();
  for (const auto& [name, value] : gripper.joint_values(opening))
    values[robot.joints()[static_cast<std::size_t>(robot.joint_index(name))].value_index] = value;
  return group.with_reference(values);
}

}  // namespace

CarryChecks::CarryChecks(const ManipulationProblem& problem, const EdgeOptions& edge, int workers)
    : problem_(problem), edge_(edge), held_(static_cast<std::size_t>(workers)), next_held_(held_.size(), 0) {
  std::map<double, int> openings;
  for (const CandidateGrasp& grasp : problem.grasps) {
    const double opening = problem.gripper ? grasp.opening : 0;
    const auto [at, added] = openings.emplace(opening, static_cast<int>(groups_.size()));
    if (added) {
      groups_.push_back(problem.gripper ? with_fingers(problem.group, *problem.gripper, opening) : problem.group);
    }
    opening_of_.push_back(at->second);
  }
  tip_ = problem.group.robot().links()[static_cast<std::size_t>(problem.group.tip_link())].name;
  robot_.resize(held_.size());
  for (auto& own : robot_) own.resize(groups_.size());
}

CollisionChecker& CarryChecks::robot(int worker, int opening) {
  auto& slot = robot_[static_cast<std::size_t>(worker)][static_cast<std::size_t>(opening)];
  if (!slot) slot.emplace(group(opening), problem_.world);
  return *slot;
}

World CarryChecks::world_with(int grasp) const {
  World world = problem_.world;
  const CandidateGrasp& candidate = problem_.grasps[static_cast<std::size_t>(grasp)];
  world.add(problem_.object_name, WorldObject{problem_.object, problem_.T_world_start});
  world.attach(problem_.object_name, tip_, candidate.T_object_tool.inverse(), problem_.touch_links);
  return world;
}

CollisionChecker CarryChecks::whole(int grasp) const {
  return CollisionChecker(group(opening_of(grasp)), world_with(grasp));
}

int CarryChecks::blocked_edge(int grasp, const JointPath& path) const {
  CollisionChecker checker = whole(grasp);
  for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i)
    if (!checker.edge_is_free(path.waypoints[i], path.waypoints[i + 1], kFineStep)) return static_cast<int>(i);
  return -1;
}

CollisionChecker& CarryChecks::held(int worker, int grasp) {
  auto& own = held_[static_cast<std::size_t>(worker)];
  for (Held& entry : own)
    if (entry.grasp == grasp) return *entry.checker;
  if (own.size() < kHeldKept) own.emplace_back();
  std::size_t& next = next_held_[static_cast<std::size_t>(worker)];
  Held& entry = own.size() < kHeldKept ? own.back() : own[next++ % kHeldKept];
  entry.grasp = grasp;
  CheckerOptions options;
  options.held_only = true;
  entry.checker.emplace(group(opening_of(grasp)), world_with(grasp), options);
  return *entry.checker;
}

bool CarryChecks::robot_is_free(int worker, int opening, const Eigen::VectorXd& q) {
  return robot(worker, opening).is_free(q);
}
bool CarryChecks::robot_edge_is_free(int worker, int opening, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return check_edge(robot(worker, opening), a, b, edge_).free;
}
Rejection CarryChecks::robot_rejection(int worker, int opening, const Eigen::VectorXd& q) {
  return robot(worker, opening).rejection(q);
}
bool CarryChecks::held_is_free(int worker, int grasp, const Eigen::VectorXd& q) {
  return held(worker, grasp).is_free(q);
}
bool CarryChecks::held_edge_is_free(int worker, int grasp, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return check_edge(held(worker, grasp), a, b, edge_).free;
}
Rejection CarryChecks::held_rejection(int worker, int grasp, const Eigen::VectorXd& q) {
  return held(worker, grasp).rejection(q);
}

}  // namespace mmgrasp::detail
