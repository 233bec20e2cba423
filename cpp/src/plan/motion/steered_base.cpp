#include "plan/motion/steered_base.hpp"

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::detail {

bool has_steered_base(const JointGroup& group) {
  return group.has_base() && group.robot().base() == BaseKind::diff_drive;
}

void refuse_steered_base(const JointGroup& group, const char* function) {
  if (!has_steered_base(group)) return;
  throw InvalidInput("group = " + group.name() + ": moves a diff_drive base, which cannot go sideways as " + function +
                     " would have it; must be the arm alone or have an omni base (to drive as well, see plan_motion "
                     "and plan_drive_by)");
}

}  // namespace mmgrasp::detail
