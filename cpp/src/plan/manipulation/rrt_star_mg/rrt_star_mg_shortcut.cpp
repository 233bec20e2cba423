// Pulling the paths of grasps taut. Beyond the paper.

#include <cmath>

#include "plan/manipulation/rrt_star_mg/rrt_star_mg.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kOthers = 0.5;    // Corners cut on other grasps' paths.
constexpr double kClose = 0.5;     // Corners cut close to them.
constexpr double kInside = 0.999;  // Points on an edge keep off its end.

}  // namespace

bool RrtStarMg::follow(int grasp) {
  for (auto& chain : chain_) chain.clear();
  const int index = own_[grasp].bridge;
  if (index < 0) return false;
  const Bridge& bridge = bridges_[index];
  if (!trees_.vertex(bridge.a).alive || !trees_.vertex(bridge.b).alive) return false;
  for (int v = bridge.a; v >= 0; v = trees_.vertex(v).parent) chain_[0].push_back(v);
  for (int v = bridge.b; v >= 0; v = trees_.vertex(v).parent) chain_[1].push_back(v);
  return true;
}

// No more than rewiring along the path: each vertex below the earliest one before it that sees
// it.
void RrtStarMg::straighten(int grasp) {
  if (!follow(grasp)) return;
  // Paths that follow one another share most vertices, and most of these edges are blocked.
  const auto sees = [&](int a, int b) {
    const int from = trees_.vertex(a).configuration, to = trees_.vertex(b).configuration;
    if (blocked_.recall(grasp, from, to) == 0) return false;
    const bool free = edge_is_free(grasp, from, to);
    if (!free) blocked_.keep(grasp, from, to, false);
    return free;
  };
  for (const auto& chain : chain_)
    for (std::size_t i = 0; i + 2 < chain.size(); ++i)
      for (std::size_t k = chain.size() - 1; k > i + 1; --k) {
        const double length = apart(chain[i], chain[k]);
        if (trees_.vertex(chain[k]).cost + length >= trees_.vertex(chain[i]).cost * (1 - kBetter)) continue;
        if (!sees(chain[i], chain[k])) continue;
        trees_.reparent(chain[i], chain[k], length);
        break;
      }
  if (!follow(grasp)) return;
  for (std::size_t i = 0; i < chain_[0].size(); ++i)
    for (std::size_t k = 0; k < chain_[1].size(); ++k) {
      const int a = chain_[0][chain_[0].size() - 1 - i], b = chain_[1][chain_[1].size() - 1 - k];
      const double cost = trees_.vertex(a).cost + apart(a, b) + trees_.vertex(b).cost + ends_.cost(grasp);
      if (cost >= best_ * (1 - kBetter) || cost >= cost_of(bridges_[own_[grasp].bridge]) - kSame) continue;
      if (!sees(a, b)) continue;
      add_bridge(a, b);
      return;
    }
}

int RrtStarMg::pick_path() {
  if (!(rng_.uniform() < kOthers) || contenders_.empty()) return best_grasp_;
  const std::size_t at = rng_.index(contenders_.size());
  const int grasp = contenders_[at];
  Own& own = own_[grasp];
  if (grasp < informed_.grasps() && own.bridge >= 0) return grasp;
  contenders_[at] = contenders_.back();
  contenders_.pop_back();
  own = {};
  return -1;
}

bool RrtStarMg::pick_corner(Corner& out) {
  const std::size_t corners = chain_[0].size() + chain_[1].size() - 2;
  if (corners == 0) return false;
  std::size_t at = rng_.index(corners);
  const int side = at < chain_[0].size() - 1 ? 0 : 1;
  if (side == 1) at -= chain_[0].size() - 1;
  const std::vector<int>& chain = chain_[side];
  out = {chain[at + 1], chain[at], at > 0 ? chain[at - 1] : chain_[1 - side].front(), at == 0};
  return true;
}

void RrtStarMg::cut_corner() {
  const int grasp = pick_path();
  if (grasp < 0) return;
  if (!follow(grasp)) return refresh(grasp);
  Corner at;
  if (!pick_corner(at)) return;
  // Far from the corner at first; what is nearly taut can only be cut close to it.
  const bool close = rng_.uniform() < kClose;
  int points[2];
  for (int i = 0; i < 2; ++i) {
    const double drawn = rng_.uniform() * rng_.uniform();
    const double share = close ? drawn : 1 - drawn;
    const double *from = trees_.at(at.corner), *to = trees_.at(i == 0 ? at.before : at.after);
    for (int k = 0; k < ends_.dimension(); ++k) q_[k] = from[k] + (to[k] - from[k]) * share * kInside;
    points[i] = trees_.add_configuration(q_.data());
  }
  if (!edge_is_free(grasp, points[0], points[1])) return;
  const int first = trees_.add(at.before, points[0], length(trees_.vertex(at.before).configuration, points[0]));
  const int second = trees_.add(first, points[1], length(points[0], points[1]));
  if (at.at_bridge) {
    add_bridge(second, at.after);
  } else {
    trees_.reparent(at.after, second, length(points[1], trees_.vertex(at.after).configuration));
  }
  refresh(grasp);
}

}  // namespace mmgrasp::detail
