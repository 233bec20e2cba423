#pragma once

#include <vector>

#include "collision/kernels/kernels.hpp"
#include "mmgrasp/core/detail/rigid.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// Forward kinematics for collision checks: one frame for each joint the group moves, links rigidly joined to it (or
/// attached at the reference) folded in. Frame 0 is the robot's root. Immutable.
class MMGRASP_EXPORT MovingFrames {
 public:
  explicit MovingFrames(const JointGroup& group);

  int count() const { return static_cast<int>(steps_.size()) + 1; }
  bool has_base() const { return has_base_; }
  int frame_of(int link) const { return frame_of_[link]; }
  const Rigid& link_in_frame(int link) const { return link_in_frame_[link]; }

  /// frames: 16 numbers each (see Kernels::place_frames). The root must have been set unless the group has the base.
  void place(const double* q, double* frames) const;
  static void set(const Rigid& T, double* frame);
  static Rigid get(const double* frame);

  const std::vector<FrameStep>& steps() const { return steps_; }
  /// A joint's frame in its parent's while the joint is at zero.
  static Rigid rest(const FrameStep& step);
  /// Numbers in a configuration.
  int columns() const { return columns_; }
  /// Bound on how fast any point within a sphere moves in the world, per unit of each column [m/rad or m/m], while no
  /// column exceeds `largest` in magnitude.
  Eigen::VectorXd point_rates(const FrameSphere& sphere, const Eigen::VectorXd& largest) const;
  /// Bound on how fast the bodies within two spheres can close a clearance between them, likewise. Turning about a
  /// joint between them closes it no faster than the nearer of the two can move: either may be taken for the one that
  /// turns.
  Eigen::VectorXd closing_rates(const FrameSphere& a, const FrameSphere& b, const Eigen::VectorXd& largest) const;

  /// Turning about several joints at once bends the ways of points. Each of the two bounds how much: a column pair's
  /// entry (order of squares()) times the magnitudes of both columns' motion per unit of time, summed, is a bound of
  /// the acceleration of the points within a sphere while the columns move evenly [m/rad^2 and so on].
  /// Meaningless where bends() is false.
  Eigen::VectorXd point_bends(const FrameSphere& sphere, const Eigen::VectorXd& largest) const;
  /// The same for one of the bodies within two spheres as seen from the other one, the gentler way round; `b_moves`:
  /// seen from a.
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
  /// The last frame on both ways to the root.
  int common_frame(int a, int b) const;

  bool has_base_, bends_ = true;
  int columns_;
  std::vector<FrameStep> steps_;
  std::vector<int> frame_of_;
  std::vector<Rigid> link_in_frame_;
};

}  // namespace mmgrasp::detail
