#include "grasp/synthesis/hand_clearance.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr double kSide = 0.008;  // of the cells in which points are looked for [m]
constexpr int kHalvings = 24;    // of the stretch in which the point of a way nearest to a box lies

/// Height of the lowest corner of a box that stands at T in the world.
double lowest(const Pose& T, const LinkShape& box) {
  return T.translation().z() - T.linear().row(2).cwiseAbs().dot(std::get<Box>(box.shape).size / 2);
}

double squared_distance(const Vector3d& point, const Vector3d& half) {
  return (point.cwiseAbs() - half).cwiseMax(0).squaredNorm();
}

/// Whether the way from `begin` to `begin` + `way`, in a box's frame, comes nearer to the box than `around`. The
/// distance from a convex body is convex along a line, so the side to which it falls holds the nearest point.
bool comes_near(Vector3d begin, Vector3d way, const Vector3d& half, double around) {
  for (int k = 0; k < kHalvings; ++k) {
    const Vector3d middle = begin + way / 2, past = (middle.cwiseAbs() - half).cwiseMax(0);
    if (past.squaredNorm() < around * around) return true;
    // Half the derivative of the squared distance along the way.
    const double rising = past.cwiseProduct(middle.cwiseSign()).dot(way);
    if (rising == 0) return false;
    way /= 2;
    if (rising < 0) begin = middle;
  }
  return squared_distance(begin, half) < around * around || squared_distance(begin + way, half) < around * around;
}

}  // namespace

HandClearance::HandClearance(const std::vector<Vector3d>& points, const std::vector<Vector3d>& normals,
                             const std::vector<double>& sigma, double sigmas, double margin,
                             const std::optional<double>& table)
    : margin_(margin), table_(table), grid_(points, kSide) {
  swept_.reserve(points.size());
  for (const std::uint32_t i : grid_.order()) {
    const double farther = sigmas * sigma[i], radius = margin + farther;
    swept_.push_back({points[i], farther * normals[i], normals[i].isZero(0) ? radius : margin, radius});
    largest_ = std::max(largest_, radius);
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
  // A cell is passed over when its middle is farther from the box than its half diagonal and the largest radius.
  const double far = grid_.side() * std::sqrt(3.0) / 2 + most;
  return grid_.any_cell({T.translation() - reach, T.translation() + reach},
                        [&](const Vector3d& middle, std::uint32_t first, std::uint32_t last) {
                          const Vector3d outside = ((to_box * middle - offset).cwiseAbs() - half).cwiseMax(0);
                          if (outside.squaredNorm() > far * far) return false;
                          return std::any_of(swept_.begin() + first, swept_.begin() + last, [&](const Swept& each) {
                            const Vector3d begin = to_box * each.begin - offset;
                            if (depth) return (begin.cwiseAbs() - half).maxCoeff() < -*depth;
                            return squared_distance(begin, half) < each.radius * each.radius &&
                                   comes_near(begin, to_box * each.way, half, each.around);
                          });
                        });
}

}  // namespace mmgrasp::detail
