// Cells that regions lack and that would spare a stop. A few are enough for that, too few for samples to find.
#include "verify/base/left_out_cells.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "mmgrasp/core/parallel.hpp"
#include "verify/base/floor.hpp"
#include "verify/base/searched_cells.hpp"
#include "verify/base/shared_discs.hpp"
#include "verify/base/smallest_cover.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr int kTries = 300;     // IK solutions tried for a part, as for samples.
constexpr int kHole = 5;        // A cell of whose eight neighbours so many are in the region lies in a hole of it.
constexpr int kMostLooks = 30;  // So many times region_samples cells are looked at; others count as rightly left out.

struct Candidate {
  int region;
  Cell cell;
};

/// Grows the regions by what may be missing. Only where fewer stops would do then are cells looked at, and only what
/// serves is added: the least number of stops is judged with these.
class LeftOutCells {
 public:
  LeftOutCells(const Context& context, const Pools& pools) : context_(context), plan_(context.plan), pools_(pools) {
    for (const CheckedRegion& region : plan_.regions) {
      const int index = static_cast<int>(parts_.size());
      parts_.push_back(wanted_parts(plan_, {region.tray}));
      if (!parts_.back().empty()) wanted_.insert(index);
    }
  }

  void check(Faults& faults, std::size_t& configurations) {
    const std::vector<CheckedRegion> grown = grown_regions();
    if (least(grown).lower >= plan_.lower_bound) return;
    const std::vector<Candidate> candidates = where_stops_may_be_spared(grown);
    std::vector<CheckedRegion> mended = plan_.regions;
    int serving = 0;
    const std::vector<char> serve = which_serve(candidates, configurations);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (!serve[i]) continue;
      mended[candidates[i].region].cells[cells(candidates[i].region).index(candidates[i].cell)] = 1;
      ++serving;
    }
    if (serving == 0 || context_.monitor.stopped()) return;
    const int enough = least(mended).upper;
    if (enough < 0 || enough >= plan_.lower_bound) return;
    faults.push_back({"region-incomplete", "regions",
                      "with " + std::to_string(serving) +
                          " cells that they lack, from which all parts can be grasped, " +
                          (enough == 1 ? "1 stop is" : std::to_string(enough) + " stops are") +
                          " enough: the least number of stops is not " + std::to_string(plan_.lower_bound)});
  }

 private:
  SearchedCells cells(int region) const { return {plan_, plan_.regions[region]}; }

  template <typename Visitor>
  static void visit_neighbours(const Cell& cell, const Visitor& visitor) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx != 0 || dy != 0) visitor(Cell{cell.layer, cell.ix + dx, cell.iy + dy});
      }
    }
  }

  /// Each region with the searched cells that touch it, and holes in what that gives.
  std::vector<CheckedRegion> grown_regions() const {
    std::vector<CheckedRegion> grown = plan_.regions;
    for (const int region : wanted_) {
      const SearchedCells own = cells(region);
      for (const int needed : {1, kHole}) {
        const std::vector<std::uint8_t> before = grown[region].cells;
        own.visit([&](const Cell& cell) {
          if (before[own.index(cell)] || !own.is_left_out(cell)) return;
          int inside = 0;
          visit_neighbours(cell, [&](const Cell& near) { inside += own.on_grid(near) && before[own.index(near)]; });
          if (inside >= needed) grown[region].cells[own.index(cell)] = 1;
        });
      }
    }
    return grown;
  }

  CoverBounds least(const std::vector<CheckedRegion>& regions) const {
    std::vector<const CheckedRegion*> pointers;
    for (const CheckedRegion& region : regions) pointers.push_back(&region);
    const SharedDiscs discs =
        shared_discs(Floor(plan_.grid, pointers), plan_.positioning_uncertainty, context_.monitor);
    return {smallest_cover(discs.possible, wanted_).lower, smallest_cover(discs.certain, wanted_).upper};
  }

  bool share_a_stop(int a, int b) const {
    const auto serves = [](const CheckedStop& stop, const std::string& tray) {
      return std::find(stop.trays.begin(), stop.trays.end(), tray) != stop.trays.end();
    };
    return std::any_of(plan_.stops.begin(), plan_.stops.end(), [&](const CheckedStop& stop) {
      return serves(stop, plan_.regions[a].tray) && serves(stop, plan_.regions[b].tray);
    });
  }

  /// Cells that the grown regions have more, where a tray that shares no stop with theirs may be served as well.
  std::vector<Candidate> where_stops_may_be_spared(const std::vector<CheckedRegion>& grown) const {
    std::vector<Candidate> found;
    for (const int region : wanted_) {
      std::vector<int> others;
      std::copy_if(wanted_.begin(), wanted_.end(), std::back_inserter(others),
                   [&](int other) { return other != region && !share_a_stop(region, other); });
      const SearchedCells own = cells(region);
      own.visit([&](const Cell& cell) {
        const std::size_t index = own.index(cell);
        const bool is_new = grown[region].cells[index] && !plan_.regions[region].cells[index];
        if (is_new && std::any_of(others.begin(), others.end(), [&](int o) { return grown[o].cells[index] != 0; }))
          found.push_back({region, cell});
      });
    }
    Rng rng(context_.options.seed, 999'999);
    for (std::size_t i = found.size(); i > 1; --i) std::swap(found[i - 1], found[rng.index(i)]);
    const auto most = static_cast<std::size_t>(kMostLooks) * static_cast<std::size_t>(context_.options.region_samples);
    if (found.size() > most) found.resize(most);
    return found;
  }

  std::vector<char> which_serve(const std::vector<Candidate>& candidates, std::size_t& configurations) const {
    std::vector<char> serve(candidates.size(), 0);
    std::vector<Judge> judges(resolve_threads(context_.options.threads), Judge(context_.stage));
    parallel_for(
        candidates.size(), context_.options.threads,
        [&](std::size_t i, int worker) {
          const auto& [region, cell] = candidates[i];
          GraspSearch search(context_, judges[worker], pools_, Rng(context_.options.seed, 3'000'000 + i), kTries);
          serve[i] = whole_cell_serves(plan_, search, cells(region), cell, parts_[region]);
        },
        context_.monitor, "cells left out");
    for (const Judge& judge : judges) configurations += judge.queries();
    return serve;
  }

  const Context& context_;
  const PlanToCheck& plan_;
  const Pools& pools_;
  std::vector<std::vector<int>> parts_;  // wanted ones of each region's tray
  RegionSet wanted_;
};

bool regions_fit_the_grid(const PlanToCheck& plan) {
  const std::size_t size = plan.grid.headings.size() * static_cast<std::size_t>(plan.grid.nx) * plan.grid.ny;
  return size > 0 && std::all_of(plan.regions.begin(), plan.regions.end(),
                                 [&](const CheckedRegion& region) { return region.cells.size() == size; });
}

}  // namespace

void check_left_out_cells(const Context& context, const Pools& pools, Faults& faults, std::size_t& configurations) {
  if (context.plan.lower_bound <= 1 || context.plan.searched.empty() || !regions_fit_the_grid(context.plan)) return;
  LeftOutCells(context, pools).check(faults, configurations);
}

}  // namespace mmgrasp::verify::detail
