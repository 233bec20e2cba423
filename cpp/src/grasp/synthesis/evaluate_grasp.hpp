#pragma once

#include <vector>

#include "grasp/synthesis/hand_clearance.hpp"
#include "grasp/synthesis/map_surface.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/grasp/synthesize_grasps.hpp"

namespace mmgrasp::detail {

/// How the evaluation of a grasp ended.
enum class Verdict { good, missed, uneven, slipping, uncertain, collision, table, arm };

/// Counts what a grasp was rejected for; nothing for a good one.
void add_verdict(Verdict verdict, SynthesisCounts& counts);

/// A grasp while it is searched for.
struct EvaluatedGrasp {
  Pose T_world_hand = Pose::Identity();
  std::vector<double> shares;  ///< How far open the closing groups are before they close.
  Verdict verdict = Verdict::missed;
  GraspSuccess success;
  std::vector<ContactPatch> patches;
  Eigen::VectorXd q;
};

/// Rates grasps of one hand on one map; const members may be called from several threads.
class GraspEvaluator {
 public:
  GraspEvaluator(const ProbabilisticSdf& map, const HandModel& hand, const MapSurface& surface,
                 const SynthesisOptions& options);

  /// The hand around two walls `width` apart whose middle is given, closing along `axis`, moving in along `approach`.
  EvaluatedGrasp place(const Eigen::Vector3d& middle, const Eigen::Vector3d& axis, const Eigen::Vector3d& approach,
                       double width) const;
  /// Casts the pads' rays, centres and opens the hand, and rates it; sets all but `q`.
  void evaluate(EvaluatedGrasp& grasp) const;
  /// Checks what evaluate() left out: the way in and closing; casts the rays again. Sets
  /// `verdict`, `patches` and `success`.
  void confirm(EvaluatedGrasp& grasp) const;
  /// A grasp next to a good one: shifted in the plane of the pads, every second one turned to face its patches.
  EvaluatedGrasp shifted(const EvaluatedGrasp& from, double radius, bool turned, Rng& rng) const;

  Eigen::Vector3d closing_axis(const EvaluatedGrasp& grasp) const;
  Eigen::Vector3d approach(const EvaluatedGrasp& grasp) const;
  /// Groups' shares at which the pads are so far apart [m]; all the same.
  std::vector<double> shares_at(double opening) const;
  double opening_at(const std::vector<double>& shares) const;
  /// The shares at which every pad just touches.
  std::vector<double> holding_shares(const EvaluatedGrasp& grasp) const;
  double largest_opening() const { return openings_.back(); }
  double smallest_opening() const { return openings_.front(); }

 private:
  Verdict cast(const EvaluatedGrasp& grasp, std::vector<ContactPatch>& patches) const;
  void draw_back(EvaluatedGrasp& grasp) const;
  void centre_parallel(EvaluatedGrasp& grasp) const;
  Verdict centre_by_finger(EvaluatedGrasp& grasp) const;
  /// Each group's share so that its pads go on by `error` [m] on average.
  std::vector<double> moved_fingers(const EvaluatedGrasp& grasp, const std::vector<double>& errors) const;
  void rate(EvaluatedGrasp& grasp) const;

  const ProbabilisticSdf& map_;
  const HandModel& hand_;
  const MapSurface& surface_;
  const SynthesisOptions& options_;
  HandClearance clearance_;
  std::vector<double> openings_;  ///< Openings at equal steps of the shares; rising.
};

}  // namespace mmgrasp::detail
