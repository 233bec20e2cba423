#pragma once

#include "collision/narrow/narrow.hpp"
#include "mmgrasp/collision/field_obstacle.hpp"

namespace mmgrasp::detail {

/// A distance field as an obstacle, with what is asked of it again and again.
struct FieldView {
  explicit FieldView(const FieldObstacle& obstacle);

  std::shared_ptr<const DistanceField> field;
  DistanceFieldProperties properties;
  double resolution;
  bool unknown_is_free;
};

/// Solid of kind `field`; padding is its margin.
std::shared_ptr<const Solid> make_field_solid(const FieldObstacle& obstacle, double padding);

/// False proves that the body at T_body is farther than its margin and `more` [m] from what the field holds.
bool field_collides(const Solid& body, const Rigid& T_body, const FieldView& field, const Rigid& T_field, double more);

/// The clearance of a body (a) from what the field holds (b), from below and by at most twice the field's error and its
/// resolution. Not below `bound`: the distance is infinite. Overlap: how deep the body's deepest point lies.
SolidClearance field_distance(const Solid& body, const Rigid& T_body, const FieldView& field, const Rigid& T_field,
                              double bound);

/// A lower bound of the clearance of a sphere in the field's frame [m]; not above 0 where none is known.
double field_clearance(const FieldView& field, const Eigen::Vector3d& centre, double radius);

}  // namespace mmgrasp::detail
