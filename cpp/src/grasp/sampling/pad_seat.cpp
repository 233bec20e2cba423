#include "grasp/sampling/pad_seat.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/detail/clip_polygon.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr double kGive = 5e-4;  // A pad is touched by what lies this deep under its outermost point [m].

/// What of a triangle lies under a pad: along the approach, across, and outwards from the pair's middle.
struct Piece {
  std::vector<Vector3d> corners;
  double least = kInfinity, most = -kInfinity;  // How far outwards it reaches [m].
  double slant = 0;                             // Cosine of its normal to the way outwards.
};

/// What one pad touches.
struct Touch {
  double reach = 0;           // How far outwards [m].
  double angle = kPi;         // The least between what is touched and the pad [rad].
  Eigen::AlignedBox2d where;  // Along the approach and across [m].
};

/// The surface under the pads of a hand that approaches a pair of contacts.
class UnderPads {
 public:
  UnderPads(const ContactPair& pair, const Vector3d& approach, const Hand& hand, double standoff, bool solid)
      : solid_(solid),
        middle_(pair.middle),
        lowest_(pair.width / 2 - kGive),
        edges_{HalfPlane{{1, 0}, hand.finger_depth / 2 - standoff},
               HalfPlane{{-1, 0}, hand.finger_depth / 2 + standoff}, HalfPlane{{0, 1}, hand.finger_width / 2},
               HalfPlane{{0, -1}, hand.finger_width / 2}} {
    axes_ << approach.transpose(), pair.axis.cross(approach).transpose(), pair.axis.transpose();
  }

  /// Adds what the fingers on the two sides may touch, first that where the pair's axis points.
  void add(const std::array<Vector3d, 3>& triangle, std::array<std::vector<Piece>, 2>& pieces) const {
    std::array<Vector3d, 3> seen;
    for (int i = 0; i < 3; ++i) seen[i] = axes_ * (triangle[i] - middle_);
    for (const HalfPlane& edge : edges_)
      if (all_of(seen, [&](const Vector3d& p) { return edge.n.dot(p.head<2>()) > edge.d; })) return;
    for (const int side : {0, 1}) {
      if (side == 1)
        for (Vector3d& corner : seen) corner.z() = -corner.z();
      if (all_of(seen, [&](const Vector3d& p) { return p.z() < lowest_; })) continue;
      const double slant = (seen[1] - seen[0]).cross(seen[2] - seen[0]).normalized().z();
      Piece piece = clipped(seen);
      // A mirrored triangle is wound the other way; an open surface has no outside.
      piece.slant = !solid_ ? std::abs(slant) : side == 0 ? slant : -slant;
      if (piece.most >= lowest_) pieces[side].push_back(std::move(piece));
    }
  }

 private:
  template <typename Condition>
  static bool all_of(const std::array<Vector3d, 3>& corners, Condition&& condition) {
    return condition(corners[0]) && condition(corners[1]) && condition(corners[2]);
  }

  Piece clipped(const std::array<Vector3d, 3>& triangle) const {
    Piece out;
    out.corners.assign(triangle.begin(), triangle.end());
    for (const HalfPlane& edge : edges_) out.corners = clip_polygon(out.corners, edge);
    for (const Vector3d& corner : out.corners) {
      out.least = std::min(out.least, corner.z());
      out.most = std::max(out.most, corner.z());
    }
    return out;
  }

  bool solid_;
  Eigen::Matrix3d axes_;
  Vector3d middle_;
  double lowest_;  // What reaches less far outwards is behind the contacts [m].
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

/// Extends a rectangle by what of the piece reaches out as far as a level.
void extend_above(double level, const Piece& piece, Eigen::AlignedBox2d& where) {
  for (std::size_t i = 0; i < piece.corners.size(); ++i) {
    const Vector3d &a = piece.corners[i], &b = piece.corners[(i + 1) % piece.corners.size()];
    if (a.z() >= level) where.extend(a.head<2>().eval());
    if ((a.z() < level) != (b.z() < level))
      where.extend((a + (level - a.z()) / (b.z() - a.z()) * (b - a)).head<2>().eval());
  }
}

Touch touch(const std::vector<Piece>& pieces, double contact, double gap) {
  Touch out;
  out.reach = outermost(pieces, contact, gap);
  for (const Piece& piece : pieces) {
    if (piece.most > out.reach || piece.most < out.reach - kGive) continue;
    out.angle = std::min(out.angle, std::acos(std::clamp(piece.slant, -1.0, 1.0)));
    extend_above(out.reach - kGive, piece, out.where);
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

std::vector<int> PadSeats::near(const ContactPair& pair) const {
  const double radius = std::hypot(hand_.finger_depth / 2 + std::abs(options_.standoff), hand_.finger_width / 2);
  std::vector<int> found;
  for (std::size_t t = 0; t < centres_.size(); ++t) {
    const Vector3d arm = centres_[t] - pair.middle;
    const double along = arm.dot(pair.axis), reach = radius + radii_[t];
    if (arm.squaredNorm() - along * along <= reach * reach) found.push_back(static_cast<int>(t));
  }
  return found;
}

std::optional<PadSeat> PadSeats::seat(const ContactPair& pair, const Vector3d& approach,
                                      const std::vector<int>& near) const {
  if (std::abs(options_.standoff) > hand_.finger_depth / 2) return {};  // the contacts are not under the pads
  const UnderPads under(pair, approach, hand_, options_.standoff, surface_.solid);
  std::array<std::vector<Piece>, 2> pieces;
  for (const int t : near) {
    const auto& [i, j, k] = surface_.mesh.triangles[t];
    under.add({surface_.mesh.vertices[i], surface_.mesh.vertices[j], surface_.mesh.vertices[k]}, pieces);
  }
  const double gap = std::max(hand_.clearance, hand_.body.finger_thickness);
  const Touch touched[] = {touch(pieces[0], pair.width / 2, gap), touch(pieces[1], pair.width / 2, gap)};
  const double angle = std::max(touched[0].angle, touched[1].angle), width = touched[0].reach + touched[1].reach;
  if (angle > cone_ || apart(touched[0].where, touched[1].where) > options_.friction * width) return {};
  return PadSeat{pair.middle + (touched[0].reach - touched[1].reach) / 2 * pair.axis, width, 1 - angle / cone_};
}

}  // namespace mmgrasp::detail
