#include "task/base_region/region_search.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/parallel.hpp"
#include "task/base_region/base_grid.hpp"

namespace mmgrasp {
namespace {

/// Of a base pose and a part.
enum Mark : std::uint8_t { kTried = 1, kGood = 2 };
/// Of a base pose: may the robot at home stand there?
enum HomeState : std::uint8_t { kUnknown, kFree, kInCollision, kAsked };

constexpr std::size_t kHomeBlock = 128;  // Base poses that one item of the loop over homes looks at.

}  // namespace

bool RegionSearch::Task::cell(std::size_t slot, int ix, int iy) const {
  const std::vector<std::uint8_t>& at_corners = corners[slot];
  return (centres[slot][at(ix, iy)] & at_corners[at(ix, iy)] & at_corners[at(ix + 1, iy)] & at_corners[at(ix, iy + 1)] &
          at_corners[at(ix + 1, iy + 1)] & kGood) != 0;
}

RegionSearch::RegionSearch(const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid,
                           bool keep_open)
    : problem_(&problem), grid_(grid), keep_open_(keep_open), threads_(resolve_threads(problem.options.threads)) {
  BasePoseEvaluator first(problem, database);
  for (int i = 1; i < threads_; ++i) evaluators_.push_back(first.clone());
  evaluators_.push_back(std::move(first));
  for (const Tray& tray : problem.trays) gone_.emplace_back(tray.parts.size(), 0);
  for (int tray = 0; tray < trays(); ++tray) add_tasks(tray, database);
  home_.resize(grid.headings.size());
  for (Home& layer : home_) {
    layer.centres.assign(static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny), kUnknown);
    layer.corners.assign(static_cast<std::size_t>(grid.nx + 1) * static_cast<std::size_t>(grid.ny + 1), kUnknown);
  }
}

RegionSearch::RegionSearch(const RegionSearch& other)
    : problem_(other.problem_),
      grid_(other.grid_),
      keep_open_(other.keep_open_),
      threads_(other.threads_),
      gone_(other.gone_),
      tasks_(other.tasks_),
      home_(other.home_) {
  for (const BasePoseEvaluator& evaluator : other.evaluators_) evaluators_.push_back(evaluator.clone());
}

void RegionSearch::add_tasks(int index, const ReachDatabase& database) {
  const Tray& tray = problem_->trays[index];
  const double radius = base_search_radius(*problem_, tray, database);
  const Eigen::Vector2d middle = tray.T_world_tray.translation().head<2>();
  const auto window = [&](double from, double cells, int& begin, int& count) {
    // A cell more each way: which centres are in range is decided below, by the distance alone.
    const double low = std::floor((from - radius) / grid_.resolution) - 1,
                 high = std::ceil((from + radius) / grid_.resolution) + 1;
    begin = static_cast<int>(std::clamp(low, 0.0, cells));
    count = static_cast<int>(std::clamp(high, 0.0, cells)) - begin;
  };
  for (double wanted : tray_headings(tray)) {
    Task task;
    task.tray = index;
    for (int p = 0; p < static_cast<int>(tray.parts.size()); ++p) {
      if (tray.parts[p].target) task.parts.push_back(p);
    }
    if (task.parts.empty()) return;
    for (task.heading = 0; task.heading < static_cast<int>(grid_.headings.size()); ++task.heading) {
      if (std::abs(wrap_angle(grid_.headings[task.heading] - wanted)) < 1e-9) break;
    }
    if (task.heading == static_cast<int>(grid_.headings.size())) continue;  // a grid made by hand may leave it out
    window(middle.x() - grid_.origin.x(), grid_.nx, task.x0, task.nx);
    window(middle.y() - grid_.origin.y(), grid_.ny, task.y0, task.ny);
    task.in_range.assign(static_cast<std::size_t>(task.nx) * static_cast<std::size_t>(task.ny), 0);
    for (int iy = 0; iy < task.ny; ++iy) {
      for (int ix = 0; ix < task.nx; ++ix) {
        const Eigen::Vector2d centre = pose(task, false, ix, iy).head<2>();
        task.in_range[static_cast<std::size_t>(iy) * static_cast<std::size_t>(task.nx) + static_cast<std::size_t>(ix)] =
            (centre - middle).norm() <= radius;
      }
    }
    task.totals.resize(task.parts.size());
    tasks_.push_back(std::move(task));
  }
}

Eigen::Vector3d RegionSearch::pose(const Task& task, bool corner, int ix, int iy) const {
  Eigen::Vector3d p = grid_.centre(task.heading, task.x0 + ix, task.y0 + iy);
  if (corner) p.head<2>().array() -= 0.5 * grid_.resolution;
  return p;
}

std::uint8_t& RegionSearch::home(const Task& task, bool corner, int ix, int iy) {
  Home& layer = home_[task.heading];
  const std::size_t row = static_cast<std::size_t>(grid_.nx + (corner ? 1 : 0));
  return (corner
              ? layer.corners
              : layer.centres)[static_cast<std::size_t>(task.y0 + iy) * row + static_cast<std::size_t>(task.x0 + ix)];
}

/// Centres within the search radius, and corners of cells whose centre is feasible.
bool RegionSearch::wanted(const Task& task, std::size_t slot, bool corner, int ix, int iy) const {
  if (!corner)
    return task
        .in_range[static_cast<std::size_t>(iy) * static_cast<std::size_t>(task.nx) + static_cast<std::size_t>(ix)];
  return task.beside(task.centres[slot], ix, iy);
}

bool RegionSearch::Task::beside(const std::vector<std::uint8_t>& good, int ix, int iy) const {
  for (int cy = std::max(iy - 1, 0); cy <= std::min(iy, ny - 1); ++cy) {
    for (int cx = std::max(ix - 1, 0); cx <= std::min(ix, nx - 1); ++cx) {
      if (good[at(cx, cy)] & kGood) return true;
    }
  }
  return false;
}

bool RegionSearch::run(int first, int last, const Monitor& monitor) {
  std::vector<Task*> tasks;
  for (Task& task : tasks_) {
    if (task.tray < first || task.tray >= last) continue;
    if (task.good_anywhere.empty()) {
      task.good_anywhere.assign(static_cast<std::size_t>(task.nx + 1) * static_cast<std::size_t>(task.ny + 1), 0);
      task.centres.assign(task.parts.size(), task.good_anywhere);
      task.corners = task.centres;
    }
    tasks.push_back(&task);
  }
  return check_home(tasks, false, monitor) && check_parts(tasks, false, monitor) && check_home(tasks, true, monitor) &&
         check_parts(tasks, true, monitor);
}

/// Where the robot at home is free: the same for all trays of a layer.
bool RegionSearch::check_home(const std::vector<Task*>& tasks, bool corner, const Monitor& monitor) {
  struct Place {
    std::uint8_t* state;
    Eigen::Vector3d pose;
  };
  std::vector<Place> places;
  for (Task* task : tasks) {
    for (int iy = 0; iy < task->ny + corner; ++iy) {
      for (int ix = 0; ix < task->nx + corner; ++ix) {
        std::uint8_t& state = home(*task, corner, ix, iy);
        if (state != kUnknown) continue;
        if (task->parts.empty()) continue;
        if (!(corner ? task->beside(task->good_anywhere, ix, iy) : wanted(*task, 0, false, ix, iy))) continue;
        state = kAsked;
        places.push_back({&state, pose(*task, corner, ix, iy)});
      }
    }
  }
  const bool done =
      parallel_for((places.size() + kHomeBlock - 1) / kHomeBlock, threads_,
                   [&](std::size_t item, int worker) {
                     BasePoseEvaluator& evaluator = evaluators_[worker];
                     for (std::size_t i = item * kHomeBlock; i < std::min(places.size(), (item + 1) * kHomeBlock); ++i)
                       *places[i].state = evaluator.home(places[i].pose) == Rejection::none ? kFree : kInCollision;
                   },
                   monitor, corner ? "home at corners" : "home at centres");
  for (const Place& place : places) {
    if (*place.state == kAsked) *place.state = kUnknown;  // stopped
  }
  return done;
}

/// One item a row of base poses, so that nothing depends on the number of threads.
bool RegionSearch::check_parts(const std::vector<Task*>& tasks, bool corner, const Monitor& monitor) {
  std::vector<std::pair<Task*, int>> rows;
  for (Task* task : tasks) {
    for (int iy = 0; iy < task->ny + corner; ++iy) rows.emplace_back(task, iy);
  }
  std::vector<RowResult> results(rows.size());
  const bool done = parallel_for(
      rows.size(), threads_,
      [&](std::size_t item, int worker) {
        check_row(*rows[item].first, rows[item].second, corner, results[item], evaluators_[worker], monitor);
      },
      monitor, corner ? "base regions, corners" : "base regions, centres");
  for (std::size_t item = 0; item < rows.size(); ++item) {
    Task& task = *rows[item].first;
    for (std::size_t slot = 0; slot < results[item].counts.size(); ++slot) {
      const RowCount& count = results[item].counts[slot];
      PartExplanation& total = task.totals[slot];
      total.base_poses_tried += count.tried;
      total.base_poses_feasible += count.feasible;
      total.rejections += count.rejections;
    }
    task.blocked.insert(task.blocked.end(), results[item].blocked.begin(), results[item].blocked.end());
  }
  return done && !monitor.stopped();
}

void RegionSearch::check_row(Task& task, int iy, bool corner, RowResult& result, BasePoseEvaluator& evaluator,
                             const Monitor& monitor) {
  result.counts.resize(task.parts.size());
  std::vector<int> last(task.parts.size(), -1);  // the grasp that worked at the base pose before
  std::vector<Rejection> causes;
  for (int ix = 0; ix < task.nx + corner; ++ix) {
    if (monitor.stopped()) return;
    if (home(task, corner, ix, iy) != kFree) continue;
    const Eigen::Vector3d base_pose = pose(task, corner, ix, iy);
    for (std::size_t slot = 0; slot < task.parts.size(); ++slot) {
      std::uint8_t& mark = (corner ? task.corners : task.centres)[slot][task.at(ix, iy)];
      if ((mark & kTried) || !wanted(task, slot, corner, ix, iy)) continue;
      mark |= kTried;
      RowCount& count = result.counts[slot];
      ++count.tried;
      const int grasp = evaluator.find_grasp(base_pose, task.tray, task.parts[slot], last[slot], causes);
      if (grasp >= 0) {
        mark |= kGood;
        if (!corner) task.good_anywhere[task.at(ix, iy)] = kGood;
        ++count.feasible;
        last[slot] = grasp;
        continue;
      }
      Rejections sum;
      for (Rejection cause : causes) sum.add(cause);
      count.rejections += sum;
      if (!keep_open_ || sum.scene + sum.grasp_filter == 0) continue;
      const auto narrow = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
      result.blocked.push_back({static_cast<int>(slot),
                                ix,
                                iy,
                                corner,
                                {narrow(sum.reach), narrow(sum.limits), narrow(sum.self_collision), narrow(sum.scene),
                                 narrow(sum.grasp_filter)}});
    }
  }
}

BaseRegion RegionSearch::region(int index) const {
  const Tray& tray = problem_->trays[index];
  const std::vector<int> left = parts(index);
  BaseRegion region;
  region.tray = tray.name;
  region.cells.assign(grid_.size(), 0);
  region.part_cells.assign(left.size(), PartCells(grid_));
  for (int part : left) {
    PartExplanation explanation;
    explanation.part = tray.parts[part].name;
    explanation.grasps = static_cast<int>(tray.parts[part].grasps.size());
    region.explanations.push_back(explanation);
  }
  for (const Task& task : tasks_) {
    if (task.tray != index || left.empty() || task.good_anywhere.empty()) continue;
    std::vector<std::uint8_t> all(static_cast<std::size_t>(task.nx) * static_cast<std::size_t>(task.ny), 1), own(all);
    for (std::size_t slot = 0, place = 0; slot < task.parts.size(); ++slot) {
      if (gone_[index][task.parts[slot]]) continue;
      for (int iy = 0; iy < task.ny; ++iy) {
        for (int ix = 0; ix < task.nx; ++ix) {
          const std::size_t i =
              static_cast<std::size_t>(iy) * static_cast<std::size_t>(task.nx) + static_cast<std::size_t>(ix);
          own[i] = task.good_anywhere[task.at(ix, iy)] && task.cell(slot, ix, iy);
          all[i] &= own[i];
        }
      }
      region.part_cells[place].add_window(task.heading, task.x0, task.y0, task.nx, task.ny, own);
      PartExplanation& explanation = region.explanations[place++];
      explanation.base_poses_tried += task.totals[slot].base_poses_tried;
      explanation.base_poses_feasible += task.totals[slot].base_poses_feasible;
      explanation.rejections += task.totals[slot].rejections;
    }
    const Home& layer = home_[task.heading];
    for (int iy = 0; iy < task.ny; ++iy) {
      for (int ix = 0; ix < task.nx; ++ix) {
        const std::size_t i =
            static_cast<std::size_t>(iy) * static_cast<std::size_t>(task.nx) + static_cast<std::size_t>(ix);
        region.cells[grid_.index(task.heading, task.x0 + ix, task.y0 + iy)] = all[i];
        const std::uint8_t state =
            layer.centres[static_cast<std::size_t>(task.y0 + iy) * static_cast<std::size_t>(grid_.nx) +
                          static_cast<std::size_t>(task.x0 + ix)];
        region.base_poses_in_collision += task.in_range[i] && state == kInCollision;
      }
    }
  }
  return region;
}

void RegionSearch::forget(int tray) {
  for (Task& task : tasks_) {
    if (task.tray != tray) continue;
    for (auto* marks : {&task.centres, &task.corners}) std::vector<std::vector<std::uint8_t>>().swap(*marks);
    task.good_anywhere.clear();
    task.totals.assign(task.parts.size(), {});
    task.blocked.clear();
  }
}

std::vector<int> RegionSearch::parts(int tray) const {
  std::vector<int> found;
  const std::vector<Part>& all = problem_->trays[tray].parts;
  for (int p = 0; p < static_cast<int>(all.size()); ++p) {
    if (all[p].target && present(tray, p)) found.push_back(p);
  }
  return found;
}

bool RegionSearch::present(int tray, int part) const {
  const std::vector<std::uint8_t>& gone = gone_[tray];
  return part >= 0 && part < static_cast<int>(gone.size()) && !gone[part];
}

void RegionSearch::common_cells(int tray, const std::vector<int>& parts, CellMask& cells) const {
  for (const Task& task : tasks_) {
    if (task.tray != tray) continue;
    std::vector<std::size_t> slots;
    for (int part : parts) {
      const auto it = std::lower_bound(task.parts.begin(), task.parts.end(), part);
      slots.push_back(static_cast<std::size_t>(it - task.parts.begin()));
    }
    for (int iy = 0; iy < task.ny; ++iy) {
      for (int ix = 0; ix < task.nx; ++ix) {
        cells[grid_.index(task.heading, task.x0 + ix, task.y0 + iy)] =
            std::all_of(slots.begin(), slots.end(), [&](std::size_t slot) { return task.cell(slot, ix, iy); });
      }
    }
  }
}

void RegionSearch::resume_without(const std::vector<std::pair<int, int>>& tray_and_part) {
  for (const auto& [tray, part] : tray_and_part) gone_[tray][part] = 1;
  BasePoseEvaluator first = evaluators_.front().without(tray_and_part);
  evaluators_.clear();
  for (int i = 1; i < threads_; ++i) evaluators_.push_back(first.clone());
  evaluators_.push_back(std::move(first));
  for (Home& layer : home_) {
    for (auto* states : {&layer.centres, &layer.corners})
      std::replace(states->begin(), states->end(), std::uint8_t{kInCollision}, std::uint8_t{kUnknown});
  }
  for (Task& task : tasks_) {
    for (const Blocked& blocked : task.blocked) {
      const std::size_t slot = static_cast<std::size_t>(blocked.slot);
      (blocked.corner ? task.corners : task.centres)[slot][task.at(blocked.ix, blocked.iy)] = 0;
      PartExplanation& total = task.totals[slot];
      --total.base_poses_tried;
      total.rejections.reach -= blocked.causes[0];
      total.rejections.limits -= blocked.causes[1];
      total.rejections.self_collision -= blocked.causes[2];
      total.rejections.scene -= blocked.causes[3];
      total.rejections.grasp_filter -= blocked.causes[4];
    }
    task.blocked.clear();
    const std::vector<std::uint8_t>& gone = gone_[task.tray];
    for (std::size_t slot = task.parts.size(); slot-- > 0;) {
      if (!gone[task.parts[slot]]) continue;
      const auto at = static_cast<std::ptrdiff_t>(slot);
      task.parts.erase(task.parts.begin() + at);
      task.centres.erase(task.centres.begin() + at);
      task.corners.erase(task.corners.begin() + at);
      task.totals.erase(task.totals.begin() + at);
    }
  }
}

}  // namespace mmgrasp
