// straight_route_length(): routes as the crow flies, enough to choose among equally good sequences.
#include "mmgrasp/optim/tour.hpp"
#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp {

double straight_route_length(const std::vector<Stop>& stops, const Eigen::Vector2d& start,
                             const Eigen::Vector2d& goal) {
  std::vector<Eigen::Vector2d> places;
  for (const Stop& stop : stops) places.emplace_back(stop.pose.head<2>());
  places.push_back(start);
  places.push_back(goal);
  const auto n = static_cast<Eigen::Index>(places.size());
  const Eigen::MatrixXd lengths = Eigen::MatrixXd::NullaryExpr(
      n, n, [&](Eigen::Index i, Eigen::Index j) { return (places[i] - places[j]).norm(); });
  return shortest_visiting_tour(lengths).length;
}

}  // namespace mmgrasp
