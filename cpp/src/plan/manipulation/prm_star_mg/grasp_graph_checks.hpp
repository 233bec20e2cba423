#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "plan/manipulation/common/transfer_checks.hpp"
#include "plan/manipulation/prm_star_mg/grasp_graph.hpp"

namespace mmgrasp::detail {

/// Checks the paths found last of several grasps at once, cheap questions first, side by side. What is asked depends on
/// the paths alone and every answer on its question alone, so that what is known afterwards is the same at any number
/// of threads.
class GraspGraphChecks {
 public:
  GraspGraphChecks(const Roadmap& roadmap, TransferChecks& checks, std::vector<EdgeValidityCache>& knowledge,
                   int threads, const Monitor& monitor, ManipulationStats& stats);

  /// Whether each path is free; what was learned goes to the graphs and to the robot's knowledge. When stopped on the
  /// way, answers and knowledge are worth nothing.
  std::vector<char> check(const std::vector<GraspGraph*>& paths);

 private:
  struct Item {
    int path;
    int what;  ///< A node, or the place of a step in the path.
  };
  void vertices_for_robot();
  void vertices_for_held();
  void samples();
  void edges_for_robot();
  void edges_for_held();

  /// One thread unless there are at least `worth` items.
  void run(std::size_t count, std::size_t worth, const std::function<void(std::size_t, int)>& work);
  /// Steps that the object in hand is not known to pass, of paths not yet found blocked.
  std::vector<Item> open_steps() const;
  /// Of these, edges of the roadmap that nobody asked about yet for the robot alone, each once, and links.
  std::vector<Item> open_steps_of_robot() const;
  GraspGraph& overlay_of(const Item& item) const;
  Step step_of(const Item& item) const;
  std::pair<Eigen::VectorXd, Eigen::VectorXd> ends(const Item& step) const;
  void take_step_of_robot(const Item& item, bool is_free);
  /// Whether the robot alone is known not to pass one of the path's steps.
  bool robot_blocks(const GraspGraph& graph) const;
  /// What the object in hand says of steps; unless `final`, free steps stay open.
  void take_steps(const std::vector<Item>& items, const std::vector<char>& answers, bool final);
  EdgeValidityCache& robot_of(const GraspGraph& graph) const { return knowledge_[graph.candidate.opening]; }

  const Roadmap& roadmap_;
  TransferChecks& checks_;
  std::vector<EdgeValidityCache>& knowledge_;
  int threads_;
  Monitor stop_;  ///< Silent.
  ManipulationStats& stats_;
  const std::vector<GraspGraph*>* paths_ = nullptr;
  std::vector<char> live_;
};

}  // namespace mmgrasp::detail
