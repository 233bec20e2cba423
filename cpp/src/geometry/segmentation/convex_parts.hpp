#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace mmgrasp::detail {

/// The hull of a region's points; flat or empty ones have no volume and no planes.
struct RegionHull {
  std::vector<Eigen::Vector3d> points;        ///< Corners of the hull; all points of a flat one.
  std::vector<std::array<int, 3>> triangles;  ///< Into points.
  std::vector<Eigen::Vector4d> planes;        ///< Inside where normal . x <= w.
  double volume = 0;                          ///< [m^3]
  bool contains(const Eigen::Vector3d& x, double tolerance) const;
};

RegionHull region_hull(const std::vector<Eigen::Vector3d>& points);

/// Volume of the hull of both that lies in neither, from 512 points at equal shares of the volume [m^3].
double uncovered_volume(const RegionHull& a, const RegionHull& b, RegionHull* joined = nullptr);

}  // namespace mmgrasp::detail
