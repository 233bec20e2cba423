#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/task/base_route.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "mmgrasp/task/problem.hpp"
#include "mmgrasp/task/visiting_order.hpp"

namespace mmgrasp::detail {

/// A drive with the arm at home, tried in cells of several sizes, with the `padded` checker first.
BasePath plan_drive(const PartSupplyProblem& problem, CollisionChecker& padded, CollisionChecker& bare,
                    const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Monitor& monitor);

/// Links and what is attached to them, grown by what drives keep to the scene where they can.
CheckerOptions drive_padding();

/// Plans drives between base poses and remembers them; keeps a little away from the scene where it can.
class BaseRoutes {
 public:
  BaseRoutes(const PartSupplyProblem& problem, const Monitor& monitor);

  /// A drive with all parts in place: it stays free when parts leave.
  BasePath between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  /// Lengths between many base poses without planning each drive (see route_lengths()); empty when stopped.
  Eigen::MatrixXd estimates(const std::vector<Eigen::Vector3d>& poses) const;
  /// Plans between() of many pairs at once, in parallel.
  void prepare(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& pairs);

 private:
  using Key = std::array<double, 6>;

  const PartSupplyProblem& problem_;
  const Monitor& monitor_;
  CollisionChecker padded_, bare_;
  std::map<Key, BasePath> known_;
};

/// order_stops() with drives that the caller keeps.
VisitingOrder order_stops(const PartSupplyProblem& problem, const std::vector<Stop>& stops, BaseRoutes& routes);

}  // namespace mmgrasp::detail
