#pragma once

#include <fcl/fcl.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "mmgrasp/plan/manipulation.hpp"
#include "support/bar_transfer.hpp"

namespace mmgrasp::test {

/// Whether a planar arm of links of `length` and the bar it holds are free of the scene's boxes, and the bar of the
/// links but the last: kinematics by trigonometry and FCL called directly, nothing of mmgrasp's checker.
class FclTransfer {
 public:
  FclTransfer(const ManipulationProblem& problem, int grasp, double length, double width) : length_(length) {
    T_tip_bar_ = problem.grasps[grasp].T_object_hand.inverse();
    for (const auto& [name, object] : problem.world.objects())
      for (const LinkShape& shape : object.shapes)
        scene_.push_back(box(shape, object.T_world_object * shape.T_link_shape));
    bar_ = box(problem.object.front(), Pose::Identity());
    for (int i = 0; i < problem.group.size(); ++i) {
      LinkShape link;
      link.shape = Box{{length, width, width}};
      links_.push_back(box(link, Pose::Identity()));
    }
  }

  bool is_free(const Eigen::VectorXd& q) {
    Pose T = Pose::Identity();
    for (std::size_t i = 0; i < links_.size(); ++i) {
      T = T * flat_pose(0, 0, q[static_cast<Eigen::Index>(i)]);
      place(*links_[i], T * flat_pose(length_ / 2, 0, 0));
      T = T * flat_pose(length_, 0, 0);
    }
    place(*bar_, T * T_tip_bar_);
    for (const auto& other : scene_) {
      if (touch(*bar_, *other)) return false;
      for (const auto& link : links_)
        if (touch(*link, *other)) return false;
    }
    for (std::size_t i = 0; i + 1 < links_.size(); ++i)
      if (touch(*bar_, *links_[i])) return false;
    return true;
  }

  /// Every configuration of the path at most `step` apart in any joint.
  bool is_free(const JointPath& path, double step) {
    for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
      const Eigen::VectorXd motion = path.waypoints[i + 1] - path.waypoints[i];
      const int count = std::max(1, static_cast<int>(std::ceil(motion.cwiseAbs().maxCoeff() / step)));
      for (int k = 0; k <= count; ++k)
        if (!is_free(Eigen::VectorXd(path.waypoints[i] + k * motion / count))) return false;
    }
    return true;
  }

 private:
  using Object = std::shared_ptr<fcl::CollisionObjectd>;
  static Object box(const LinkShape& shape, const Pose& T) {
    const Eigen::Vector3d size = std::get<Box>(shape.shape).size;
    auto object = std::make_shared<fcl::CollisionObjectd>(std::make_shared<fcl::Boxd>(size[0], size[1], size[2]));
    place(*object, T);
    return object;
  }
  static void place(fcl::CollisionObjectd& object, const Pose& T) {
    fcl::Transform3d to = fcl::Transform3d::Identity();
    to.linear() = T.linear();
    to.translation() = T.translation();
    object.setTransform(to);
    object.computeAABB();
  }
  static bool touch(const fcl::CollisionObjectd& a, const fcl::CollisionObjectd& b) {
    const fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    return fcl::collide(&a, &b, request, result) > 0;
  }

  double length_;
  Pose T_tip_bar_;
  Object bar_;
  std::vector<Object> scene_, links_;
};

}  // namespace mmgrasp::test
