#pragma once

#include "arrays.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/task/drive_by.hpp"
#include "shown.hpp"

namespace mmgrasp::python {

inline constexpr char kViolationRows[] = "dict[str, mmgrasp.records.ViolationRow]";
using ViolationRows = Shown<kViolationRows>;

/// By kind of constraint.
ViolationRows violations_dict(const std::vector<Violation>& violations);

/// A configuration (n,), or (2, n) with bounds.
DriveByGoal goal_argument(const ArrayLike& goal, Eigen::Index size);

}  // namespace mmgrasp::python
