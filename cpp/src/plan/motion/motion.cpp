#include "mmgrasp/plan/motion.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/detail/joint_metric.hpp"
#include "plan/motion/beyond_limits.hpp"
#include "plan/motion/free_edges.hpp"
#include "plan/motion/motion_edges.hpp"
#include "plan/motion/motion_goals.hpp"
#include "plan/motion/ompl_bridge.hpp"
#include "plan/motion/redundant_waypoints.hpp"
#include "plan/motion/rrt_connect.hpp"
#include "plan/motion/shortening.hpp"

namespace mmgrasp {
namespace {

constexpr const char* kOwnPlanner = "rrt_connect";
constexpr int kMaxSearches = 4;  // Searches at most, when paths fail the final check.
// OMPL's planners get no more whole turns of goals, the nearest ones: its heuristics look at all goals for each state.
constexpr std::size_t kMaxOmplGoals = 64;
constexpr double kNearEnds =
    detail::kPi / 2;  // Distance from start and goal within which joints are mostly drawn [rad or m].
// Resolution factors of the check of paths before they are returned. Proven intervals make it cheap for single paths; a
// planner that keeps improving checks every edge as finely.
constexpr double kFinalResolution = 64, kFinalWhileImproving = 8;

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
        metric_(edges_.metric()),
        start_(start),
        goals_(goals),
        options_(options),
        monitor_(monitor),
        keeps_improving_(keeps_improving(options.planner)),
        final_resolution_(keeps_improving_ ? kFinalWhileImproving : kFinalResolution),
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
    ends_ = detail::allowed_goals(edges_, start_, goals_, options_, monitor_, result_.rejections, result_.contacts);
    if (ends_.empty()) {
      for (std::size_t i = 0; i < goals_.configurations.size() && result_.beyond_limits.empty(); ++i)
        result_.beyond_limits = detail::beyond_limits(checker_.group(), goals_.configurations[i]);
      end(monitor_.stopped() ? Outcome::stopped : Outcome::invalid_goal);
      return false;
    }
    result_.contacts.clear();
    std::stable_sort(ends_.begin(), ends_.end(),
                     [&](const auto& a, const auto& b) { return distance(a.q) < distance(b.q); });
    if (options_.planner != kOwnPlanner) drop_far_turns();
    return true;
  }

  void drop_far_turns() {
    std::size_t kept = 0;
    const auto is_too_many = [&](const auto& goal) { return ++kept > kMaxOmplGoals && goal.turned; };
    ends_.erase(std::remove_if(ends_.begin(), ends_.end(), is_too_many), ends_.end());
  }

  double distance(const Eigen::VectorXd& q) const { return metric_.distance(q, start_); }
  double time_left() const { return options_.time_limit - stopwatch_.seconds(); }

  bool try_straight_edges() {
    for (const auto& goal : ends_) {
      if (monitor_.stopped()) return false;
      // What blocks the way to the nearest turn mostly blocks longer ones, too. But BIT* crashes when it finds a
      // straight path by itself: rounding makes it prune the goal.
      if (goal.turned && options_.planner == kOwnPlanner) continue;
      JointPath path{{start_}};
      edges_.connect(start_, metric_.nearest(start_, goal.q), path.waypoints);
      if (!is_free(path)) continue;
      result_.stats.length_before_shortening = metric_.length(path.waypoints);
      finish(std::move(path));
      return true;
    }
    return false;
  }

  void search() {
    for (int round = 0; round < kMaxSearches; ++round) {
      // A path that fails the final check has cut an obstacle: later searches check at its resolution.
      const double resolution = round == 0 && !keeps_improving_ ? 1 : final_resolution_;
      const detail::PlannerAnswer answer = run_planner(resolution, round);
      if (monitor_.stopped()) return end(Outcome::stopped);
      if (!answer.solved) return end(answer.exhausted ? Outcome::not_found : Outcome::timeout);
      monitor_.report("plan motion", 0.6);
      const JointPath found = continuous(answer.waypoints);
      result_.stats.length_before_shortening = metric_.length(found.waypoints);
      if (options_.shorten && finish_shortened(found, resolution)) return;
      if (monitor_.stopped()) return end(Outcome::stopped);
      if (is_free(found)) {
        if (options_.shorten && finish_shortened(found, final_resolution_)) return;
        return finish(found);
      }
    }
    end(Outcome::not_found);
  }

  detail::PlannerAnswer run_planner(double resolution, int round) {
    detail::PlannerQuery query;
    query.planner = options_.planner;
    query.lower = checker_.group().sample_lower();
    query.upper = checker_.group().sample_upper();
    if (checker_.group().has_base()) bound_base(query);
    query.metric = metric_;
    // Ends beyond a limit by less than the checker's slack are on it.
    const auto within = [&](const Eigen::VectorXd& q) -> Eigen::VectorXd {
      return metric_.wrapped(q).cwiseMax(query.lower).cwiseMin(query.upper);
    };
    query.start = within(start_);
    prefer_samples_near_ends(query);
    for (const auto& goal : ends_) {
      query.goals.push_back(within(goal.q));
      query.turned_goals += goal.turned;
    }
    query.range = options_.range * metric_.unit();
    query.near_end_probability = options_.near_end_probability;
    query.seed = options_.seed + 7919u * static_cast<unsigned>(round);
    query.max_iterations = options_.max_iterations;
    query.time_limit = std::clamp(time_left(), 1e-3, 1e7);
    query.stopped = [&] { return monitor_.stopped(); };
    query.is_free = [&](const Eigen::VectorXd& q) { return edges_.is_free(q); };
    query.edge_is_free = [&, resolution](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      return edges_.edge_stays_free(a, b, resolution);
    };
    if (edges_.constrained()) query.project = [&](Eigen::VectorXd& q) { return edges_.project(q); };
    if (options_.planner == kOwnPlanner) return detail::rrt_connect(query);
    if (options_.on_improvement && keeps_improving_) {
      query.on_improvement = [&](const std::vector<Eigen::VectorXd>& waypoints) { report(continuous(waypoints)); };
    }
    return detail::solve_with_ompl(query);
  }

  void report(const JointPath& path) {
    const double cost = metric_.length(path.waypoints);
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
      const Eigen::VectorXd target = metric_.nearest(from, to);
      edges_.connect(Eigen::VectorXd(from), target, path.waypoints);
    }
    return path;
  }

  std::size_t nearest_end(const Eigen::VectorXd& q) const {
    const auto off = [&](const auto& goal) { return metric_.distance(goal.q, q); };
    const auto nearest =
        std::min_element(ends_.begin(), ends_.end(), [&](const auto& a, const auto& b) { return off(a) < off(b); });
    return nearest - ends_.begin();
  }

  bool finish_shortened(const JointPath& found, double resolution) {
    JointPath path = found;
    Rng rng(options_.seed, 1);
    detail::FreeEdges known;
    detail::ShorteningOptions shortening;
    shortening.iterations = options_.shorten_iterations;
    shortening.resolution = resolution;
    shortening.stopped = [&] { return monitor_.stopped() || time_left() < 0; };
    shortening.skips_at_end = edges_.steered();
    detail::shorten_path(edges_, path, rng, shortening);
    if (!edges_.steered()) {
      detail::remove_redundant_waypoints(path.waypoints, [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
        if (shortening.stopped() || !edges_.straight_stays_free(a, b, final_resolution_)) return false;
        known.add(a, b);
        return true;
      });
    }
    if (monitor_.stopped() || !is_free(path, known)) return false;
    finish(std::move(path));
    return true;
  }

  /// The final check; `known` are edges that passed it.
  bool is_free(const JointPath& path, const detail::FreeEdges& known = {}) {
    for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
      if (monitor_.stopped()) return false;
      const Eigen::VectorXd &a = path.waypoints[i], &b = path.waypoints[i + 1];
      if (!known.has(a, b) && !edges_.straight_stays_free(a, b, final_resolution_)) return false;
    }
    return true;
  }

  void finish(JointPath path) {
    result_.goal_index = ends_[nearest_end(path.waypoints.back())].goal;
    result_.cost = metric_.length(path.waypoints);
    report(path);
    result_.path = std::move(path);
    end(Outcome::solved);
    monitor_.report("plan motion", 1.0);
  }

  CollisionChecker& checker_;
  detail::MotionEdges edges_;
  const detail::JointMetric& metric_;
  const Eigen::VectorXd& start_;
  const MotionGoals& goals_;
  const MotionOptions& options_;
  const Monitor& monitor_;
  const bool keeps_improving_;
  const double final_resolution_;
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

namespace {

void check_question(const CollisionChecker& checker, const Eigen::VectorXd& start, const MotionGoals& goals,
                    const MotionOptions& options) {
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
}

}  // namespace

MotionResult plan_motion_to(CollisionChecker& checker, const Eigen::VectorXd& start, const MotionGoals& goals,
                            const MotionOptions& options, const Monitor& monitor) {
  check_question(checker, start, goals, options);
  return MotionSearch(checker, start, goals, options, monitor).run();
}

MotionResult plan_motion_via(CollisionChecker& checker, const Eigen::VectorXd& start,
                             const std::vector<Eigen::VectorXd>& via, const MotionGoals& goals,
                             const MotionOptions& options, const Monitor& monitor) {
  if (via.empty()) return plan_motion_to(checker, start, goals, options, monitor);
  check_question(checker, start, goals, options);
  for (std::size_t i = 0; i < via.size(); ++i)
    checker.group().check_configuration(via[i], "via[" + std::to_string(i) + "]");
  const detail::Stopwatch stopwatch;
  MotionOptions of_segment = options;
  of_segment.on_improvement = {};  // reported for whole paths
  JointPath path{{start}};
  MotionStats stats;
  double cost = 0;
  for (std::size_t segment = 0; segment <= via.size(); ++segment) {
    MotionGoals ends = goals;
    if (segment < via.size()) {
      ends = {};
      ends.configurations = {via[segment]};
    }
    of_segment.time_limit = std::max(1e-3, options.time_limit - stopwatch.seconds());
    MotionResult found = plan_motion_to(checker, path.waypoints.back(), ends, of_segment, monitor);
    stats.collision_queries += found.stats.collision_queries;
    cost += found.cost;
    stats.length_before_shortening += found.stats.length_before_shortening;
    stats.seconds = stopwatch.seconds();
    found.stats = stats;
    found.via_reached = static_cast<int>(segment);
    if (!found.path) return found;
    path.waypoints.insert(path.waypoints.end(), found.path->waypoints.begin() + 1, found.path->waypoints.end());
    if (segment < via.size()) continue;
    found.cost = cost;
    found.path = std::move(path);
    if (options.on_improvement) options.on_improvement({stats.seconds, found.cost, -1, *found.path});
    return found;
  }
  return {};
}

MotionResult plan_motion(CollisionChecker& checker, const Eigen::VectorXd& start,
                         const std::vector<Eigen::VectorXd>& goals, const MotionOptions& options,
                         const Monitor& monitor) {
  MotionGoals ends;
  ends.configurations = goals;
  return plan_motion_to(checker, start, ends, options, monitor);
}

}  // namespace mmgrasp
