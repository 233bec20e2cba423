#pragma once

#include "bindings.hpp"
#include "mmgrasp/collision/checker.hpp"
#include "padding.hpp"

namespace mmgrasp::python {

namespace annotations {
inline constexpr char kRobotOrChecker[] = "mmgrasp._core.Robot | mmgrasp._core.CollisionChecker";
inline constexpr char kOptionalGroup[] = "mmgrasp._core.JointGroup | None";
inline constexpr char kOptionalWorld[] = "mmgrasp._core.World | None";
}  // namespace annotations

using RobotOrChecker = Shown<annotations::kRobotOrChecker>;
using OptionalGroup = Shown<annotations::kOptionalGroup>;
using OptionalWorld = Shown<annotations::kOptionalWorld>;

/// The checker itself (its clone), or one made for group and world.
CollisionChecker checker_argument(const RobotOrChecker& robot, const OptionalGroup& given_group,
                                  const OptionalWorld& given_world, const OptionalPadding& padding = py::none());

}  // namespace mmgrasp::python
