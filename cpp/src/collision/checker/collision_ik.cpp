#include "mmgrasp/collision/collision_ik.hpp"

namespace mmgrasp {

IkResult solve_collision_free_ik(CollisionChecker& checker, const Pose& T_world_tip, const Eigen::VectorXd& seed,
                                 const IkOptions& options, const Monitor& monitor) {
  const auto valid = [&](const Eigen::VectorXd& q) { return checker.rejection(q); };
  return solve_ik(checker.group(), T_world_tip, seed, options, valid, monitor);
}

}  // namespace mmgrasp
