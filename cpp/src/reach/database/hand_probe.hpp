#pragma once

#include <optional>

#include "mmgrasp/collision/checker.hpp"

namespace mmgrasp::detail {

/// What moves with the tip, whatever the arm does to bring it there: links rigidly joined to it and what they hold.
/// When that alone collides at a tool pose, no configuration helps. One per thread.
class HandProbe {
 public:
  HandProbe(const JointGroup& arm, const World& world);
  HandProbe(const HandProbe& other);

  /// self_collision: the hand meets links that no joint of the arm moves; scene: an object; none: neither.
  Rejection rejection(const Pose& T_world_tip);

 private:
  std::optional<CollisionChecker> robot_, scene_;
  Eigen::VectorXd still_;
};

}  // namespace mmgrasp::detail
