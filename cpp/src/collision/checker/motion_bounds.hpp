#pragma once

#include <memory>
#include <vector>

#include "collision/kernels/kernels.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"

namespace mmgrasp::detail {

/// Bounds on how bodies that stand in the frames of a group move as the joints do, from the tree of frames alone: they
/// hold in every configuration within the values given. Immutable.
class MMGRASP_EXPORT MotionBounds {
 public:
  explicit MotionBounds(const JointGroup& group);

  const FrameTree& tree() const { return kinematics_->tree; }
  bool has_base() const { return has_base_; }
  /// Numbers in a configuration.
  int columns() const { return columns_; }

  /// Bound on how fast any point within a sphere moves in the world, per unit of each column [m/rad or m/m], while no
  /// column exceeds `largest` in magnitude.
  Eigen::VectorXd point_rates(const FrameSphere& sphere, const Eigen::VectorXd& largest) const;
  /// Bound on how fast the clearance between the bodies within two spheres can shrink, per unit of each column. A joint
  /// between the two moves them against each other; whichever body is taken to stand still, the clearance shrinks at
  /// the same rate, so for each joint the smaller of the two bodies' point rates is a bound.
  Eigen::VectorXd closing_rates(const FrameSphere& a, const FrameSphere& b, const Eigen::VectorXd& largest) const;

  /// When all columns move at constant rates, points on turning links still accelerate: they move along curves. This
  /// and closing_bends() bound that acceleration. One entry for each pair of columns, in the order of squares(): each
  /// entry times the rates of both columns, summed, bounds the acceleration of every point within the sphere
  /// [m/rad^2 and so on]. Meaningless where bends() is false.
  Eigen::VectorXd point_bends(const FrameSphere& sphere, const Eigen::VectorXd& largest) const;
  /// The same for the motion of one of two bodies as seen from the other. Of the two views the one with the smaller
  /// bound is returned; `b_moves` is set when it is b's motion seen from a.
  Eigen::VectorXd closing_bends(const FrameSphere& a, const FrameSphere& b, const Eigen::VectorXd& largest,
                                bool& b_moves) const;
  /// False when a joint turns by a rotation vector, for which there are no such bounds.
  bool bends() const { return bends_; }
  /// Products of all pairs of numbers, each pair once: (0, 0), (0, 1) ... (1, 1), ...
  static void squares(const Eigen::VectorXd& values, Eigen::VectorXd& out);

 private:
  /// A joint on the way from a body to where it is seen from.
  struct JointReach {
    int column;
    double turning;  ///< Angle per unit of the column; 0 for joints that slide.
    double rate;     ///< How far the body's points move per unit of the column.
  };
  /// All joints that move the points within a sphere, the nearest first.
  std::vector<JointReach> joints_above(const FrameSphere& sphere, const Eigen::VectorXd& largest) const;
  /// The joints between two bodies: a's motion seen from b, nearest to a first, and b's seen from a.
  void joints_between(const FrameSphere& a, const FrameSphere& b, const Eigen::VectorXd& largest,
                      std::vector<JointReach>& of_a, std::vector<JointReach>& of_b) const;
  Eigen::VectorXd bends_of(const std::vector<JointReach>& joints) const;
  /// The motions between two frames: up from the first one, then down to the second one; `up`: how many go up.
  std::vector<const ElementaryMotion*> motions_between(int from, int to, std::size_t& up) const;

  std::shared_ptr<const GroupKinematics> kinematics_;
  bool has_base_, bends_ = true;
  int columns_;
};

}  // namespace mmgrasp::detail
