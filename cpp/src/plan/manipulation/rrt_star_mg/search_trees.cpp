#include "plan/manipulation/rrt_star_mg/search_trees.hpp"

#include <cstddef>
#include <utility>

namespace mmgrasp::detail {

void append_search_trees(const GraspTrees& trees, std::vector<SearchTree>& out) {
  const GraspEnds& ends = trees.ends();
  for (int grasp = 0; grasp < ends.size(); ++grasp)
    for (const int side : {GraspEnds::kStart, GraspEnds::kGoal}) {
      std::vector<int> column(trees.vertex_count(), -1), members;
      trees.each_in_tree(GraspTrees::tree(grasp, side), [&](int v) {
        column[v] = static_cast<int>(members.size());
        members.push_back(v);
      });
      if (members.empty()) continue;
      SearchTree tree;
      tree.grasp = ends.grasp(grasp);
      tree.from_goal = side == GraspEnds::kGoal;
      tree.vertices.resize(ends.dimension(), static_cast<Eigen::Index>(members.size()));
      tree.costs.resize(tree.vertices.cols());
      for (std::size_t i = 0; i < members.size(); ++i) {
        const GraspTrees::Vertex& vertex = trees.vertex(members[i]);
        tree.vertices.col(static_cast<Eigen::Index>(i)) =
            Eigen::Map<const Eigen::VectorXd>(trees.at(members[i]), ends.dimension());
        tree.costs[static_cast<Eigen::Index>(i)] = vertex.cost;
        tree.parents.push_back(vertex.parent < 0 ? -1 : column[vertex.parent]);
      }
      out.push_back(std::move(tree));
    }
}

}  // namespace mmgrasp::detail
