#pragma once

#include <algorithm>

#include "mmgrasp/plan/manipulation.hpp"
#include "support/planar_arm.hpp"

namespace mmgrasp::test {

inline Pose flat_pose(double x, double y, double yaw) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x, y, 0);
  return T;
}

/// A bar moved by an arm of three links in the plane past two posts: twenty grasps, ten along the bar, from both
/// sides.
inline ManipulationProblem bar_transfer() {
  const PlanarArm arm(3, 0.4);
  LinkShape bar;
  bar.shape = Box{{0.4, 0.02, 0.02}};
  ManipulationProblem problem{arm.group(), {}, {bar}, flat_pose(0.55, 0.45, 1.2), flat_pose(0.6, -0.45, 0.9), {}};
  problem.world.add("post", Shape(Box{{0.1, 0.1, 0.2}}), flat_pose(0.85, 0.0, 0));
  problem.world.add("corner", Shape(Box{{0.06, 0.06, 0.2}}), flat_pose(0.35, -0.75, 0));
  for (int i = 0; i < 10; ++i)
    for (const double side : {0.5 * M_PI, -0.5 * M_PI})
      problem.grasps.push_back({flat_pose(-0.18 + 0.04 * i, 0, side), 0, 0});
  problem.touch_links = {"l3", "tip"};
  return problem;
}

/// The problem's world with the object in hand.
inline World carrying(const ManipulationProblem& problem, const Grasp& grasp) {
  World world = problem.world;
  world.add("object", WorldObject{problem.object, problem.T_world_start});
  world.attach("object", "tip", grasp.T_object_hand.inverse(), problem.touch_links);
  return world;
}

}  // namespace mmgrasp::test
