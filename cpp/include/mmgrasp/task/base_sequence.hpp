#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/task/base_region.hpp"

namespace mmgrasp {

/// The largest disc inside a union of grid cells.
struct MMGRASP_EXPORT InscribedCircle {
  double radius = 0;  ///< 0 when there is no cell.
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
};

/// Exact on the cells' squares to 1e-6 m in radius (branch and bound on the distance to the complement). One layer.
MMGRASP_EXPORT InscribedCircle inscribed_circle(const BaseGrid& grid, const CellMask& cells, int heading);

/// Cells that several regions share, with their largest disc (P1 3.4.2).
struct MMGRASP_EXPORT Intersection {
  std::vector<int> trays;  ///< Indices into the regions, ascending.
  int heading = 0;         ///< Layer.
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0;
  std::size_t cells = 0;
};

/// Every set of trays (first order included) whose shared cells hold a disc of at least `min_radius`, and how many sets
/// were looked at and lost. Grown order by order: a set is tried only if all its subsets are robust.
struct MMGRASP_EXPORT Intersections {
  std::vector<Intersection> robust;
  std::size_t sets_tried = 0;
  std::size_t sets_too_small = 0;  ///< Shared cells, but the disc is too small.
  bool complete = true;  ///< False: `max_sets` ended the search; minimality then holds for the sets found only.
  std::vector<Intersection> lost;  ///< Those, up to 200, largest radius first: why each alternative lost.
};

MMGRASP_EXPORT Intersections robust_intersections(const BaseGrid& grid, const std::vector<BaseRegion>& regions,
                                                  double min_radius, std::size_t max_sets = 200000);

/// The same, but only sets that are part of no other robust one: every stop that could be made at all is among them, so
/// they are enough to prove a least number of stops, and there are few of them (some thousand for 500 trays) where
/// robust_intersections() would list every subset. Found on the floor, not on the sets: boxes of places are split until
/// what each could serve at most is known (no disc smaller than `min_radius` by more than 1e-9 m counts; sets whose
/// disc is within 1e-6 m of it may be judged either way). `complete` is false when `max_boxes` a layer or the monitor
/// ended the search. sets_tried counts the sets found, `lost` stays empty.
MMGRASP_EXPORT Intersections maximal_intersections(const BaseGrid& grid, const std::vector<BaseRegion>& regions,
                                                   double min_radius, std::size_t max_boxes = 50'000'000,
                                                   const Monitor& monitor = {});

/// Where the base stops and which trays it serves there.
struct MMGRASP_EXPORT Stop {
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< x, y, theta
  double radius = 0;       ///< Of the disc around it in which every target part stays graspable [m].
  std::vector<int> trays;  ///< Trays picked here (each tray at one stop).
  int intersection = -1;   ///< Index into the robust intersections.
};

struct MMGRASP_EXPORT StopSet {
  Outcome outcome = Outcome::infeasible;  ///< Solved: proven least; approximate: a cover that may have too many stops.
  std::vector<Stop> stops;                ///< In no order yet.
  int lower_bound = 0;                    ///< Proven least number of stops.
  std::vector<int> unreachable_trays;
  Intersections candidates;  ///< least_stops(): the maximal intersections it chose from.
};

/// What is asked of a least sequence of stops, and how equally short ones are told apart.
struct MMGRASP_EXPORT StopOptions {
  double min_radius = 0.10;      ///< Positioning uncertainty: the least disc at every stop [m]; >= 0.
  double time_limit = 60.0;      ///< For the proof that fewer stops cannot do [s]; > 0.
  double tie_time_limit = 10.0;  ///< For choosing among equally few stops [s]; >= 0.
  /// Length of the shortest route over some stops, the last tie-breaker; empty: not looked at.
  std::function<double(const std::vector<Stop>&)> route_length;
  void check() const;
};

/// The whole of P1's PlanMinSequence from the regions: the least number of stops, over maximal_intersections(); among
/// equally few, the largest smallest disc (to 0.1 mm), of those the largest sum of radii (P1 equation 3.2; counted in
/// whole millimetres, over discs no more than a quarter of a cell, or a sixteenth of their range, apart), of those the
/// shortest route among up to 200 sequences. Each tray is served at one stop, and the disc of a stop is the widest one
/// for exactly its trays. The outcome tells about the number of stops only. Stop::intersection stays -1.
MMGRASP_EXPORT StopSet least_stops(const BaseGrid& grid, const std::vector<BaseRegion>& regions,
                                   const StopOptions& options = {}, const Monitor& monitor = {});

/// The least number of robust intersections that cover all trays (P1 equation 3.1), by 0-1 programming with proof;
/// among equally few, larger discs are preferred. Each tray goes to the chosen stop with the largest disc.
MMGRASP_EXPORT StopSet minimal_stops(const BaseGrid& grid, const std::vector<Intersection>& intersections, int trays);

/// The same over what robust_intersections() found. When that is not complete, sets of trays that were never looked at
/// could save stops: all that is proven then is that one stop is needed, and more than one stop is an approximate
/// answer.
MMGRASP_EXPORT StopSet minimal_stops(const BaseGrid& grid, const Intersections& intersections, int trays);

}  // namespace mmgrasp
