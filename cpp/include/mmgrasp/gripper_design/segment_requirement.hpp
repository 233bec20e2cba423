#pragma once

#include <limits>
#include <string>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// What a gripper needs to hold one segment of a part in its operation: C_ij = {F, W, L-, L+} of P1 5.3.4. A part with
/// several graspable segments has several of these; a gripper that meets one of them takes the part.
struct MMGRASP_EXPORT SegmentRequirement {
  std::string part;     ///< Whose segment it is; parts are distinguished by this name.
  std::string segment;  ///< Its label in messages and results; may be empty.
  int fingers = 2;      ///< 2: parallel jaws; 3: centric fingers.
  /// Characteristic length [m], > 0: the diameter of the fitted cylinder or the distance of the faces in touch.
  double opening = 0;
  double min_finger_length = 0;                                        ///< [m], >= 0.
  double max_finger_length = std::numeric_limits<double>::infinity();  ///< [m], >= min_finger_length.
  /// How far each finger opens to let go of it [m], >= 0: minimal_grippers() keeps twice this free above `opening`.
  double clearance = 0;
  /// The gripper's smallest opening is no less [m], in [0, opening]: centric fingers that close farther have pads too
  /// narrow to hold it.
  double least_min_opening = 0;
  /// The drive's stroke is no more [m], > 0: a longer one has a wider palm, or opens farther to let go.
  double max_stroke = std::numeric_limits<double>::infinity();

  void check() const;        ///< Throws InvalidInput naming part, segment, field, value and rule.
  std::string name() const;  ///< "part" or "part, segment".
};

}  // namespace mmgrasp
