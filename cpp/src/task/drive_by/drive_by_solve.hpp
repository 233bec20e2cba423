#pragma once

#include <optional>
#include <vector>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "task/drive_by/drive_by_route.hpp"
#include "task/drive_by/drive_by_seed.hpp"

namespace mmgrasp::detail {

/// How a configuration sequence is solved.
struct SolveSettings {
  int iteration_budget = 0;        ///< Iterations of one solve at most.
  bool guided = false;             ///< Led around obstacles even when the straight guess meets none.
  bool by_reference_path = false;  ///< See PathGuide::way.
};

/// Makes configuration sequences into motions. What it is given has to outlive it; `scene_states` null: nothing can
/// collide.
class DriveBySolver {
 public:
  DriveBySolver(const JointGroup& group, const Eigen::VectorXd& start, const std::vector<DriveByStep>& steps,
                const DriveByGoal& goal, const DriveByOptions& options, SceneStates* scene_states,
                const Monitor& monitor);

  /// Optimises from a guess straight through the configurations, or around obstacles when that collides; very many
  /// waypoints start from the solution with few. `waypoints` are those of the steps.
  WholeBodyResult solve(const ConfigurationSequence& sequence, const SolveSettings& settings,
                        std::vector<int>& waypoints);
  /// Number of waypoints at which the first guess collides.
  int collisions(const ConfigurationSequence& sequence);
  DriveBySeeds& seeds() { return seeds_; }
  double seconds() const { return stopwatch_.seconds(); }

 private:
  void lead_around_obstacles(SeededProblem& a, const ConfigurationSequence& sequence, const SolveSettings& settings);
  WholeBodyResult optimize(const SeededProblem& a, double warm_start = 0);
  /// Ways around obstacles; nothing when some are not found.
  std::optional<DriveByRoute> route(const ConfigurationSequence& sequence, const SeededProblem& a,
                                    bool by_reference_path);
  /// What can collide on the way to a step: with the part that is held, where that does not touch at either end.
  CollisionChecker& checker_between(const SeededProblem& a, std::size_t step, const Eigen::VectorXd& from,
                                    const Eigen::VectorXd& to);

  const JointGroup& group_;
  const Eigen::VectorXd& start_;
  const std::vector<DriveByStep>& steps_;
  const DriveByGoal& goal_;
  const DriveByOptions& options_;
  SceneStates* scene_states_;
  DriveBySeeds seeds_;
  std::optional<PathGuide> guide_;
  int iterations_ = 0;  // budget of one solve
  const Monitor& monitor_;
  Stopwatch stopwatch_;
};

/// How much of a result's constraints is broken; 0: nothing.
double broken(const WholeBodyResult& result);

}  // namespace mmgrasp::detail
