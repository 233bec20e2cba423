// Refiner: a place of the height map made an exact grasp, or rejected.
#include <algorithm>
#include <cmath>
#include <limits>

#include "grasp/graspability/graspability_layers.hpp"
#include "grasp/hand/hand_outline.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector2d;

/// Runs of the part between the fingers, one a row across the pads.
struct Rows {
  double left = kInfinity, right = -left;
  std::vector<double> lefts, rights;
  std::size_t held = 0, spanned = 0;
};

}  // namespace

float Refiner::height_at(const Vector2d& p) const {
  const int ix = static_cast<int>(std::floor(p.x() / map_.resolution + 0.5 * map_.nx));
  const int iy = static_cast<int>(std::floor(p.y() / map_.resolution + 0.5 * map_.ny));
  if (ix < 0 || iy < 0 || ix >= map_.nx || iy >= map_.ny) return std::numeric_limits<float>::quiet_NaN();
  return map_.height[map_.index(ix, iy)];
}

bool Refiner::touches(const Vector2d& middle, const Vector2d& along, double u0, double u1, double v_half,
                      double above) const {
  const double grow = options_.margin + map_.resolution * std::sqrt(0.5);
  const Vector2d across(-along.y(), along.x());
  const Vector2d centre = middle + (u0 + u1) / 2 * along;
  const double u_half = (u1 - u0) / 2 + grow, side = v_half + grow;
  const Vector2d half = (u_half * along.cwiseAbs() + side * across.cwiseAbs()) / map_.resolution;
  const Vector2d in_cells = centre / map_.resolution + 0.5 * Vector2d(map_.nx, map_.ny) - Vector2d(0.5, 0.5);
  const int x0 = static_cast<int>(std::ceil(in_cells.x() - half.x())),
            x1 = static_cast<int>(std::floor(in_cells.x() + half.x()));
  const int y0 = static_cast<int>(std::ceil(in_cells.y() - half.y())),
            y1 = static_cast<int>(std::floor(in_cells.y() + half.y()));
  for (int iy = y0; iy <= y1; ++iy) {
    for (int ix = x0; ix <= x1; ++ix) {
      const Vector2d d = (Vector2d(ix, iy) - in_cells) * map_.resolution;
      if (std::abs(d.dot(along)) > u_half || std::abs(d.dot(across)) > side) continue;
      if (ix < 0 || iy < 0 || ix >= map_.nx || iy >= map_.ny) return true;
      if (!(map_.upper[map_.index(ix, iy)] <= above - options_.margin)) return true;
    }
  }
  return false;
}

bool Refiner::hand_touches(const Vector2d& middle, const Vector2d& along, double opening, double tip) const {
  const HandOutline o(hand_, opening);
  if (touches(middle, along, -o.outer, -o.inner, o.side, tip) || touches(middle, along, o.inner, o.outer, o.side, tip))
    return true;
  const double above = tip + hand_.body.finger_length;
  if (top_ <= above - options_.margin) return false;
  // Beyond the map and where nothing was seen the palm is only as free as the fingers beside it: see TipLayer.
  const int reach = static_cast<int>(std::ceil(std::hypot(o.palm, o.palm_side) / map_.resolution)) + 2;
  const int cx = static_cast<int>(std::floor(middle.x() / map_.resolution + 0.5 * map_.nx));
  const int cy = static_cast<int>(std::floor(middle.y() / map_.resolution + 0.5 * map_.ny));
  const double grow = options_.margin + map_.resolution * std::sqrt(0.5);
  const Vector2d across(-along.y(), along.x());
  for (int iy = std::max(0, cy - reach); iy <= std::min(map_.ny - 1, cy + reach); ++iy) {
    for (int ix = std::max(0, cx - reach); ix <= std::min(map_.nx - 1, cx + reach); ++ix) {
      if (!(map_.upper[map_.index(ix, iy)] > above - options_.margin)) continue;
      const Vector2d d = map_.centre(ix, iy) - middle;
      if (std::abs(d.dot(along)) <= o.palm + grow && std::abs(d.dot(across)) <= o.palm_side + grow) return true;
    }
  }
  return false;
}

Refined Refiner::refine(int ix, int iy, double angle, double opening, const TipLayer& layer, Grasp& grasp,
                        HeightMapProvenance& place, std::vector<QualityFactor>& parts) const {
  const double tip = layer.tip_height;
  const Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
  const Vector2d start = map_.centre(ix, iy);
  // Lines across the pads every half cell, points along the closing axis every half cell.
  const double step = map_.resolution / 2;
  const int lines = std::max(1, static_cast<int>(hand_.finger_width / step));
  const int points = std::max(1, static_cast<int>(opening / step));
  const double held_above = tip + options_.insertion;
  Rows rows;
  double top = tip;
  for (int j = 0; j < lines; ++j) {
    const double v = ((j + 0.5) / lines - 0.5) * hand_.finger_width;
    double left = 0, right = 0;
    std::size_t held = 0;
    for (int i = 0; i < points; ++i) {
      const double u = ((i + 0.5) / points - 0.5) * opening;
      const float h = height_at(start + u * along + v * across);
      if (!(h > held_above)) continue;
      if (held++ == 0) left = u;
      right = u;
      top = std::max(top, static_cast<double>(h));
    }
    if (held == 0) continue;
    rows.held += held;
    rows.spanned += std::lround((right - left) / (opening / points)) + 1;
    rows.lefts.push_back(left);
    rows.rights.push_back(right);
    rows.left = std::min(rows.left, left);
    rows.right = std::max(rows.right, right);
  }
  if (rows.lefts.empty()) return Refined::poor;
  // Pads close on what stands out farthest; rows that stand back by more than a cell and a half are not in contact.
  const double slack = 1.5 * map_.resolution;
  const auto share = [&](const std::vector<double>& ends, double end) {
    const auto near = std::count_if(ends.begin(), ends.end(), [&](double e) { return std::abs(e - end) <= slack; });
    return static_cast<double>(near) / lines;
  };
  const double contact = std::min(share(rows.lefts, rows.left), share(rows.rights, rows.right));
  const double solid = static_cast<double>(rows.held) / rows.spanned;
  if (contact < options_.min_contact || solid < 0.5) return Refined::poor;

  // Silhouettes end on average half a pixel inside the part's edge.
  grasp.opening = rows.right - rows.left + opening / points + map_.pixel;
  if (grasp.opening + 2 * options_.margin > hand_.max_opening) return Refined::too_wide;
  const Vector2d middle = start + (rows.left + rows.right) / 2 * along;
  if (hand_touches(middle, along, hand_.pregrasp_opening(grasp.opening), tip)) return Refined::collision;
  place.angle = angle;
  place.height = tip;
  place.ix = static_cast<int>(std::floor(middle.x() / map_.resolution + 0.5 * map_.nx));
  place.iy = static_cast<int>(std::floor(middle.y() / map_.resolution + 0.5 * map_.ny));
  grasp.T_object_hand.translation() << middle, tip + hand_.finger_depth / 2;
  const double depth = std::min(1.0, (top - tip) / hand_.finger_depth);
  parts = {{"contact", contact, 1},
           {"solidity", solid, 1},
           {"depth", depth, 0.5},
           {"centring", layer.pieces.centring(middle), 0.5}};
  return Refined::good;
}

}  // namespace mmgrasp::detail
