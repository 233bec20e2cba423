#pragma once

#include <string>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/grasp/finger_length_range.hpp"

namespace mmgrasp {

/// How deep the active and the passive parts of an operation stand in each other, where it is deepest.
struct MMGRASP_EXPORT OperationOverlap {
  double depth = 0;             ///< A point of one part's surface lies this deep in the other [m]; 0: nowhere.
  std::string active, passive;  ///< The two parts' names; empty where depth is 0.
  double before_end = 0;        ///< The way that is left when it happens, of the active parts' middle [m].
};

/// The deepest overlap at the end of an operation, or, if that is at most `allowed` [m], along its motion (looked at
/// every 2 mm and 0.05 rad; what lies beyond the first look that is deeper is not looked at). Judged at the corners
/// of the meshes and at points drawn evenly over their surfaces (the same each time): up to 4,000 of each a part, so
/// that what it tells is there, and what is thinner than their distance may be missed. Only closed meshes have an
/// inside. Throws InvalidInput for a wrong operation, or `allowed` < 0.
MMGRASP_EXPORT OperationOverlap operation_overlap(const AssemblyOperation& operation, double allowed = 0,
                                                  const Monitor& monitor = {});

}  // namespace mmgrasp
