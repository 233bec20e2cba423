#include "grasp/sampling/pad_seat.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/detail/clip_polygon.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kGive = 5e-4;  // A pad is touched by what lies this deep under its outermost point [m].

/// A triangle under a pad: its corners along the approach, across, and outwards from the pair's middle.
struct Piece {
  std::array<Vector3d, 3> corners;
  double least = kInfinity, most = -kInfinity;  // How far outwards what is under the pad reaches [m].
};

/// What one pad touches.
struct Touch {
  double reach = 0;           // How far outwards [m].
  double angle = kPi;         // The least between what is touched and the pad [rad].
  Eigen::AlignedBox2d where;  // Along the approach and across [m].
};

/// What reaches less far outwards is behind the contacts [m].
double lowest_touched(const ContactPair& pair) {
  return pair.width / 2 - kGive;
}

/// The pads of a hand that approaches a pair of contacts, and what lies under them.
class UnderPads {
 public:
  UnderPads(const ContactPair& pair, const Vector3d& approach, const Hand& hand, double standoff)
      : lowest_(lowest_touched(pair)),
        standoff_(standoff),
        half_(hand.finger_depth / 2, hand.finger_width / 2),
        edges_{HalfPlane{{1, 0}, half_.x() - standoff}, HalfPlane{{-1, 0}, half_.x() + standoff},
               HalfPlane{{0, 1}, half_.y()}, HalfPlane{{0, -1}, half_.y()}} {
    const double cosine = approach.dot(pair.first_approach);
    const double sine = approach.dot(pair.axis.cross(pair.first_approach));
    turn_ << cosine, sine, -sine, cosine;
  }

  /// Adds what the fingers on the two sides may touch, first that where the pair's axis points.
  void add(const NearTriangle& triangle, std::array<std::vector<Piece>, 2>& pieces) const {
    Vector2d off = turn_ * triangle.centre;
    off.x() += standoff_;
    if (((off.cwiseAbs() - half_).array() > triangle.radius).any()) return;
    Piece piece;
    for (int i = 0; i < 3; ++i) piece.corners[i] << turn_ * triangle.corners[i].head<2>(), triangle.corners[i].z();
    bool whole = true;
    for (const HalfPlane& edge : edges_) {
      int beyond = 0;
      for (const Vector3d& corner : piece.corners) beyond += edge.n.dot(corner.head<2>()) > edge.d;
      if (beyond == 3) return;
      whole = whole && beyond == 0;
    }
    const auto measure = [&piece](const auto& corners) {
      for (const Vector3d& corner : corners) {
        piece.least = std::min(piece.least, corner.z());
        piece.most = std::max(piece.most, corner.z());
      }
    };
    if (whole)
      measure(piece.corners);
    else
      measure(clipped(piece));
    if (piece.most >= lowest_) pieces[0].push_back(piece);
    if (-piece.least >= lowest_) pieces[1].push_back(seen_from_below(piece));
  }

  std::vector<Vector3d> clipped(const Piece& piece) const {
    std::vector<Vector3d> polygon(piece.corners.begin(), piece.corners.end());
    for (const HalfPlane& edge : edges_) polygon = clip_polygon(polygon, edge);
    return polygon;
  }

 private:
  /// Two corners change places, so that the outside stays where it was.
  static Piece seen_from_below(const Piece& piece) {
    Piece seen{{piece.corners[1], piece.corners[0], piece.corners[2]}, -piece.most, -piece.least};
    for (Vector3d& corner : seen.corners) corner.z() = -corner.z();
    return seen;
  }

  double lowest_, standoff_;
  Vector2d half_;         // Half sizes of the pads along the approach and across.
  Eigen::Matrix2d turn_;  // From the pair's first approach to this one.
  std::array<HalfPlane, 4> edges_;
};

/// Where a pad stops that comes from as far out as a gap for the finger is free.
double outermost(const std::vector<Piece>& pieces, double contact, double gap) {
  double reach = contact;
  for (bool moved = true; moved;) {
    moved = false;
    for (const Piece& piece : pieces) {
      if (piece.most <= reach || piece.least >= reach + gap) continue;
      reach = piece.most;
      moved = true;
    }
  }
  return reach;
}

/// Extends a rectangle by what of the polygon reaches out as far as a level.
void extend_above(double level, const std::vector<Vector3d>& polygon, Eigen::AlignedBox2d& where) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a.z() >= level) where.extend(a.head<2>().eval());
    if ((a.z() < level) != (b.z() < level))
      where.extend((a + (level - a.z()) / (b.z() - a.z()) * (b - a)).head<2>().eval());
  }
}

/// `solid`: the surface has an outside.
double angle_to_pad(const Piece& piece, bool solid) {
  const auto& [a, b, c] = piece.corners;
  const double cosine = (b - a).cross(c - a).normalized().z();
  return std::acos(std::clamp(solid ? cosine : std::abs(cosine), -1.0, 1.0));
}

Touch touch(const UnderPads& pads, const std::vector<Piece>& pieces, double contact, double gap, bool solid) {
  Touch out;
  out.reach = outermost(pieces, contact, gap);
  const double level = out.reach - kGive;
  for (const Piece& piece : pieces) {
    if (piece.most > out.reach || piece.most < level) continue;
    out.angle = std::min(out.angle, angle_to_pad(piece, solid));
    extend_above(level, pads.clipped(piece), out.where);
  }
  return out;
}

/// How far apart two rectangles are [m].
double apart(const Eigen::AlignedBox2d& a, const Eigen::AlignedBox2d& b) {
  return (a.min() - b.max()).cwiseMax(b.min() - a.max()).cwiseMax(0).norm();
}

}  // namespace

PadSeats::PadSeats(const JoinedSurface& surface, const Hand& hand, const GraspSamplerOptions& options)
    : surface_(surface), hand_(hand), options_(options), cone_(std::atan(options.friction)) {
  for (const auto& [i, j, k] : surface.mesh.triangles) {
    const Vector3d centre = (surface.mesh.vertices[i] + surface.mesh.vertices[j] + surface.mesh.vertices[k]) / 3;
    const auto off = [&](int v) { return (surface.mesh.vertices[v] - centre).norm(); };
    centres_.push_back(centre);
    radii_.push_back(std::max({off(i), off(j), off(k)}));
  }
}

std::vector<NearTriangle> PadSeats::near(const ContactPair& pair, double standoff) const {
  const double radius = std::hypot(hand_.finger_depth / 2 + std::abs(standoff), hand_.finger_width / 2);
  const double lowest = lowest_touched(pair);
  Eigen::Matrix3d axes;
  axes << pair.first_approach.transpose(), pair.axis.cross(pair.first_approach).transpose(), pair.axis.transpose();
  std::vector<NearTriangle> found;
  for (std::size_t t = 0; t < centres_.size(); ++t) {
    const Vector3d centre = axes * (centres_[t] - pair.middle);
    if (std::abs(centre.z()) + radii_[t] < lowest) continue;
    const double reach = radius + radii_[t];
    if (centre.head<2>().squaredNorm() > reach * reach) continue;
    NearTriangle triangle{{}, centre.head<2>(), radii_[t]};
    for (int i = 0; i < 3; ++i)
      triangle.corners[i] = axes * (surface_.mesh.vertices[surface_.mesh.triangles[t][i]] - pair.middle);
    found.push_back(triangle);
  }
  return found;
}

std::optional<PadSeat> PadSeats::seat(const ContactPair& pair, const Vector3d& approach, double standoff,
                                      const std::vector<NearTriangle>& near) const {
  if (std::abs(standoff) > hand_.finger_depth / 2) return {};  // the contacts are not under the pads
  const UnderPads under(pair, approach, hand_, standoff);
  std::array<std::vector<Piece>, 2> pieces;
  for (const NearTriangle& triangle : near) under.add(triangle, pieces);
  const double gap = std::max(hand_.clearance, hand_.body.finger_thickness);
  const auto on_side = [&](int side) { return touch(under, pieces[side], pair.width / 2, gap, surface_.solid); };
  const Touch touched[] = {on_side(0), on_side(1)};
  const double angle = std::max(touched[0].angle, touched[1].angle), width = touched[0].reach + touched[1].reach;
  if (angle > cone_ || apart(touched[0].where, touched[1].where) > options_.friction * width) return {};
  return PadSeat{pair.middle + (touched[0].reach - touched[1].reach) / 2 * pair.axis, width, 1 - angle / cone_};
}

}  // namespace mmgrasp::detail
