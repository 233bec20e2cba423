#pragma once

#include <optional>

#include "mmgrasp/geometry/opposite_facets.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"

namespace mmgrasp::detail {

/// Whether fingers reach facets from outside of a mesh: walls of a closed void, and flanks of teeth whose gap is
/// narrower than a finger, lie opposite each other, too, but nothing gets there.
class JawReach {
 public:
  /// `depth`: how far fingers reach over what they hold [m], > 0. The mesh must live as long.
  JawReach(const TriangleMesh& mesh, double depth) : mesh_(mesh), depth_(depth) {}

  /// Whether both fingers reach the pair from one side, along the facets, without meeting the mesh: looked at in 36
  /// directions, as jaw_grasps() does with fingers across the middle of the overlap.
  bool reaches(const OppositeFacets& pair);

 private:
  bool reaches_from(const OppositeFacets& pair, const Eigen::Vector2d& approach);
  bool finger_is_free(const OppositeFacets& pair, const Eigen::Vector2d& tip, const Eigen::Vector2d& approach,
                      double side);

  const TriangleMesh& mesh_;
  double depth_;
  UsualFingers fingers_{};
  std::optional<RayCaster> caster_;  // Made when the first pair is asked about.
};

}  // namespace mmgrasp::detail
