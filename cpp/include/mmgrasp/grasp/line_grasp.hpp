#pragma once

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// P3's grasp in one dimension (4.4.2, figure 4.5): a parallel gripper on a line and an object whose place is not known
/// exactly. The worked example of (4.1): both of its factors are simple enough for a closed form.
struct MMGRASP_EXPORT LineGrasp {
  double width = 0.2;        ///< The object's width, P3's w [m]; in (0, max_opening).
  double max_opening = 0.4;  ///< The gripper's largest opening, P3's u_1^max [m].
  void check() const;

  /// P(S | x, G) of (4.3) and (4.4): 1 - |position - object| / d_max with d_max = (max_opening - width) / 2, and 0
  /// where a fingertip would stand in the object.
  double success(double opening, double position, double object) const;
  /// P(S) of (4.1) for an object at N(mean, sigma^2), exact.
  double probability(double opening, double position, double mean, double sigma) const;
};

}  // namespace mmgrasp
