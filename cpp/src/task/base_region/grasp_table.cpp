#include "task/base_region/grasp_table.hpp"

#include <cmath>
#include <map>

#include "mmgrasp/core/parallel.hpp"
#include "task/base_region/hand_checker.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp::detail {

GraspTable::GraspTable(const PartSupplyProblem& problem) : problem_(&problem) {
  std::map<long, int> known;
  for (const Tray& tray : problem.trays) {
    first_.emplace_back();
    for (const Part& part : tray.parts) {
      first_.back().push_back(static_cast<int>(opening_.size()));
      for (const Grasp& grasp : part.grasps) {
        const double opening = problem.gripper.pregrasp_opening(grasp.opening);
        const auto [it, is_new] = known.emplace(std::lround(opening * 1e9), static_cast<int>(openings_.size()));
        if (is_new) openings_.push_back(opening);
        opening_.push_back(it->second);
      }
    }
  }
  blocked_.assign(opening_.size(), 1);
}

void GraspTable::find_blocked(const std::vector<PartRef>& parts, const World& world) {
  std::vector<CollisionChecker> originals;
  for (double opening : openings_) originals.push_back(hand_checker(*problem_, opening, world));
  const int threads = resolve_threads(problem_->options.threads);
  std::vector<std::vector<CollisionChecker>> checkers(threads);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(1);
  parallel_for(parts.size(), threads, [&](std::size_t item, int worker) {
    const Part& part = part_of(*problem_, parts[item]);
    if (!part.target) return;
    std::vector<CollisionChecker>& own = checkers[worker];
    if (own.empty()) {
      for (const CollisionChecker& checker : originals) own.push_back(checker.clone());
    }
    const std::size_t begin = first(parts[item]);
    for (std::size_t g = 0; g < part.grasps.size(); ++g) {
      if (!blocked_[begin + g]) continue;
      CollisionChecker& checker = own[opening_[begin + g]];
      checker.set_root(part.T_world_part * part.grasps[g].T_object_hand);
      blocked_[begin + g] = !checker.is_free(still);
    }
  });
}

}  // namespace mmgrasp::detail
