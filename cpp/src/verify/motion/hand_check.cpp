#include "verify/motion/hand_check.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/verify/plan_check.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr double kGripPlay = 0.01;   // Fingers may close this far below a grasp's width to meet the part [m],
constexpr double kGripShare = 0.25;  // or this share of it.
constexpr double kPlay = 1.5e-3;     // How far a pad or finger may be off the part [m],
constexpr double kShare = 0.05;      // or this share of the part's width.

}  // namespace

bool HandCheck::collides(const Eigen::VectorXd& arm, double opening, const std::string& where) {
  const Touch touch = judge_.touch(arm, opening);
  if (!touch) return false;
  const char* code = touch.kind == TouchKind::self       ? "self-collision"
                     : touch.kind == TouchKind::attached ? "attached-collision"
                                                         : "scene-collision";
  faults_.push_back({code, where, "'" + touch.a + "' touches '" + touch.b + "'"});
  return true;
}

void HandCheck::check_fingers(const Eigen::VectorXd& arm, double from, double to, const std::string& where) {
  const ArmSetup& setup = judge_.stage().setup;
  const double share = setup.share_open(to) - setup.share_open(from);
  double travel = 0;
  for (const CheckedFinger& finger : context_.plan.fingers)
    travel = std::max(travel, std::abs((finger.open - finger.closed) * share));
  const int steps = static_cast<int>(std::min(std::ceil(travel / context_.options.joint_step), 1000.0));
  for (int i = 0; i <= steps; ++i) {
    const double opening = steps ? from + (to - from) * i / steps : from;
    if (collides(arm, opening, where + " at " + text(opening) + " m")) return;
  }
}

void HandCheck::check_grip(const Eigen::VectorXd& arm, double width, const std::string& where) {
  constexpr int kSteps = 20;
  const double below = width - narrowest_grip(width);
  int most = 0;
  for (int i = 0; i <= kSteps && most < 2; ++i) {
    most = std::max(most, judge_.sides_touching_attached(arm, width - below * i / kSteps));
  }
  if (most >= 2) return;
  faults_.push_back({"grasp-empty", where,
                     "closing from " + text(width) + " m to " + text(width - below) + " m, " +
                         (most == 0 ? "no finger touches the part" : "fingers of only one side touch the part")});
}

void HandCheck::check_room(const Eigen::VectorXd& arm, double width, double moved, const std::string& where) {
  const double before = std::min(width + 2 * (grip_play(width) + moved), context_.plan.max_opening);
  if (judge_.sides_touching_attached(arm, before) == 0) return;
  faults_.push_back({"grasp-fingers", where,
                     "fingers meet the part when they are still " + text(before) + " m apart, the grasp says " +
                         text(width) + " m: they would stand in the part"});
}

}  // namespace mmgrasp::verify::detail

namespace mmgrasp::verify {

double grip_play(double width) {
  return std::max(detail::kPlay, detail::kShare * width);
}

double narrowest_grip(double width) {
  return std::max(0.0, width - std::max(detail::kGripPlay, detail::kGripShare * width));
}

}  // namespace mmgrasp::verify
