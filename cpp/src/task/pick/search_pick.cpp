#include "task/pick/search_pick.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

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
constexpr std::size_t kDriveTries = 6;       // Grasps with which the base may fail to drive to the place.
constexpr double kAlikeTurn = 0.35;          // An object that is held but so little otherwise [rad]
constexpr double kAlikeShift = 0.03;         // and [m] passes where that one does.
constexpr double kLineDeviation = 2e-4;      // Blending of straight tool motions [rad]: the tool stays on its line.
constexpr double kEdgeStep = 0.02;
// States per second of motion_time_limit: so few that this budget ends a search before the time limit does.
constexpr double kStatesPerSecond = 2000;
constexpr double kMaxStates = 1e8;
constexpr double kTimedStep = 0.01;

/// Stages at which candidates fall; the first eight in the order in which they are planned.
enum Stage { kGrasp, kApproach, kClose, kLift, kRelease, kTransit, kTransfer, kRetreat, kStow, kHeldDrive, kStages };
constexpr std::array<const char*, kStages> kStageNames = {"grasp",   "approach", "close",   "lift", "release",
                                                          "transit", "transfer", "retreat", "stow", kHeldDriveStage};

JointPath reversed(const JointPath& path) {
  JointPath back = path;
  std::reverse(back.waypoints.begin(), back.waypoints.end());
  return back;
}

/// The paths of one pick before timing.
struct Paths {
  JointPath transit, approach, lift, stow, transfer, retreat;
};

/// What must stay free along them: the object in place, just raised, held where it was picked, held where it is
/// released, gone from there.
struct Checkers {
  CollisionChecker &before, &lifting, &holding, &releasing, &after;
};

/// A path with what its motion must be.
struct PlannedMotion {
  MotionKind kind;
  Stage stage;
  const JointPath& path;
  CollisionChecker& checker;
  bool holds = false, straight = false;
};

/// The problem as it is where the object is released from.
PickProblem at_place(const PickProblem& problem) {
  PickProblem there = problem;
  there.arm = problem.arm.at(*problem.T_world_root_at_place);
  return there;
}

/// Tries grasps and arm configurations, the best first, until one has all motions of the pick.
class PickPlanner {
 public:
  PickPlanner(const PickProblem& problem, const ReachDatabase& database, const Monitor& monitor,
              const std::function<bool(int)>& carries)
      : problem_(problem),
        database_(database),
        carries_(carries),
        scene_(problem),
        T_world_object_(problem.world.objects().at(problem.object).T_world_object),
        monitor_(monitor),
        seed_(problem.options.seed) {
    if (problem.T_world_root_at_place && !problem.places.empty()) {
      problem_there_.emplace(at_place(problem));
      scene_there_.emplace(*problem_there_);
    }
    if (problem.gripper.suction)
      centre_of_mass_ = joined_surface(problem.world.objects().at(problem.object).shapes).centre_of_mass;
  }

  Pick run(int rounds) {
    for (int round = 0; round < rounds; ++round) {
      for (int g = 0; g < static_cast<int>(problem_.grasps.size()); ++g) {
        if (refused_.size() < kDriveTries && motion_tries_ < kMotionTries && try_grasp(g, round)) return pick_;
        if (monitor_.stopped()) {
          pick_.outcome = Outcome::stopped;
          return pick_;
        }
      }
    }
    const auto worst = std::max_element(fallen_.begin(), fallen_.end());
    pick_.failed_at = *worst > 0 ? kStageNames[worst - fallen_.begin()] : "grasp";
    if (!refused_.empty()) pick_.failed_at = kHeldDriveStage;  // all the rest would do
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

  /// Whether the base can drive to the place with the object in the hand.
  bool can_carry(int grasp) {
    if (!carries_ || carries_(grasp)) return true;
    refused_.push_back(grasp);
    return false;
  }

  /// A grasp that holds the object as one did with which no drive was found.
  bool held_like_a_refused_one(int grasp) const {
    const Pose& T = problem_.grasps[grasp].T_object_hand;
    return std::any_of(refused_.begin(), refused_.end(), [&](int other) {
      const Pose& T_other = problem_.grasps[other].T_object_hand;
      return rotation_distance(T, T_other) < kAlikeTurn &&
             (T.translation() - T_other.translation()).norm() < kAlikeShift;
    });
  }

  bool try_grasp(int grasp, int round) {
    if (held_like_a_refused_one(grasp)) return false;
    const double width = problem_.grasps[grasp].opening;
    const double opening = problem_.gripper.pregrasp_opening(width);
    CollisionChecker& before = scene_.before(opening);
    const std::vector<Eigen::VectorXd> configurations = grasp_configurations(grasp, round, before);
    if (configurations.empty()) return fell(kGrasp);
    for (const Eigen::VectorXd& q : configurations) {
      if (monitor_.stopped() || motion_tries_ >= kMotionTries || held_like_a_refused_one(grasp)) return false;
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
    PickScene& there = scene_there_ ? *scene_there_ : scene_;
    std::optional<CollisionChecker> holding_there;
    if (scene_there_) holding_there.emplace(there.holding(width, T_hand_object));
    const Checkers checkers{before, lifting, holding, holding_there ? *holding_there : holding, there.after(opening)};
    if (scene_there_ && !(holding.is_free(problem_.home) && holding_there->is_free(problem_.home))) return fell(kStow);
    std::vector<Eigen::VectorXd> releases;
    if (!problem_.places.empty()) {
      for (const Eigen::VectorXd& some :
           release_configurations(database_, checkers.releasing, problem_.places, T_hand_object, before_transfer(paths),
                                  kReleases, pick_.rejections)) {
        if (there.fingers_free(checkers.after, some, width, opening)) releases.push_back(some);
      }
      if (releases.empty()) return fell(kRelease);
    }
    if (!scene_.fingers_free(before, problem_.home, 0, opening)) return fell(kTransit);
    if (scene_there_ && !there.fingers_free(checkers.after, problem_.home, opening, 0)) return fell(kRetreat);
    ++motion_tries_;
    if (!plan_motions(checkers, releases, paths)) return false;
    if (!can_carry(grasp)) return fell(kHeldDrive);
    return finish(grasp, width, opening, checkers, paths);
  }

  /// Where the arm stands as it begins to bring the object to its place.
  const Eigen::VectorXd& before_transfer(const Paths& paths) const {
    return scene_there_ ? problem_.home : paths.lift.waypoints.back();
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

  bool plan_motions(const Checkers& checkers, const std::vector<Eigen::VectorXd>& releases, Paths& paths) {
    const Eigen::VectorXd& home = problem_.home;
    if (!motion(checkers.before, home, {paths.approach.waypoints.front()}, kTransit, paths.transit)) return false;
    if (releases.empty()) return true;
    if (scene_there_ && !motion(checkers.holding, paths.lift.waypoints.back(), {home}, kStow, paths.stow)) return false;
    return motion(checkers.releasing, before_transfer(paths), releases, kTransfer, paths.transfer) &&
           motion(checkers.after, paths.transfer.waypoints.back(), {home}, kRetreat, paths.retreat);
  }

  std::vector<PlannedMotion> motions_of(const Checkers& checkers, const Paths& paths) const {
    std::vector<PlannedMotion> motions{{MotionKind::transit, kTransit, paths.transit, checkers.before, false, false},
                                       {MotionKind::approach, kApproach, paths.approach, checkers.before, false, true},
                                       {MotionKind::lift, kLift, paths.lift, checkers.lifting, true, true}};
    if (problem_.places.empty()) return motions;
    if (scene_there_) motions.push_back({MotionKind::stow, kStow, paths.stow, checkers.holding, true, false});
    motions.push_back({MotionKind::transfer, kTransfer, paths.transfer, checkers.releasing, true, false});
    motions.push_back({MotionKind::retreat, kRetreat, paths.retreat, checkers.after, false, false});
    return motions;
  }

  bool finish(int grasp, double width, double opening, const Checkers& checkers, const Paths& paths) {
    TimingOptions line;
    line.max_deviation = kLineDeviation;
    bool held = true;
    const std::vector<PlannedMotion> planned = motions_of(checkers, paths);
    for (const PlannedMotion& motion : planned) {
      const TimingOptions& options = motion.straight ? line : TimingOptions();
      JointTrajectory trajectory =
          time_parameterize_free(motion.checker, motion.path, options, kTimedStep, {monitor_.stop, {}});
      if (motion.holds && problem_.gripper.suction)
        held = slow_to_hold(motion.checker.group(), load_at(grasp), trajectory) && held;
      pick_.motions.push_back({motion.kind, motion.holds ? width : opening, motion.holds, std::move(trajectory)});
    }
    if (!held) {
      pick_.motions.clear();
      return fell(kLift);
    }
    join_motions(problem_.arm.wraps(), problem_.home, pick_.motions);
    for (std::size_t i = 0; i < planned.size(); ++i) {
      if (trajectory_free(planned[i].checker, pick_.motions[i].trajectory)) continue;
      pick_.motions.clear();
      return fell(planned[i].stage);
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
  const std::function<bool(int)>& carries_;
  PickScene scene_;
  std::optional<PickProblem> problem_there_;  ///< Set where the object is released from another base pose.
  std::optional<PickScene> scene_there_;
  std::vector<int> refused_;  ///< Grasps with which no drive to the place was found.
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

Pick search_pick(const PickProblem& problem, const ReachDatabase& database, const Monitor& monitor, bool thorough,
                 const std::function<bool(int)>& carries) {
  Monitor quiet;
  quiet.stop = monitor.stop;
  return PickPlanner(problem, database, quiet, carries).run(thorough ? 2 : 1);
}

}  // namespace mmgrasp::detail
