#pragma once

#include <array>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "reach/database/branch_table.hpp"
#include "reach/database/hand_probe.hpp"

namespace mmgrasp::detail {

/// Searches one tool pose after another for a free configuration, remembering how near to one it came. One per thread.
class PoseSearch {
 public:
  /// `table` must outlive it.
  PoseSearch(const CollisionChecker& checker, const HandProbe& hand, const BranchTable& table, unsigned seed);

  /// Starts on a pose; `number` picks its random numbers. False when the position is surely out of reach.
  bool start(const Pose& T_world_tip, std::uint64_t number);
  /// The pose is refused for good: the hand alone collides.
  bool out_of_reach() const { return out_of_reach_; }
  /// The most hopeful failure so far: scene before self-collision before limits before reach.
  Rejection cause() const { return cause_; }
  /// The configuration found: rounded to 32-bit floats inside limits, confirmed by forward kinematics, free.
  const Eigen::VectorXf& found() const { return found_; }

  // Each true when it found a configuration; none tries anything once the pose is out of reach.
  bool try_samples(int first, int last);         ///< Entries of the table.
  bool try_samples_near(int sample, int count);  ///< The entries below `count`, nearest to `sample` first.
  int sample() const { return sample_; }         ///< The entry that found it; -1 when none did.
  bool try_locked(const Eigen::VectorXd& q);     ///< The closed form with the free joints as in q.
  /// Newton's method from the branches seen so far that stuck out of their limits least.
  bool try_nearly_inside(int iterations);
  bool try_descent(const Eigen::VectorXd& q, int iterations);  ///< Newton's method from q.
  bool try_random_descents(int count, int iterations);
  /// Refuses the pose for a cause known beforehand.
  void settle(Rejection cause) {
    cause_ = cause;
    out_of_reach_ = true;
  }
  /// Whether q itself, which reaches the pose, is free.
  bool try_configuration(const Eigen::VectorXd& q);

 private:
  bool try_branches(const LockedArm& arm);
  void note_outside(const Eigen::VectorXd& q, double outside);
  bool accept(Eigen::VectorXd& q);
  bool refused(Rejection cause);

  const BranchTable& table_;
  JointGroup arm_;
  CollisionChecker checker_;
  HandProbe hand_;
  unsigned seed_;
  IkOptions ik_;
  IkWorkspace workspace_;
  Pose target_ = Pose::Identity();
  Rigid motion_;
  std::uint64_t number_ = 0;
  Rejection cause_ = Rejection::unreachable;
  bool out_of_reach_ = false, hand_checked_ = false;
  int sample_ = -1;
  std::array<double, 3> outside_{};        ///< How far the nearest branches outside stuck out [rad] ...
  std::array<Eigen::VectorXd, 3> nearly_;  ///< ... and these, clamped.
  Eigen::VectorXf found_;
  Eigen::VectorXd q_, trial_, rounded_;
};

}  // namespace mmgrasp::detail
