#include "mmgrasp/task/policies.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

int rounds_of(const PickingOrder& order) {
  std::size_t rounds = 0;
  for (const auto& tray : order) rounds = std::max(rounds, tray.size());
  return static_cast<int>(rounds);
}

int pick_of(const PickingOrder& order, int tray, int round) {
  const auto& picks = order[tray];
  return round < static_cast<int>(picks.size()) ? picks[round] : -1;
}

void check_order(const PickingOrder& order, const PartRegions& parts) {
  require(order.size() == parts.cells.size(), "order", static_cast<double>(order.size()),
          "must have one list a tray (" + std::to_string(parts.cells.size()) + ")");
  for (std::size_t tray = 0; tray < order.size(); ++tray) {
    std::set<int> picked;
    for (int part : order[tray]) {
      require(part >= -1 && part < static_cast<int>(parts.cells[tray].size()), "order[" + std::to_string(tray) + "]",
              part, "must be a part of the tray, or -1");
      require(part < 0 || picked.insert(part).second, "order[" + std::to_string(tray) + "]", part,
              "must be picked once only");
    }
  }
}

/// Whether a disc stays inside marked cells: no square of the complement is nearer than its radius.
bool disc_inside(const BaseGrid& grid, const CellMask& cells, int heading, const Eigen::Vector2d& centre,
                 double radius) {
  const double h = grid.resolution, band = 1e-6;  // inscribed radii are as exact
  const Eigen::Vector2d low = (centre - grid.origin).array() - radius, high = (centre - grid.origin).array() + radius;
  const auto index = [h](double v) { return static_cast<int>(std::floor(v / h)); };
  for (int iy = index(low.y()); iy <= index(high.y()); ++iy) {
    for (int ix = index(low.x()); ix <= index(high.x()); ++ix) {
      const bool in_grid = ix >= 0 && iy >= 0 && ix < grid.nx && iy < grid.ny;
      if (in_grid && cells[grid.index(heading, ix, iy)]) continue;
      const Eigen::AlignedBox2d square(grid.origin + h * Eigen::Vector2d(ix, iy),
                                       grid.origin + h * Eigen::Vector2d(ix + 1, iy + 1));
      if (square.exteriorDistance(centre) < radius - band) return false;
    }
  }
  return true;
}

int heading_of(const BaseGrid& grid, double angle) {
  for (std::size_t h = 0; h < grid.headings.size(); ++h) {
    if (grid.headings[h] == angle) return static_cast<int>(h);
  }
  return -1;
}

/// Plans round after round and holds each round's stops against where the parts can really be grasped.
class PolicyRun {
 public:
  PolicyRun(const RoundRegions& planned, const PartRegions& actual, const PickingOrder& order,
            const PolicyOptions& options, const Monitor& monitor)
      : planned_(planned), actual_(actual), order_(order), options_(options), monitor_(monitor) {}

  PolicyResult run() {
    PolicyResult result;
    const int rounds = rounds_of(order_);
    for (int round = 0; round < rounds && !monitor_.stopped(); ++round) result.rounds.push_back(one(round));
    if (result.rounds.empty()) return result;
    result.solved = static_cast<int>(result.rounds.size()) == rounds;
    result.reliable = result.online = true;
    result.smallest_radius = 1e300;
    for (const PolicyRound& round : result.rounds) {
      result.solved = result.solved && (round.outcome == Outcome::solved || round.outcome == Outcome::approximate);
      result.reliable = result.reliable && round.reliable;
      result.online = result.online && round.seconds <= options_.online_limit;
      result.mean_radius += round.mean_radius / static_cast<double>(result.rounds.size());
      result.mean_stops += static_cast<double>(round.stops.size()) / static_cast<double>(result.rounds.size());
      for (const Stop& stop : round.stops) result.smallest_radius = std::min(result.smallest_radius, stop.radius);
    }
    if (result.mean_stops == 0) result.smallest_radius = 0;
    result.feasible = result.solved && result.reliable && result.online;
    return result;
  }

 private:
  PolicyRound one(int round) {
    const detail::Stopwatch stopwatch;
    std::vector<BaseRegion> regions = planned_(round);
    require(regions.size() == order_.size(), "planned regions", static_cast<double>(regions.size()),
            "must be one a tray (" + std::to_string(order_.size()) + ")");
    for (int tray = 0; tray < static_cast<int>(regions.size()); ++tray)
      regions[tray].has_targets = pick_of(order_, tray, round) >= 0;
    if (!same_as_last(regions)) {
      last_ = plan_stops_exact(actual_.grid, regions, options_.stops, monitor_);
      last_regions_ = std::move(regions);
    }
    PolicyRound result;
    result.outcome = last_.outcome;
    result.stops = last_.stops;
    for (const Stop& stop : result.stops) result.mean_radius += stop.radius / static_cast<double>(result.stops.size());
    result.seconds = stopwatch.seconds();
    result.reliable = !result.stops.empty() && holds(result.stops, round);
    return result;
  }

  bool same_as_last(const std::vector<BaseRegion>& regions) const {
    const auto same = [](const BaseRegion& a, const BaseRegion& b) {
      return a.has_targets == b.has_targets && (!a.has_targets || a.cells == b.cells);
    };
    return std::equal(regions.begin(), regions.end(), last_regions_.begin(), last_regions_.end(), same);
  }

  bool holds(const std::vector<Stop>& stops, int round) const {
    for (const Stop& stop : stops) {
      const int heading = heading_of(actual_.grid, stop.pose.z());
      for (TrayId tray : stop.trays) {
        const std::size_t part = pick_of(order_, tray, round);
        const CellMask& cells = actual_.cells[tray][part];
        if (heading < 0 || !disc_inside(actual_.grid, cells, heading, stop.pose.head<2>(), options_.stops.min_radius))
          return false;
      }
    }
    return true;
  }

  const RoundRegions& planned_;
  const PartRegions& actual_;
  const PickingOrder& order_;
  const PolicyOptions& options_;
  const Monitor& monitor_;
  StopSet last_;
  std::vector<BaseRegion> last_regions_;
};

}  // namespace

const char* to_string(UpdatePolicy policy) {
  switch (policy) {
    case UpdatePolicy::all:
      return "all";
    case UpdatePolicy::remaining:
      return "remaining";
    default:
      return "targets";
  }
}

UpdatePolicy make_update_policy(const std::string& name) {
  for (const UpdatePolicy policy : {UpdatePolicy::all, UpdatePolicy::remaining, UpdatePolicy::targets}) {
    if (name == to_string(policy)) return policy;
  }
  throw InvalidInput("policy = '" + name + "': must be 'all', 'remaining' or 'targets'");
}

void PartRegions::check() const {
  for (std::size_t tray = 0; tray < cells.size(); ++tray) {
    for (const CellMask& mask : cells[tray]) {
      require(mask.size() == grid.size(), "cells[" + std::to_string(tray) + "]", static_cast<double>(mask.size()),
              "must be one flag a cell of the grid (" + std::to_string(grid.size()) + ")");
    }
  }
}

CellMask PartRegions::region(int tray, const std::vector<int>& parts) const {
  require(tray >= 0 && tray < static_cast<int>(cells.size()), "tray", tray, "must be one of the trays");
  CellMask shared(grid.size(), 1);
  for (const int part : parts) {
    const auto& all = cells[tray];
    require(part >= 0 && part < static_cast<int>(all.size()), "part", part, "must be one of the tray's parts");
    const CellMask& mask = all[part];
    for (std::size_t i = 0; i < shared.size(); ++i) shared[i] = shared[i] && mask[i];
  }
  return shared;
}

void PolicyOptions::check() const {
  stops.check();
  require(online_limit > 0, "online_limit", online_limit, "must be > 0");
}

RoundRegions regions_for(UpdatePolicy policy, const PartRegions& parts, const PickingOrder& order) {
  parts.check();
  check_order(order, parts);
  return [policy, &parts, &order](int round) {
    std::vector<BaseRegion> regions(order.size());
    for (int tray = 0; tray < static_cast<int>(order.size()); ++tray) {
      std::vector<int> wanted(parts.cells[tray].size());
      std::iota(wanted.begin(), wanted.end(), 0);
      if (policy == UpdatePolicy::remaining) {
        for (int before = 0; before < round; ++before)
          wanted.erase(std::remove(wanted.begin(), wanted.end(), pick_of(order, tray, before)), wanted.end());
      }
      if (policy == UpdatePolicy::targets) wanted = {pick_of(order, tray, round)};
      BaseRegion& region = regions[tray];
      region.tray = std::to_string(tray);
      region.cells = pick_of(order, tray, round) < 0 ? CellMask(parts.grid.size(), 0) : parts.region(tray, wanted);
    }
    return regions;
  };
}

PolicyResult run_policy(const RoundRegions& planned, const PartRegions& actual, const PickingOrder& order,
                        const PolicyOptions& options, const Monitor& monitor) {
  actual.check();
  options.check();
  check_order(order, actual);
  return PolicyRun(planned, actual, order, options, monitor).run();
}

}  // namespace mmgrasp
