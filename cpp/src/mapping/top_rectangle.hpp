#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmgrasp::detail {

/// Points of a flat face in its plane, with the area each one stands for (any unit).
struct FacePoints {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> weights;
};

struct Rectangle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double angle = 0;                                ///< Direction of the first side [rad].
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< Along that side and across.
  double fill = 0;                                 ///< Share of its cells of edge `cell` that hold a point.
};

/// The rectangle that an evenly seen face fills; see fit_cuboids.
Rectangle fit_rectangle(const FacePoints& face, double cell);

/// Indices of the convex hull, counter-clockwise.
std::vector<Eigen::Vector2d> hull_of(std::vector<Eigen::Vector2d> points);
bool inside_hull(const std::vector<Eigen::Vector2d>& hull, const Eigen::Vector2d& point);

}  // namespace mmgrasp::detail
