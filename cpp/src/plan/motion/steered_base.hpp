#pragma once

#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// The group moves a diff-drive base: it cannot follow straight lines between its configurations.
bool has_steered_base(const JointGroup& group);

/// For planners whose paths are straight lines between configurations: throws InvalidInput when the group could not
/// drive them.
void refuse_steered_base(const JointGroup& group, const char* function);

}  // namespace mmgrasp::detail
