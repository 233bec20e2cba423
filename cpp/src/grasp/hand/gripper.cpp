#include "mmgrasp/grasp/gripper.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

constexpr double kUnitTolerance = 1e-6;
constexpr double kOpeningSlack = 1e-9;  // openings are often width + 2 clearance, computed with rounding

void check_unit_axis(const Eigen::Vector3d& axis, const std::string& field) {
  require(axis.allFinite(), field, "not finite", "must be a unit vector");
  require(std::abs(axis.norm() - 1.0) <= kUnitTolerance, field + " norm", axis.norm(), "must be 1 within 1e-6");
}

void check_positive(double value, const std::string& field) {
  require(std::isfinite(value) && value > 0, field, value, "must be positive and finite [m]");
}

}  // namespace

void Gripper::check() const {
  check_unit_axis(approach, "gripper.approach");
  check_unit_axis(closing, "gripper.closing");
  const double dot = approach.dot(closing);
  require(std::abs(dot) <= kUnitTolerance, "gripper.approach . gripper.closing", dot,
          "the two axes must be orthogonal within 1e-6");
  check_positive(max_opening, "gripper.max_opening");
  check_positive(finger_depth, "gripper.finger_depth");
  check_positive(finger_width, "gripper.finger_width");
  require(std::isfinite(clearance) && clearance >= 0, "gripper.clearance", clearance,
          "must be zero or positive and finite [m]");
  std::set<std::string> names;
  for (const FingerJoint& joint : joints) {
    require(!joint.name.empty(), "gripper.joints", "\"\"", "a finger joint needs a name");
    require(names.insert(joint.name).second, "gripper.joints", joint.name, "each finger joint may be listed once");
    require(std::isfinite(joint.closed), "gripper.joints." + joint.name + ".closed", joint.closed, "must be finite");
    require(std::isfinite(joint.open), "gripper.joints." + joint.name + ".open", joint.open, "must be finite");
  }
}

std::map<std::string, double> Gripper::joint_values(double opening) const {
  require(opening >= -kOpeningSlack && opening <= max_opening + kOpeningSlack, "opening", opening,
          "must lie between 0 and the gripper's max_opening " + std::to_string(max_opening) + " [m]");
  const double share = std::clamp(opening / max_opening, 0.0, 1.0);
  std::map<std::string, double> values;
  for (const FingerJoint& joint : joints) values[joint.name] = joint.closed + share * (joint.open - joint.closed);
  return values;
}

double Gripper::pregrasp_opening(double width) const {
  require(width >= 0 && width <= max_opening + kOpeningSlack, "width", width,
          "must lie between 0 and the gripper's max_opening " + std::to_string(max_opening) + " [m]");
  return std::min(width + 2 * clearance, max_opening);
}

}  // namespace mmgrasp
