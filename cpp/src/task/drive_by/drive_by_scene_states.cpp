#include "task/drive_by/drive_by_scene_states.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace mmgrasp::detail {
namespace {

constexpr double kResting = 1e-3;  // What rests on something counts as this much higher once it is held [m].

/// Links of the hand that joints move against the tip.
std::vector<std::string> finger_links(const JointGroup& group) {
  const Robot& robot = group.robot();
  // Up to where a movable joint carries the link.
  const auto rigid_root = [&](int link) {
    while (link > 0 && robot.joints()[robot.links()[link].parent_joint].type == JointType::fixed)
      link = robot.joints()[robot.links()[link].parent_joint].parent_link;
    return link;
  };
  const int palm = rigid_root(group.tip_link());
  std::vector<std::string> fingers;
  for (int link = 1; link < static_cast<int>(robot.links().size()); ++link) {
    int above = rigid_root(link);
    if (above == palm) continue;
    while (above > 0 && above != palm) above = robot.joints()[robot.links()[above].parent_joint].parent_link;
    if (above == palm) fingers.push_back(robot.links()[link].name);
  }
  return fingers;
}

}  // namespace

SceneStates::SceneStates(const JointGroup& group, const World& world, const std::vector<DriveByStep>& tasks,
                         const CollisionChecker* prepared)
    : group_(group), world_(world), tasks_(tasks), options_(prepared ? prepared->options() : CheckerOptions()) {
  if (prepared) before_.emplace(0, prepared->clone());
}

World SceneStates::left(std::size_t task) const {
  World world = world_;
  for (std::size_t i = 0; i < std::min(task, tasks_.size()); ++i)
    if (!tasks_[i].object.empty() && world.has(tasks_[i].object)) world.remove(tasks_[i].object);
  return world;
}

CollisionChecker& SceneStates::before(std::size_t task) {
  return before_.try_emplace(task, group_, left(task), options_).first->second;
}

CollisionChecker& SceneStates::at(std::size_t task) {
  if (task >= tasks_.size() || tasks_[task].object.empty()) return before(task);
  World world = left(task);
  for (const std::string& finger : finger_links(group_)) world.allow(tasks_[task].object, finger);
  return at_.try_emplace(task, group_, world, options_).first->second;
}

CollisionChecker SceneStates::holding(std::size_t step, const Eigen::VectorXd& q) const {
  const std::string& object = tasks_[step].object;
  const std::string& tip = group_.robot().links()[group_.tip_link()].name;
  const Pose T_world_object = world_.objects().at(object).T_world_object;
  const auto attached_at = [&](const Pose& T_world_standing) {
    World world = left(step);
    world.attach(object, tip, attached_pose(tasks_[step], group_.fk(q), T_world_standing));
    return CollisionChecker(group_, world, options_);
  };
  CollisionChecker checker = attached_at(T_world_object);
  const std::vector<Contact> contacts = checker.contacts(q);
  const bool rests =
      std::any_of(contacts.begin(), contacts.end(), [&](const Contact& c) { return c.a == object || c.b == object; });
  if (rests) return attached_at(Eigen::Translation3d(0, 0, kResting) * T_world_object);
  return checker;
}

std::vector<CollisionChecker*> SceneStates::along(const std::vector<int>& intervals,
                                                  const ConfigurationSequence& sequence) {
  attached_.clear();
  std::vector<CollisionChecker*> result;
  for (std::size_t s = 0; s < intervals.size(); ++s) {
    CollisionChecker* here = &before(s);
    // A push-grasp may have it between the fingers before its last step.
    std::size_t by = s;
    while (by > 0 && tasks_[by - 1].object.empty() && !tasks_[by - 1].begins) --by;
    if (by > 0 && !tasks_[by - 1].object.empty())
      here = &attached_.try_emplace(s, holding(by - 1, sequence[by - 1].q)).first->second;
    result.insert(result.end(), intervals[s], here);
  }
  return result;
}

}  // namespace mmgrasp::detail
