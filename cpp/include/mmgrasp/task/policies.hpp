#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp {

/// What the stops of a round are planned for (P1 3.5): all parts of each tray, those still there, or those to be picked
/// in the round.
enum class UpdatePolicy { all, remaining, targets };

MMGRASP_EXPORT const char* to_string(UpdatePolicy policy);
/// "all", "remaining" or "targets"; throws InvalidInput naming these on anything else.
MMGRASP_EXPORT UpdatePolicy make_update_policy(const std::string& name);

/// Base poses from which each part can be grasped: one bitmap a part, by tray.
struct MMGRASP_EXPORT PartRegions {
  BaseGrid grid;
  std::vector<std::vector<CellMask>> cells;  ///< [tray][part]
  /// Throws InvalidInput on a bitmap that does not fit the grid.
  void check() const;
  /// Cells from which all of these parts of a tray can be grasped (every cell when there are none).
  CellMask region(int tray, const std::vector<int>& parts) const;
};

/// Which part of each tray is picked in which round: [tray][round], -1 for none. Each part at most once.
using PickingOrder = std::vector<std::vector<int>>;

/// P1's heuristic (figure 3.11): tray by tray, each part goes with the part of the tray before so that the distances
/// within these pairs are as equal as can be (least squares about their mean). `places` are the parts' positions on the
/// floor, [tray][part]; the first tray's parts come in their order. Trays may hold different numbers of parts: a
/// round without a partner is -1, and parts left over take rounds in which the tray before has none.
MMGRASP_EXPORT PickingOrder paired_order(const std::vector<std::vector<Eigen::Vector2d>>& places);

/// What a picking order should make large, and how many orders optimised_order() tries.
struct MMGRASP_EXPORT OrderOptions {
  bool smallest_first = false;      ///< Maximise the smallest radius over the rounds, then their sum; else the sum.
  int restarts = 20;                ///< Random orders to start from, where a search is needed; >= 0.
  std::size_t max_tried = 200'000;  ///< Orders of one group up to which all are tried; >= 0.
  unsigned seed = 1;
  void check() const;
};

/// A picking order, and how large the discs are in which the base may stop for its rounds.
struct MMGRASP_EXPORT OptimisedOrder {
  PickingOrder order;
  double mean_radius = 0;      ///< Mean radius of the discs, over rounds and groups [m].
  double smallest_radius = 0;  ///< Smallest of these radii [m].
  bool proven = true;          ///< No other order is better for these groups.
};

/// The order in which parts are best picked when the trays of each group are served together (from one stop): for one
/// and two trays by assignment, for more by trying all orders where that is possible, else tray by tray by assignment
/// from `start` and random orders until nothing is gained. Never worse than `start` for these groups. Every tray of a
/// group must hold as many parts as there are rounds in `start`.
MMGRASP_EXPORT OptimisedOrder optimised_order(const PartRegions& parts, const std::vector<std::vector<int>>& groups,
                                              const PickingOrder& start, const OrderOptions& options = {});

/// One round of pick and place.
struct MMGRASP_EXPORT PolicyRound {
  Outcome outcome = Outcome::not_found;  ///< The outcome of plan_stops_exact().
  std::vector<Stop> stops;               ///< Their trays are indices into the picking order.
  double mean_radius = 0;                ///< Mean over the stops: P1's robustness_i [m].
  double seconds = 0;                    ///< Spent between the rounds: regions and stops.
  /// The parts picked in this round can be grasped from everywhere in the discs of their stops, as `actual` tells.
  bool reliable = false;
};

/// A row of P1 table 3.4.
struct MMGRASP_EXPORT PolicyResult {
  std::vector<PolicyRound> rounds;
  double mean_radius = 0;      ///< P1 equation 3.2 [m].
  double smallest_radius = 0;  ///< Smallest disc of all stops of all rounds [m].
  double mean_stops = 0;
  bool solved = false;    ///< Every round has stops.
  bool reliable = false;  ///< Every round is.
  bool online = false;    ///< Every round's seconds are within the limit.
  bool feasible = false;  ///< All three.
};

/// How the stops of each round are planned, and how long that may take between two rounds.
struct MMGRASP_EXPORT PolicyOptions {
  StopOptions stops;
  double online_limit = 1.0;  ///< Seconds that may pass between two rounds; > 0.
  void check() const;
};

/// Regions of the trays for a round, one a tray that is visited; what they cost counts as time between rounds.
using RoundRegions = std::function<std::vector<BaseRegion>(int round)>;

/// The regions a policy uses when the parts' bitmaps are known (regular placement). The result refers to `parts` and
/// `order`. Trays without a pick in the round get a region without cells and are not visited.
MMGRASP_EXPORT RoundRegions regions_for(UpdatePolicy policy, const PartRegions& parts, const PickingOrder& order);

/// Plans every round's stops from `planned` and holds them against the parts' true bitmaps. A round whose regions equal
/// the last one's keeps its stops. `planned` gives one region a tray of the order; trays without a pick in a round are
/// left out of it.
MMGRASP_EXPORT PolicyResult run_policy(const RoundRegions& planned, const PartRegions& actual,
                                       const PickingOrder& order, const PolicyOptions& options = {},
                                       const Monitor& monitor = {});

}  // namespace mmgrasp
