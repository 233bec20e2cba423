#include "grasp/synthesis/hand_clearance.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr double kSide = 0.008;  // of the cells in which points are looked for [m]

/// Height of the lowest corner of a box that stands at T in the world.
double lowest(const Pose& T, const LinkShape& box) {
  return T.translation().z() - T.linear().row(2).cwiseAbs().dot(std::get<Box>(box.shape).size / 2);
}

}  // namespace

HandClearance::HandClearance(const std::vector<Vector3d>& points, const std::vector<double>& sigma, double sigmas,
                             double margin, const std::optional<double>& table)
    : margin_(margin), table_(table), grid_(points, kSide) {
  spheres_.reserve(points.size());
  for (const std::uint32_t i : grid_.order()) {
    spheres_.push_back({points[i], margin + sigmas * sigma[i]});
    largest_ = std::max(largest_, spheres_.back().radius);
  }
}

double HandClearance::in_table(const std::vector<LinkShape>& boxes, const Pose& T_world_hand) const {
  double deepest = 0;
  for (const LinkShape& box : boxes) {
    if (table_) deepest = std::max(deepest, *table_ + margin_ - lowest(T_world_hand * box.T_link_shape, box));
  }
  return deepest;
}

HandContact HandClearance::check(const std::vector<LinkShape>& boxes, const Pose& T_world_hand) const {
  for (const LinkShape& box : boxes) {
    const Pose T = T_world_hand * box.T_link_shape;
    const Vector3d half = std::get<Box>(box.shape).size / 2;
    if (table_ && lowest(T, box) < *table_ + margin_) return HandContact::table;
    if (touches(T, half, {})) return HandContact::map;
  }
  return HandContact::none;
}

bool HandClearance::pierced(const std::vector<LinkShape>& boxes, const Pose& T_world_hand, double depth) const {
  return std::any_of(boxes.begin(), boxes.end(), [&](const LinkShape& box) {
    return touches(T_world_hand * box.T_link_shape, std::get<Box>(box.shape).size / 2, depth);
  });
}

bool HandClearance::touches(const Pose& T, const Vector3d& half, const std::optional<double>& depth) const {
  const double most = depth ? 0 : largest_;
  const Vector3d reach = T.linear().cwiseAbs() * half + Vector3d::Constant(most);
  const Eigen::Matrix3d to_box = T.linear().transpose();
  const Vector3d offset = to_box * T.translation();
  // A cell is passed over when its middle is farther from the box than its half diagonal and the largest sphere.
  const double far = grid_.side() * std::sqrt(3.0) / 2 + most;
  return grid_.any_cell(
      {T.translation() - reach, T.translation() + reach},
      [&](const Vector3d& middle, std::uint32_t first, std::uint32_t last) {
        const Vector3d outside = ((to_box * middle - offset).cwiseAbs() - half).cwiseMax(0);
        if (outside.squaredNorm() > far * far) return false;
        return std::any_of(spheres_.begin() + first, spheres_.begin() + last, [&](const BoundingSphere& sphere) {
          const Vector3d beyond = (to_box * sphere.centre - offset).cwiseAbs() - half;
          return depth ? beyond.maxCoeff() < -*depth : beyond.cwiseMax(0).squaredNorm() < sphere.radius * sphere.radius;
        });
      });
}

}  // namespace mmgrasp::detail
