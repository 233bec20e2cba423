#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/planar_facets.hpp"

namespace mmgrasp {

/// Fingers of a gripper whose own are not known: jaw_grasps() makes grasps for them, and widths are listed for them.
struct UsualFingers {
  double width = 0.015, thickness = 0.008;  ///< Across the approach and along the closing axis [m], > 0.
};

/// Which facets of a segment two parallel jaws can close on.
struct MMGRASP_EXPORT OppositeFacetsOptions {
  double facet_angle = 0.1;      ///< Faces of one facet bend no more than this from its largest one [rad]; in (0, 0.5].
  double parallel_angle = 0.05;  ///< Facets held between jaws are off parallel by no more [rad]; in (0, 0.5].
  double min_contact = 0.003;    ///< Facets lie opposite each other over this length, and its square [m], > 0.
  double max_width = 1e6;        ///< Facets farther apart are left out [m], > 0.
  void check() const;            ///< Throws InvalidInput naming field, value and rule.
};

/// Two facets that look away from each other, with material behind both, and lie in each other's shadow.
struct MMGRASP_EXPORT OppositeFacets {
  const Facet& first;
  const Facet& second;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();   ///< Columns: two along the facets, and out of the first.
  std::vector<std::vector<Eigen::Vector3d>> overlap{};  ///< Convex pieces of both shadows; x and y in `axes` [m].
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();     ///< Centre of the overlap's area in `axes` [m].
  double area = 0;                                      ///< The overlap's [m^2].
  double width = 0;                                     ///< From one to the other in the middle of the overlap [m].
  double height = 0;                                    ///< Half way between them there, along the third axis [m].
};

/// Calls `visit` for every pair of facets of a segment (`faces`; empty: the whole mesh) that jaws can close on, larger
/// facets first: where mmgrasp makes grasps, and where it lists widths, these are the pairs (P1 5.3.3, figure 5.12).
/// The facets live as long as the call.
MMGRASP_EXPORT void visit_opposite_facets(const TriangleMesh& mesh, const std::vector<int>& faces,
                                          const OppositeFacetsOptions& options,
                                          const std::function<void(const OppositeFacets&)>& visit);

}  // namespace mmgrasp
