#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/task/base_route.hpp"

namespace mmgrasp::detail {

/// Floor plan of everything with an end in the scene and of some base poses, grown by 2 m; nothing of it lies outside
/// of the square of the base's workspace [m], whatever stands there.
Eigen::AlignedBox2d floor_bounds(const World& world, const std::vector<Eigen::Vector3d>& poses, double workspace);

/// Lengths of the drives from one base pose to any other, around obstacles: one search of the whole floor for each pose
/// instead of one for each pair. A cell can be driven through in a direction when the robot at home is
/// free in its middle heading that way or backwards (omni: in any heading). Turns cost nothing. Good to some per cent:
/// 16 directions, and places join the cells around them unchecked.
class FloorField {
 public:
  /// The resolution is made coarser where the floor would have more than some ten thousand cells. Not complete when the
  /// monitor ends it.
  FloorField(const CollisionChecker& checker, const Eigen::VectorXd& home, const BaseRouteOptions& options,
             const std::vector<Eigen::Vector3d>& places, int threads, const Monitor& monitor);

  bool complete() const { return complete_; }
  /// Lengths between all places; infinite where no way was found.
  Eigen::MatrixXd lengths() const { return lengths_; }

 private:
  std::size_t cell(int ix, int iy) const { return static_cast<std::size_t>(iy) * nx_ + ix; }
  Eigen::Vector2d middle(int ix, int iy) const {
    return bounds_.min() + resolution_ * Eigen::Vector2d(ix + 0.5, iy + 0.5);
  }
  bool passable(int ix, int iy, int direction) const;
  void look_at_rows(const CollisionChecker& checker, const Eigen::VectorXd& home, const BaseRouteOptions& options,
                    const std::vector<Eigen::Vector3d>& places, int threads, const Monitor& monitor);
  std::vector<double> search(const Eigen::Vector2d& from) const;
  /// Calls visit(cell, distance) for the cells around a place.
  template <class Visit>
  void around(const Eigen::Vector2d& place, const Visit& visit) const;

  Eigen::AlignedBox2d bounds_;
  double resolution_;
  int nx_, ny_;
  std::vector<unsigned char> free_;  ///< One bit for each of the eight axes of driving.
  Eigen::MatrixXd lengths_;
  bool complete_ = false;
};

}  // namespace mmgrasp::detail
