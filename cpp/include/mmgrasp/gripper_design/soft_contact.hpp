#pragma once

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Where a soft pad touches: a rectangle along and across the approach.
struct MMGRASP_EXPORT ContactArea {
  double length = 0;          ///< Along the approach [m].
  double width = 0;           ///< Across it [m].
  double torsion_radius = 0;  ///< Mean distance from the middle, weighted by pressure: the largest torque about the
                              ///< normal is friction times normal force times this [m].
  double area() const { return length * width; }
};

/// A flat pad on a flat face, pressed evenly. Both sides are positive [m].
MMGRASP_EXPORT ContactArea flat_contact(double length, double width);

/// A pad on a round wall along the wall's axis: Hertz' line contact (Johnson 1985, 4.2), as wide as
/// 2 sqrt(4 F R / (pi l E)) and no wider than the pad, pressure like half an ellipse across. `force` F > 0 [N];
/// `wall_radius` > 0 [m]; `length` l > 0 [m]; `pad_width` > 0 [m]; `modulus` E of both surfaces together > 0 [Pa];
/// `pad_radius` of a hollow pad, infinite for a flat one, >= wall_radius [m]: 1/R = 1/wall_radius - 1/pad_radius. A pad
/// that fits the wall touches over its whole width.
MMGRASP_EXPORT ContactArea line_contact(double force, double wall_radius, double length, double pad_width,
                                        double modulus, double pad_radius);

/// The torque about its normal that a soft contact holds beside a tangential force, by the ellipsoid that stands for
/// the limit surface (Howe and Cutkosky 1996): (tangential / (mu N))^2 + (torque / (mu N r))^2 = 1; 0 where the
/// tangential force alone makes it slip. `normal` N >= 0 and `tangential` >= 0 [N], `friction` mu >= 0,
/// `torsion_radius` r >= 0 [m]; [N m].
MMGRASP_EXPORT double soft_finger_torque(double normal, double friction, double torsion_radius, double tangential = 0);

}  // namespace mmgrasp
