#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"
#include "mmgrasp/grasp/suction.hpp"

namespace mmgrasp::detail {

/// Sides of round shapes where rims are laid on them: the triangles stay within 8e-5 of the radius.
inline constexpr int kSealSegments = 256;

/// Where the surface is before the cups: rays along the approach through the rims and through what they enclose.
class CupSeal {
 public:
  /// What one hand pose meets. Distances along the approach from the rims' plane [m]; infinite: nothing.
  struct Contact {
    double nearest = 0;   ///< The least of all points within the rims.
    double farthest = 0;  ///< The largest of the points of the rims.
    bool covered = true;  ///< The surface is before every point within the rims, no deeper than the cup's radius.
    std::vector<Eigen::Vector3d> rim;  ///< Points that the rims' rays meet, in the object's frame.
  };

  /// The mesh of the body as joined_surface() makes it.
  CupSeal(const TriangleMesh& mesh, const Suction& suction, const Eigen::Vector3d& approach);

  Contact at(const Pose& T_object_hand) const;

 private:
  struct Cup {
    double radius;
    std::vector<Eigen::Vector3d> rim, inside;  ///< Points in the tool frame.
  };
  RayCaster caster_;
  Eigen::Vector3d approach_;
  double behind_;  ///< Rays begin so far behind the rims' plane [m].
  std::vector<Cup> cups_;
};

}  // namespace mmgrasp::detail
