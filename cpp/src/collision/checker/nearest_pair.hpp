#pragma once

#include <optional>
#include <vector>

#include "collision/checker/placement.hpp"
#include "collision/narrow/narrow.hpp"

namespace mmgrasp::detail {

/// A pair of shapes, with a number its distance is not below.
struct CandidatePair {
  double bound = 0;
  int shape = 0;
  int other = 0;  ///< Another shape, or one of the scene.
  bool with_scene = false;
};

struct NearestPair {
  CandidatePair pair;
  SolidClearance clearance;  ///< Infinite: there is none.
};

/// Distances of a robot placed with its links: spheres bound every pair from below, boxes those that remain, and exact
/// clearances are computed nearest bound first until no bound lies below the best of them. Nothing is kept from one
/// query to the next that could change a digit of an answer.
class NearestPairSearch {
 public:
  NearestPair nearest(Placement& placement);
  /// The nearest pair of shapes for each two bodies nearer than `within` [m], in the order of the bodies.
  std::vector<NearestPair> all_within(Placement& placement, double within);
  /// d distance / d q.
  Eigen::VectorXd gradient(const Placement& placement, const NearestPair& nearest, const Eigen::VectorXd& q);

  /// Forgets the distance of the pairs that no configuration changes.
  void forget() { nearest_constant_.reset(); }

 private:
  void search(Placement& placement, bool constant, NearestPair& best);

  /// The nearest of the pairs that no configuration changes, in the frame they share.
  std::optional<NearestPair> nearest_constant_;
  std::vector<CandidatePair> candidates_;  ///< Scratch of nearest().
  Matrix6Xd point_jacobian_;               ///< Scratch of gradient().
};

/// The pair by the names of its bodies, without gradient.
DistanceResult describe(const Snapshot& snapshot, const NearestPair& nearest);

}  // namespace mmgrasp::detail
