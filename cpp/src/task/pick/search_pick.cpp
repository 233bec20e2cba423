#include "task/pick/search_pick.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mmgrasp/core/detail/no_time_limit.hpp"
#include "mmgrasp/grasp/detail/joined_surface.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/plan/straight_line.hpp"
#include "mmgrasp/plan/time_parameterization.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "task/pick/held_by_suction.hpp"
#include "task/pick/joined_motions.hpp"
#include "task/pick/pick_scene.hpp"
#include "task/pick/release.hpp"
#include "task/problem/full_turns.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kSameConfiguration = 1e-2;  // Configurations nearer than this are one [rad or m].
constexpr int kConfigurations = 6;           // Tried for one grasp.
constexpr int kMotionTries = 12;             // Grasp configurations that may reach the costly stage.
constexpr std::size_t kReleases = 6;         // Goals of a transfer.
constexpr double kLineDeviation = 2e-4;      // Blending of straight tool motions [rad]: the tool stays on its line.
constexpr double kEdgeStep = 0.02;
// States per second of motion_time_limit: so few that this budget ends a search before the time limit does.
constexpr double kStatesPerSecond = 2000;
constexpr double kMaxStates = 1e8;
constexpr double kTimedStep = 0.01;

/// Stages at which candidates fall, in the order in which they are planned.
enum Stage { kGrasp, kApproach, kClose, kLift, kRelease, kTransit, kTransfer, kRetreat, kStages };
constexpr std::array<const char*, kStages> kStageNames = {"grasp",   "approach", "close",    "lift",
                                                          "release", "transit",  "transfer", "retreat"};

JointPath reversed(const JointPath& path) {
  JointPath back = path;
  std::reverse(back.waypoints.begin(), back.waypoints.end());
  return back;
}

/// The paths of one pick before timing.
struct Paths {
  JointPath transit, approach, lift, transfer, retreat;
};

/// Tries grasps and arm configurations, the best first, until one has all motions of the pick.
class PickPlanner {
 public:
  PickPlanner(const PickProblem& problem, const ReachDatabase& database, const Monitor& monitor)
      : problem_(problem),
        database_(database),
        scene_(problem),
        T_world_object_(problem.world.objects().at(problem.object).T_world_object),
        monitor_(monitor),
        seed_(problem.options.seed) {
    if (problem.gripper.suction)
      centre_of_mass_ = joined_surface(problem.world.objects().at(problem.object).shapes).centre_of_mass;
  }

  Pick run(int rounds) {
    for (int round = 0; round < rounds; ++round) {
      for (int g = 0; g < static_cast<int>(problem_.grasps.size()); ++g) {
        if (motion_tries_ < kMotionTries && try_grasp(g, round)) return pick_;
        if (monitor_.stopped()) {
          pick_.outcome = Outcome::stopped;
          return pick_;
        }
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

  Pose T_world_hand(int grasp) const { return T_world_object_ * problem_.grasps[grasp].T_object_hand; }

  /// Free configurations at the grasp, nearest to home first. Second round: from random starts instead of the database.
  std::vector<Eigen::VectorXd> grasp_configurations(int grasp, int round, CollisionChecker& checker) {
    const Pose T = T_world_hand(grasp);
    std::vector<Eigen::VectorXd> found;
    const auto judge = [&](Eigen::VectorXd q) {
      turn_towards(checker.group(), problem_.home, q);
      for (const Eigen::VectorXd& other : found) {
        if ((q - other).cwiseAbs().maxCoeff() < kSameConfiguration) return;
      }
      const Rejection cause = checker.rejection(q);
      pick_.rejections.add(cause);
      if (cause == Rejection::none) found.push_back(q);
    };
    const Pose T_base_hand = problem_.arm.T_world_root().inverse() * T;
    if (round == 0) {
      const int count = database_.nearest(T_base_hand, std::max(kConfigurations, problem_.options.ik_seeds), seeds_);
      if (count == 0) pick_.rejections.add(Rejection::unreachable);
      for (int i = 0; i < count; ++i) {
        Eigen::VectorXd q = seeds_.col(i).head(problem_.arm.size());
        if (refine_ik(checker.group(), T, q, ik_, workspace_)) {
          judge(q);
        } else {
          pick_.rejections.add(Rejection::unreachable);
        }
      }
    } else {
      IkOptions options;
      options.restarts = 4;
      options.time_limit = kNoTimeLimit;
      options.seed = seed_ + static_cast<unsigned>(grasp);
      for (const Eigen::VectorXd& q : solve_ik_all(checker.group(), T, kConfigurations, options)) judge(q);
    }
    std::stable_sort(found.begin(), found.end(), [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      return (a - problem_.home).norm() < (b - problem_.home).norm();
    });
    return found;
  }

  bool try_grasp(int grasp, int round) {
    const double width = problem_.grasps[grasp].opening;
    const double opening = problem_.gripper.pregrasp_opening(width);
    CollisionChecker& before = scene_.before(opening);
    const std::vector<Eigen::VectorXd> configurations = grasp_configurations(grasp, round, before);
    if (configurations.empty()) return fell(kGrasp);
    for (const Eigen::VectorXd& q : configurations) {
      if (monitor_.stopped() || motion_tries_ >= kMotionTries) return false;
      if (try_configuration(grasp, q, before, width, opening)) return true;
    }
    return false;
  }

  bool try_configuration(int grasp, const Eigen::VectorXd& q, CollisionChecker& before, double width, double opening) {
    Paths paths;
    Pose T_pre = T_world_hand(grasp);
    T_pre.translation() -= problem_.options.approach_distance * (T_pre.linear() * problem_.gripper.approach);
    const StraightLineResult back = plan_straight_line(before, q, T_pre, line_options());
    if (back.outcome != Outcome::solved) return fell(kApproach);
    paths.approach = reversed(*back.path);

    const Pose T_grasp = before.group().fk(q);
    CollisionChecker lifting = scene_.lifting(width, T_grasp, T_world_object_);
    if (!scene_.fingers_free(lifting, q, opening, width)) return fell(kClose);
    Pose T_lifted = T_grasp;
    T_lifted.translation().z() += problem_.options.lift_height;
    const StraightLineResult lift = plan_straight_line(lifting, q, T_lifted, line_options());
    if (lift.outcome != Outcome::solved) return fell(kLift);
    paths.lift = *lift.path;

    const Pose T_hand_object = T_grasp.inverse() * T_world_object_;
    CollisionChecker holding = scene_.holding(width, T_hand_object);
    CollisionChecker& after = scene_.after(opening);
    std::vector<Eigen::VectorXd> releases;
    if (!problem_.places.empty()) {
      for (const Eigen::VectorXd& some :
           release_configurations(database_, holding, problem_.places, T_hand_object, paths.lift.waypoints.back(),
                                  kReleases, pick_.rejections)) {
        if (scene_.fingers_free(after, some, width, opening)) releases.push_back(some);
      }
      if (releases.empty()) return fell(kRelease);
    }
    if (!scene_.fingers_free(before, problem_.home, 0, opening)) return fell(kTransit);
    ++motion_tries_;
    if (!plan_motions(before, holding, after, releases, paths)) return false;
    return finish(grasp, width, opening, {&before, &before, &lifting, &holding, &after}, paths);
  }

  StraightLineOptions line_options() const {
    StraightLineOptions options;
    options.joint_step = kEdgeStep;
    return options;
  }

  bool motion(CollisionChecker& checker, const Eigen::VectorXd& from, const std::vector<Eigen::VectorXd>& to,
              Stage stage, JointPath& path) {
    MotionOptions options;
    options.time_limit = problem_.options.motion_time_limit;
    options.max_iterations =
        static_cast<int>(std::clamp(std::ceil(kStatesPerSecond * options.time_limit), 1.0, kMaxStates));
    options.seed = seed_ * 31u + static_cast<unsigned>(stage) + 7u * static_cast<unsigned>(motion_tries_);
    options.joint_step = kEdgeStep;
    MotionResult result = plan_motion(checker, from, to, options, monitor_);
    if (result.outcome != Outcome::solved) return fell(stage);
    path = std::move(*result.path);
    return true;
  }

  bool plan_motions(CollisionChecker& before, CollisionChecker& holding, CollisionChecker& after,
                    const std::vector<Eigen::VectorXd>& releases, Paths& paths) {
    if (!motion(before, problem_.home, {paths.approach.waypoints.front()}, kTransit, paths.transit)) return false;
    if (releases.empty()) return true;
    return motion(holding, paths.lift.waypoints.back(), releases, kTransfer, paths.transfer) &&
           motion(after, paths.transfer.waypoints.back(), {problem_.home}, kRetreat, paths.retreat);
  }

  /// Checkers of transit, approach, lift, transfer, retreat.
  using MotionCheckers = std::array<CollisionChecker*, 5>;

  bool finish(int grasp, double width, double opening, const MotionCheckers& checkers, const Paths& paths) {
    TimingOptions line;
    line.max_deviation = kLineDeviation;
    bool held = true;
    const auto add = [&](MotionKind kind, bool holds, const JointPath& path, const TimingOptions& options) {
      CollisionChecker& checker = *checkers[pick_.motions.size()];
      JointTrajectory trajectory = time_parameterize_free(checker, path, options, kTimedStep, {monitor_.stop, {}});
      if (holds && problem_.gripper.suction) held = slow_to_hold(checker.group(), load_at(grasp), trajectory) && held;
      pick_.motions.push_back({kind, holds ? width : opening, holds, std::move(trajectory)});
    };
    add(MotionKind::transit, false, paths.transit, {});
    add(MotionKind::approach, false, paths.approach, line);
    add(MotionKind::lift, true, paths.lift, line);
    if (!problem_.places.empty()) {
      add(MotionKind::transfer, true, paths.transfer, {});
      add(MotionKind::retreat, false, paths.retreat, {});
    }
    if (!held) {
      pick_.motions.clear();
      return fell(kLift);
    }
    join_motions(problem_.arm.wraps(), problem_.home, pick_.motions);
    const std::array<Stage, 5> stages = {kTransit, kApproach, kLift, kTransfer, kRetreat};
    for (std::size_t i = 0; i < pick_.motions.size(); ++i) {
      if (trajectory_free(*checkers[i], pick_.motions[i].trajectory)) continue;
      pick_.motions.clear();
      return fell(stages[i]);
    }
    pick_.outcome = Outcome::solved;
    pick_.grasp = grasp;
    return true;
  }

  SuctionLoad load_at(int grasp) const {
    const Hand& hand = problem_.gripper;
    const Eigen::Vector3d centre = problem_.grasps[grasp].T_object_hand.inverse() * centre_of_mass_;
    return {*hand.suction, hand.approach, problem_.mass, centre};
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

  const PickProblem& problem_;
  const ReachDatabase& database_;
  PickScene scene_;
  Pose T_world_object_;
  Eigen::Vector3d centre_of_mass_ = Eigen::Vector3d::Zero();  ///< The object's, for cups.
  const Monitor& monitor_;
  Pick pick_;
  unsigned seed_;
  int motion_tries_ = 0;
  std::array<std::size_t, kStages> fallen_{};
  IkOptions ik_;
  IkWorkspace workspace_;
  Eigen::MatrixXd seeds_;
};

}  // namespace

Pick search_pick(const PickProblem& problem, const ReachDatabase& database, const Monitor& monitor, bool thorough) {
  Monitor quiet;
  quiet.stop = monitor.stop;
  return PickPlanner(problem, database, quiet).run(thorough ? 2 : 1);
}

}  // namespace mmgrasp::detail
