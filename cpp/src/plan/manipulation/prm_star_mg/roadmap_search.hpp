#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "plan/manipulation/common/manipulation_planner.hpp"
#include "plan/manipulation/prm_star_mg/grasp_graph_checks.hpp"
#include "plan/manipulation/prm_star_mg/grasp_graph_search.hpp"

namespace mmgrasp::detail {

/// Searches one roadmap for the cheapest free path with any of the grasps (P2 Algorithm 4.3).
class RoadmapSearch {
 public:
  /// Searches for paths over the roadmap, or `straight` from start to goal, that cost less than `best`, which they
  /// replace. Paths of one edge are reported as straight lines, others as found by `stage`.
  RoadmapSearch(const ManipulationInput& input, const Roadmap& roadmap, bool straight, int threads, TransferPath& best,
                ManipulationResult& result, PlanStage stage = PlanStage::roadmap);

  /// False when time ran out before all grasps were searched.
  bool run();

 private:
  struct Entry {
    double key;
    int graph;
    bool searched;  ///< The key is the cost of the grasp's path; otherwise a lower bound.
  };
  static bool later(const Entry& a, const Entry& b) { return a.key != b.key ? a.key > b.key : a.graph > b.graph; }

  GraspGraph& graph(int index) { return graphs_[index]; }
  void push(const Entry& entry);
  void push_straight(int index);
  bool any_promising() const { return !heap_.empty() && heap_.front().key < best_.cost; }
  /// Searches the graph of a grasp. Returns what is left to do with the grasp, if anything.
  std::optional<Entry> find_path(int worker, int index, double bound);
  bool search_batches();
  bool search_batch(int first, int last);
  /// Searches every grasp of the batch before anything is checked, each bounded by the best path and by what can be
  /// spliced from those found before it (P2 lines 6-15).
  bool search_all(int first, int last);
  /// False when time ran out; what is left to do then stays in the heap.
  bool search_heap();
  /// Takes the most promising grasps, checks the paths of those that have one, and searches the others and those whose
  /// path is blocked. A free path becomes the best even while others could still be better.
  void round(std::size_t size);
  /// The final check of a free path, robot and object together in small steps; takes it when it is the best. False when
  /// it fails, since the search stepped over a thin obstacle; the step at fault is then blocked.
  bool accept(int index);

  const ManipulationInput& input_;
  const Roadmap& roadmap_;
  const bool straight_;
  TransferPath& best_;
  ManipulationResult& result_;
  const PlanStage stage_;
  int threads_;
  std::vector<EdgeValidityCache> robot_caches_;  ///< One per opening.
  GraspGraphChecks checks_;
  std::vector<GraspGraphSearch> searches_;  ///< One per worker.
  std::vector<GraspGraph> graphs_;          ///< One per grasp found.
  std::vector<Entry> heap_;
};

}  // namespace mmgrasp::detail
