#pragma once

#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp::test {

inline LinkShape shape_at(const Shape& shape, const Pose& pose = Pose::Identity()) {
  LinkShape result;
  result.shape = shape;
  result.T_link_shape = pose;
  return result;
}

/// Opens by 10 cm, pads of 3 x 2 cm.
inline Hand wide_gripper() {
  Hand gripper;
  gripper.max_opening = 0.10;
  gripper.finger_depth = 0.03;
  gripper.finger_width = 0.02;
  return gripper;
}

}  // namespace mmgrasp::test
