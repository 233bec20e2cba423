#pragma once

#include <vector>

#include "collision/checker/placement.hpp"
#include "collision/narrow/convex_clearance.hpp"

namespace mmgrasp::detail {

/// Bounds on how far bodies come from where they are at one check of a straight edge up to other checks of it, in
/// metres; distances along the edge are in pieces between checks. Two bounds hold, and the lesser is given: the rates
/// of PairPlan, for any configuration, and the velocity at the check with what the way can bend from it (a Taylor bound
/// of second order). Kept from edge to edge for its memory alone.
class MMGRASP_EXPORT EdgeMotion {
 public:
  /// Begins with an edge; every other call is about it. `step`: motion of the joints in one piece. The placement must
  /// outlive the edge.
  void start(const Placement& placement, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
             const Eigen::VectorXd& step);

  /// Must be called when the bodies were placed for another check.
  void placed() { velocities_valid_ = false; }

  /// How plan().moving[body] moves in the world, up to `reach` pieces away.
  Closing of_body(int body, double reach);
  /// How much closer the bodies of plan().varying[pair] come to each other.
  Closing of_pair(int pair, double reach);
  /// The farthest of the two by the rates alone: quick to come by.
  double of_body_anywhere(int body, double reach) const { return with_slack(body_rates_[body] * reach); }
  double of_pair_anywhere(int pair, double reach) const { return with_slack(pair_rates_[pair] * reach); }

 private:
  // Clearances and rates are in single precision; the spheres' radii carry the slack of their own coordinates.
  static double with_slack(double motion) { return motion * (1 + 1e-5) + 1e-7; }

  struct Velocity {
    Eigen::Vector3d origin, linear, angular;  ///< The frame's origin and its velocities per piece.
    Eigen::Vector3d at(const Eigen::Vector3d& p) const { return linear + angular.cross(p - origin); }
  };
  void find_velocities();
  static void add_velocity(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular, double radius, double bend,
                           double reach, Closing& out);
  const Velocity& velocity(int sphere) {
    if (!velocities_valid_) find_velocities();
    return velocities_[placement_->plan().spheres[sphere].frame];
  }

  const Placement* placement_ = nullptr;
  Eigen::VectorXd step_, magnitude_;
  Eigen::VectorXd body_rates_, pair_rates_;  ///< Motion per piece.
  Eigen::VectorXd
      half_squares_;        ///< Half the square of each joint's motion in one piece; empty where nothing is known.
  MotionRates along_edge_;  ///< Where those of the plan are not finite.
  const MotionRates* rates_ = nullptr;
  std::vector<Velocity> velocities_;
  bool velocities_valid_ = false;
};

}  // namespace mmgrasp::detail
