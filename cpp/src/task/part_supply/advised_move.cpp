#include "task/part_supply/advised_move.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "task/problem/moving_group.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kFarthest = 3.0;           // Longest move tried [m].
constexpr int kMovesChecked = 24;           // Moves checked pose by pose in the moved scene.
constexpr std::size_t kCentresChecked = 4;  // Disc centres checked for each of them.

using Offset = std::pair<int, int>;

/// Cells that a disc around a cell's centre touches.
std::vector<Offset> disc_cells(double radius_in_cells) {
  std::vector<Offset> cells;
  const int n = static_cast<int>(std::ceil(radius_in_cells)) + 1;
  for (int y = -n; y <= n; ++y) {
    for (int x = -n; x <= n; ++x) {
      const double dx = std::max(std::abs(x) - 0.5, 0.0), dy = std::max(std::abs(y) - 0.5, 0.0);
      if (std::hypot(dx, dy) < radius_in_cells || (x == 0 && y == 0)) cells.emplace_back(x, y);
    }
  }
  return cells;
}

/// Moves of up to kFarthest by whole cells, shortest first; staying put is none.
std::vector<Offset> moves_by_length(double resolution) {
  std::vector<Offset> moves;
  const int n = static_cast<int>(kFarthest / resolution);
  for (int y = -n; y <= n; ++y) {
    for (int x = -n; x <= n; ++x) {
      if ((x != 0 || y != 0) && x * x + y * y <= n * n) moves.emplace_back(x, y);
    }
  }
  std::stable_sort(moves.begin(), moves.end(), [](const Offset& a, const Offset& b) {
    return a.first * a.first + a.second * a.second < b.first * b.first + b.second * b.second;
  });
  return moves;
}

struct Centre {
  int heading, ix, iy;
};

/// Whether the robot at home is free of all that stays; checked lazily, where it is queried.
class FreeFloor {
 public:
  FreeFloor(const PartSupplyProblem& problem, const MovingGroup& group, const BaseGrid& grid)
      : home_(problem.home), grid_(grid), checker_(problem.arm, scene_without(problem, group)) {}

  bool disc(const Centre& at, const std::vector<Offset>& cells) {
    const auto [it, is_new] = discs_.emplace(key(at.heading, 2 * at.ix, 2 * at.iy), true);
    if (!is_new) return it->second;
    bool free = true;
    for (const auto& [x, y] : cells) free = free && cell(at.heading, at.ix + x, at.iy + y);
    return discs_[key(at.heading, 2 * at.ix, 2 * at.iy)] = free;
  }

 private:
  static std::int64_t key(int heading, int x, int y) {
    return (static_cast<std::int64_t>(heading) << 48) + (static_cast<std::int64_t>(x + (1 << 20)) << 24) +
           (y + (1 << 20));
  }

  bool cell(int h, int ix, int iy) {
    bool free = point(h, 2 * ix, 2 * iy);
    for (int dy : {-1, 1}) {
      for (int dx : {-1, 1}) free = free && point(h, 2 * ix + dx, 2 * iy + dy);
    }
    return free;
  }

  /// Free at a point, counted in half cells so that centres and corners both have whole numbers?
  bool point(int h, int x, int y) {
    const auto [it, is_new] = points_.emplace(key(h, x, y), false);
    if (!is_new) return it->second;
    Eigen::Vector3d pose = grid_.centre(h, 0, 0);
    pose.x() += 0.5 * x * grid_.resolution;
    pose.y() += 0.5 * y * grid_.resolution;
    checker_.set_root(pose_from_planar(pose));
    return it->second = checker_.is_free(home_);
  }

  const Eigen::VectorXd& home_;
  const BaseGrid& grid_;
  CollisionChecker checker_;
  std::unordered_map<std::int64_t, bool> points_, discs_;
};

/// Looks for the shortest move of a tray, and all that moves with it, after which it can be served.
class MoveSearch {
 public:
  MoveSearch(const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid, TrayId tray)
      : problem_(problem),
        database_(database),
        grid_(grid),
        group_(moving_group(problem, tray)),
        bounds_(problem, group_),
        floor_(problem, group_, grid),
        disc_(disc_cells(problem.options.positioning_uncertainty / grid.resolution + 1)) {
    const PartSupplyProblem alone = group_alone(problem, group_);
    const std::vector<BaseRegion> regions = compute_base_regions(alone, database, grid);
    for (TrayId member : group_.trays) {
      std::vector<Centre> centres = disc_centres(regions[member].cells);
      // Another tray that has no base poses wherever it is does not hinder the move.
      if (!centres.empty() || member == tray) centres_[member] = std::move(centres);
    }
  }

  std::optional<Eigen::Vector2d> run(TrayId tray) {
    if (centres_.at(tray).empty()) return std::nullopt;
    std::vector<Offset> failed;
    for (const Offset& move : moves_by_length(grid_.resolution)) {
      const Eigen::Vector2d by = grid_.resolution * Eigen::Vector2d(move.first, move.second);
      if (near_one_that_failed(move, failed) || !has_room(move) || bounds_.pushes_into_something(by)) continue;
      if (works(move, by)) return by;
      failed.push_back(move);
      if (static_cast<int>(failed.size()) == kMovesChecked) break;
    }
    return std::nullopt;
  }

  const MovingGroup& group() const { return group_; }

 private:
  /// Cells around which the whole disc lies in the region.
  std::vector<Centre> disc_centres(const CellMask& cells) const {
    std::vector<Centre> centres;
    for (int h = 0; h < static_cast<int>(grid_.headings.size()); ++h) {
      for (int iy = 0; iy < grid_.ny; ++iy) {
        for (int ix = 0; ix < grid_.nx; ++ix) {
          const bool all = std::all_of(disc_.begin(), disc_.end(), [&](const Offset& o) {
            const int x = ix + o.first, y = iy + o.second;
            return x >= 0 && y >= 0 && x < grid_.nx && y < grid_.ny && cells[grid_.index(h, x, y)];
          });
          if (all) centres.push_back({h, ix, iy});
        }
      }
    }
    return centres;
  }

  /// The more moves failed, the farther the next one is from them.
  static bool near_one_that_failed(const Offset& move, const std::vector<Offset>& failed) {
    const int apart = static_cast<int>(failed.size()) / 4;
    return std::any_of(failed.begin(), failed.end(), [&](const Offset& other) {
      return std::max(std::abs(other.first - move.first), std::abs(other.second - move.second)) <= apart;
    });
  }

  bool free_after(const Centre& centre, const Offset& move) {
    return floor_.disc({centre.heading, centre.ix + move.first, centre.iy + move.second}, disc_);
  }

  bool has_room(const Offset& move) {
    return std::all_of(centres_.begin(), centres_.end(), [&](const auto& tray) {
      return std::any_of(tray.second.begin(), tray.second.end(), [&](const Centre& c) { return free_after(c, move); });
    });
  }

  /// Does the move help? In the moved scene start and goal stay free, and each tray has a disc of base poses that
  /// serves all its parts.
  bool works(const Offset& move, const Eigen::Vector2d& by) {
    const PartSupplyProblem moved = with_group_moved(problem_, group_, by);
    BasePoseEvaluator evaluator(moved, database_);
    for (const Eigen::Vector3d& end : {problem_.start, problem_.goal}) {
      if (evaluator.home(end) != Rejection::none) return false;
    }
    return std::all_of(centres_.begin(), centres_.end(), [&](const auto& tray) {
      const std::vector<Centre> candidates = candidates_after(tray.second, move);
      return std::any_of(candidates.begin(), candidates.end(),
                         [&](const Centre& c) { return disc_serves(moved, evaluator, tray.first, c); });
    });
  }

  /// Free disc centres after the move: the middle one first, then some spread over the rest.
  std::vector<Centre> candidates_after(const std::vector<Centre>& centres, const Offset& move) {
    std::vector<Centre> free;
    for (const Centre& c : centres) {
      if (free_after(c, move)) free.push_back({c.heading, c.ix + move.first, c.iy + move.second});
    }
    std::vector<Centre> chosen;
    for (std::size_t i = 0; i < kCentresChecked && i < free.size(); ++i) {
      chosen.push_back(free[(free.size() / 2 + i * free.size() / kCentresChecked) % free.size()]);
    }
    return chosen;
  }

  bool disc_serves(const PartSupplyProblem& moved, BasePoseEvaluator& evaluator, TrayId tray,
                   const Centre& centre) const {
    std::map<std::tuple<int, int>, bool> known;  // in half cells
    const auto serves = [&](int x, int y) {
      const auto [it, is_new] = known.emplace(std::tuple{x, y}, true);
      if (!is_new) return it->second;
      Eigen::Vector3d pose = grid_.centre(centre.heading, 0, 0);
      pose.x() += 0.5 * x * grid_.resolution;
      pose.y() += 0.5 * y * grid_.resolution;
      const std::vector<PartRef> targets = target_parts(moved, tray);
      return it->second = std::all_of(targets.begin(), targets.end(),
                                      [&](const PartRef& part) { return evaluator.part(pose, part).feasible; });
    };
    return std::all_of(disc_.begin(), disc_.end(), [&](const Offset& o) {
      const int x = 2 * (centre.ix + o.first), y = 2 * (centre.iy + o.second);
      return serves(x, y) && serves(x - 1, y - 1) && serves(x + 1, y - 1) && serves(x - 1, y + 1) &&
             serves(x + 1, y + 1);
    });
  }

  const PartSupplyProblem& problem_;
  const ReachDatabase& database_;
  const BaseGrid& grid_;
  MovingGroup group_;
  GroupBounds bounds_;
  FreeFloor floor_;
  std::vector<Offset> disc_;
  std::map<TrayId, std::vector<Centre>> centres_;  // before the move, by tray
};

}  // namespace

std::optional<TrayMove> advise_move(const PartSupplyProblem& problem, const ReachDatabase& database,
                                    const BaseGrid& grid, TrayId tray) {
  MoveSearch search(problem, database, grid, tray);
  const std::optional<Eigen::Vector2d> by = search.run(tray);
  if (!by) return std::nullopt;
  TrayMove move;
  move.by = *by;
  move.trays.push_back(problem.trays[tray].name);
  for (TrayId other : search.group().trays) {
    if (other != tray) move.trays.push_back(problem.trays[other].name);
  }
  move.objects.assign(search.group().objects.begin(), search.group().objects.end());
  return move;
}

}  // namespace mmgrasp::detail
