#pragma once

#include <Eigen/Geometry>
#include <set>
#include <string>
#include <vector>

#include "mmgrasp/task/ids.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp::detail {

/// What moves when a tray is moved: its parts, what carries it, and whatever else stands on that. The floor never
/// moves.
struct MovingGroup {
  std::set<TrayId> trays;
  std::set<std::string> objects;
};

MovingGroup moving_group(const PartSupplyProblem& problem, TrayId tray);

/// Scene and parts of the group only, or all but the group. Trays keep their indices; those left out have no parts.
PartSupplyProblem group_alone(const PartSupplyProblem& problem, const MovingGroup& group);
World scene_without(const PartSupplyProblem& problem, const MovingGroup& group);

/// The problem after the group was moved.
PartSupplyProblem with_group_moved(const PartSupplyProblem& problem, const MovingGroup& group,
                                   const Eigen::Vector2d& by);

/// Bounds of the shapes, to tell whether a move would push the group into something.
class GroupBounds {
 public:
  GroupBounds(const PartSupplyProblem& problem, const MovingGroup& group);
  /// True when a moved shape's bounds overlap some other shape's that they do not overlap where they are now.
  bool pushes_into_something(const Eigen::Vector2d& by) const;

 private:
  std::vector<Eigen::AlignedBox3d> moving_, standing_;
};

}  // namespace mmgrasp::detail
