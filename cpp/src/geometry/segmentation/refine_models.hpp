#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace mmgrasp::detail {

struct RoundFit {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< Unit; of a cone from foot to apex.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< Any on a cylinder's axis; a sphere's centre, a cone's apex.
  double radius = 0;                                ///< Radius of a cylinder or sphere.
  double half_angle = 0;                            ///< Half opening angle of a cone [rad].

  /// Signed distance from the surface, and the outward normal there.
  double distance(const Eigen::Vector3d& x, Eigen::Vector3d& normal) const;
  enum class Kind { cylinder, cone, sphere } kind = Kind::cylinder;
};

/// Turns and moves a cylinder to the least squares of its distances from the points (Gauss-Newton); false when it
/// breaks down.
bool refine_cylinder(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights,
                     RoundFit& cylinder);

/// Least squares over points and their unit normals: the axis from the normals, the rest from the points.
std::optional<RoundFit> cylinder_through(const std::vector<Eigen::Vector3d>& points,
                                         const std::vector<Eigen::Vector3d>& normals);
std::optional<RoundFit> cone_through(const std::vector<Eigen::Vector3d>& points,
                                     const std::vector<Eigen::Vector3d>& normals);
std::optional<RoundFit> sphere_through(const std::vector<Eigen::Vector3d>& points);

}  // namespace mmgrasp::detail
