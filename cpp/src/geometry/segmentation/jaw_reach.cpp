#include "geometry/segmentation/jaw_reach.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/detail/clip_polygon.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kDirections = 36;
/// Lines along a finger, in its widths across it and in its thicknesses above the facet: faces of the facet bend by so
/// much that what lies closer to it is the facet itself.
constexpr double kAcross[] = {-0.45, -0.3, -0.15, 0, 0.15, 0.3, 0.45},
                 kAbove[] = {0.06, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95};

}  // namespace

bool JawReach::reaches(const OppositeFacets& pair) {
  if (!caster_) caster_.emplace(mesh_);
  for (int k = 0; k < kDirections; ++k) {
    throw_if_interrupted();
    const double turn = kTwoPi * k / kDirections;
    if (reaches_from(pair, {std::cos(turn), std::sin(turn)})) return true;
  }
  return false;
}

bool JawReach::reaches_from(const OppositeFacets& pair, const Vector2d& approach) {
  const Vector2d across(-approach.y(), approach.x());
  double near = kInfinity;
  for (const std::vector<Vector3d>& piece : pair.overlap) {
    const auto strip = clip_polygon(clip_polygon(piece, {across, across.dot(pair.middle) + fingers_.width / 2}),
                                    {-across, -across.dot(pair.middle) + fingers_.width / 2});
    for (const Vector3d& p : strip) near = std::min(near, approach.dot(p.head<2>() - pair.middle));
  }
  if (near == kInfinity) return false;
  const Vector2d tip = pair.middle + (near + depth_) * approach;
  return finger_is_free(pair, tip, approach, 1) && finger_is_free(pair, tip, approach, -1);
}

bool JawReach::finger_is_free(const OppositeFacets& pair, const Vector2d& tip, const Vector2d& approach, double side) {
  const Vector2d across(-approach.y(), approach.x());
  const Vector3d away = pair.axes * Vector3d(-approach.x(), -approach.y(), 0);
  for (const double above : kAbove) {
    for (const double beside : kAcross) {
      const Vector2d at = tip + beside * fingers_.width * across;
      const Vector3d from(at.x(), at.y(), pair.height + side * (pair.width / 2 + above * fingers_.thickness));
      if (caster_->any_hit({pair.axes * from, away})) return false;
    }
  }
  return true;
}

}  // namespace mmgrasp::detail
