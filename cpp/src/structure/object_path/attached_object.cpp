#include "structure/object_path/attached_object.hpp"

namespace mmgrasp::detail {

AttachedChecker& AttachedObject::hold(const Grasp& grasp) {
  const bool fingers = problem_.gripper.has_value();
  const auto key = fingers ? std::pair(grasp.opening, grasp.posture) : std::pair(0.0, std::vector<double>{});
  auto at = holding_.find(key);
  if (at == holding_.end()) {
    const JointGroup held = fingers ? with_fingers(problem_.group, *problem_.gripper, grasp) : problem_.group;
    World world = problem_.world;
    world.add(problem_.object_name, WorldObject{problem_.object, problem_.T_world_object[0]});
    world.attach(problem_.object_name, held.robot().links()[held.tip_link()].name, grasp.T_object_hand.inverse(),
                 problem_.touch_links);
    at = holding_.emplace(key, std::pair(held, AttachedChecker(held, world))).first;
  }
  now_ = &at->second;
  now_->second.place_attached(grasp.T_object_hand.inverse());
  return now_->second;
}

const Eigen::VectorXd& AttachedObject::levers() {
  return now_->second.motion_bounds();
}

}  // namespace mmgrasp::detail
