#pragma once

#include <dlfcn.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "fcl_baseline.hpp"
#include "plan/ompl_plugin/plugin_api.hpp"

namespace bench {

/// The longest motion of any link point between two checks of an edge, as plan_motion bounds it: sum_i bound_i |dq_i|.
struct EdgeSteps {
  Eigen::VectorXd bounds;
  double joint_step = 0.02, workspace_step = 0.005;

  long pieces(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    const Eigen::VectorXd delta = (b - a).cwiseAbs();
    return std::max(1L, static_cast<long>(std::ceil(
                            std::max(delta.maxCoeff() / joint_step, bounds.dot(delta) / workspace_step) - 1e-9)));
  }
};

/// A planner of OMPL through the plugin's own boundary, with FCL for collisions, as people put the two together:
/// edges are checked in the order of OMPL's DiscreteMotionValidator (the end, then ever finer halves).
class OmplBaseline {
 public:
  OmplBaseline(const mmgrasp::JointGroup& group, const mmgrasp::World& world, const EdgeSteps& steps)
      : group_(group), fcl_(group, world, true), steps_(steps) {}

  struct Answer {
    bool solved = false;
    double seconds = 0;
    std::vector<Eigen::VectorXd> path;
  };

  Answer solve(const Eigen::VectorXd& start, const std::vector<Eigen::VectorXd>& goals, double range, unsigned seed,
               double limit) {
    std::vector<double> ends;
    for (const Eigen::VectorXd& goal : goals) ends.insert(ends.end(), goal.begin(), goal.end());
    const Eigen::VectorXd lower = group_.sample_lower(), upper = group_.sample_upper();
    std::vector<double> turns;
    for (const bool wraps : group_.wraps()) turns.push_back(wraps ? 2 * M_PI : 0);
    answer_ = {};
    MmgraspOmplProblem problem{};
    problem.planner = "ompl_rrt_connect";
    problem.size = group_.size();
    problem.lower = lower.data();
    problem.upper = upper.data();
    problem.turns = turns.data();
    problem.start = start.data();
    problem.goal_count = static_cast<int>(goals.size());
    problem.goals = ends.data();
    problem.range = range;
    problem.seed = seed;
    problem.max_iterations = 100000000;
    problem.time_limit = limit;
    problem.user = this;
    problem.is_free = [](void* user, const double* q) { return self(user).free(q) ? 1 : 0; };
    problem.edge_is_free = [](void* user, const double* a, const double* b) {
      return self(user).edge_free(a, b) ? 1 : 0;
    };
    problem.stopped = [](void*) { return 0; };
    problem.waypoint = [](void* user, const double* q) {
      self(user).answer_.path.push_back(Eigen::Map<const Eigen::VectorXd>(q, self(user).group_.size()));
    };
    problem.fail = [](void*, const char* message) { std::fprintf(stderr, "OMPL: %s\n", message); };
    const auto begin = std::chrono::steady_clock::now();
    answer_.solved = plugin().solve(&problem) == MMGRASP_OMPL_SOLVED;
    answer_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return answer_;
  }

 private:
  static OmplBaseline& self(void* user) { return *static_cast<OmplBaseline*>(user); }

  static const MmgraspOmplApi& plugin() {
    static const MmgraspOmplApi* const api = [] {
      void* handle = dlopen(MMGRASP_OMPL_PLUGIN, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
      if (!handle) throw std::runtime_error(dlerror());
      return reinterpret_cast<const MmgraspOmplApi* (*)()>(dlsym(handle, kMmgraspOmplApiSymbol))();
    }();
    return *api;
  }

  bool free(const double* q) { return fcl_.is_free(Eigen::Map<const Eigen::VectorXd>(q, group_.size())); }

  bool edge_free(const double* a, const double* b) {
    const Eigen::Map<const Eigen::VectorXd> from(a, group_.size()), to(b, group_.size());
    if (!fcl_.is_free(to)) return false;
    const long pieces = steps_.pieces(from, to);
    // Halves, breadth first: (low, high) have been looked at.
    queue_.clear();
    queue_.push_back({0, pieces});
    for (std::size_t next = 0; next < queue_.size(); ++next) {
      const auto [low, high] = queue_[next];
      if (high - low < 2) continue;
      const long middle = (low + high) / 2;
      if (!fcl_.is_free(from + (to - from) * (static_cast<double>(middle) / static_cast<double>(pieces)))) return false;
      queue_.push_back({low, middle});
      queue_.push_back({middle, high});
    }
    return true;
  }

  mmgrasp::JointGroup group_;
  FclBaseline fcl_;
  EdgeSteps steps_;
  std::vector<std::pair<long, long>> queue_;
  Answer answer_;
};

}  // namespace bench
