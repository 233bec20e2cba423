#include "mmgrasp/task/base_region.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/parallel.hpp"
#include "task/base_grid.hpp"

namespace mmgrasp {
namespace {

/// Base poses of one layer: the centres of the cells, or their corners (one more each way, shared between cells).
struct Lattice {
  const BaseGrid& grid;
  int heading;
  bool corners;

  int nx() const { return grid.nx + (corners ? 1 : 0); }
  int ny() const { return grid.ny + (corners ? 1 : 0); }
  std::size_t size() const { return static_cast<std::size_t>(nx()) * static_cast<std::size_t>(ny()); }
  std::size_t index(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx()) + static_cast<std::size_t>(ix);
  }
  Eigen::Vector3d pose(int ix, int iy) const {
    Eigen::Vector3d p = grid.centre(heading, ix, iy);
    if (corners) p.head<2>().array() -= 0.5 * grid.resolution;
    return p;
  }
};

using Marks = std::vector<std::uint8_t>;

/// A flag a base pose, for both lattices of one layer.
struct LayerMarks {
  Marks centres, corners;
};

/// What one row of base poses adds to a part's explanation.
struct RowCount {
  std::size_t tried = 0, feasible = 0;
  Rejections rejections;
};

/// The work on one tray and one of its headings.
struct Task {
  int tray;
  int heading;
  std::vector<int> parts;         // its target parts
  std::vector<LayerMarks> marks;  // one a part: 1 where it can be grasped
  Marks in_range;                 // cells whose centre is within the search radius
};

class RegionSearch {
 public:
  RegionSearch(const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid,
               const Monitor& monitor)
      : problem_(problem), grid_(grid), monitor_(monitor), threads_(resolve_threads(problem.options.threads)) {
    BasePoseEvaluator first(problem, database);
    for (int i = 1; i < threads_; ++i) evaluators_.push_back(first.clone());
    evaluators_.push_back(std::move(first));
    for (int tray = 0; tray < static_cast<int>(problem.trays.size()); ++tray) add_tasks(tray, database);
  }

  std::vector<BaseRegion> run() {
    std::vector<BaseRegion> regions;
    for (const Tray& tray : problem_.trays) regions.push_back(empty_region(tray));
    home_.resize(grid_.headings.size());
    const bool done =
        check_home(false) && check_parts(false, regions) && check_home(true) && check_parts(true, regions);
    if (!done) return {};
    for (const Task& task : tasks_) fill(task, regions[static_cast<std::size_t>(task.tray)]);
    return regions;
  }

 private:
  void add_tasks(int index, const ReachDatabase& database) {
    const Tray& tray = problem_.trays[static_cast<std::size_t>(index)];
    const double radius = base_search_radius(problem_, tray, database);
    const Eigen::Vector2d middle = tray.T_world_tray.translation().head<2>();
    for (double wanted : tray_headings(tray)) {
      Task task;
      task.tray = index;
      for (int p = 0; p < static_cast<int>(tray.parts.size()); ++p) {
        if (tray.parts[static_cast<std::size_t>(p)].target) task.parts.push_back(p);
      }
      if (task.parts.empty()) return;
      for (task.heading = 0; task.heading < static_cast<int>(grid_.headings.size()); ++task.heading) {
        if (std::abs(wrap_angle(grid_.headings[static_cast<std::size_t>(task.heading)] - wanted)) < 1e-9) break;
      }
      if (task.heading == static_cast<int>(grid_.headings.size())) continue;  // a grid made by hand may leave it out
      const Lattice centres{grid_, task.heading, false};
      task.in_range.assign(centres.size(), 0);
      for (int iy = 0; iy < grid_.ny; ++iy) {
        for (int ix = 0; ix < grid_.nx; ++ix) {
          task.in_range[centres.index(ix, iy)] = (centres.pose(ix, iy).head<2>() - middle).norm() <= radius;
        }
      }
      const Lattice corners{grid_, task.heading, true};
      task.marks.assign(task.parts.size(), LayerMarks{Marks(centres.size(), 0), Marks(corners.size(), 0)});
      tasks_.push_back(std::move(task));
    }
  }

  BaseRegion empty_region(const Tray& tray) const {
    BaseRegion region;
    region.tray = tray.name;
    region.cells.assign(grid_.size(), 0);
    for (const Part& part : tray.parts) {
      if (!part.target) continue;
      region.part_cells.emplace_back(grid_.size(), 0);
      PartExplanation explanation;
      explanation.part = part.name;
      explanation.grasps = static_cast<int>(part.grasps.size());
      region.explanations.push_back(explanation);
    }
    return region;
  }

  /// A corner counts when a cell beside it has a feasible centre.
  static bool beside(const Marks& centres, const BaseGrid& grid, int ix, int iy) {
    for (int dy = -1; dy <= 0; ++dy) {
      for (int dx = -1; dx <= 0; ++dx) {
        const int cx = ix + dx, cy = iy + dy;
        if (cx < 0 || cy < 0 || cx >= grid.nx || cy >= grid.ny) continue;
        if (centres[static_cast<std::size_t>(cy) * static_cast<std::size_t>(grid.nx) + static_cast<std::size_t>(cx)])
          return true;
      }
    }
    return false;
  }

  bool wanted(const Task& task, std::size_t part, const Lattice& lattice, int ix, int iy) const {
    return lattice.corners ? beside(task.marks[part].centres, grid_, ix, iy)
                           : task.in_range[lattice.index(ix, iy)] != 0;
  }

  /// Where the robot at home is free: the same for all trays of a layer.
  bool check_home(bool corners) {
    std::vector<Marks> wanted_here(grid_.headings.size());
    for (int h = 0; h < static_cast<int>(grid_.headings.size()); ++h) {
      const Lattice lattice{grid_, h, corners};
      Marks& flags = wanted_here[static_cast<std::size_t>(h)];
      flags.assign(lattice.size(), 0);
      for (const Task& task : tasks_) {
        if (task.heading != h) continue;
        for (int iy = 0; iy < lattice.ny(); ++iy) {
          for (int ix = 0; ix < lattice.nx(); ++ix) {
            for (std::size_t p = 0; p < task.parts.size() && !flags[lattice.index(ix, iy)]; ++p) {
              if (wanted(task, p, lattice, ix, iy)) flags[lattice.index(ix, iy)] = 1;
            }
          }
        }
      }
      (corners ? home_[static_cast<std::size_t>(h)].corners : home_[static_cast<std::size_t>(h)].centres)
          .assign(lattice.size(), 0);
    }
    const int rows = grid_.ny + (corners ? 1 : 0);
    return parallel_for(
        grid_.headings.size() * static_cast<std::size_t>(rows), threads_,
        [&](std::size_t item, int worker) {
          const int h = static_cast<int>(item) / rows, iy = static_cast<int>(item) % rows;
          const Lattice lattice{grid_, h, corners};
          LayerMarks& home = home_[static_cast<std::size_t>(h)];
          for (int ix = 0; ix < lattice.nx(); ++ix) {
            const std::size_t i = lattice.index(ix, iy);
            if (!wanted_here[static_cast<std::size_t>(h)][i]) continue;
            const bool free =
                evaluators_[static_cast<std::size_t>(worker)].home(lattice.pose(ix, iy)) == Rejection::none;
            (corners ? home.corners : home.centres)[i] = free;
          }
        },
        monitor_, corners ? "home at corners" : "home at centres");
  }

  /// One item a row of base poses, so that nothing depends on the number of threads.
  bool check_parts(bool corners, std::vector<BaseRegion>& regions) {
    const int rows = grid_.ny + (corners ? 1 : 0);
    std::vector<std::vector<RowCount>> counts(tasks_.size() * static_cast<std::size_t>(rows));
    const bool done = parallel_for(
        counts.size(), threads_,
        [&](std::size_t item, int worker) {
          // Rows are dealt out tray by tray in turn: a tray's rows near its middle cost most.
          Task& task = tasks_[item % tasks_.size()];
          check_row(task, static_cast<int>(item / tasks_.size()), corners, counts[item],
                    evaluators_[static_cast<std::size_t>(worker)]);
        },
        monitor_, corners ? "base regions, corners" : "base regions, centres");
    if (!done) return false;
    for (std::size_t item = 0; item < counts.size(); ++item) {
      BaseRegion& region = regions[static_cast<std::size_t>(tasks_[item % tasks_.size()].tray)];
      for (std::size_t p = 0; p < counts[item].size(); ++p) {
        PartExplanation& explanation = region.explanations[p];
        explanation.base_poses_tried += counts[item][p].tried;
        explanation.base_poses_feasible += counts[item][p].feasible;
        explanation.rejections += counts[item][p].rejections;
      }
    }
    if (!corners) count_home_collisions(regions);
    return true;
  }

  void check_row(Task& task, int iy, bool corners, std::vector<RowCount>& counts, BasePoseEvaluator& evaluator) {
    const Lattice lattice{grid_, task.heading, corners};
    const LayerMarks& home = home_[static_cast<std::size_t>(task.heading)];
    counts.resize(task.parts.size());
    std::vector<int> last(task.parts.size(), -1);  // the grasp that worked at the base pose before
    std::vector<Rejection> causes;
    for (int ix = 0; ix < lattice.nx(); ++ix) {
      if (monitor_.stopped()) return;
      const std::size_t i = lattice.index(ix, iy);
      if (!(corners ? home.corners : home.centres)[i]) continue;
      const Eigen::Vector3d pose = lattice.pose(ix, iy);
      for (std::size_t p = 0; p < task.parts.size(); ++p) {
        if (!wanted(task, p, lattice, ix, iy)) continue;
        RowCount& count = counts[p];
        ++count.tried;
        const int grasp = evaluator.find_grasp(pose, task.tray, task.parts[p], last[p], causes);
        if (grasp < 0) {
          for (Rejection cause : causes) count.rejections.add(cause);
          continue;
        }
        ++count.feasible;
        last[p] = grasp;
        (corners ? task.marks[p].corners : task.marks[p].centres)[i] = 1;
      }
    }
  }

  void count_home_collisions(std::vector<BaseRegion>& regions) const {
    for (const Task& task : tasks_) {
      const Marks& free = home_[static_cast<std::size_t>(task.heading)].centres;
      for (std::size_t i = 0; i < free.size(); ++i) {
        if (task.in_range[i] && !free[i]) ++regions[static_cast<std::size_t>(task.tray)].base_poses_in_collision;
      }
    }
  }

  /// A cell takes part when its centre and its four corners are feasible.
  void fill(const Task& task, BaseRegion& region) const {
    const Lattice centres{grid_, task.heading, false}, corners{grid_, task.heading, true};
    for (int iy = 0; iy < grid_.ny; ++iy) {
      for (int ix = 0; ix < grid_.nx; ++ix) {
        bool all = true;
        for (std::size_t p = 0; p < task.parts.size(); ++p) {
          const LayerMarks& marks = task.marks[p];
          const bool good = marks.centres[centres.index(ix, iy)] && marks.corners[corners.index(ix, iy)] &&
                            marks.corners[corners.index(ix + 1, iy)] && marks.corners[corners.index(ix, iy + 1)] &&
                            marks.corners[corners.index(ix + 1, iy + 1)];
          region.part_cells[p][grid_.index(task.heading, ix, iy)] = good;
          all = all && good;
        }
        region.cells[grid_.index(task.heading, ix, iy)] = all;
      }
    }
  }

  const PartSupplyProblem& problem_;
  const BaseGrid& grid_;
  const Monitor& monitor_;
  int threads_;
  std::vector<BasePoseEvaluator> evaluators_;
  std::vector<Task> tasks_;
  std::vector<LayerMarks> home_;
};

}  // namespace

std::vector<BaseRegion> compute_base_regions(const PartSupplyProblem& problem, const ReachDatabase& database,
                                             const BaseGrid& grid, const Monitor& monitor) {
  return RegionSearch(problem, database, grid, monitor).run();
}

}  // namespace mmgrasp
