#include "task/drive_by_route.hpp"

#include "mmgrasp/task/base_route.hpp"

namespace mmgrasp::detail {
namespace {

/// The chain from the root to the tip, everything as in the configuration.
JointGroup standing_arm(const JointGroup& group, const Eigen::VectorXd& q, Eigen::VectorXd& home) {
  const Robot& robot = group.robot();
  const Eigen::VectorXd values = group.full_values(q);
  const auto link = [&](int index) { return robot.links()[static_cast<std::size_t>(index)].name; };
  const JointGroup arm = robot.chain(link(robot.root_link()), link(group.tip_link())).with_reference(values);
  home.resize(arm.size());
  for (int i = 0; i < arm.size(); ++i) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(arm.joints()[static_cast<std::size_t>(i)])];
    home[i] = values[joint.value_index];
  }
  return arm;
}

}  // namespace

GuidedBase guided_base(const JointGroup& group, const CollisionChecker& checker, const Eigen::VectorXd& from,
                       const Eigen::VectorXd& to, const Monitor& monitor) {
  BaseRouteOptions options;
  options.base = group.robot().base();
  for (const bool waits : {true, false}) {
    Eigen::VectorXd home;
    const JointGroup arm = standing_arm(group, waits ? from : to, home);
    CollisionChecker standing = checker.with_group(arm);
    const BasePath path = plan_base_route(standing, home, from.head<3>(), to.head<3>(), options, {monitor.stop, {}});
    if (path.outcome == Outcome::solved) return {path.poses, waits};
  }
  return {};
}

bool base_collides(const std::vector<CollisionChecker*>& checkers, const WholeBodyGuess& guess) {
  for (std::size_t i = 0; i < checkers.size(); ++i) {
    if (!checkers[i]) continue;
    const std::string& root = checkers[i]->group().robot().links()[0].name;
    for (const Contact& c : checkers[i]->contacts(guess.positions[i]))
      if (c.with_scene && c.a == root) return true;
  }
  return false;
}

}  // namespace mmgrasp::detail
