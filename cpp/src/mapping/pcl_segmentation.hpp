#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmgrasp::detail {

/// The one door to PCL: plain arrays in and out, so that its types stay in one file.

struct FoundPlane {
  bool found = false;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Unit.
  double offset = 0;                                  ///< normal . x = offset
  std::vector<int> inliers;
};

/// The plane with most points within `tolerance` [m] by random samples (the same ones every time), refined over them.
/// With an `axis` other than zero only planes whose normal lies within `angle` [rad] of it.
FoundPlane dominant_plane(const std::vector<Eigen::Vector3d>& points, double tolerance, int iterations,
                          const Eigen::Vector3d& axis, double angle);

/// Groups of points no farther than `tolerance` [m] from a neighbour of the same group, at least `least` points each;
/// largest first. Points are thinned to one a cell of edge `leaf` [m] for the search, and all belong to a group again.
std::vector<std::vector<int>> euclidean_clusters(const std::vector<Eigen::Vector3d>& points, double tolerance,
                                                 double leaf, int least);

}  // namespace mmgrasp::detail
