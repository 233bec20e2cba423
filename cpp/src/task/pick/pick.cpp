#include "mmgrasp/task/pick.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mmgrasp/core/detail/no_time_limit.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/plan/straight_line.hpp"
#include "mmgrasp/plan/time_parameterization.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "task/pick/joined_motions.hpp"
#include "task/pick/pick_scene.hpp"
#include "task/pick/release.hpp"
#include "task/problem/full_turns.hpp"

namespace mmgrasp {
namespace {

constexpr double kSame = 1e-2;           // Configurations nearer than this are one [rad or m].
constexpr int kConfigurations = 6;       // Tried for one grasp.
constexpr int kMotionTries = 12;         // Grasp configurations that may reach the costly stage.
constexpr std::size_t kReleases = 6;     // Goals of a carry.
constexpr double kLineDeviation = 2e-4;  // Blending of straight tool motions [rad]: the tool stays on its line.
constexpr double kEdgeStep = 0.02;
constexpr double kStatesPerSecond = 2000;  // Of motion_time_limit: slow enough that this budget ends before the clock.
constexpr double kMostStates = 1e8;
constexpr double kTimedStep = 0.01;

enum Stage { kAtGrasp, kApproaching, kClosing, kLifting, kReleasing, kReaching, kCarrying, kRetreating, kStages };
constexpr std::array<const char*, kStages> kStageNames = {"grasp",   "approach", "close", "lift",
                                                          "release", "reach",    "carry", "retreat"};

JointPath reversed(const JointPath& path) {
  JointPath back = path;
  std::reverse(back.waypoints.begin(), back.waypoints.end());
  return back;
}

/// The paths of one pick before timing.
struct Paths {
  JointPath reach, approach, lift, carry, retreat;
};

class PickPlanner {
 public:
  PickPlanner(const PartSupplyProblem& problem, const ReachDatabase& database, const Eigen::Vector3d& base_pose,
              int tray, int part, const std::vector<std::pair<int, int>>& remaining, const Monitor& monitor)
      : problem_(problem),
        database_(database),
        part_(part_of(problem, tray, part)),
        scene_(problem, base_pose, tray, part, remaining),
        monitor_(monitor) {
    pick_.tray = tray;
    pick_.part = part;
    seed_ = problem.options.seed * 1000003u + static_cast<unsigned>(tray) * 1009u + static_cast<unsigned>(part);
  }

  Pick run() {
    for (int round = 0; round < 2; ++round) {
      for (int g = 0; g < static_cast<int>(part_.grasps.size()); ++g) {
        if (monitor_.stopped()) {
          pick_.outcome = Outcome::stopped;
          return pick_;
        }
        if (motion_tries_ < kMotionTries && try_grasp(g, round)) return pick_;
      }
    }
    const auto worst = std::max_element(fallen_.begin(), fallen_.end());
    pick_.failed_at = *worst > 0 ? kStageNames[worst - fallen_.begin()] : "grasp";
    return pick_;
  }

 private:
  bool fell(Stage stage) {
    ++fallen_[stage];
    return false;
  }

  Pose T_world_tcp(int grasp) const { return part_.T_world_part * part_.grasps[grasp].T_object_hand; }

  /// Free configurations at the grasp, nearest to home first. Second round: from random starts instead of the database.
  std::vector<Eigen::VectorXd> grasp_configurations(int grasp, int round, CollisionChecker& checker) {
    const Pose T = T_world_tcp(grasp);
    std::vector<Eigen::VectorXd> found;
    const auto judge = [&](Eigen::VectorXd q) {
      turn_towards(checker.group(), problem_.home, q);
      for (const Eigen::VectorXd& other : found) {
        if ((q - other).cwiseAbs().maxCoeff() < kSame) return;
      }
      const Rejection cause = checker.rejection(q);
      pick_.rejections.add(cause);
      if (cause == Rejection::none) found.push_back(q);
    };
    const Pose T_base_tcp = scene_.T_world_root().inverse() * T;
    if (round == 0) {
      const int count =
          database_.nearest(T_base_tcp, std::max(kConfigurations, problem_.options.grid.ik_seeds), seeds_);
      if (count == 0) pick_.rejections.add(Rejection::reach);
      for (int i = 0; i < count; ++i) {
        Eigen::VectorXd q = seeds_.col(i).head(problem_.arm.size());
        if (refine_ik(checker.group(), T, q, ik_, workspace_)) {
          judge(q);
        } else {
          pick_.rejections.add(Rejection::reach);
        }
      }
    } else {
      IkOptions options;
      options.restarts = 4;
      options.time_limit = detail::kNoTimeLimit;
      options.seed = seed_ + static_cast<unsigned>(grasp);
      for (const Eigen::VectorXd& q : solve_ik_all(checker.group(), T, kConfigurations, options)) judge(q);
    }
    std::stable_sort(found.begin(), found.end(), [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      return (a - problem_.home).norm() < (b - problem_.home).norm();
    });
    return found;
  }

  bool try_grasp(int grasp, int round) {
    const double width = part_.grasps[grasp].opening;
    const double opening = problem_.gripper.pregrasp_opening(width);
    CollisionChecker& before = scene_.before(opening);
    const std::vector<Eigen::VectorXd> configurations = grasp_configurations(grasp, round, before);
    if (configurations.empty()) return fell(kAtGrasp);
    for (const Eigen::VectorXd& q : configurations) {
      if (monitor_.stopped() || motion_tries_ >= kMotionTries) return false;
      if (try_configuration(grasp, q, before, width, opening)) return true;
    }
    return false;
  }

  bool try_configuration(int grasp, const Eigen::VectorXd& q, CollisionChecker& before, double width, double opening) {
    Paths paths;
    Pose T_pre = T_world_tcp(grasp);
    T_pre.translation() -= problem_.options.approach_distance * (T_pre.linear() * problem_.gripper.approach);
    const StraightLineResult back = plan_straight_line(before, q, T_pre, line_options());
    if (back.outcome != Outcome::solved) return fell(kApproaching);
    paths.approach = reversed(*back.path);

    const Pose T_grasp = before.group().fk(q);
    const Pose T_tcp_part = T_grasp.inverse() * part_.T_world_part;
    CollisionChecker holding = scene_.holding(width, T_tcp_part);
    if (!PickScene::fingers_free(problem_, scene_.T_world_root(), holding, q, opening, width)) return fell(kClosing);
    Pose T_lifted = T_grasp;
    T_lifted.translation().z() += problem_.options.lift_height;
    const StraightLineResult lift = plan_straight_line(holding, q, T_lifted, line_options());
    if (lift.outcome != Outcome::solved) return fell(kLifting);
    paths.lift = *lift.path;

    CollisionChecker& after = scene_.after(opening);
    std::vector<Eigen::VectorXd> releases;
    for (const Eigen::VectorXd& some :
         release_configurations(database_, holding, release_poses(problem_, scene_.T_world_root(), part_, T_tcp_part),
                                paths.lift.waypoints.back(), kReleases, pick_.rejections)) {
      if (PickScene::fingers_free(problem_, scene_.T_world_root(), after, some, width, opening))
        releases.push_back(some);
    }
    if (releases.empty()) return fell(kReleasing);
    if (!PickScene::fingers_free(problem_, scene_.T_world_root(), before, problem_.home, 0, opening))
      return fell(kReaching);
    ++motion_tries_;
    if (!plan_motions(before, holding, after, releases, paths)) return false;
    return finish(grasp, width, opening, before, holding, after, paths);
  }

  StraightLineOptions line_options() const {
    StraightLineOptions options;
    options.edge_step = kEdgeStep;
    return options;
  }

  bool motion(CollisionChecker& checker, const Eigen::VectorXd& from, const std::vector<Eigen::VectorXd>& to,
              Stage stage, JointPath& path) {
    MotionOptions options;
    options.time_limit = problem_.options.motion_time_limit;
    options.max_iterations =
        static_cast<int>(std::clamp(std::ceil(kStatesPerSecond * options.time_limit), 1.0, kMostStates));
    options.seed = seed_ * 31u + static_cast<unsigned>(stage) + 7u * static_cast<unsigned>(motion_tries_);
    options.edge_step = kEdgeStep;
    MotionResult result = plan_motion(checker, from, to, options, monitor_);
    if (result.outcome != Outcome::solved) return fell(stage);
    path = std::move(*result.path);
    return true;
  }

  bool plan_motions(CollisionChecker& before, CollisionChecker& holding, CollisionChecker& after,
                    const std::vector<Eigen::VectorXd>& releases, Paths& paths) {
    return motion(before, problem_.home, {paths.approach.waypoints.front()}, kReaching, paths.reach) &&
           motion(holding, paths.lift.waypoints.back(), releases, kCarrying, paths.carry) &&
           motion(after, paths.carry.waypoints.back(), {problem_.home}, kRetreating, paths.retreat);
  }

  bool finish(int grasp, double width, double opening, CollisionChecker& before, CollisionChecker& holding,
              CollisionChecker& after, const Paths& paths) {
    TimingOptions line;
    line.max_deviation = kLineDeviation;
    const auto timed = [](CollisionChecker& checker, const JointPath& path, const TimingOptions& options) {
      return time_parameterize_free(checker, path, options, kTimedStep);
    };
    pick_.motions = {{MotionKind::reach, opening, false, timed(before, paths.reach, {})},
                     {MotionKind::approach, opening, false, timed(before, paths.approach, line)},
                     {MotionKind::lift, width, true, timed(holding, paths.lift, line)},
                     {MotionKind::carry, width, true, timed(holding, paths.carry, {})},
                     {MotionKind::retreat, opening, false, timed(after, paths.retreat, {})}};
    join_motions(problem_.arm.wraps(), problem_.home, pick_.motions);
    const std::array<CollisionChecker*, 5> checkers = {&before, &before, &holding, &holding, &after};
    const std::array<Stage, 5> stages = {kReaching, kApproaching, kLifting, kCarrying, kRetreating};
    for (std::size_t i = 0; i < checkers.size(); ++i) {
      if (trajectory_free(*checkers[i], pick_.motions[i].trajectory)) continue;
      pick_.motions.clear();
      return fell(stages[i]);
    }
    pick_.outcome = Outcome::solved;
    pick_.grasp = grasp;
    return true;
  }

  /// The check before return: on the trajectory itself, between its samples too.
  bool trajectory_free(CollisionChecker& checker, const JointTrajectory& trajectory) const {
    if (trajectory.times.size() < 2) return false;
    Eigen::VectorXd last = trajectory.positions.front();
    if (!checker.is_free(last)) return false;
    for (std::size_t i = 1; i < trajectory.times.size(); ++i) {
      const double largest = (trajectory.positions[i] - trajectory.positions[i - 1]).cwiseAbs().maxCoeff();
      const int steps = std::max(1, static_cast<int>(std::ceil(largest / kTimedStep)));
      for (int k = 1; k <= steps; ++k) {
        const double t = trajectory.times[i - 1] + (trajectory.times[i] - trajectory.times[i - 1]) * k / steps;
        if (!checker.is_free(trajectory.at(t))) return false;
      }
    }
    return true;
  }

  const PartSupplyProblem& problem_;
  const ReachDatabase& database_;
  const Part& part_;
  PickScene scene_;
  const Monitor& monitor_;
  Pick pick_;
  unsigned seed_;
  int motion_tries_ = 0;
  std::array<std::size_t, kStages> fallen_{};
  IkOptions ik_;
  IkWorkspace workspace_;
  Eigen::MatrixXd seeds_;
};

void check_part(const PartSupplyProblem& problem, int tray, int part, const std::string& tray_name,
                const std::string& part_name) {
  const auto check = [](int index, std::size_t count, const std::string& name) {
    require(index >= 0 && index < static_cast<int>(count), name, std::to_string(index),
            "must be in [0, " + std::to_string(count) + ")");
  };
  check(tray, problem.trays.size(), tray_name);
  check(part, problem.trays[tray].parts.size(), part_name);
}

}  // namespace

const char* to_string(MotionKind kind) {
  switch (kind) {
    case MotionKind::reach:
      return "reach";
    case MotionKind::approach:
      return "approach";
    case MotionKind::lift:
      return "lift";
    case MotionKind::carry:
      return "carry";
    case MotionKind::retreat:
      return "retreat";
  }
  return "unknown";
}

double Pick::duration() const {
  double sum = 0;
  for (const PickMotion& motion : motions) sum += motion.trajectory.duration();
  return sum;
}

Pick plan_pick(const PartSupplyProblem& problem, const ReachDatabase& database, const Eigen::Vector3d& base_pose,
               int tray, int part, const std::vector<std::pair<int, int>>& remaining, const Monitor& monitor) {
  check_part(problem, tray, part, "tray", "part");
  for (std::size_t i = 0; i < remaining.size(); ++i) {
    const std::string name = "remaining[" + std::to_string(i) + "]";
    check_part(problem, remaining[i].first, remaining[i].second, name + ".tray", name + ".part");
  }
  // Only the calling thread may report progress; here it only listens for the end.
  Monitor quiet;
  quiet.stop = monitor.stop;
  return PickPlanner(problem, database, base_pose, tray, part, remaining, quiet).run();
}

}  // namespace mmgrasp
