#include "mmgrasp/plan/motion.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "plan/joint_angles.hpp"
#include "plan/ompl_bridge.hpp"
#include "plan/shortening.hpp"

namespace mmgrasp {
namespace {

using Clock = std::chrono::steady_clock;
using detail::nearest_turn;

constexpr int kAttempts = 4;  // Searches, when paths fail the finer check.

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void check_planner_name(const std::string& name) {
  const std::vector<std::string> names = planner_names();
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  std::string known;
  for (const auto& n : names) known += (known.empty() ? "" : ", ") + n;
  require(false, "planner", "\"" + name + "\"", "must be one of " + known);
}

/// One call of plan_motion.
class MotionSearch {
 public:
  MotionSearch(CollisionChecker& checker, const Eigen::VectorXd& start, const std::vector<Eigen::VectorXd>& goals,
               const MotionOptions& options, const Monitor& monitor)
      : checker_(checker),
        wraps_(checker.group().wraps()),
        start_(start),
        goals_(goals),
        options_(options),
        monitor_(monitor),
        queries_before_(checker.queries()) {}

  MotionResult run() {
    find_path();
    result_.stats.seconds = seconds_since(begin_);
    result_.stats.collision_queries = checker_.queries() - queries_before_;
    return std::move(result_);
  }

 private:
  void find_path() {
    monitor_.report("plan motion", 0.0);
    if (!start_is_valid() || !screen_goals()) return;
    if (try_straight_edges()) return;
    if (monitor_.stopped()) return end(Outcome::stopped);
    search();
  }

  void end(Outcome outcome) { result_.outcome = outcome; }

  bool start_is_valid() {
    if (checker_.is_free(start_)) return true;
    result_.contacts = checker_.contacts(start_);
    end(Outcome::invalid_start);
    return false;
  }

  /// Keeps the free goals, nearest first (as they come among equals).
  bool screen_goals() {
    for (std::size_t g = 0; g < goals_.size(); ++g) {
      const Rejection cause = checker_.rejection(goals_[g]);
      result_.rejections.add(cause);
      if (cause == Rejection::none) {
        free_goals_.push_back(static_cast<int>(g));
      } else if (result_.contacts.empty()) {
        result_.contacts = checker_.contacts(goals_[g]);
      }
    }
    if (free_goals_.empty()) {
      end(Outcome::invalid_goal);
      return false;
    }
    result_.contacts.clear();
    std::stable_sort(free_goals_.begin(), free_goals_.end(), [&](int a, int b) { return distance(a) < distance(b); });
    return true;
  }

  double distance(int goal) const { return (nearest_turn(wraps_, start_, goals_[goal]) - start_).norm(); }
  double fine_step() const { return options_.edge_step / 8; }
  double time_left() const { return options_.time_limit - seconds_since(begin_); }

  bool try_straight_edges() {
    for (int goal : free_goals_) {
      if (monitor_.stopped()) return false;
      JointPath path{{start_, nearest_turn(wraps_, start_, goals_[goal])}};
      if (!is_free(path)) continue;
      result_.stats.length_before_shortening = path.length();
      finish(std::move(path));
      return true;
    }
    return false;
  }

  void search() {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      // A path that fails the finer check has cut a thin obstacle: look more closely from then on.
      const double step = attempt == 0 ? options_.edge_step : fine_step();
      const detail::OmplAnswer answer = ask_planner(step, attempt);
      if (monitor_.stopped()) return end(Outcome::stopped);
      if (!answer.solved) return end(answer.exhausted ? Outcome::infeasible : Outcome::timeout);
      monitor_.report("plan motion", 0.6);
      const JointPath found = continuous(answer.waypoints);
      result_.stats.length_before_shortening = found.length();
      if (options_.shorten && finish_shortened(found, step)) return;
      if (monitor_.stopped()) return end(Outcome::stopped);
      if (is_free(found)) {
        if (options_.shorten && finish_shortened(found, fine_step())) return;
        return finish(found);
      }
    }
    end(Outcome::timeout);
  }

  detail::OmplAnswer ask_planner(double step, int attempt) {
    detail::OmplQuery query;
    query.planner = options_.planner;
    query.lower = checker_.group().sample_lower();
    query.upper = checker_.group().sample_upper();
    if (checker_.group().has_base()) bound_base(query);
    query.wraps = wraps_;
    query.start = detail::wrapped(wraps_, start_);
    for (int goal : free_goals_) query.goals.push_back(detail::wrapped(wraps_, goals_[goal]));
    query.range = options_.range;
    query.seed = options_.seed + 7919u * static_cast<unsigned>(attempt);
    query.max_iterations = options_.max_iterations;
    query.time_limit = std::clamp(time_left(), 1e-3, 1e7);
    query.is_free = [&](const Eigen::VectorXd& q) { return checker_.is_free(q); };
    query.edge_is_free = [&, step](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      return checker_.edge_is_free(a, nearest_turn(wraps_, a, b), step);
    };
    query.stopped = [&] { return monitor_.stopped(); };
    return detail::solve_with_ompl(query);
  }

  /// Base positions are drawn around start and goals only, not in the whole workspace.
  void bound_base(detail::OmplQuery& query) const {
    for (Eigen::Index i = 0; i < 2; ++i) {
      double low = start_[i], high = start_[i];
      for (int goal : free_goals_) {
        low = std::min(low, goals_[goal][i]);
        high = std::max(high, goals_[goal][i]);
      }
      query.lower[i] = std::max(query.lower[i], low - options_.base_margin);
      query.upper[i] = std::min(query.upper[i], high + options_.base_margin);
    }
  }

  /// The planner's waypoints as continuous numbers that begin at the caller's start and end at a goal up to full turns.
  JointPath continuous(const std::vector<Eigen::VectorXd>& waypoints) const {
    JointPath path{{start_}};
    for (std::size_t i = 1; i < waypoints.size(); ++i) {
      path.waypoints.push_back(nearest_turn(wraps_, path.waypoints.back(), waypoints[i]));
    }
    Eigen::VectorXd& last = path.waypoints.back();
    last = nearest_turn(wraps_, last, goals_[goal_reached(last)]);
    return path;
  }

  int goal_reached(const Eigen::VectorXd& q) const {
    const auto off = [&](int goal) { return (nearest_turn(wraps_, q, goals_[goal]) - q).norm(); };
    return *std::min_element(free_goals_.begin(), free_goals_.end(), [&](int a, int b) { return off(a) < off(b); });
  }

  bool finish_shortened(const JointPath& found, double step) {
    JointPath path = found;
    Rng rng(options_.seed, 1);
    detail::ShorteningOptions shortening;
    shortening.iterations = options_.shorten_iterations;
    shortening.edge_step = step;
    shortening.stopped = [&] { return monitor_.stopped() || time_left() < 0; };
    detail::shorten_path(checker_, path, rng, shortening);
    if (monitor_.stopped() || !is_free(path)) return false;
    finish(std::move(path));
    return true;
  }

  bool is_free(const JointPath& path) {
    for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
      if (monitor_.stopped()) return false;
      if (!checker_.edge_is_free(path.waypoints[i], path.waypoints[i + 1], fine_step())) return false;
    }
    return true;
  }

  void finish(JointPath path) {
    result_.goal_index = goal_reached(path.waypoints.back());
    result_.cost = path.length();
    result_.path = std::move(path);
    end(Outcome::solved);
    monitor_.report("plan motion", 1.0);
  }

  CollisionChecker& checker_;
  const std::vector<bool> wraps_;
  const Eigen::VectorXd& start_;
  const std::vector<Eigen::VectorXd>& goals_;
  const MotionOptions& options_;
  const Monitor& monitor_;
  const Clock::time_point begin_ = Clock::now();
  const std::size_t queries_before_;
  std::vector<int> free_goals_;
  MotionResult result_;
};

}  // namespace

void MotionOptions::check() const {
  require(time_limit > 0, "time_limit", time_limit, "must be > 0");
  require(max_iterations > 0, "max_iterations", max_iterations, "must be > 0");
  require(std::isfinite(range) && range >= 0, "range", range, "must be finite and >= 0");
  require(std::isfinite(edge_step) && edge_step > 0, "edge_step", edge_step, "must be finite and > 0");
  require(std::isfinite(base_margin) && base_margin > 0, "base_margin", base_margin, "must be finite and > 0");
  require(shorten_iterations >= 0, "shorten_iterations", shorten_iterations, "must be >= 0");
}

std::vector<std::string> planner_names() {
  return detail::ompl_planner_names();
}

MotionResult plan_motion(CollisionChecker& checker, const Eigen::VectorXd& start,
                         const std::vector<Eigen::VectorXd>& goals, const MotionOptions& options,
                         const Monitor& monitor) {
  options.check();
  check_planner_name(options.planner);
  checker.group().check_configuration(start, "start");
  require(!goals.empty(), "goals", "[]", "must hold at least one configuration");
  for (std::size_t g = 0; g < goals.size(); ++g) {
    checker.group().check_configuration(goals[g], "goals[" + std::to_string(g) + "]");
  }
  return MotionSearch(checker, start, goals, options, monitor).run();
}

}  // namespace mmgrasp
