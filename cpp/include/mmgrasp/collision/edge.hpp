#pragma once

#include <Eigen/Core>
#include <optional>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// How check_edge() looks at the motion between two configurations: in steps, and how long these may be, or proven free
/// as a whole.
struct MMGRASP_EXPORT EdgeOptions {
  double joint_step = 0.02;  ///< No joint moves more than this between two checks [rad or m]; > 0.
  /// No point of the robot (or of what is attached to it) moves more than this between two checks [m]; > 0, infinite:
  /// no bound.
  double workspace_step = std::numeric_limits<double>::infinity();
  /// Conservative advancement instead of steps: free means that every configuration between is free, wherever the
  /// bodies stay `tolerance` apart.
  bool continuous = false;
  double tolerance = 1e-4;  ///< Continuous only: clearances below this count as contact [m]; > 0.
  /// Continuous only: the motion is no straight line but leaves it by at most this much in each joint [rad or m]; free
  /// then holds for all that does. Empty: straight. Entries finite and >= 0.
  Eigen::VectorXd bend = {};
  void check() const;
};

/// Whether an edge is free; if not, how far along it the first contact is and what touches there.
struct MMGRASP_EXPORT EdgeResult {
  bool free = false;
  double fraction = 1;             ///< Where along the edge the first refused check was, in [0, 1]; 1 when free.
  std::optional<Contact> contact;  ///< What touches there; empty when limits refuse it.
  int checks = 0;                  ///< Configurations checked.
};

/// Straight joint-space edge (angles are not wrapped), ends included. Throws InvalidInput on a wrong length or a number
/// that is not finite, and on a `bend` of another length.
MMGRASP_EXPORT EdgeResult check_edge(CollisionChecker& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                                     const EdgeOptions& options = {});

/// Bound on how far any point of the robot (or of what is attached to it) moves when joint i moves by one unit [m/rad
/// or m/m], at any configuration: workspace motion <= sum_i bound_i |dq_i|.
MMGRASP_EXPORT Eigen::VectorXd motion_bounds(const CollisionChecker& checker);

/// is_free of each column of Q (size() x m), with one clone of the checker per thread; the answers do not depend on
/// `threads` (0: all).
MMGRASP_EXPORT std::vector<char> are_free(const CollisionChecker& checker, const Eigen::MatrixXd& Q, int threads = 0);

}  // namespace mmgrasp
