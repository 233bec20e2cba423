#include "mmgrasp/verify/path_check.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify {
namespace {

using namespace detail;

constexpr double kMaxPieces = 1e9;    // Those of an edge are counted by an int.
constexpr double kLimitSlack = 1e-5;  // What limits and values printed to five digits lose.

int known_joint(const RobotModel& robot, const std::string& name) {
  const int joint = robot.joint_index(name);
  if (joint < 0) throw InvalidInput("joint \"" + name + "\": the robot has none of this name");
  return joint;
}

ArmSetup setup_of(const PathToCheck& path, const RobotModel& robot) {
  ArmSetup setup;
  for (const std::string& name : path.joints) setup.arm.push_back(known_joint(robot, name));
  require(!setup.arm.empty(), "joints", "[]", "must name at least one joint");
  for (const auto& [name, value] : path.other_joints) setup.others[known_joint(robot, name)] = value;
  setup.tip_link = robot.joints[setup.arm.back()].child;
  return setup;
}

/// Walks along a path in steps until a configuration is not allowed.
class PathWalk {
 public:
  PathWalk(const PathToCheck& path, std::shared_ptr<const Stage> stage, double step, const Monitor& monitor)
      : path_(path), judge_(std::move(stage)), step_(step), monitor_(monitor) {}

  PathCheckResult run() {
    const auto& points = path_.waypoints;
    if (is_good(points.front(), 0, 0)) {
      for (std::size_t e = 0; e + 1 < points.size() && walk(points[e], points[e + 1], e);) ++e;
    }
    result_.free = result_.where.empty();
    return result_;
  }

 private:
  bool walk(const Eigen::VectorXd& from, const Eigen::VectorXd& to, std::size_t edge) {
    const double pieces = std::ceil((to - from).cwiseAbs().maxCoeff() / step_);
    require(pieces <= kMaxPieces, "joint_step", step_, "must not cut an edge into more than 1e9 pieces");
    const int count = std::max(1, static_cast<int>(pieces));
    for (int i = 1; i <= count; ++i) {
      const double at = static_cast<double>(i) / count;
      if (!is_good(from + at * (to - from), edge, at)) return false;
    }
    return true;
  }

  bool is_good(const Eigen::VectorXd& q, std::size_t edge, double at) {
    ++result_.configurations_checked;
    const Kinematics& kinematics = judge_.kinematics();
    const std::string place = "edge " + std::to_string(edge) + " at " + text(at) + ": ";
    if (monitor_.stopped()) {
      result_.where = place + "stopped";
      return false;
    }
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (kinematics.continuous()[i]) continue;
      if (q[i] >= kinematics.lower()[i] - kLimitSlack && q[i] <= kinematics.upper()[i] + kLimitSlack) continue;
      result_.where = place + "joint '" + path_.joints[i] + "' beyond its limits";
      return false;
    }
    const Touch touch = judge_.touch(q, 0);
    if (touch) result_.where = place + "'" + touch.a + "' touches '" + touch.b + "'";
    return !touch;
  }

  const PathToCheck& path_;
  Judge judge_;
  const double step_;
  const Monitor& monitor_;
  PathCheckResult result_;
};

}  // namespace

PathCheckResult check_path(const PathToCheck& path, double joint_step, const Monitor& monitor) {
  require(joint_step >= kLeastStep && joint_step <= 1e6, "joint_step", joint_step, "must be in [1e-9, 1e6] [rad or m]");
  require(!path.waypoints.empty(), "waypoints", "[]", "must hold at least one configuration");
  const auto robot = std::make_shared<const RobotModel>(read_robot(path.robot));
  const ArmSetup setup = setup_of(path, *robot);
  for (const auto& q : path.waypoints) {
    require(q.size() == static_cast<Eigen::Index>(setup.arm.size()) && q.allFinite(), "waypoints",
            static_cast<double>(q.size()), "must have a finite value for each of the joints");
  }
  auto stage = std::make_shared<Stage>(make_stage(robot, setup, {}, path.allowed_collisions));
  for (const auto& [a, b] : path.allowed_collisions) {
    for (const std::string& name : {a, b}) {
      const bool is_body = std::any_of(path.bodies.begin(), path.bodies.end(),
                                       [&name](const CheckedBody& body) { return body.name == name; });
      require(is_body || robot->link_index(name) >= 0, "allowed_collisions", "'" + name + "'",
              "must name a link of the robot or a body");
    }
  }
  for (const CheckedBody& body : path.bodies) {
    stage->bodies.push_back(place_body(body.name, body.shapes, body.T_world_body));
  }
  stage->first_part = stage->bodies.size();
  return PathWalk(path, stage, joint_step, monitor).run();
}

}  // namespace mmgrasp::verify
