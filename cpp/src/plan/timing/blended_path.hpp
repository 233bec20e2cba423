#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmgrasp::detail {

/// A joint path of straight edges whose corners are rounded by circular arcs, by arc length s. Each arc lies in the
/// plane of its two edges, touches both, takes at most half of either, and passes its corner within a given distance. A
/// corner with no room or no deviation stays sharp: the motion has to stop there.
class BlendedPath {
 public:
  struct Segment {
    double start = 0, length = 0;  // Arc length.
    double radius = 0;             // 0: straight.
    Eigen::VectorXd origin;        // Configuration at its start.
    Eigen::VectorXd tangent,
        normal;                // Unit, at its start; the normal points to the arc's centre (empty when straight).
    bool stop_before = false;  // The path has a sharp corner at its start.

    Eigen::VectorXd position(double s) const;    ///< `s` counts from the segment's start.
    Eigen::VectorXd derivative(double s) const;  ///< With respect to arc length: a unit vector.
    Eigen::VectorXd second_derivative(double s) const;
  };

  /// `deviations` has one entry per inner waypoint. Neighbouring waypoints must differ.
  BlendedPath(const std::vector<Eigen::VectorXd>& waypoints, const std::vector<double>& deviations);

  const std::vector<Segment>& segments() const { return segments_; }
  double length() const { return segments_.empty() ? 0 : segments_.back().start + segments_.back().length; }
  /// Arc length at which the path passes each inner waypoint (the middle of its arc).
  const std::vector<double>& corners() const { return corners_; }

 private:
  void add_line(const Eigen::VectorXd& from, const Eigen::VectorXd& direction, double length, bool stop_before);

  std::vector<Segment> segments_;
  std::vector<double> corners_;
};

}  // namespace mmgrasp::detail
