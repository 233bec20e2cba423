#pragma once

#include <fcl/fcl.h>

#include <algorithm>
#include <string>
#include <vector>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/robot/trajectory.hpp"
#include "support/planar_arm.hpp"

namespace mmgrasp::test {

/// An axis-aligned box of the scene.
struct SceneBox {
  Eigen::Vector3d centre, size;
};

/// Smallest distance of a planar arm from boxes with kinematics by trigonometry and FCL's own distance: knows nothing
/// of mmgrasp's checker. 0 or less: touching.
inline double fcl_clearance(const PlanarArm& arm, double length, const Eigen::VectorXd& q,
                            const std::vector<SceneBox>& scene) {
  double smallest = 1e9;
  double angle = 0;
  for (int i = 0; i < arm.joints(); ++i) {
    angle += q[i];
    const Eigen::Vector3d from = i == 0 ? Eigen::Vector3d::Zero().eval() : arm.joint_position(q, i);
    fcl::Transform3d T_link = fcl::Transform3d::Identity();
    T_link.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T_link.translation() = from + T_link.linear() * Eigen::Vector3d(length / 2, 0, 0);
    fcl::CollisionObjectd link(std::make_shared<fcl::Boxd>(length, arm.width(), arm.width()), T_link);
    for (const auto& box : scene) {
      fcl::Transform3d T_box = fcl::Transform3d::Identity();
      T_box.translation() = box.centre;
      fcl::CollisionObjectd object(std::make_shared<fcl::Boxd>(box.size[0], box.size[1], box.size[2]), T_box);
      fcl::CollisionRequestd request;
      fcl::CollisionResultd result;
      if (fcl::collide(&link, &object, request, result) > 0) return 0;
      fcl::DistanceRequestd distance_request;
      fcl::DistanceResultd distance_result;
      smallest = std::min(smallest, fcl::distance(&link, &object, distance_request, distance_result));
    }
  }
  return smallest;
}

/// Smallest clearance along the path's straight edges, looked at every `step`.
inline double fcl_path_clearance(const PlanarArm& arm, double length, const JointPath& path,
                                 const std::vector<SceneBox>& scene, double step) {
  double smallest = 1e9;
  for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
    const Eigen::VectorXd motion = path.waypoints[i + 1] - path.waypoints[i];
    const int count = std::max(1, static_cast<int>(std::ceil(motion.cwiseAbs().maxCoeff() / step)));
    for (int k = 0; k <= count; ++k) {
      smallest = std::min(smallest, fcl_clearance(arm, length, path.waypoints[i] + k * motion / count, scene));
    }
  }
  return smallest;
}

inline World make_world(const std::vector<SceneBox>& scene) {
  World world;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    Pose pose = Pose::Identity();
    pose.translation() = scene[i].centre;
    world.add("box " + std::to_string(i), Box{scene[i].size}, pose);
  }
  return world;
}

}  // namespace mmgrasp::test
