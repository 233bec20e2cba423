#include "mmgrasp/task/base_route.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/base_motion.hpp"
#include "task/base_route/base_search.hpp"
#include "task/base_route/floor_field.hpp"

namespace mmgrasp {
namespace {

using detail::BaseClearance;
using detail::BaseSearchSettings;
using detail::direct_ways;
using detail::way_cost;

constexpr int kShorteningChecks = 400;  // Direct ways tried for shortening.
constexpr double kMaxCells = 500000;    // Largest number of cells of a floor: with more of them a search ends nowhere.

using Poses3 = std::vector<Eigen::Vector3d>;

bool path_free(BaseClearance& clearance, const Poses3& poses, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    if (!clearance.segment_free(poses[i], poses[i + 1])) return false;
  }
  return true;
}

double path_cost(const Poses3& poses, std::size_t first, std::size_t last, double turn_weight) {
  return way_cost(poses[first],
                  Poses3(poses.begin() + static_cast<std::ptrdiff_t>(first) + 1,
                         poses.begin() + static_cast<std::ptrdiff_t>(last) + 1),
                  turn_weight);
}

/// Takes out poses in the middle of one drive or one turn.
void merge_primitives(BaseKind base, Poses3& poses) {
  for (std::size_t i = 1; i + 1 < poses.size();) {
    const Eigen::Vector3d a = poses[i] - poses[i - 1], b = poses[i + 1] - poses[i];
    const double la = a.head<2>().norm(), lb = b.head<2>().norm();
    const bool turn = la < 1e-9 && lb < 1e-9 && a.z() * b.z() >= 0;
    const bool drive = std::abs(a.z()) < 1e-12 && std::abs(b.z()) < 1e-12 && a.head<2>().dot(b.head<2>()) > 0 &&
                       std::abs(a.x() * b.y() - a.y() * b.x()) < 1e-12 * std::max(1.0, la * lb);
    const bool idle = a.norm() < 1e-12;
    if (idle || (turn && (base != BaseKind::fixed)) || drive) {
      poses.erase(poses.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
}

/// Replaces stretches by direct ways while that is cheaper, the longest stretches first.
void shorten(BaseClearance& clearance, const BaseSearchSettings& settings, Poses3& poses) {
  int checks = 0;
  bool changed = true;
  while (changed && checks < kShorteningChecks) {
    changed = false;
    for (std::size_t span = poses.size() - 1; span >= 2 && !changed; --span) {
      for (std::size_t i = 0; i + span < poses.size() && !changed && checks < kShorteningChecks; ++i) {
        const std::size_t j = i + span;
        const double now = path_cost(poses, i, j, settings.turn_weight);
        for (const Poses3& way : direct_ways(settings.base, poses[i], poses[j], settings.turn_weight)) {
          if (way_cost(poses[i], way, settings.turn_weight) > now - 1e-6 || checks >= kShorteningChecks) break;
          ++checks;
          Poses3 trial = {poses[i]};
          trial.insert(trial.end(), way.begin(), way.end());
          if (!path_free(clearance, trial, 0, trial.size() - 1)) continue;
          const double turns = trial.back().z() - poses[j].z();  // later headings keep their count of turns
          Poses3 joined(poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(i));
          joined.insert(joined.end(), trial.begin(), trial.end());
          for (std::size_t k = j + 1; k < poses.size(); ++k) joined.push_back(poses[k] + Eigen::Vector3d(0, 0, turns));
          poses = std::move(joined);
          changed = true;
          break;
        }
      }
    }
  }
}

/// The part of a floor around two places that has room for kMaxCells cells of the resolution asked for; the whole of a
/// floor that has no more.
Eigen::AlignedBox2d around(const Eigen::AlignedBox2d& floor, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                           double resolution) {
  Eigen::AlignedBox2d box(Eigen::Vector2d(from.head<2>()));
  box.extend(Eigen::Vector2d(to.head<2>()));
  const double area = kMaxCells * resolution * resolution, sum = box.sizes().sum();
  const double left = area - box.volume();
  if (floor.volume() <= area || !(left > 0)) return floor;
  const double margin = (std::sqrt(sum * sum + 4 * left) - sum) / 4;
  return Eigen::AlignedBox2d(Eigen::Vector2d(box.min().array() - margin), Eigen::Vector2d(box.max().array() + margin))
      .intersection(floor);
}

}  // namespace

void BaseRouteOptions::check() const {
  require_length(resolution, "route.resolution");
  require_length(check_step, "route.check_step");
  require_within(clearance, 0, 10, "route.clearance", "m");
}

BasePath plan_base_route(CollisionChecker& checker, const Eigen::VectorXd& home, const Eigen::Vector3d& from,
                         const Eigen::Vector3d& to, const BaseRouteOptions& options, const Monitor& monitor) {
  options.check();
  checker.group().check_configuration(home, "home");
  require_numbers(from, "from", "m, rad");
  require_numbers(to, "to", "m, rad");
  BasePath path;
  BaseClearance clearance(checker, home, options.check_step);
  clearance.keep(options.clearance, {from, to});
  if (!clearance.free(from) || !clearance.free(to)) {
    path.outcome = clearance.free(from) ? Outcome::invalid_goal : Outcome::invalid_start;
    return path;
  }
  const bool same = (from - to).head<2>().norm() < 1e-9 && std::abs(wrap_angle(from.z() - to.z())) < 1e-9;
  if (options.base == BaseKind::fixed && !same) {
    path.outcome = Outcome::infeasible;
    return path;
  }
  const BaseLimits limits = driving_limits(options.base, checker.group().robot().base_limits());
  const double workspace = checker.group().robot().base_limits().workspace;
  const Eigen::AlignedBox2d floor =
      options.bounds.isEmpty() ? detail::floor_bounds(checker.world(), {from, to}, workspace) : options.bounds;
  const auto settings_on = [&](const Eigen::AlignedBox2d& bounds) {
    const double resolution = std::max(options.resolution, std::sqrt(bounds.volume() / kMaxCells));
    return BaseSearchSettings{options.base, resolution, limits.linear_velocity / limits.angular_velocity, bounds};
  };
  const BaseSearchSettings settings = settings_on(around(floor, from, to, options.resolution));
  Poses3 poses = {from};
  if (!same) {
    auto found = detail::search_base_path(clearance, from, to, settings, monitor);
    path.cell = settings.resolution;
    const bool whole = settings.bounds.isApprox(floor);
    if (found.outcome == Outcome::not_found && !whole) {
      // A way that leads far around, in cells as large as they must be.
      const BaseSearchSettings far = settings_on(floor);
      found = detail::search_base_path(clearance, from, to, far, monitor);
      path.cell = far.resolution;
    }
    if (found.outcome != Outcome::solved) {
      path.outcome = found.outcome;
      return path;
    }
    poses = std::move(found.poses);
    shorten(clearance, settings, poses);
    merge_primitives(options.base, poses);
  }
  BaseClearance fine(checker, home, 0.5 * options.check_step);
  fine.keep(options.clearance, {from, to});
  if (!path_free(fine, poses, 0, poses.size() - 1)) return path;
  path.outcome = Outcome::solved;
  path.poses = std::move(poses);
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    path.length += (path.poses[i] - path.poses[i - 1]).head<2>().norm();
    path.turning += std::abs(path.poses[i].z() - path.poses[i - 1].z());
  }
  return path;
}

Eigen::MatrixXd route_lengths(const CollisionChecker& checker, const Eigen::VectorXd& home,
                              const std::vector<Eigen::Vector3d>& poses, const BaseRouteOptions& options, int threads,
                              const Monitor& monitor) {
  options.check();
  checker.group().check_configuration(home, "home");
  for (std::size_t i = 0; i < poses.size(); ++i)
    require_numbers(poses[i], "poses[" + std::to_string(i) + "]", "m, rad");
  if (poses.empty()) return Eigen::MatrixXd(0, 0);
  const detail::FloorField field(checker, home, options, poses, threads, monitor);
  return field.complete() ? field.lengths() : Eigen::MatrixXd();
}

}  // namespace mmgrasp
