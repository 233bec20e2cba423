#include "task/base_sequence/base_routes.hpp"

#include <algorithm>

#include "mmgrasp/core/parallel.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kPadding = 0.01;  // [m]
constexpr double kUsual = 0.1;     // Cells of this size are tried first where smaller ones are asked for [m].
constexpr double kCoarsest = 8;    // Cells at most this much larger than the first are tried where a search gives up.

std::array<double, 6> key_of(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return {from.x(), from.y(), from.z(), to.x(), to.y(), to.z()};
}

/// Searches in ever larger cells until one search does not give up; only a way that is found is an answer.
template <class Search>
BasePath search_coarser(const Search& search, double first) {
  for (double cells = 2 * first; cells <= kCoarsest * first; cells *= 2) {
    BasePath path = search(cells);
    if (path.outcome == Outcome::solved || path.outcome == Outcome::stopped) return path;
    if (path.outcome != Outcome::timeout) break;
  }
  BasePath none;
  none.outcome = Outcome::timeout;
  none.cell = first;
  return none;
}

}  // namespace

CheckerOptions drive_padding() {
  CheckerOptions options;
  options.padding = kPadding;
  return options;
}

BaseRoutes::BaseRoutes(const PartSupplyProblem& problem, const Monitor& monitor)
    : problem_(problem),
      monitor_(monitor),
      padded_(problem.arm, world_with_parts(problem, all_parts(problem)), drive_padding()),
      bare_(problem.arm, world_with_parts(problem, all_parts(problem))) {}

BasePath plan_drive(const PartSupplyProblem& problem, CollisionChecker& padded, CollisionChecker& bare,
                    const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Monitor& monitor) {
  const auto search = [&](CollisionChecker& checker, double resolution) {
    BaseRouteOptions options;
    options.base = problem.robot.base();
    options.resolution = resolution;
    options.clearance = problem.drive_clearance;
    return plan_base_route(checker, problem.home, from, to, options, monitor);
  };
  const auto search_both = [&](double resolution) {
    BasePath path = search(padded, resolution);
    const bool is_narrow =
        path.outcome != Outcome::solved && path.outcome != Outcome::stopped && path.outcome != Outcome::timeout;
    return is_narrow ? search(bare, resolution) : path;
  };
  const double asked = problem.options.route_resolution;
  double first = asked;
  while (2 * first <= kUsual) first *= 2;
  BasePath path = search_both(first);
  // Larger cells may lead there in the number of base poses that ran out, smaller ones through narrow places.
  if (path.outcome == Outcome::timeout) return search_coarser(search_both, first);
  for (double cells = first / 2; path.outcome == Outcome::not_found && cells > 0.9 * asked; cells /= 2)
    path = search_both(cells);
  return path.outcome == Outcome::not_found ? search(bare, asked / 2) : path;
}

BasePath BaseRoutes::between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  prepare({{from, to}});
  const auto found = known_.find(key_of(from, to));
  return found == known_.end() ? BasePath{} : found->second;
}

void BaseRoutes::prepare(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& pairs) {
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> open;
  for (const auto& [from, to] : pairs) {
    if (!known_.count(key_of(from, to))) open.emplace_back(from, to);
  }
  std::vector<BasePath> paths(open.size());
  Monitor quiet;
  quiet.stop = monitor_.stop;
  if (!open.empty()) monitor_.report("route", 0);
  const bool done = parallel_for(
      open.size(), problem_.options.threads,
      [&](std::size_t item, int worker) {  // worker 0 is the calling thread, which may report
        CollisionChecker padded = padded_.clone(), bare = bare_.clone();
        const Monitor& monitor = worker == 0 ? monitor_ : quiet;
        paths[item] = plan_drive(problem_, padded, bare, open[item].first, open[item].second, monitor);
      },
      monitor_, "route");
  if (!done) return;
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto& [from, to] = open[i];
    BasePath back = paths[i];  // every primitive can be driven the other way
    std::reverse(back.poses.begin(), back.poses.end());
    known_[key_of(from, to)] = std::move(paths[i]);
    known_.emplace(key_of(to, from), std::move(back));
  }
}

Eigen::MatrixXd BaseRoutes::estimates(const std::vector<Eigen::Vector3d>& poses) const {
  BaseRouteOptions options;
  options.base = problem_.robot.base();
  options.resolution = problem_.options.route_resolution;
  options.clearance = problem_.drive_clearance;
  return route_lengths(bare_, problem_.home, poses, options, problem_.options.threads, monitor_);
}

}  // namespace mmgrasp::detail
