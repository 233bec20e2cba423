#include "task/drive_by/drive_by_scene_states.hpp"

#include <algorithm>

namespace mmgrasp::detail {
SceneStates::SceneStates(const JointGroup& group, const World& world, const std::vector<DriveByStep>& tasks)
    : group_(group), world_(world), tasks_(tasks) {}

World SceneStates::left(std::size_t task) const {
  World world = world_;
  for (std::size_t i = 0; i < std::min(task, tasks_.size()); ++i)
    if (!tasks_[i].object.empty() && world.has(tasks_[i].object)) world.remove(tasks_[i].object);
  return world;
}

CollisionChecker& SceneStates::before(std::size_t task) {
  return before_.try_emplace(task, group_, left(task)).first->second;
}

CollisionChecker& SceneStates::at(std::size_t task) {
  if (task >= tasks_.size() || tasks_[task].object.empty()) return before(task);
  return at_.try_emplace(task, group_, left(task + 1)).first->second;
}

std::vector<CollisionChecker*> SceneStates::along(const std::vector<int>& intervals,
                                                  const ConfigurationSequence& sequence) {
  held_.clear();
  std::vector<CollisionChecker*> result;
  const std::string& tip = group_.robot().links()[group_.tip_link()].name;
  for (std::size_t s = 0; s < intervals.size(); ++s) {
    CollisionChecker* here = &before(s);
    CollisionChecker *taken = here, *taking = s < tasks_.size() ? &at(s) : here;
    const int touching_after = s > 0 ? tasks_[s - 1].touching : 0;
    const int touching_before = s < tasks_.size() ? tasks_[s].touching : 0;
    // A push-grasp may have it between the fingers before its last step.
    std::size_t by = s;
    while (by > 0 && tasks_[by - 1].object.empty() && !tasks_[by - 1].begins) --by;
    if (by > 0 && !tasks_[by - 1].object.empty()) {
      World world = left(by - 1);
      const std::string& object = tasks_[by - 1].object;
      const Pose T_world_object = world.objects().at(object).T_world_object;
      world.attach(object, tip, held_pose(tasks_[by - 1], group_.fk(sequence[by - 1].q), T_world_object));
      here = &held_.try_emplace(s, group_, world).first->second;
      if (by == s) taken = &at(s - 1);
    }
    const int n = intervals[s];
    for (int i = 0; i < n; ++i) {
      const bool first = i < touching_after, last = i >= n - touching_before;
      const bool object = s < tasks_.size() && !tasks_[s].object.empty();
      result.push_back(first && taken != here ? taken : last && object ? taking : here);
    }
  }
  return result;
}

}  // namespace mmgrasp::detail
