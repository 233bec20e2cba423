#pragma once

#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "mmgrasp/task/base_route.hpp"
#include "mmgrasp/task/ids.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp::detail {

/// Drives to the goal with a part in the hand, the arm at home; the last one found for each part and base pose is kept.
class HeldDrives {
 public:
  HeldDrives(const PartSupplyProblem& problem, const Monitor& monitor);

  /// Whether there is one with the part held by its grasp of this index, the other `remaining` parts in place. May be
  /// asked from many threads at once: reports no progress.
  bool plan(const Eigen::Vector3d& base_pose, PartRef part, int grasp, const std::vector<PartRef>& remaining);
  /// The one that plan() found last, or why the last search found none.
  BasePath found(const Eigen::Vector3d& base_pose, PartRef part) const;

 private:
  using Key = std::pair<std::vector<double>, PartRef>;

  const PartSupplyProblem& problem_;
  Monitor quiet_;
  mutable std::mutex mutex_;
  std::map<Key, BasePath> known_;
};

}  // namespace mmgrasp::detail
