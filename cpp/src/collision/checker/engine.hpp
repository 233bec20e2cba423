#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "collision/checker/collision_search.hpp"
#include "collision/checker/edge_walk.hpp"
#include "collision/checker/limit_slack.hpp"
#include "collision/checker/nearest_pair.hpp"
#include "collision/checker/placement.hpp"

namespace mmgrasp::detail {

/// No edge is cut into more pieces.
constexpr double kMaxPieces = 1e9;

/// Throws InvalidInput naming `field` for a wrong length or a number that is not finite. The group's own check builds
/// its message's words first: too slow for the hot path, so it is called only when something is wrong.
inline void check_configuration(const JointGroup& group, const Eigen::VectorXd& q, const char* field) {
  if (q.size() != group.lower().size() || !q.allFinite()) group.check_configuration(q, field);
}

/// What a CollisionChecker does, on configurations that are known to have the right length and finite numbers: a
/// placement, the search for collisions and the search for the nearest pair. A copy shares snapshot and plan.
class CheckerEngine {
 public:
  CheckerEngine(std::shared_ptr<const Snapshot> snapshot, std::shared_ptr<const PairPlan> plan,
                const JointGroup& group);
  CheckerEngine(const std::shared_ptr<const Snapshot>& snapshot, const JointGroup& group);

  Placement& placement() { return placement_; }
  const Placement& placement() const { return placement_; }
  const JointGroup& group() const { return placement_.group(); }
  const CheckerOptions& options() const { return placement_.snapshot().options; }
  std::size_t queries() const { return queries_; }
  void count_queries(std::size_t more) { queries_ += more; }

  void set_root(const Pose& T_world_root);
  /// Must be called when the snapshot's attached object was placed anew.
  void attached_moved();

  Rejection rejection(const Eigen::VectorXd& q);
  bool is_free(const Eigen::VectorXd& q);
  std::optional<Contact> first_contact(const Eigen::VectorXd& q);
  std::vector<Contact> contacts(const Eigen::VectorXd& q);
  DistanceResult distance(const Eigen::VectorXd& q, bool with_gradient);
  std::vector<DistanceResult> distances(const Eigen::VectorXd& q, double within);
  /// The edge without its start, which is known to be free, or without its end either.
  bool edge_stays_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double step, bool end_is_free = false);

 private:
  Placement placement_;
  CollisionSearch search_;
  NearestPairSearch nearest_;
  EdgeWalk walk_;
  std::size_t queries_ = 0;
};

}  // namespace mmgrasp::detail
