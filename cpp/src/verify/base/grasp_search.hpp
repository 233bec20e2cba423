#pragma once

#include <deque>
#include <string>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "verify/context.hpp"
#include "verify/robot/ik.hpp"

namespace mmgrasp::verify::detail {

/// A grasp with an arm configuration that once reached it.
struct Hold {
  int grasp = -1;
  Eigen::VectorXd arm;
};

/// Holds by part, the last successful in front.
using Pools = std::vector<std::deque<Hold>>;

/// The plan's own configurations are the first seeds.
Pools planned_holds(const Context& context);

/// Target parts of these trays.
std::vector<int> wanted_parts(const PlanToCheck& plan, const std::vector<std::string>& trays);

/// What counts as a grasp that serves.
enum class Effort {
  usual,
  thorough,      ///< As find_thoroughly().
  without_ties,  ///< The robot keeps clear of what it might just touch: configurations are off by up to their
                 ///< tolerance, so that rounding and search decide whether they touch.
};

/// Finds grasps from one base pose after another.
class GraspSearch {
 public:
  /// `tries`: IK solutions tried from other seeds before a part counts as lost.
  GraspSearch(const Context& context, Judge& judge, Pools pools, Rng rng, int tries = 1500);

  /// Whether the part can be grasped from where the judge's base stands.
  bool find(int part);
  /// find() with kSecondLook tries before the part counts as lost: where a verdict hangs on it.
  bool find_thoroughly(int part);
  /// Moves the base there: whether the robot may stand there at home and grasp all these parts.
  bool serves(const Eigen::Vector3d& base_pose, const std::vector<int>& parts, Effort effort = Effort::usual);

 private:
  bool try_hold(int part, Hold& hold);
  bool search(int part, int tries);
  Eigen::VectorXd known_arm(int part);
  Eigen::VectorXd random_arm();

  const Context& context_;
  Judge& judge_;
  Pools pools_;
  Rng rng_;
  int tries_;
  double clearance_ = 0;  // Kept by the grasps that are found [m].
  IkTolerance tolerance_;
};

}  // namespace mmgrasp::verify::detail
