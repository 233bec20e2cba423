#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmgrasp::detail {

enum class RoundModel { cylinder, cone, sphere };

/// The one door to PCL of this folder. Indices of the points on the best cylinder, cone or sphere by random samples
/// (the same ones every time): no farther than `tolerance` from it, the angle between normals weighed in. Empty where
/// none is found. Coordinates should be of the order of 1.
std::vector<int> points_on_model(const std::vector<Eigen::Vector3d>& points,
                                 const std::vector<Eigen::Vector3d>& normals, RoundModel model, double tolerance);

}  // namespace mmgrasp::detail
