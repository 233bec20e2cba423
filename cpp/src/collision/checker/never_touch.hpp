#pragma once

#include <array>
#include <vector>

#include "collision/checker/bodies.hpp"

namespace mmgrasp::detail {

/// Proves that two bodies of a robot never touch, whatever the values of its joints within their limits: boxes of joint
/// values are halved until, in each of them, the clearance at its middle exceeds what the bodies can move against each
/// other within it. Only reads, so that threads may share one.
class NeverTouch {
 public:
  explicit NeverTouch(const Snapshot& snapshot);

  /// False where they touch, and where nothing was proven within `max_boxes`, as for most pairs that many joints part.
  bool proven(int body_a, int body_b, int max_boxes) const;

 private:
  /// A joint between two bodies, or one that mimics another one's value.
  struct Mover {
    int link = 0;  ///< The joint's child.
    int value = 0;
    double factor = 1;
    Eigen::Vector3d axis;  ///< Axis in the child's frame.
    bool slides = false;
  };
  /// Where a shape is, in the world: a sphere around it, and a box around the points that its rounding surrounds.
  struct Extent {
    Extent(const BodyShape& shape, const Pose& link);
    /// How far from an axis the points are that move the shape.
    double from_axis(const Eigen::Vector3d& origin, const Eigen::Vector3d& axis) const;

    Eigen::Vector3d centre;
    double radius;
    std::array<Eigen::Vector3d, 8> corners;
  };
  struct Box {
    Eigen::VectorXd middle, half;  ///< All values of the robot; half is zero where one does not matter.
    double clearance = 0;          ///< At the middle of the box that was halved into this one.
  };
  struct Verdict {
    bool proven = false, touching = false;
    double clearance = 0;
    int widest = -1;  ///< The value that moves the bodies most.
  };

  bool movers_between(int link_a, int link_b, std::vector<Mover>& of_a, std::vector<Mover>& of_b) const;
  bool movers_up_to(int link, int top, std::vector<Mover>& out) const;
  Box whole_range(const std::vector<Mover>& of_a, const std::vector<Mover>& of_b) const;
  double motion(const std::vector<Mover>& movers, const Poses& links, const Extent& extent, const Eigen::VectorXd& half,
                Eigen::VectorXd& of_value) const;
  Verdict judge(const Box& box, int body_a, int body_b, const std::vector<Mover>& of_a,
                const std::vector<Mover>& of_b) const;

  const Snapshot& snapshot_;
  std::vector<std::vector<int>> shapes_of_;  ///< Per body.
};

}  // namespace mmgrasp::detail
