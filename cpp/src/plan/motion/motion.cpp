#include "mmgrasp/plan/motion.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "plan/motion/beyond_limits.hpp"
#include "plan/motion/joint_angles.hpp"
#include "plan/motion/motion_edges.hpp"
#include "plan/motion/motion_goals.hpp"
#include "plan/motion/ompl_bridge.hpp"
#include "plan/motion/rrt_connect.hpp"
#include "plan/motion/shortening.hpp"

namespace mmgrasp {
namespace {

using detail::nearest_turn;

constexpr const char* kOwnPlanner = "rrt_connect";
constexpr int kMaxSearches = 4;  // Searches at most, when paths fail the final check.
constexpr double kNearEnds =
    detail::kPi / 2;                    // Distance from start and goal within which joints are mostly drawn [rad or m].
constexpr double kFinalResolution = 8;  // Resolution factor of the check of paths before they are returned.

void check_planner_name(const std::string& name) {
  if (name == kOwnPlanner) return;
  const std::vector<std::string> names = planner_names();
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  std::string known;
  for (const auto& n : names) known += (known.empty() ? "" : ", ") + n;
  require(false, "planner", "\"" + name + "\"", "must be one of " + known);
}

/// Such a planner searches at the final resolution from the start: it has no budget left for a second search when its
/// path fails the final check, and the shortest of many paths is the one that grazes obstacles.
bool keeps_improving(const std::string& name) {
  if (name == kOwnPlanner) return false;
  const std::vector<detail::OmplPlanner> planners = detail::ompl_planners();
  return std::any_of(planners.begin(), planners.end(),
                     [&](const auto& planner) { return planner.name == name && planner.keeps_improving; });
}

/// One call of plan_motion.
class MotionSearch {
 public:
  MotionSearch(CollisionChecker& checker, const Eigen::VectorXd& start, const MotionGoals& goals,
               const MotionOptions& options, const Monitor& monitor)
      : checker_(checker),
        edges_(checker, options),
        wraps_(checker.group().wraps()),
        start_(start),
        goals_(goals),
        options_(options),
        monitor_(monitor),
        keeps_improving_(keeps_improving(options.planner)),
        queries_before_(checker.queries()) {}

  MotionResult run() {
    find_path();
    result_.stats.seconds = stopwatch_.seconds();
    result_.stats.collision_queries = checker_.queries() - queries_before_;
    return std::move(result_);
  }

 private:
  void find_path() {
    monitor_.report("plan motion", 0.0);
    if (!start_is_valid() || !find_goals()) return;
    if (try_straight_edges()) return;
    if (monitor_.stopped()) return end(Outcome::stopped);
    search();
  }

  void end(Outcome outcome) { result_.outcome = outcome; }

  bool start_is_valid() {
    const Rejection cause = edges_.rejection(start_);
    if (cause == Rejection::none) return true;
    result_.rejections.add(cause);
    if (cause == Rejection::limits) result_.beyond_limits = detail::beyond_limits(checker_.group(), start_);
    result_.contacts = checker_.contacts(start_);
    end(Outcome::invalid_start);
    return false;
  }

  /// Keeps the allowed goals, nearest first; equally near ones in the caller's order.
  bool find_goals() {
    ends_ = detail::allowed_goals(edges_, goals_, options_, monitor_, result_.rejections, result_.contacts);
    if (ends_.empty()) {
      for (std::size_t i = 0; i < goals_.configurations.size() && result_.beyond_limits.empty(); ++i)
        result_.beyond_limits = detail::beyond_limits(checker_.group(), goals_.configurations[i]);
      end(monitor_.stopped() ? Outcome::stopped : Outcome::invalid_goal);
      return false;
    }
    result_.contacts.clear();
    std::stable_sort(ends_.begin(), ends_.end(),
                     [&](const auto& a, const auto& b) { return distance(a.q) < distance(b.q); });
    return true;
  }

  double distance(const Eigen::VectorXd& q) const { return (nearest_turn(wraps_, start_, q) - start_).norm(); }
  double time_left() const { return options_.time_limit - stopwatch_.seconds(); }

  bool try_straight_edges() {
    for (const auto& goal : ends_) {
      if (monitor_.stopped()) return false;
      JointPath path{{start_}};
      edges_.connect(start_, nearest_turn(wraps_, start_, goal.q), path.waypoints);
      if (!is_free(path)) continue;
      result_.stats.length_before_shortening = path.length();
      finish(std::move(path));
      return true;
    }
    return false;
  }

  void search() {
    for (int round = 0; round < kMaxSearches; ++round) {
      // A path that fails the final check has cut an obstacle: later searches check at its resolution.
      const double resolution = round == 0 && !keeps_improving_ ? 1 : kFinalResolution;
      const detail::PlannerAnswer answer = run_planner(resolution, round);
      if (monitor_.stopped()) return end(Outcome::stopped);
      if (!answer.solved) return end(answer.exhausted ? Outcome::infeasible : Outcome::timeout);
      monitor_.report("plan motion", 0.6);
      const JointPath found = continuous(answer.waypoints);
      result_.stats.length_before_shortening = found.length();
      if (options_.shorten && finish_shortened(found, resolution)) return;
      if (monitor_.stopped()) return end(Outcome::stopped);
      if (is_free(found)) {
        if (options_.shorten && finish_shortened(found, kFinalResolution)) return;
        return finish(found);
      }
    }
    end(Outcome::timeout);
  }

  detail::PlannerAnswer run_planner(double resolution, int round) {
    detail::PlannerQuery query;
    query.planner = options_.planner;
    query.lower = checker_.group().sample_lower();
    query.upper = checker_.group().sample_upper();
    if (checker_.group().has_base()) bound_base(query);
    query.wraps = wraps_;
    query.start = detail::wrapped(wraps_, start_);
    prefer_samples_near_ends(query);
    for (const auto& goal : ends_) query.goals.push_back(detail::wrapped(wraps_, goal.q));
    query.range = options_.range;
    query.seed = options_.seed + 7919u * static_cast<unsigned>(round);
    query.max_iterations = options_.max_iterations;
    query.time_limit = std::clamp(time_left(), 1e-3, 1e7);
    query.stopped = [&] { return monitor_.stopped(); };
    query.is_free = [&](const Eigen::VectorXd& q) { return edges_.is_free(q); };
    query.edge_is_free = [&, resolution](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      return edges_.edge_is_free(a, b, resolution);
    };
    if (edges_.constrained()) query.project = [&](Eigen::VectorXd& q) { return edges_.project(q); };
    if (options_.planner == kOwnPlanner) return detail::rrt_connect(query);
    if (options_.on_improvement && keeps_improving_) {
      query.on_improvement = [&](const std::vector<Eigen::VectorXd>& waypoints) { report(continuous(waypoints)); };
    }
    return detail::solve_with_ompl(query);
  }

  void report(const JointPath& path) {
    const double cost = path.length();
    if (!options_.on_improvement || cost >= best_reported_) return;
    best_reported_ = cost;
    options_.on_improvement({stopwatch_.seconds(), cost, -1, path});
  }

  /// Base positions are drawn around start and goals only, not in the whole workspace.
  void bound_base(detail::PlannerQuery& query) const {
    for (Eigen::Index i = 0; i < 2; ++i) {
      double low = start_[i], high = start_[i];
      for (const auto& goal : ends_) {
        low = std::min(low, goal.q[i]);
        high = std::max(high, goal.q[i]);
      }
      query.lower[i] = std::max(query.lower[i], low - options_.base_margin);
      query.upper[i] = std::min(query.upper[i], high + options_.base_margin);
    }
  }

  /// Most paths lead through the joint angles between the ends: a joint that may turn twice has many others.
  void prefer_samples_near_ends(detail::PlannerQuery& query) const {
    const Eigen::VectorXd &a = start_, &b = ends_.front().q;
    query.near_lower = query.lower;
    query.near_upper = query.upper;
    for (Eigen::Index i = checker_.group().has_base() ? 2 : 0; i < start_.size(); ++i) {
      query.near_lower[i] = std::max(query.lower[i], std::min(a[i], b[i]) - kNearEnds);
      query.near_upper[i] = std::min(query.upper[i], std::max(a[i], b[i]) + kNearEnds);
    }
  }

  /// The planner's waypoints as continuous numbers that begin at the caller's start and end at a goal up to full turns.
  JointPath continuous(const std::vector<Eigen::VectorXd>& waypoints) const {
    JointPath path{{start_}};
    for (std::size_t i = 1; i < waypoints.size(); ++i) {
      const bool last = i + 1 == waypoints.size();
      const Eigen::VectorXd& from = path.waypoints.back();
      const Eigen::VectorXd& to = last ? ends_[nearest_end(waypoints[i])].q : waypoints[i];
      const Eigen::VectorXd target = nearest_turn(wraps_, from, to);
      edges_.connect(Eigen::VectorXd(from), target, path.waypoints);
    }
    return path;
  }

  std::size_t nearest_end(const Eigen::VectorXd& q) const {
    const auto off = [&](const auto& goal) { return (nearest_turn(wraps_, q, goal.q) - q).norm(); };
    const auto nearest =
        std::min_element(ends_.begin(), ends_.end(), [&](const auto& a, const auto& b) { return off(a) < off(b); });
    return static_cast<std::size_t>(nearest - ends_.begin());
  }

  bool finish_shortened(const JointPath& found, double resolution) {
    JointPath path = found;
    Rng rng(options_.seed, 1);
    detail::ShorteningOptions shortening;
    shortening.iterations = options_.shorten_iterations;
    shortening.resolution = resolution;
    shortening.stopped = [&] { return monitor_.stopped() || time_left() < 0; };
    detail::shorten_path(edges_, path, rng, shortening);
    if (monitor_.stopped() || !is_free(path)) return false;
    finish(std::move(path));
    return true;
  }

  bool is_free(const JointPath& path) {
    for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
      if (monitor_.stopped()) return false;
      if (!edges_.straight_is_free(path.waypoints[i], path.waypoints[i + 1], kFinalResolution)) return false;
    }
    return true;
  }

  void finish(JointPath path) {
    result_.goal_index = ends_[nearest_end(path.waypoints.back())].goal;
    result_.cost = path.length();
    report(path);
    result_.path = std::move(path);
    end(Outcome::solved);
    monitor_.report("plan motion", 1.0);
  }

  CollisionChecker& checker_;
  detail::MotionEdges edges_;
  const std::vector<bool> wraps_;
  const Eigen::VectorXd& start_;
  const MotionGoals& goals_;
  const MotionOptions& options_;
  const Monitor& monitor_;
  const bool keeps_improving_;
  const detail::Stopwatch stopwatch_;
  const std::size_t queries_before_;
  std::vector<detail::GoalConfiguration> ends_;
  double best_reported_ = detail::kInfinity;
  MotionResult result_;
};

}  // namespace

std::vector<std::string> planner_names() {
  std::vector<std::string> names{kOwnPlanner};
  for (auto& planner : detail::ompl_planners()) names.push_back(std::move(planner.name));
  return names;
}

MotionResult plan_motion_to(CollisionChecker& checker, const Eigen::VectorXd& start, const MotionGoals& goals,
                            const MotionOptions& options, const Monitor& monitor) {
  options.check();
  check_planner_name(options.planner);
  checker.group().check_configuration(start, "start");
  require(!goals.configurations.empty() || !goals.tool_poses.empty() || !goals.regions.empty(), "goals", "[]",
          "must hold at least one configuration, pose or region");
  for (std::size_t g = 0; g < goals.configurations.size(); ++g) {
    checker.group().check_configuration(goals.configurations[g], "goals[" + std::to_string(g) + "]");
  }
  for (std::size_t g = 0; g < goals.tool_poses.size(); ++g) {
    checked_pose(goals.tool_poses[g].matrix(), "tool_poses[" + std::to_string(g) + "]");
  }
  for (std::size_t g = 0; g < goals.regions.size(); ++g) {
    goals.regions[g].check("regions[" + std::to_string(g) + "]");
  }
  return MotionSearch(checker, start, goals, options, monitor).run();
}

MotionResult plan_motion(CollisionChecker& checker, const Eigen::VectorXd& start,
                         const std::vector<Eigen::VectorXd>& goals, const MotionOptions& options,
                         const Monitor& monitor) {
  MotionGoals ends;
  ends.configurations = goals;
  return plan_motion_to(checker, start, ends, options, monitor);
}

}  // namespace mmgrasp
