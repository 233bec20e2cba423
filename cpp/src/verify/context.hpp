#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/verify/plan_check.hpp"
#include "verify/judge.hpp"

namespace mmgrasp::verify::detail {

using Faults = std::vector<Fault>;

constexpr double kLeastStep = 1e-9;  ///< No path is walked in smaller steps [rad or m].

/// A number for a message: six significant digits.
std::string text(double value);
std::string text(const Eigen::Vector3d& x_y_theta);

/// A plan whose names are resolved, with everything the checks share. Made only for plans without a structural fault,
/// so every index in it is good; what may still be missing is said at the field.
struct Context {
  const PlanToCheck& plan;
  const PlanCheckOptions& options;
  const Monitor& monitor;
  std::shared_ptr<const Stage> stage;
  std::map<std::string, int> part_index;  ///< Name -> index into plan.parts.
  std::vector<int> pick_part;             ///< Part of each pick; -1: unknown name.
  std::vector<int> picked_by;             ///< First good pick of each part; -1: never picked.

  std::size_t body_of_part(int part) const { return stage->first_part + part; }
  double pregrasp_opening(double width) const;
  std::string pick_name(std::size_t pick) const;
  /// Judge with exactly the parts in the scene that are left before this pick.
  void set_parts_before(Judge& judge, std::size_t pick) const;
};

/// Names, lengths and numbers (structure.cpp). With any fault here nothing else can be checked.
bool check_structure(const PlanToCheck& plan, const RobotModel& robot, Faults& faults, ArmSetup& setup,
                     std::vector<int>& finger_links);

/// Listed grasps that have something between the pads, and used ones of their parts' widths (grasp_opening.cpp).
void check_grasp_openings(const Context& context, Faults& faults);
/// Listed grasps of a hand with suction cups seal (cup_seal.cpp).
void check_seals(const PlanToCheck& plan, Faults& faults);
/// No target part is heavier than the hand may carry (payload.cpp).
void check_payload(const PlanToCheck& plan, Faults& faults);
/// Which part is picked when and where (picks.cpp).
void check_pick_list(Context& context, Faults& faults);
/// The motions of each pick (arm_motions.cpp).
void check_arm_motions(const Context& context, Faults& faults, std::size_t& configurations);
/// Drive and pick in one (drive_by.cpp).
void check_drive_by(const Context& context, Faults& faults, std::size_t& configurations);
/// "base-workspace": x and y of a base pose, off by up to `radius`, stay in the base's workspace (route.cpp).
bool check_workspace(const PlanToCheck& plan, const Eigen::Vector3d& pose, double radius, const std::string& where,
                     Faults& faults);
/// Base route, home and start (route.cpp).
void check_route(const Context& context, Faults& faults, std::size_t& configurations);
/// Every target part graspable from everywhere in the uncertainty discs (robustness.cpp).
void check_robustness(const Context& context, Faults& faults, std::vector<StopRate>& rates,
                      std::size_t& configurations);
/// Arrivals drawn by the plan's covariance serve all parts as often as it says (robustness.cpp).
void check_arrivals(const Context& context, Faults& faults, std::size_t& configurations);
/// Base poses drawn in the regions and beside them (region_samples.cpp).
void check_regions(const Context& context, Faults& faults, std::size_t& configurations);
/// Stops inside their regions, and no smaller cover (minimality.cpp).
void check_stops(const Context& context, PlanCheckResult& result);

}  // namespace mmgrasp::verify::detail
