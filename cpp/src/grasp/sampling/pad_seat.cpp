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

constexpr double kGive = 5e-4;      // A pad is touched by what lies this deep under its outermost point [m].
constexpr double kStraight = 0.01;  // A pad that stands on a face so nearly needs no look at the hull [rad].

/// A triangle under a pad: its corners along the approach, across, and outwards from the pair's middle.
struct Piece {
  std::array<Vector3d, 3> corners;
  double least = kInfinity, most = -kInfinity;  // How far outwards what is under the pad reaches [m].
};

/// What one pad touches.
struct Touch {
  double reach = 0;             // How far outwards [m].
  double angle = kPi;           // The least between what is touched and the pad [rad].
  std::vector<Vector2d> where;  // Corners of what is touched, along the approach and across [m].
  bool on_crests = false;       // The pad stands on several edges, by the hull over them.
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

/// Adds the corners of what of the polygon reaches out as far as a level.
void add_above(double level, const std::vector<Vector3d>& polygon, std::vector<Vector2d>& where) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a.z() >= level) where.emplace_back(a.head<2>());
    if ((a.z() < level) != (b.z() < level))
      where.emplace_back((a + (level - a.z()) / (b.z() - a.z()) * (b - a)).head<2>());
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
  out.reach = outermost(pieces, contact - kGive, gap);  // a contact on the hull may stand before the surface
  const double level = out.reach - kGive;
  for (const Piece& piece : pieces) {
    if (piece.most > out.reach || piece.most < level) continue;
    out.angle = std::min(out.angle, angle_to_pad(piece, solid));
    add_above(level, pads.clipped(piece), out.where);
  }
  return out;
}

/// The least angle between a pad and what of the hull is where it stops [rad].
double angle_to_hull(const std::vector<Piece>& hull, double reach) {
  double angle = kPi;
  for (const Piece& piece : hull)
    if (std::abs(piece.most - reach) <= kGive) angle = std::min(angle, angle_to_pad(piece, true));
  return angle;
}

Eigen::AlignedBox2d bounds_of(const std::vector<Vector2d>& points) {
  Eigen::AlignedBox2d bounds;
  for (const Vector2d& point : points) bounds.extend(point);
  return bounds;
}

/// Corners of the convex hull, counter-clockwise (Andrew 1979), of at least one point.
std::vector<Vector2d> corners_of(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(),
            [](const Vector2d& a, const Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  std::vector<Vector2d> corners;
  const auto add = [&corners](const Vector2d& point, std::size_t first) {
    while (corners.size() >= first + 2 &&
           edge_side(corners.back() - corners[corners.size() - 2], point - corners.back()) <= 0)
      corners.pop_back();
    corners.push_back(point);
  };
  for (const Vector2d& point : points) add(point, 0);
  const std::size_t first = corners.size() - 1;
  for (auto point = points.rbegin(); point != points.rend(); ++point) add(*point, first);
  corners.pop_back();
  return corners;
}

/// Whether the points lie between no two parallel lines that are so near to each other.
bool wider_than(double width, const std::vector<Vector2d>& points) {
  if (points.empty() || bounds_of(points).sizes().minCoeff() <= width) return false;
  const std::vector<Vector2d> corners = corners_of(points);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d along = (corners[(i + 1) % corners.size()] - corners[i]).normalized();
    const auto within = [&](const Vector2d& corner) { return edge_side(along, corner - corners[i]) <= width; };
    if (std::all_of(corners.begin(), corners.end(), within)) return false;
  }
  return true;
}

/// How far apart what two pads touch is, by its bounding rectangles [m].
double apart(const Touch& a, const Touch& b) {
  const Eigen::AlignedBox2d one = bounds_of(a.where), other = bounds_of(b.where);
  return (one.min() - other.max()).cwiseMax(other.min() - one.max()).cwiseMax(0).norm();
}

/// Angle between the closing axis and the line between the middles of what two pads touch, `width` apart [rad].
double angle_of_middles(const Touch& a, const Touch& b, double width) {
  return std::atan2((bounds_of(a.where).center() - bounds_of(b.where).center()).norm(), width);
}

}  // namespace

TriangleBalls::TriangleBalls(const TriangleMesh& mesh) : mesh_(mesh) {
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector3d centre = (mesh.vertices[i] + mesh.vertices[j] + mesh.vertices[k]) / 3;
    const auto off = [&](int v) { return (mesh.vertices[v] - centre).norm(); };
    centres_.push_back(centre);
    radii_.push_back(std::max({off(i), off(j), off(k)}));
  }
}

std::vector<NearTriangle> TriangleBalls::near(const ContactPair& pair, double radius, double lowest) const {
  Eigen::Matrix3d axes;
  axes << pair.first_approach.transpose(), pair.axis.cross(pair.first_approach).transpose(), pair.axis.transpose();
  std::vector<NearTriangle> found;
  for (std::size_t t = 0; t < centres_.size(); ++t) {
    const Vector3d centre = axes * (centres_[t] - pair.middle);
    if (std::abs(centre.z()) + radii_[t] < lowest) continue;
    const double reach = radius + radii_[t];
    if (centre.head<2>().squaredNorm() > reach * reach) continue;
    NearTriangle triangle{{}, centre.head<2>(), radii_[t]};
    for (int i = 0; i < 3; ++i) triangle.corners[i] = axes * (mesh_.vertices[mesh_.triangles[t][i]] - pair.middle);
    found.push_back(triangle);
  }
  return found;
}

PadSeats::PadSeats(const JoinedSurface& surface, const TriangleMesh* hull, const Hand& hand,
                   const GraspSamplerOptions& options)
    : surface_(surface.mesh),
      solid_(surface.solid),
      hand_(hand),
      options_(options),
      cone_(std::atan(options.friction)) {
  if (hull) hull_.emplace(*hull);
}

NearPads PadSeats::near(const ContactPair& pair, double standoff) const {
  const double radius = std::hypot(hand_.finger_depth / 2 + std::abs(standoff), hand_.finger_width / 2);
  const double lowest = lowest_touched(pair);
  NearPads found{surface_.near(pair, radius, lowest), {}};
  if (hull_) found.hull = hull_->near(pair, radius, lowest);
  return found;
}

std::optional<PadSeat> PadSeats::seat(const ContactPair& pair, const Vector3d& approach, double standoff,
                                      const NearPads& near) const {
  if (std::abs(standoff) > hand_.finger_depth / 2) return {};  // the contacts are not under the pads
  const UnderPads under(pair, approach, hand_, standoff);
  std::array<std::vector<Piece>, 2> pieces, over;
  for (const NearTriangle& triangle : near.surface) under.add(triangle, pieces);
  for (const NearTriangle& triangle : near.hull) under.add(triangle, over);
  const double gap = std::max(hand_.clearance, hand_.body.finger_thickness);
  const double widest_edge = 2 * kGive / options_.friction;  // the slopes beside a wider one are within the cone
  const auto on_side = [&](int side) {
    Touch touched = touch(under, pieces[side], pair.width / 2, gap, solid_);
    if (touched.angle > kStraight && !over[side].empty() && wider_than(widest_edge, touched.where)) {
      const double on_hull = angle_to_hull(over[side], touched.reach);
      touched.on_crests = on_hull < touched.angle;
      touched.angle = std::min(touched.angle, on_hull);
    }
    return touched;
  };
  const Touch touched[] = {on_side(0), on_side(1)};
  const double angle = std::max(touched[0].angle, touched[1].angle), width = touched[0].reach + touched[1].reach;
  if (angle > cone_ || apart(touched[0], touched[1]) > options_.friction * width) return {};
  // Faces that lie flat on the pads hold each other wherever they overlap; crests hold where they are touched.
  const bool on_crests = touched[0].on_crests || touched[1].on_crests;
  const double worst = on_crests ? std::max(angle, angle_of_middles(touched[0], touched[1], width)) : angle;
  return PadSeat{pair.middle + (touched[0].reach - touched[1].reach) / 2 * pair.axis, width,
                 std::max(0.0, 1 - worst / cone_)};
}

}  // namespace mmgrasp::detail
