#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

/// Square cells over the floor, one layer for each heading; all trays share one grid so that regions intersect cell by
/// cell.
struct MMGRASP_EXPORT BaseGrid {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< Lower corner of cell (0, 0) [m].
  double resolution = 0.05;
  int nx = 0, ny = 0;
  std::vector<double> headings;  ///< [rad], distinct.

  int cells_per_layer() const { return nx * ny; }
  std::size_t size() const { return headings.size() * static_cast<std::size_t>(nx) * ny; }
  std::size_t index(int heading, int ix, int iy) const {
    return (static_cast<std::size_t>(heading) * ny + iy) * nx + ix;
  }
  Eigen::Vector3d centre(int heading, int ix, int iy) const;  ///< (x, y, theta)
};

/// One flag a cell of a BaseGrid.
using CellMask = std::vector<std::uint8_t>;

/// The cells of a BaseGrid from which one part can be grasped: flags, kept for the rows and columns that hold any,
/// since a grid over a whole storeroom is much larger than what one part needs.
class MMGRASP_EXPORT PartCells {
 public:
  /// Flags of a block of cells of one layer, row by row.
  struct Window {
    int heading, x0, y0, nx, ny;
    std::vector<std::uint8_t> flags;
  };
  PartCells() = default;
  explicit PartCells(const BaseGrid& grid) : nx_(grid.nx), ny_(grid.ny), size_(grid.size()) {}
  /// As it was: what grid and windows() told.
  PartCells(int nx, int ny, std::size_t size, std::vector<Window> windows)
      : nx_(nx), ny_(ny), size_(size), windows_(std::move(windows)) {}
  int nx() const { return nx_; }              ///< Of the grid.
  int ny() const { return ny_; }              ///< Of the grid.
  std::size_t size() const { return size_; }  ///< Of the grid.
  const std::vector<Window>& windows() const { return windows_; }
  bool operator[](std::size_t cell) const;  ///< By BaseGrid::index().
  std::size_t count() const;
  CellMask mask() const;  ///< One flag a cell of the grid.
  bool operator==(const PartCells& other) const;
  /// Flags of a block of one layer, row by row; at most one block a layer.
  void add_window(int heading, int x0, int y0, int nx, int ny, const std::vector<std::uint8_t>& flags);

 private:
  int nx_ = 0, ny_ = 0;
  std::size_t size_ = 0;
  std::vector<Window> windows_;
};

/// What became of the candidates for one part, over all base poses tried. The rejections count grasp x base pose pairs
/// at the base poses from which the part cannot be grasped: there every grasp fell, each to one cause, so that their
/// total is grasps x (base_poses_tried - base_poses_feasible). Where one grasp works the others are not looked at. The
/// cause of a pair is the last filter that any of its arm configurations got to: reach, limits, self-collision, scene;
/// `grasp_filter` when the open hand alone touches the scene or a part at the grasp, whatever the arm does.
struct MMGRASP_EXPORT PartExplanation {
  std::string part;
  int grasps = 0;  ///< Candidates.
  /// Centres of cells within the search radius, and corners of those cells whose centre is feasible for the part;
  /// without the base poses at which the robot at home touches the scene.
  std::size_t base_poses_tried = 0;
  std::size_t base_poses_feasible = 0;  ///< Base poses from which the part has a collision-free grasp.
  Rejections rejections;                ///< Grasp x base pose pairs by the cause that turned them down.
};

struct MMGRASP_EXPORT BaseRegion {
  std::string tray;
  CellMask cells;                     ///< 1: from everywhere in this cell every target part can be grasped.
  std::vector<PartCells> part_cells;  ///< The same for each target part alone, in the tray's order.
  std::vector<PartExplanation> explanations;
  std::size_t base_poses_in_collision =
      0;  ///< Cell centres within the search radius at which the robot at home touches the scene.
  std::size_t count() const;
};

/// One part seen from one base pose.
struct MMGRASP_EXPORT PartAtPose {
  bool feasible = false;
  int grasp = -1;                 ///< A grasp that works.
  Eigen::VectorXd q;              ///< A collision-free arm configuration for it.
  std::vector<Rejection> causes;  ///< When not feasible: one a grasp.
};

struct EvaluatorTables;

/// Asks for single base poses what compute_base_regions asks for all of them: the same base pose gives the same answer,
/// whatever was asked before. Parts are all in place. Not thread-safe (scratch inside): `clone()` gives one per thread.
/// The problem and the database must outlive it.
class MMGRASP_EXPORT BasePoseEvaluator {
 public:
  BasePoseEvaluator(const PartSupplyProblem& problem, const ReachDatabase& database);
  BasePoseEvaluator(BasePoseEvaluator&&) noexcept;
  BasePoseEvaluator& operator=(BasePoseEvaluator&&) noexcept;
  ~BasePoseEvaluator();
  BasePoseEvaluator clone() const;
  /// The same with these parts (tray, part) gone: they are nobody's obstacle any more, and are not to be asked for.
  /// Quicker than a new one. Throws InvalidInput for a part that is gone already.
  BasePoseEvaluator without(const std::vector<std::pair<int, int>>& tray_and_part) const;

  /// What the robot at home with fingers at rest runs into when its base stands there (x, y, theta).
  Rejection home(const Eigen::Vector3d& base_pose);
  /// Grasps are tried in order, `first_grasp` (when >= 0) before the others: that saves time and changes only which
  /// grasp is named. The robot at home is not looked at.
  PartAtPose part(const Eigen::Vector3d& base_pose, int tray, int part, int first_grasp = -1);
  /// Index of a grasp that works, or -1 with one cause for each in `causes`. As part(), quicker: without naming a
  /// configuration, and what worked near by is tried first; that changes only which grasp is named.
  int find_grasp(const Eigen::Vector3d& base_pose, int tray, int part, int first_grasp, std::vector<Rejection>& causes);
  /// The same with random restarts of IK: slower, finds a configuration in more cases. For checks, not for regions.
  bool part_with_restarts(const Eigen::Vector3d& base_pose, int tray, int part, int first_grasp = -1);
  /// True when the open hand alone touches the scene or a part at the grasp: no arm configuration can be free.
  bool hand_blocked(int tray, int part, int grasp) const;
  /// Distance by which the tool at its nearest usable grasp lies beyond the arm's reach from a base pose [m]; 0:
  /// within.
  double missing_reach(const Eigen::Vector3d& base_pose, int tray, int part) const;

 private:
  struct Impl;
  explicit BasePoseEvaluator(std::unique_ptr<Impl> impl);
  static std::unique_ptr<Impl> make_impl(const std::shared_ptr<EvaluatorTables>& tables, const World& world);
  std::unique_ptr<Impl> impl_;
};

/// The grid that covers all base poses from which any tray could be reached.
MMGRASP_EXPORT BaseGrid make_base_grid(const PartSupplyProblem& problem, const ReachDatabase& database);

/// P1 Algorithm 2, with exact IK: a base pose is feasible when every target part has a grasp with a collision-free arm
/// configuration (all parts still in place, fingers at the pre-grasp opening) and the robot at home is free there. A
/// tray without target parts gives an empty region, and so does a part without grasps. A cell belongs to the region
/// when its centre and its four corners are feasible, so that the guarantee holds between cell centres too. Same answer
/// at any thread count.
MMGRASP_EXPORT std::vector<BaseRegion> compute_base_regions(const PartSupplyProblem& problem,
                                                            const ReachDatabase& database, const BaseGrid& grid,
                                                            const Monitor& monitor = {});

}  // namespace mmgrasp
