#include "plan/manipulation/rrt_star_mg/tree_repair.hpp"

#include <algorithm>
#include <cstddef>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kMaxParentsTried = 8;  // Edges checked for one vertex; its neighbours below may have others.

}  // namespace

void TreeRepair::reconnect(int v) {
  members_.clear();
  collect_below(v, members_);
  cut_.resize(trees_.vertex_count(), 0);
  for (const int member : members_) cut_[member] = 1;
  // A vertex takes all below it along; the least bridge is the cheapest edge from those to what remains above them.
  double least = kInfinity;
  std::pair<int, int> bridge(-1, -1);
  for (const int member : members_) {
    if (!cut_[member]) continue;
    const int parent = verified_parent(member);
    if (parent < 0) continue;
    const int above = trees_.vertex(member).parent;
    trees_.reparent(member, parent, trees_.vertex_distance(member, parent));
    adopted_.clear();
    collect_below(member, adopted_);
    for (const int below : adopted_) cut_[below] = 0;
    if (member == v) return;
    const double cost = trees_.vertex(member).cost + trees_.vertex_distance(member, above);
    if (cost >= least) continue;
    least = cost;
    bridge = {above, member};
  }
  for (const int member : members_) cut_[member] = 0;
  if (bridge.first >= 0) return turn_branch(v, bridge.first, bridge.second);
  trees_.remove_below(v, [&](int removed) {
    if (!trees_.has_duplicate(removed)) sampler_.reassign(trees_.vertex(removed).configuration);
  });
}

int TreeRepair::verified_parent(int v) {
  const GraspTrees::Vertex own = trees_.vertex(v);
  near_vertices_.in_tree(own.tree, trees_.at(v), v, near_);
  near_.erase(std::remove_if(near_.begin(), near_.end(),
                             [&](const GraspTrees::Near& entry) { return cut_[entry.vertex] != 0; }),
              near_.end());
  for (GraspTrees::Near& entry : near_) entry.key = trees_.vertex(entry.vertex).cost + entry.distance;
  const auto tried = std::min<std::size_t>(near_.size(), kMaxParentsTried);
  std::partial_sort(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(tried), near_.end(),
                    [](const GraspTrees::Near& a, const GraspTrees::Near& b) { return costlier(b, a); });
  for (std::size_t i = 0; i < tried; ++i)
    if (checks_.edge_is_verified(GraspTrees::grasp_of(own.tree), trees_.vertex(near_[i].vertex).configuration,
                                 own.configuration))
      return near_[i].vertex;
  return -1;
}

void TreeRepair::collect_below(int v, std::vector<int>& out) const {
  out.push_back(v);
  for (std::size_t i = out.size() - 1; i < out.size(); ++i)
    for (int child = trees_.vertex(out[i]).first_child; child >= 0; child = trees_.vertex(child).next_sibling)
      out.push_back(child);
}

void TreeRepair::turn_branch(int v, int last, int parent) {
  for (int at = last;;) {
    const int above = trees_.vertex(at).parent;
    trees_.reparent(at, parent, trees_.vertex_distance(at, parent));
    if (at == v) return;
    parent = at;
    at = above;
  }
}

}  // namespace mmgrasp::detail
