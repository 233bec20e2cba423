#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "grasp/sampling/contact_pairs.hpp"

namespace mmgrasp::detail {

/// Where the pads of a parallel hand come to rest when they close over a pair of contacts.
struct PadSeat {
  Eigen::Vector3d middle;  ///< Midway between the pads, object frame [m].
  double width;            ///< Distance between the pads [m].
  double alignment;        ///< As ContactPair's, of what the pads touch.
};

/// Pads are flat and wider than a contact: on a slanted or bent surface they rest on the outermost points under them,
/// and the hand, whose fingers close alike, moves the part (or itself) to the middle of these.
class PadSeats {
 public:
  PadSeats(const JoinedSurface& surface, const Hand& hand, const GraspSamplerOptions& options);

  /// The triangles that may come under pads at this pair, whatever the approach: for seat().
  std::vector<int> near(const ContactPair& pair) const;
  /// None where the pads find no hold: what they touch is steeper than friction allows, or on the two sides so far
  /// apart that the part turns between them. A finger needs its thickness, or the hand's
  /// clearance if that is more: what leaves less room behind a pad is under it, too.
  std::optional<PadSeat> seat(const ContactPair& pair, const Eigen::Vector3d& approach,
                              const std::vector<int>& near) const;

 private:
  const JoinedSurface& surface_;
  const Hand& hand_;
  const GraspSamplerOptions& options_;
  double cone_;                           // Half angle of the friction cone [rad].
  std::vector<Eigen::Vector3d> centres_;  // Middle of each triangle.
  std::vector<double> radii_;             // The farthest of its corners from there [m].
};

}  // namespace mmgrasp::detail
