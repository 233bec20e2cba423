#include "task/base_region/region_search.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/parallel.hpp"
#include "task/base_region/search_area.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kHomeBlock = 128;  // Base poses that one item of the loop over homes checks.

}  // namespace

RegionSearch::RegionSearch(const PartSupplyProblem& problem, const BaseGrid& grid, const BasePoseEvaluator& evaluator,
                           bool resumable)
    : problem_(&problem),
      grid_(grid),
      resumable_(resumable),
      threads_(resolve_threads(problem.options.threads)),
      home_(grid) {
  clone_evaluators(evaluator);
  for (const Tray& tray : problem.trays) removed_.emplace_back(tray.parts.size(), 0);
}

RegionSearch::RegionSearch(const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid,
                           const BasePoseEvaluator& evaluator, bool resumable)
    : RegionSearch(problem, grid, evaluator, resumable) {
  for (TrayId tray : all_trays(problem)) add_windows(tray, database, nullptr);
}

RegionSearch::RegionSearch(const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid,
                           const BasePoseEvaluator& evaluator, const CellMask& served)
    : RegionSearch(problem, grid, evaluator, false) {
  for (TrayId tray : all_trays(problem)) {
    if (tray_of(problem, tray).headings.empty()) add_windows(tray, database, &served);
  }
}

RegionSearch::RegionSearch(const RegionSearch& other)
    : problem_(other.problem_),
      grid_(other.grid_),
      resumable_(other.resumable_),
      threads_(other.threads_),
      removed_(other.removed_),
      windows_(other.windows_),
      home_(other.home_) {
  clone_evaluators(other.evaluators_.front());
}

void RegionSearch::clone_evaluators(const BasePoseEvaluator& evaluator) {
  evaluators_.clear();
  for (int i = 0; i < threads_; ++i) evaluators_.push_back(evaluator.clone());
}

/// Adds what is to be searched for a tray: its own headings; with `served` all others.
void RegionSearch::add_windows(TrayId id, const ReachDatabase& database, const CellMask* served) {
  const Tray& tray = tray_of(*problem_, id);
  const std::vector<int> targets = parts(id);
  if (targets.empty()) return;
  const double radius = base_search_radius(*problem_, tray, database);
  const Eigen::Vector2d middle = tray.T_world_tray.translation().head<2>();
  const std::vector<int> own = tray_layers(grid_, tray);
  for (int layer = 0; layer < static_cast<int>(grid_.headings.size()); ++layer) {
    const bool is_own = std::find(own.begin(), own.end(), layer) != own.end();
    if (is_own == (served != nullptr)) continue;
    TrayWindow window(id, layer, targets, grid_, middle, radius);
    if (!served || window.keep_only(grid_, *served)) windows_.push_back(std::move(window));
  }
}

std::uint8_t& RegionSearch::home(const TrayWindow& window, bool corner, int ix, int iy) {
  return home_.at(window.heading(), corner, window.grid_x(ix), window.grid_y(iy));
}

bool RegionSearch::run(int first, int last, const Monitor& monitor) {
  std::vector<TrayWindow*> windows;
  for (TrayWindow& window : windows_) {
    if (window.tray() < first || window.tray() >= last) continue;
    window.begin();
    windows.push_back(&window);
  }
  return check_home(windows, false, monitor) && check_parts(windows, false, monitor) &&
         check_home(windows, true, monitor) && check_parts(windows, true, monitor);
}

/// Where the robot at home is free: the same for all trays of a layer.
bool RegionSearch::check_home(const std::vector<TrayWindow*>& windows, bool corner, const Monitor& monitor) {
  struct Query {
    std::uint8_t* state;
    Eigen::Vector3d pose;
  };
  std::vector<Query> queries;
  for (const TrayWindow* window : windows) {
    for (int iy = 0; iy < window->ny() + corner; ++iy) {
      for (int ix = 0; ix < window->nx() + corner; ++ix) {
        std::uint8_t& state = home(*window, corner, ix, iy);
        if (state != HomeMap::unknown || !window->wanted_for_any(corner, ix, iy)) continue;
        state = HomeMap::queried;
        queries.push_back({&state, window->pose(grid_, corner, ix, iy)});
      }
    }
  }
  const auto check = [&](std::size_t item, int worker) {
    BasePoseEvaluator& evaluator = evaluators_[worker];
    for (std::size_t i = item * kHomeBlock; i < std::min(queries.size(), (item + 1) * kHomeBlock); ++i)
      *queries[i].state = evaluator.home(queries[i].pose) == Rejection::none ? HomeMap::free : HomeMap::in_collision;
  };
  const bool done = parallel_for((queries.size() + kHomeBlock - 1) / kHomeBlock, threads_, check, monitor,
                                 corner ? "home at corners" : "home at centres");
  for (const Query& query : queries) {
    if (*query.state == HomeMap::queried) *query.state = HomeMap::unknown;  // stopped
  }
  return done;
}

/// One item a row of base poses, so that nothing depends on the number of threads.
bool RegionSearch::check_parts(const std::vector<TrayWindow*>& windows, bool corner, const Monitor& monitor) {
  std::vector<std::pair<TrayWindow*, int>> rows;
  for (TrayWindow* window : windows) {
    for (int iy = 0; iy < window->ny() + corner; ++iy) rows.emplace_back(window, iy);
  }
  std::vector<RowResult> results(rows.size());
  const bool done = parallel_for(
      rows.size(), threads_,
      [&](std::size_t item, int worker) {
        check_row(*rows[item].first, rows[item].second, corner, results[item], evaluators_[worker], monitor);
      },
      monitor, corner ? "base regions, corners" : "base regions, centres");
  for (std::size_t item = 0; item < rows.size(); ++item) {
    TrayWindow& window = *rows[item].first;
    for (std::size_t slot = 0; slot < results[item].counts.size(); ++slot) {
      const RowCount& count = results[item].counts[slot];
      window.add(slot, count.tried, count.feasible, count.rejections);
    }
    window.add_blocked(results[item].blocked);
  }
  return done && !monitor.stopped();
}

void RegionSearch::check_row(TrayWindow& window, int iy, bool corner, RowResult& result, BasePoseEvaluator& evaluator,
                             const Monitor& monitor) {
  const std::vector<int>& parts = window.parts();
  result.counts.resize(parts.size());
  std::vector<int> last(parts.size(), -1);  // the grasp that worked at the base pose before
  std::vector<Rejection> causes;
  for (int ix = 0; ix < window.nx() + corner; ++ix) {
    if (monitor.stopped()) return;
    if (home(window, corner, ix, iy) != HomeMap::free) continue;
    const Eigen::Vector3d base_pose = window.pose(grid_, corner, ix, iy);
    for (std::size_t slot = 0; slot < parts.size(); ++slot) {
      if (window.tried(slot, corner, ix, iy) || !window.wanted(slot, corner, ix, iy)) continue;
      window.mark_tried(slot, corner, ix, iy);
      RowCount& count = result.counts[slot];
      ++count.tried;
      const int grasp = evaluator.find_grasp(base_pose, {window.tray(), parts[slot]}, last[slot], causes);
      if (grasp >= 0) {
        window.mark_good(slot, corner, ix, iy);
        ++count.feasible;
        last[slot] = grasp;
        continue;
      }
      Rejections sum;
      for (Rejection cause : causes) sum.add(cause);
      count.rejections += sum;
      if (!resumable_ || sum.scene + sum.grasp_filter == 0) continue;
      const auto narrow = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
      result.blocked.push_back({static_cast<int>(slot),
                                ix,
                                iy,
                                corner,
                                {narrow(sum.unreachable), narrow(sum.limits), narrow(sum.self_collision),
                                 narrow(sum.scene), narrow(sum.grasp_filter)}});
    }
  }
}

BaseRegion RegionSearch::region(TrayId id) const {
  const Tray& tray = tray_of(*problem_, id);
  const std::vector<int> left = parts(id);
  BaseRegion region;
  region.tray = tray.name;
  region.has_targets = !left.empty();
  region.cells.assign(grid_.size(), 0);
  region.part_cells.assign(left.size(), PartCells(grid_));
  for (int part : left) {
    PartExplanation explanation;
    explanation.part = tray.parts[part].name;
    explanation.grasps = static_cast<int>(tray.parts[part].grasps.size());
    region.explanations.push_back(explanation);
  }
  for (const TrayWindow& window : windows_) {
    if (window.tray() != id || left.empty() || !window.begun()) continue;
    std::vector<std::uint8_t> all(static_cast<std::size_t>(window.nx()) * window.ny(), 1);
    for (std::size_t slot = 0, place = 0; slot < window.parts().size(); ++slot) {
      if (!present({id, window.parts()[slot]})) continue;
      const std::vector<std::uint8_t> own = window.region_flags(slot);
      for (std::size_t i = 0; i < all.size(); ++i) all[i] &= own[i];
      region.part_cells[place].add_window(window.heading(), window.grid_x(0), window.grid_y(0), window.nx(),
                                          window.ny(), own);
      PartExplanation& explanation = region.explanations[place++];
      explanation.base_poses_tried += window.total(slot).base_poses_tried;
      explanation.base_poses_feasible += window.total(slot).base_poses_feasible;
      explanation.rejections += window.total(slot).rejections;
    }
    std::size_t i = 0;
    for (int iy = 0; iy < window.ny(); ++iy) {
      for (int ix = 0; ix < window.nx(); ++ix, ++i) {
        const int gx = window.grid_x(ix), gy = window.grid_y(iy);
        region.cells[grid_.index(window.heading(), gx, gy)] = all[i];
        region.base_poses_in_collision +=
            window.in_range(ix, iy) && home_.at(window.heading(), false, gx, gy) == HomeMap::in_collision;
      }
    }
  }
  return region;
}

void RegionSearch::forget(TrayId tray) {
  for (TrayWindow& window : windows_) {
    if (window.tray() == tray) window.forget();
  }
}

std::vector<int> RegionSearch::parts(TrayId tray) const {
  std::vector<int> found;
  for (const PartRef& target : target_parts(*problem_, tray)) {
    if (present(target)) found.push_back(target.part);
  }
  return found;
}

bool RegionSearch::present(PartRef part) const {
  const std::vector<std::uint8_t>& removed = removed_[part.tray];
  return part.part >= 0 && part.part < static_cast<int>(removed.size()) && !removed[part.part];
}

void RegionSearch::common_cells(TrayId tray, const std::vector<int>& parts, CellMask& cells) const {
  for (const TrayWindow& window : windows_) {
    if (window.tray() != tray) continue;
    std::vector<std::size_t> slots;
    for (int part : parts) {
      const auto it = std::lower_bound(window.parts().begin(), window.parts().end(), part);
      slots.push_back(it - window.parts().begin());
    }
    for (int iy = 0; iy < window.ny(); ++iy) {
      for (int ix = 0; ix < window.nx(); ++ix) {
        cells[grid_.index(window.heading(), window.grid_x(ix), window.grid_y(iy))] =
            std::all_of(slots.begin(), slots.end(), [&](std::size_t slot) { return window.in_region(slot, ix, iy); });
      }
    }
  }
}

void RegionSearch::resume_without(const std::vector<PartRef>& parts) {
  for (const PartRef& part : parts) removed_[part.tray][part.part] = 1;
  clone_evaluators(evaluators_.front().without(parts));
  home_.forget_collisions();
  for (TrayWindow& window : windows_) window.resume_without(removed_[window.tray()]);
}

}  // namespace mmgrasp::detail
