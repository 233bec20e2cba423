#include "verify/motion/tool_path.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::verify::detail {
namespace {

constexpr double kStraight = 1e-3;  // Deviation from the line, and missing length [m].
constexpr double kTurn = 0.01;      // Deviation from the final orientation [rad].
constexpr double kLevel = 0.01;     // Tilt of a released part [rad].
constexpr double kDrop = 5e-3;      // A part may be let go this far below or above the drop height [m].

}  // namespace

bool StraightnessCheck::check(const Pose& T_world_tip, const std::string& where, Faults& faults) {
  const Eigen::Vector3d offset = T_world_tip.translation() - T_world_end_.translation();
  const double along = offset.dot(axis_);
  const double aside = (offset - along * axis_).norm();
  const double turned = rotation_distance(T_world_tip, T_world_end_);
  std::string message;
  if (aside > kStraight) message = "the tool is " + text(aside) + " m off the line";
  if (turned > kTurn) message = "the tool is turned by " + text(turned) + " rad from its pose at the end";
  if (along > kStraight) message = "the tool is " + text(along) + " m past the end";
  if (along < farthest_ - kStraight) message = "the tool goes back by " + text(farthest_ - along) + " m";
  farthest_ = std::max(farthest_, along);
  if (!message.empty()) faults.push_back({"not-straight", where, message});
  return message.empty();
}

void check_grasp_reached(const Context& context, const Pose& T_world_wanted, const Pose& T_world_tip,
                         const std::string& where, Faults& faults) {
  const double distance = (T_world_wanted.translation() - T_world_tip.translation()).norm();
  const double angle = rotation_distance(T_world_wanted, T_world_tip);
  if (distance <= context.options.position_tolerance && angle <= context.options.rotation_tolerance) return;
  faults.push_back({"grasp-missed", where,
                    "the tool ends " + text(distance) + " m and " + text(angle) + " rad from the grasp, allowed are " +
                        text(context.options.position_tolerance) + " m and " +
                        text(context.options.rotation_tolerance) + " rad"});
}

void check_approach(const Context& context, const Pose& T_world_start, const Pose& T_world_end,
                    const std::string& where, Faults& faults) {
  const Eigen::Vector3d way = T_world_end.translation() - T_world_start.translation();
  const double length = way.dot(T_world_end.linear() * context.plan.approach);
  if (length >= context.plan.approach_distance - kStraight) return;
  faults.push_back({"short-approach", where,
                    "the tool begins " + text(length) + " m before the grasp, must be " +
                        text(context.plan.approach_distance) + " m"});
}

void check_lift(const Context& context, const Pose& T_world_start, const Pose& T_world_end, const std::string& where,
                Faults& faults) {
  const double rise = T_world_end.translation().z() - T_world_start.translation().z();
  if (rise >= context.plan.lift_height - kStraight) return;
  faults.push_back(
      {"no-lift", where, "the tool rises by " + text(rise) + " m, must be " + text(context.plan.lift_height) + " m"});
}

void check_release(const Context& context, const CheckedPart& part, const Pose& T_world_root,
                   const Pose& T_world_released, const std::string& where, Faults& faults) {
  const PlanToCheck& plan = context.plan;
  const bool in_bin = !plan.unload_region;
  const CheckedUnloadRegion over =
      in_bin ? CheckedUnloadRegion{T_world_root * plan.T_base_bin, plan.bin_size, plan.drop_height}
             : *plan.unload_region;
  const std::string name = in_bin ? "bin" : "unload region";
  const Pose T_region_released = over.T_world_region.inverse() * T_world_released;
  const Eigen::Vector3d at = T_region_released.translation();
  if (std::abs(at.x()) > 0.5 * over.size.x() || std::abs(at.y()) > 0.5 * over.size.y()) {
    faults.push_back({"release-outside", where,
                      "the part is let go at (" + text(at.x()) + ", " + text(at.y()) + ") m from the " + name +
                          "'s middle, the " + name + " is " + text(over.size.x()) + " x " + text(over.size.y()) +
                          " m"});
  }
  // The turn since it lay: about the vertical only, if the vertical is where it was.
  const Eigen::Matrix3d turn = T_world_released.linear() * part.body.T_world_body.linear().transpose();
  const double tilt = std::atan2(std::hypot(turn(0, 2), turn(1, 2)), turn(2, 2));
  if (tilt > kLevel) {
    faults.push_back({"release-tilted", where, "the part is let go tilted by " + text(tilt) + " rad from how it lay"});
  }
  const double height = lowest_z(part.body.shapes, T_region_released);
  if (std::abs(height - over.drop_height) > kDrop) {
    faults.push_back({"release-height", where,
                      "the part's lowest point is " + text(height) + " m over the " + name +
                          (in_bin ? "'s top, must be " : ", must be ") + text(over.drop_height) + " m"});
  }
}

}  // namespace mmgrasp::verify::detail
