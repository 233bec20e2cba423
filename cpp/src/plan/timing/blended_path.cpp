#include "plan/timing/blended_path.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

constexpr double kStraight = 1e-6;        // Turns by less [rad] are no corners.
constexpr double kSmallestRadius = 1e-6;  // [rad]; tighter arcs are slower than a stop.

struct Corner {
  double turn = 0;    // Angle between the edges' directions.
  double cut = 0;     // Taken from either edge.
  double radius = 0;  // 0: sharp.
};

/// The widest arc that `room` on either edge and `deviation` from the corner allow. With h half the turn, an arc of
/// radius r touches both edges r tan(h) from the corner and misses it by r (1 / cos(h) - 1).
Corner round_corner(const Eigen::VectorXd& before, const Eigen::VectorXd& after, double room, double deviation) {
  Corner corner;
  // Half-angle from chords, exact for small and for nearly opposite directions.
  const double half = std::atan2((after - before).norm(), (after + before).norm());
  corner.turn = 2 * half;
  if (corner.turn < kStraight || deviation <= 0) return corner;
  const double wanted = deviation / std::tan(half / 2);  // r tan(h) of the arc that misses by `deviation`.
  const double cut = std::min(room, wanted);
  const double radius = cut / std::tan(half);
  if (radius < kSmallestRadius) return corner;
  corner.cut = cut;
  corner.radius = radius;
  return corner;
}

}  // namespace

Eigen::VectorXd BlendedPath::Segment::position(double s) const {
  if (radius == 0) return origin + s * tangent;
  const double half = 0.5 * s / radius;
  const double sine = std::sin(half);
  return origin + radius * (std::sin(2 * half) * tangent + 2 * sine * sine * normal);
}

Eigen::VectorXd BlendedPath::Segment::derivative(double s) const {
  if (radius == 0) return tangent;
  return std::cos(s / radius) * tangent + std::sin(s / radius) * normal;
}

Eigen::VectorXd BlendedPath::Segment::second_derivative(double s) const {
  if (radius == 0) return Eigen::VectorXd::Zero(tangent.size());
  return (std::cos(s / radius) * normal - std::sin(s / radius) * tangent) / radius;
}

void BlendedPath::add_line(const Eigen::VectorXd& from, const Eigen::VectorXd& direction, double length,
                           bool stop_before) {
  Segment segment;
  segment.start = this->length();
  segment.length = length;
  segment.origin = from;
  segment.tangent = direction;
  segment.stop_before = stop_before;
  segments_.push_back(std::move(segment));
}

BlendedPath::BlendedPath(const std::vector<Eigen::VectorXd>& waypoints, const std::vector<double>& deviations) {
  const std::size_t edges = waypoints.size() - 1;
  std::vector<double> lengths(edges);
  std::vector<Eigen::VectorXd> directions(edges);
  for (std::size_t i = 0; i < edges; ++i) {
    lengths[i] = (waypoints[i + 1] - waypoints[i]).norm();
    directions[i] = (waypoints[i + 1] - waypoints[i]) / lengths[i];
  }
  Corner before;
  for (std::size_t i = 0; i < edges; ++i) {
    Corner after;
    if (i + 1 < edges) {
      const double room = 0.5 * std::min(lengths[i], lengths[i + 1]);
      after = round_corner(directions[i], directions[i + 1], room, deviations[i]);
    }
    const double straight = lengths[i] - before.cut - after.cut;
    const bool sharp = i > 0 && before.radius == 0 && before.turn >= kStraight;
    if (straight > 1e-9 * lengths[i] || (before.radius == 0 && after.radius == 0)) {
      add_line(waypoints[i] + before.cut * directions[i], directions[i], straight, sharp);
    }
    if (i + 1 == edges) break;
    if (after.radius > 0) {
      Segment arc;
      arc.start = length();
      arc.radius = after.radius;
      arc.length = after.radius * after.turn;
      arc.origin = waypoints[i + 1] - after.cut * directions[i];
      arc.tangent = directions[i];
      arc.normal = (directions[i + 1] - directions[i].dot(directions[i + 1]) * directions[i]).normalized();
      arc.stop_before = straight <= 1e-9 * lengths[i] && sharp;
      segments_.push_back(std::move(arc));
      corners_.push_back(segments_.back().start + 0.5 * segments_.back().length);
    } else {
      corners_.push_back(length());
    }
    before = after;
  }
}

}  // namespace mmgrasp::detail
