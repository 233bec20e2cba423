#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "plan/manipulation/common/transfer_checks.hpp"
#include "plan/manipulation/prm_star_mg/grasp_graph.hpp"

namespace mmgrasp::detail {

/// Checks the paths found last of several grasps together, in stages from cheap to costly, each in parallel: vertices
/// for the robot alone, vertices for the object in hand, a few configurations of each edge, edges for the robot alone,
/// edges for the object. A path found blocked leaves the later stages; a vertex or edge that several paths share is
/// checked once for the robot. What is checked depends on the paths alone, and each answer on its query alone, so
/// results and counts are the same at any number of threads.
class GraspGraphChecks {
 public:
  /// `robot_caches`: one per opening.
  GraspGraphChecks(const Roadmap& roadmap, TransferChecks& checks, std::vector<EdgeValidityCache>& robot_caches,
                   int threads, const Monitor& monitor, ManipulationStats& stats);

  /// Whether each path is free. What was found goes to the graphs and to the robot's caches. When stopped meanwhile,
  /// answers, graphs and caches are void.
  std::vector<char> check(const std::vector<GraspGraph*>& paths);

 private:
  /// A place in one of the paths.
  struct Item {
    int path;
    int index;  ///< A roadmap vertex, or a step's index in the path.
  };

  // The stages.
  void check_vertices_for_robot();
  void check_vertices_for_attached();
  void check_edge_samples();
  void check_edges_for_robot();
  void check_edges_for_attached();

  /// Steps not known to be free for the object in hand, of paths not yet found blocked.
  std::vector<Item> unknown_steps() const;
  /// Those of the unknown steps that are links and edges of the roadmap not known to be free for the robot alone, each
  /// once.
  std::vector<Item> unknown_steps_for_robot() const;
  /// Whether a step of the path is known to be blocked for the robot alone.
  bool robot_blocks(const GraspGraph& graph) const;
  void record_step_for_robot(const Item& item, bool is_free);
  /// Steps found blocked block their paths; those found free are recorded only if `complete`, that is, if nothing about
  /// them is left to check.
  void record_steps(const std::vector<Item>& items, const std::vector<char>& answers, bool complete);
  /// Calls `work` for each item; runs in one thread when there are fewer than `min_parallel` items.
  void run(std::size_t count, std::size_t min_parallel, const std::function<void(std::size_t, int)>& work);

  GraspGraph& graph_of(const Item& item) const { return *(*paths_)[item.path]; }
  EdgeValidityCache& robot_of(const GraspGraph& graph) const { return robot_caches_[graph.candidate.opening]; }
  Step step_of(const Item& item) const { return graph_of(item).steps[item.index]; }
  std::pair<Eigen::VectorXd, Eigen::VectorXd> ends_of(const Item& step) const;

  const Roadmap& roadmap_;
  TransferChecks& checks_;
  std::vector<EdgeValidityCache>& robot_caches_;
  int threads_;
  Monitor cancel_;  ///< The caller's token without its progress reports.
  ManipulationStats& stats_;
  const std::vector<GraspGraph*>* paths_ = nullptr;  ///< Argument of check().
  std::vector<char> free_;                           ///< Per path: not found blocked so far.
};

}  // namespace mmgrasp::detail
