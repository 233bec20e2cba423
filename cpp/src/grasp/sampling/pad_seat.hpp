#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "grasp/sampling/contact_pairs.hpp"

namespace mmgrasp::detail {

/// Where the pads of a parallel hand come to rest when they close over a pair of contacts.
struct PadSeat {
  Eigen::Vector3d middle;  ///< Midway between the pads, object frame [m].
  double width;            ///< Distance between the pads [m].
  /// As ContactPair's, of what the pads touch and, on crests, of the line between the middles of that on either side.
  double alignment;
};

/// A triangle that may come under pads at a pair of contacts, seen from their middle along the pair's first approach,
/// across it, and along its axis.
struct NearTriangle {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector2d centre;  ///< The middle of its ball, along and across.
  double radius;           ///< Its ball's [m].
};

/// What may come under pads at a pair of contacts.
struct NearPads {
  std::vector<NearTriangle> surface, hull;  ///< Triangles of the surface and of its hull.
};

/// The triangles of a mesh, each in a ball.
class TriangleBalls {
 public:
  explicit TriangleBalls(const TriangleMesh& mesh);

  /// Those that come as near to the pair's line as `radius` and reach as far from its middle as `lowest` [m].
  std::vector<NearTriangle> near(const ContactPair& pair, double radius, double lowest) const;

 private:
  const TriangleMesh& mesh_;
  std::vector<Eigen::Vector3d> centres_;
  std::vector<double> radii_;  // The farthest corner from there [m].
};

/// Pads are flat and wider than a contact: on a slanted or bent surface they rest on the outermost points under them,
/// and the hand, whose fingers close alike, moves the part (or itself) to the middle of these.
///
/// An edge inside a pad is pushed along the pad's normal, however steep the slopes beside it are. One edge alone lets
/// the part rock about it; what is touched over more than a single edge can be wide are several, and the pad stands on
/// the convex hull over them, whose slope counts there.
class PadSeats {
 public:
  /// `hull`: of the surface; null where it is its own, or none.
  PadSeats(const JoinedSurface& surface, const TriangleMesh* hull, const Hand& hand,
           const GraspSamplerOptions& options);

  /// Whatever the approach, with the tool frame no farther than `standoff` from the contacts [m]: for seat().
  NearPads near(const ContactPair& pair, double standoff) const;
  /// The tool frame stays `standoff` before the contacts. None where the pads find no hold: what they touch is steeper
  /// than friction allows, or on the two sides so far apart that the part turns between them. A finger needs its
  /// thickness, or the hand's clearance if that is more: what leaves less room behind a pad is under it, too.
  std::optional<PadSeat> seat(const ContactPair& pair, const Eigen::Vector3d& approach, double standoff,
                              const NearPads& near) const;

 private:
  TriangleBalls surface_;
  std::optional<TriangleBalls> hull_;
  bool solid_;
  const Hand& hand_;
  const GraspSamplerOptions& options_;
  double cone_;  // Half angle of the friction cone [rad].
};

}  // namespace mmgrasp::detail
