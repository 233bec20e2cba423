// robust_intersections(): every set of trays whose shared cells hold a disc.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "task/base_sequence/inscribed_circle.hpp"

namespace mmgrasp {
namespace {

constexpr std::size_t kMaxTooSmall = 200;      // Most of Intersections::too_small that are kept.
constexpr std::size_t kMostSets = 10'000'000;  // beyond, those remembered fill the memory

using Words = std::vector<std::uint64_t>;

std::size_t count_bits(const Words& words) {
  std::size_t count = 0;
  for (std::uint64_t word : words) count += __builtin_popcountll(word);
  return count;
}

struct Candidate {
  std::vector<TrayId> trays;
  Words cells;
};

/// All sets of one layer, order by order.
class LayerGrowth {
 public:
  LayerGrowth(const BaseGrid& grid, int heading, double min_radius, std::size_t max_sets, Intersections& out)
      : grid_(grid), heading_(heading), min_radius_(min_radius), max_sets_(max_sets), out_(out) {}

  void run(const std::vector<BaseRegion>& regions) {
    std::vector<Candidate> level;
    for (int tray = 0; tray < static_cast<int>(regions.size()); ++tray) {
      if (!regions[tray].has_targets) continue;
      Candidate one{{TrayId(tray)}, pack(regions[tray].cells)};
      if (judge(one)) level.push_back(std::move(one));
    }
    while (level.size() > 1 && out_.sets_tried < max_sets_) level = next(level);
  }

 private:
  Words pack(const CellMask& cells) const {
    const std::size_t count = grid_.cells_per_layer();
    const std::size_t first = grid_.index(heading_, 0, 0);
    Words words((count + 63) / 64, 0);
    for (std::size_t i = 0; i < count; ++i) {
      if (cells[first + i]) words[i / 64] |= std::uint64_t{1} << (i % 64);
    }
    return words;
  }

  /// Sets of one more tray: two that differ in the last tray only, joined, when every subset is robust.
  std::vector<Candidate> next(const std::vector<Candidate>& level) {
    std::set<std::vector<TrayId>> known;
    for (const Candidate& some : level) known.insert(some.trays);
    std::vector<Candidate> grown;
    for (std::size_t a = 0; a < level.size(); ++a) {
      for (std::size_t b = a + 1; b < level.size(); ++b) {
        detail::throw_if_interrupted();
        const std::vector<TrayId>& first = level[a].trays;
        const std::vector<TrayId>& second = level[b].trays;
        if (!std::equal(first.begin(), first.end() - 1, second.begin()))
          break;  // sorted: no later one shares it either
        if (out_.sets_tried >= max_sets_) return {};
        Candidate both;
        both.trays = first;
        both.trays.push_back(second.back());
        if (!subsets_known(both.trays, known)) continue;
        both.cells.resize(level[a].cells.size());
        for (std::size_t i = 0; i < both.cells.size(); ++i) both.cells[i] = level[a].cells[i] & level[b].cells[i];
        if (judge(both)) grown.push_back(std::move(both));
      }
    }
    return grown;
  }

  static bool subsets_known(const std::vector<TrayId>& trays, const std::set<std::vector<TrayId>>& known) {
    for (std::size_t left_out = 0; left_out < trays.size(); ++left_out) {
      std::vector<TrayId> subset = trays;
      subset.erase(subset.begin() + static_cast<std::ptrdiff_t>(left_out));
      if (!known.count(subset)) return false;
    }
    return true;
  }

  bool judge(const Candidate& candidate) {
    ++out_.sets_tried;
    Intersection some;
    some.trays = candidate.trays;
    some.heading = heading_;
    some.cells = count_bits(candidate.cells);
    if (some.cells == 0) return false;
    const InscribedCircle circle = circle_of(candidate.cells);
    some.centre = circle.centre;
    some.radius = circle.radius;
    if (some.radius >= min_radius_ - detail::kRadiusSlack) {
      out_.robust.push_back(std::move(some));
      return true;
    }
    ++out_.sets_too_small;
    out_.too_small.push_back(std::move(some));
    return false;
  }

  /// Different sets often share the same cells.
  const InscribedCircle& circle_of(const Words& cells) {
    const auto found = circles_.find(cells);
    if (found != circles_.end()) return found->second;
    CellMask mask(grid_.size(), 0);
    const std::size_t first = grid_.index(heading_, 0, 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(grid_.cells_per_layer()); ++i) {
      mask[first + i] = static_cast<std::uint8_t>(cells[i / 64] >> (i % 64) & 1u);
    }
    return circles_.emplace(cells, inscribed_circle(grid_, mask, heading_)).first->second;
  }

  const BaseGrid& grid_;
  int heading_;
  double min_radius_;
  std::size_t max_sets_;
  Intersections& out_;
  std::map<Words, InscribedCircle> circles_;
};

}  // namespace

Intersections robust_intersections(const BaseGrid& grid, const std::vector<BaseRegion>& regions, double min_radius,
                                   std::size_t max_sets) {
  require_not_negative(min_radius, "min_radius");
  require(max_sets >= 1 && max_sets <= kMostSets, "max_sets", static_cast<double>(max_sets),
          "must be in [1, 10000000]");
  for (const BaseRegion& region : regions) {
    if (!region.has_targets) continue;
    require(region.cells.size() == grid.size(), "region '" + region.tray + "' cells",
            static_cast<double>(region.cells.size()),
            "must be one flag a cell of the grid (" + std::to_string(grid.size()) + ")");
  }
  Intersections result;
  for (int heading = 0; heading < static_cast<int>(grid.headings.size()); ++heading) {
    LayerGrowth(grid, heading, min_radius, max_sets, result).run(regions);
  }
  result.complete = result.sets_tried < max_sets;
  std::stable_sort(result.too_small.begin(), result.too_small.end(),
                   [](const Intersection& a, const Intersection& b) { return a.radius > b.radius; });
  if (result.too_small.size() > kMaxTooSmall) result.too_small.resize(kMaxTooSmall);
  return result;
}

}  // namespace mmgrasp
