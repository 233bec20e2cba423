#pragma once

#include <string>

#include "verify/tiny_world.hpp"

/// Ways to spoil the good plan of tiny_world.hpp and to read what the check says about it.
namespace tiny {

enum { kTransit, kApproach, kLift, kTransfer, kRetreat };

inline CheckedMotion& motion(PlanToCheck& plan, int pick, int kind) {
  return plan.picks[pick].motions[kind];
}

inline std::string listed(const PlanCheckResult& result) {
  std::string all;
  for (const Fault& fault : result.faults) all += fault.code + " | " + fault.where + " | " + fault.message + "\n";
  return all;
}

/// The good plan on a robot whose URDF and SRDF are changed: texts are replaced by others.
inline PlanToCheck on_other_robot(const PlanToCheck& good, std::string urdf_text, const std::string& srdf_text) {
  mmgrasp::RobotOptions options;
  options.base = mmgrasp::BaseKind::diff_drive;
  PlanToCheck plan = good;
  plan.robot = mmgrasp::source_of(mmgrasp::Robot::from_strings(urdf_text, srdf_text, options));
  return plan;
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  text.replace(text.find(what), what.size(), by);
  return text;
}

}  // namespace tiny
