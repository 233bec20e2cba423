// Finds the least number of stops again from the regions of the plan.
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "verify/base/floor.hpp"
#include "verify/base/shared_discs.hpp"
#include "verify/base/smallest_cover.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr double kFigureBand = 2e-6;  // [m] Radii above the uncertainty only describe; planners find them to 1e-6 m.
constexpr double kRounding = 1e-12;   // [m] Of sums such as a radius less the slack.

bool check_grid(const PlanToCheck& plan, Faults& faults) {
  const CheckedGrid& grid = plan.grid;
  const auto finite = [](double h) { return std::isfinite(h); };
  const bool good = grid.nx > 0 && grid.ny > 0 && std::isfinite(grid.resolution) && grid.resolution > 0 &&
                    grid.origin.allFinite() && !grid.headings.empty() &&
                    std::all_of(grid.headings.begin(), grid.headings.end(), finite) &&
                    plan.positioning_uncertainty < 1000 * grid.resolution;
  if (!good)
    faults.push_back({"region-malformed", "grid", "sizes, resolution and headings must be positive and finite"});
  return good;
}

/// Regions whose arrays fit the grid, in the plan's order.
std::vector<const CheckedRegion*> usable_regions(const PlanToCheck& plan, Faults& faults) {
  const std::size_t cells = plan.grid.headings.size() * static_cast<std::size_t>(plan.grid.nx) * plan.grid.ny;
  std::vector<const CheckedRegion*> usable;
  std::set<std::string> names;
  for (const CheckedRegion& region : plan.regions) {
    const std::string where = "region of tray '" + region.tray + "'";
    if (region.cells.size() != cells) {
      faults.push_back({"region-malformed", where,
                        "has " + std::to_string(region.cells.size()) + " cells, the grid " + std::to_string(cells)});
    } else if (!names.insert(region.tray).second) {
      faults.push_back({"region-malformed", where, "is there twice"});
    } else {
      usable.push_back(&region);
    }
  }
  return usable;
}

/// Holds the plan's stops against its regions: where they stand, how much room they have, whether fewer would do.
class StopsCheck {
 public:
  StopsCheck(const Context& context, std::vector<const CheckedRegion*> regions, Faults& faults)
      : context_(context), plan_(context.plan), faults_(faults), floor_(plan_.grid, regions) {
    for (std::size_t i = 0; i < regions.size(); ++i) region_of_tray_[regions[i]->tray] = static_cast<int>(i);
    for (const CheckedPart& part : plan_.parts) {
      if (!part.target) continue;
      const auto region = region_of_tray_.find(part.tray);
      if (region != region_of_tray_.end()) {
        wanted_.insert(region->second);
      } else if (missing_.insert(part.tray).second) {
        faults_.push_back(
            {"region-missing", "regions", "tray '" + part.tray + "' holds target parts and has no usable region"});
      }
    }
  }

  void run(PlanCheckResult& result) {
    std::vector<RegionSet> own;
    for (std::size_t i = 0; i < plan_.stops.size(); ++i) check_stop(i, own);
    for (std::size_t i = 0; i < plan_.intersections.size(); ++i) check_intersection(i);
    if (plan_.robustness_rate < context_.options.required_rate || plan_.robustness_rate > 1) {
      faults_.push_back({"wrong-values", "robustness_rate",
                         text(plan_.robustness_rate) + ": must be in [" + text(context_.options.required_rate) +
                             ", 1], or the stops would not be robust"});
    }
    check_headings();
    if (!missing_.empty()) return;
    SharedDiscs discs = shared_discs(floor_, plan_.positioning_uncertainty, context_.monitor);
    for (const RegionSet& set : own) {
      add_maximal(discs.certain, set);
      add_maximal(discs.possible, set);
    }
    const CoverBounds needed = smallest_cover(discs.possible, wanted_);
    const CoverBounds enough = discs.certain == discs.possible ? needed : smallest_cover(discs.certain, wanted_);
    judge_count(needed.lower, enough.upper);
    result.minimal_stops = std::max(enough.upper, 0);
    result.lower_bound = std::max(needed.lower, 0);
    result.search_cut = discs.cut;
  }

 private:
  /// The disc around the stop, in every region it claims; notes the regions that truly hold it.
  void check_stop(std::size_t index, std::vector<RegionSet>& own) {
    const CheckedStop& stop = plan_.stops[index];
    const std::string where = "stop " + std::to_string(index);
    const double needed = plan_.positioning_uncertainty;
    const int layer = floor_.layer(stop.pose.z());
    if (layer < 0) {
      faults_.push_back({"stop-heading", where, "heading " + text(stop.pose.z()) + " is none of the grid's"});
      return;
    }
    if (stop.radius < needed - kRadiusSlack - kRounding) {
      faults_.push_back(
          {"stop-radius", where,
           "radius " + text(stop.radius) + " m is below the positioning uncertainty " + text(needed) + " m"});
    }
    const double wanted = std::max(stop.radius, needed);
    double least_room = mmgrasp::detail::kInfinity;
    RegionSet holding;
    for (int region = 0; region < floor_.regions(); ++region) {
      if (clearance(region, layer, stop, needed) >= needed - kRadiusSlack - kRounding) holding.insert(region);
    }
    for (const std::string& tray : stop.trays) {
      const auto region = region_of_tray_.find(tray);
      if (region == region_of_tray_.end()) continue;
      const double room = clearance(region->second, layer, stop, wanted);
      least_room = std::min(least_room, room);
      if (room >= wanted - kFigureBand && room >= needed - kRadiusSlack - kRounding) continue;
      faults_.push_back({"stop-outside-region", where,
                         "a disc of " + text(wanted) + " m is said to lie in the region of tray '" + tray +
                             "', there is room for " + text(room) + " m"});
    }
    own.push_back(holding);
    if (std::isfinite(least_room) && least_room > wanted + kFigureBand) {
      faults_.push_back(
          {"stop-radius", where,
           "radius " + text(stop.radius) + " m is not that of the largest disc around it in the regions of its trays"});
    }
  }

  /// Every tray was searched at each of its headings and, unless it shares those of others, at no other.
  void check_headings() {
    for (const auto& [tray, searched] : plan_.searched) {
      const auto known = region_of_tray_.find(tray);
      if (known == region_of_tray_.end() || !wanted_.count(known->second)) continue;
      std::set<int> layers;
      for (const double heading : searched.headings) {
        const int layer = floor_.layer(heading);
        if (layer >= 0) layers.insert(layer);
        if (layer < 0)
          faults_.push_back({"region-malformed", "grid",
                             "has no layer for heading " + text(heading) + ", which tray '" + tray + "' lists"});
      }
      if (searched.shares_headings) continue;
      for (int layer = 0; layer < static_cast<int>(plan_.grid.headings.size()); ++layer) {
        if (layers.count(layer) || !floor_.any(known->second, layer)) continue;
        faults_.push_back(
            {"region-malformed", "region of tray '" + tray + "'",
             "has cells at heading " + text(plan_.grid.headings[layer]) + ", which its tray does not list"});
      }
    }
  }

  /// The largest disc around its centre that lies in the regions of its trays.
  void check_intersection(std::size_t index) {
    const CheckedIntersection& said = plan_.intersections[index];
    const std::string where = "intersection " + std::to_string(index);
    std::set<std::string> named;
    for (const std::string& tray : said.trays) {
      if (!named.insert(tray).second) faults_.push_back({"wrong-values", where, "names tray '" + tray + "' twice"});
    }
    const int layer = std::isfinite(said.heading) ? floor_.layer(said.heading) : -1;
    bool good = layer >= 0 && said.centre.allFinite() && said.radius >= 0 && std::isfinite(said.radius);
    double room = mmgrasp::detail::kInfinity;
    for (std::size_t i = 0; good && i < said.trays.size(); ++i) {
      const auto region = region_of_tray_.find(said.trays[i]);
      good = region != region_of_tray_.end();
      if (good) room = std::min(room, clearance(region->second, layer, said.centre, said.radius));
    }
    good = good && std::abs(room - said.radius) <= kFigureBand;
    if (good) return;
    faults_.push_back({"wrong-values", where,
                       "its disc of " + text(said.radius) +
                           " m does not lie in the regions of all its trays, or is not the largest around its centre"});
  }

  double clearance(int region, int layer, const CheckedStop& stop, double radius) const {
    return clearance(region, layer, Eigen::Vector2d(stop.pose.head<2>()), radius);
  }

  double clearance(int region, int layer, const Eigen::Vector2d& point, double radius) const {
    const double limit = 4 * plan_.grid.resolution * (plan_.grid.nx + plan_.grid.ny);  // a disc larger than the grid
    return floor_.clearance(region, layer, point, std::min(radius + 1e-3, limit));
  }

  /// Judges the number of stops: at least `least` are needed, `enough` suffice; negative: no number of them.
  void judge_count(int least, int enough) {
    const int stops = static_cast<int>(plan_.stops.size());
    if (least < 0) {
      faults_.push_back({"region-too-small", "regions",
                         "some tray's region holds no disc of " + text(plan_.positioning_uncertainty) + " m anywhere"});
      return;
    }
    if (enough >= 0 && enough < stops) {
      faults_.push_back(
          {"not-minimal", "stops",
           std::to_string(stops) + " stops, " + std::to_string(enough) + " are enough for these regions"});
    }
    if (plan_.lower_bound < least || plan_.lower_bound > (enough < 0 ? stops : enough)) {
      const std::string range =
          least == enough ? "the least number of stops is " + std::to_string(least)
                          : "at least " + std::to_string(least) + " stops are needed, " +
                                (enough < 0 ? "more was not decided" : std::to_string(enough) + " are enough");
      faults_.push_back({"lower-bound", "lower_bound", "says " + std::to_string(plan_.lower_bound) + ", " + range});
    }
  }

  const Context& context_;
  const PlanToCheck& plan_;
  Faults& faults_;
  Floor floor_;
  std::map<std::string, int> region_of_tray_;
  RegionSet wanted_;
  std::set<std::string> missing_;
};

}  // namespace

void check_stops(const Context& context, PlanCheckResult& result) {
  if (!check_grid(context.plan, result.faults)) return;
  StopsCheck(context, usable_regions(context.plan, result.faults), result.faults).run(result);
}

}  // namespace mmgrasp::verify::detail
