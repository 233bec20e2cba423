#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/ids.hpp"

namespace mmgrasp {

/// The largest disc inside a union of grid cells.
struct MMGRASP_EXPORT InscribedCircle {
  double radius = 0;                                 ///< [m]; 0 when there is no cell.
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< [m]
};

/// The largest disc in one layer: exact on the cells' squares to 1e-9 m in radius (branch and bound on the distance to
/// the complement).
MMGRASP_EXPORT InscribedCircle inscribed_circle(const BaseGrid& grid, const CellMask& cells, int heading);

/// Cells that several regions share, with their largest disc (P1 3.4.2).
struct MMGRASP_EXPORT Intersection {
  std::vector<TrayId> trays;                         ///< Trays whose regions share the cells, ascending, each once.
  int heading = 0;                                   ///< Layer of the grid.
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< Centre of the disc [m].
  double radius = 0;                                 ///< Radius of the disc [m].
  std::size_t cells = 0;                             ///< Number of shared cells.
};

/// Sets of trays whose shared cells hold a disc of at least some radius, and how many sets were tried.
struct MMGRASP_EXPORT Intersections {
  std::vector<Intersection> robust;
  std::size_t sets_tried = 0;
  std::size_t sets_too_small = 0;  ///< Shared cells, but the disc is too small.
  bool complete = true;  ///< False: `max_sets` ended the search; minimality then holds for the sets found only.
  /// The sets whose disc is too small, largest radius first; the 200 largest are kept.
  std::vector<Intersection> too_small;
};

/// Every set of trays (single ones included) whose shared cells hold a disc of at least `min_radius`. `regions` holds
/// one region a tray; those without targets take no part. Sets grow tray by tray: one is tried only if all its subsets
/// are robust, and at most `max_sets` are.
MMGRASP_EXPORT Intersections robust_intersections(const BaseGrid& grid, const std::vector<BaseRegion>& regions,
                                                  double min_radius, std::size_t max_sets = 200000);

/// The same, but only sets that are part of no other robust set: every stop that could be made at all is among them, so
/// they are enough to prove a least number of stops, and there are few of them (some thousand for 500 trays) where
/// robust_intersections() would list every subset.
///
/// The search is on the floor, not on the sets: boxes of base positions are split until the trays that each could serve
/// at most are known. A disc counts when it is smaller than `min_radius` by no more than 1e-9 m, as everywhere.
/// `complete` is false when `max_boxes` a layer or the monitor ended the search. sets_tried counts the sets found,
/// `too_small` stays empty.
MMGRASP_EXPORT Intersections maximal_intersections(const BaseGrid& grid, const std::vector<BaseRegion>& regions,
                                                   double min_radius, std::size_t max_boxes = 50'000'000,
                                                   const Monitor& monitor = {});

/// Where the base stops and which trays it serves there.
struct MMGRASP_EXPORT Stop {
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< x, y, theta
  double radius = 0;                ///< Radius of the disc around it in which every target part stays graspable [m].
  std::vector<TrayId> trays;        ///< Trays served here, ascending; each tray at one stop.
  int intersection = -1;            ///< Index into the robust intersections; -1: unknown.
  std::size_t arrivals = 0;         ///< Arrivals of the base drawn by PartSupplyProblem::arrival_covariance; 0: none.
  std::size_t arrivals_served = 0;  ///< Those of them from which all parts of its trays can be grasped.
};

/// Stops that together serve the trays, and how few are proven to be enough.
struct MMGRASP_EXPORT StopSet {
  /// solved: proven least; approximate: a cover that may have too many stops; infeasible: proven that a tray is in no
  /// stop, for the regions as given.
  Outcome outcome = Outcome::not_found;
  std::vector<Stop> stops;                ///< Not ordered yet.
  int lower_bound = 0;                    ///< Proven least number of stops.
  std::vector<TrayId> unreachable_trays;  ///< Trays that no stop can serve.
  Intersections candidates;               ///< The maximal intersections that plan_stops_exact() chose from.
};

/// Options of plan_stops_exact(): requirements, and the effort spent on choosing among equally few stops.
struct MMGRASP_EXPORT StopOptions {
  double min_radius = 0.10;      ///< Positioning uncertainty: the least disc at every stop [m]; >= 0.
  double time_limit = 60.0;      ///< Time for the proof that fewer stops do not suffice [s]; > 0.
  double tie_time_limit = 10.0;  ///< Time for choosing among equally few stops [s]; >= 0.
  /// Length of the shortest route over some stops, the last tie-breaker; empty: routes are not compared.
  std::function<double(const std::vector<Stop>&)> route_length;
  void check() const;
};

/// Where should the base stop so that every tray is served with as few stops as possible? The whole of P1's
/// PlanMinSequence from the regions (one a tray; those without targets are not served), over maximal_intersections().
///
/// - First the least number of stops;
/// - among equally few, the largest smallest disc (to 0.1 mm);
/// - then the largest sum of radii (P1 equation 3.2; counted in whole millimetres, over discs no more than a quarter of
///   a cell, or a sixteenth of their range, apart);
/// - then the shortest route among up to 200 sequences.
///
/// Each tray is served at one stop, and the disc of a stop is the widest one for exactly its trays. The outcome tells
/// about the number of stops only. Stop::intersection stays -1.
/// @code
///   StopOptions options;
///   options.min_radius = 0.08;  // the base may stand 8 cm off
///   const StopSet set = plan_stops_exact(grid, compute_base_regions(problem, database, grid), options);
/// @endcode
MMGRASP_EXPORT StopSet plan_stops_exact(const BaseGrid& grid, const std::vector<BaseRegion>& regions,
                                        const StopOptions& options = {}, const Monitor& monitor = {});

/// Length of the shortest route from `start` over all stops to `goal` as the crow flies [m]; for
/// StopOptions::route_length.
MMGRASP_EXPORT double straight_route_length(const std::vector<Stop>& stops, const Eigen::Vector2d& start,
                                            const Eigen::Vector2d& goal);

/// The least number of intersections that cover all trays (P1 equation 3.1), by 0-1 programming with proof; among
/// equally few, larger discs are preferred. A tray goes to the stop with the largest disc; one named twice is refused.
MMGRASP_EXPORT StopSet cover_from_intersections(const BaseGrid& grid, const std::vector<Intersection>& intersections,
                                                int trays);

/// The same over what robust_intersections() found. When that is not complete, sets of trays that were never tried
/// could save stops: all that is proven then is that one stop is needed, and more than one stop is an approximate
/// answer.
MMGRASP_EXPORT StopSet cover_from_intersections(const BaseGrid& grid, const Intersections& intersections, int trays);

}  // namespace mmgrasp
