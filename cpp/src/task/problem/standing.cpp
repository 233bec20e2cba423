#include "task/problem/standing.hpp"

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/base_workspace.hpp"
#include "task/problem/scene.hpp"
#include "task/problem/wording.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kNamedContacts = 3;

}  // namespace

void require_standing(const PartSupplyProblem& problem, const std::string& name, const Eigen::Vector3d& base_pose,
                      const std::vector<PartRef>& parts) {
  if (!in_workspace(problem.robot.base_limits(), base_pose)) {
    throw InvalidInput(name + " = " + pose_text(base_pose) + ": must lie within base_limits.workspace (" +
                       six_digits(problem.robot.base_limits().workspace) + " m)");
  }
  CollisionChecker checker(problem.arm, world_with_parts(problem, parts));
  checker.set_root(pose_from_planar(base_pose));
  if (checker.is_free(problem.home)) return;
  std::string pairs;
  bool self = false;
  std::size_t named = 0;
  for (const Contact& contact : checker.contacts(problem.home)) {
    if (named++ >= kNamedContacts) break;
    pairs += (pairs.empty() ? "" : ", ") + describe(contact);
    self = self || !contact.with_scene;
  }
  if (self) throw InvalidInput("home: " + pairs + "; the robot must be free of self-collision at home");
  throw InvalidInput(name + " = " + pose_text(base_pose) + ": " + pairs + "; the robot at home must be free there");
}

}  // namespace mmgrasp::detail
