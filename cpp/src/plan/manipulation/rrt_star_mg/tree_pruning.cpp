#include "plan/manipulation/rrt_star_mg/tree_pruning.hpp"

#include <vector>

namespace mmgrasp::detail {
namespace {

constexpr double kRounding = 1e-9;  // Relative, of estimates: the best path's own vertices stay.

}  // namespace

void prune_and_reassign(const Incumbent& incumbent, GraspTrees& trees, InformedUnion& informed, TreeSampler& sampler) {
  const auto on_remove = [&](int v) {
    const GraspTrees::Vertex& vertex = trees.vertex(v);
    if (vertex.parent >= 0 && !trees.has_duplicate(v)) sampler.reassign(vertex.configuration);
  };
  const int before = informed.grasps();
  informed.set_cost(incumbent.cost_to_beat());
  std::vector<int> members;
  for (int grasp = informed.grasps(); grasp < before; ++grasp)
    for (const int side : {GraspEnds::kStart, GraspEnds::kGoal}) {
      members.clear();
      trees.each_in_tree(GraspTrees::tree(grasp, side), [&](int v) { members.push_back(v); });
      for (const int v : members)
        if (trees.vertex(v).alive && trees.vertex(v).parent < 0) trees.remove_below(v, on_remove);
    }
  const double bound = incumbent.cost * (1 + kRounding);
  for (int v = 0; v < trees.vertex_count(); ++v) {
    for (int u = v; u >= 0;) {
      const GraspTrees::Vertex& vertex = trees.vertex(u);
      if (!vertex.alive || vertex.first_child >= 0 || vertex.parent < 0 || vertex.estimate <= bound) break;
      const int parent = vertex.parent;
      on_remove(u);
      trees.remove_leaf(u);
      u = parent;
    }
  }
}

}  // namespace mmgrasp::detail
