// maximal_intersections(): the sets of trays that are part of no other robust set.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "task/base_sequence/inscribed_circle.hpp"
#include "task/base_sequence/region_patches.hpp"

// Lengths in here are in cells: cell (ix, iy) is the square [ix, ix + 1] x [iy, iy + 1].
namespace mmgrasp {
namespace detail {
namespace {

// [m]: smaller boxes are not split. What such a one may serve at most is decided by its largest shared disc.
constexpr double kSmallestBox = 1e-6;

struct Window {
  double x0, x1, y0, y1;
};

struct Spot {
  double x, y;
};

/// Trays that a disc of the least radius serves, and where its centre is.
struct Found {
  std::vector<TrayId> trays;  ///< Ascending.
  Spot spot;
};

double squared(double v) {
  return v * v;
}

double squared_gap(const Square& s, const Window& w) {
  const double dx = std::max({s.ix - w.x1, 0.0, w.x0 - s.ix - 1}), dy = std::max({s.iy - w.y1, 0.0, w.y0 - s.iy - 1});
  return dx * dx + dy * dy;
}

double squared_farthest(const Square& s, const Window& w) {
  const double dx = std::max({s.ix - w.x0, 0.0, w.x1 - s.ix - 1}), dy = std::max({s.iy - w.y0, 0.0, w.y1 - s.iy - 1});
  return dx * dx + dy * dy;
}

bool subset(const std::vector<TrayId>& a, const std::vector<TrayId>& b) {
  return std::includes(b.begin(), b.end(), a.begin(), a.end());
}

/// Sets of trays of which none contains another, found by the trays they hold.
class MaximalSets {
 public:
  explicit MaximalSets(std::size_t trays) : holding_(trays) {}

  bool covers(const std::vector<TrayId>& set) const {
    if (set.empty()) return true;
    const std::vector<int>* fewest = &holding_[set[0]];
    for (const TrayId tray : set) {
      const std::vector<int>& candidates = holding_[tray];
      if (candidates.size() < fewest->size()) fewest = &candidates;
    }
    return std::any_of(fewest->begin(), fewest->end(), [&](int known) { return subset(set, sets_[known].trays); });
  }

  void add(const std::vector<TrayId>& set, const Spot& spot) {
    if (covers(set)) return;
    std::vector<int> beaten;
    for (const TrayId tray : set) {
      for (const int known : holding_[tray]) {
        if (subset(sets_[known].trays, set)) beaten.push_back(known);
      }
    }
    std::sort(beaten.begin(), beaten.end());
    beaten.erase(std::unique(beaten.begin(), beaten.end()), beaten.end());
    for (const int known : beaten) remove(known);
    for (const TrayId tray : set) holding_[tray].push_back(static_cast<int>(sets_.size()));
    sets_.push_back({set, spot});
  }

  std::vector<Found> sorted() const {
    std::vector<Found> out;
    for (const Found& found : sets_) {
      if (!found.trays.empty()) out.push_back(found);
    }
    std::sort(out.begin(), out.end(), [](const Found& a, const Found& b) { return a.trays < b.trays; });
    return out;
  }

 private:
  void remove(int known) {
    for (const TrayId tray : sets_[known].trays) {
      std::vector<int>& list = holding_[tray];
      list.erase(std::find(list.begin(), list.end(), known));
    }
    sets_[known].trays.clear();
  }

  std::vector<Found> sets_;                // without trays when beaten
  std::vector<std::vector<int>> holding_;  // by tray
};

/// Where a disc of the least radius may stand, and which trays it serves there. A position serves a tray when no square
/// of the complement of the tray's region comes nearer than the radius: boxes of positions are split until each is
/// known to hold no set of trays that is not part of one already found.
class LayerSearch {
 public:
  LayerSearch(const std::vector<Patch>& patches, double radius, double resolution, std::size_t max_boxes,
              const Monitor& monitor)
      : patches_(patches),
        least_squared_(squared(std::max(0.0, radius - kRadiusSlack / resolution))),
        radius_(radius),
        smallest_(kSmallestBox / resolution),
        max_boxes_(max_boxes),
        monitor_(monitor),
        found_(trays_of(patches)) {}

  /// False when `max_boxes` or the monitor ended it.
  bool run() {
    std::vector<Start> starts = cells();
    if (monitor_.stopped()) return false;
    std::stable_sort(starts.begin(), starts.end(),
                     [](const Start& a, const Start& b) { return a.locals.size() > b.locals.size(); });
    // Large sets first: with them most boxes need no search.
    for (const Start& start : starts) {
      if (monitor_.stopped()) return false;
      add_at({start.window.x0 + 0.5, start.window.y0 + 0.5}, start.locals, {});
    }
    for (Start& start : starts) {
      search(start.window, std::move(start.locals), {});
      if (boxes_ > max_boxes_ || monitor_.stopped()) return false;
    }
    return true;
  }

  /// Sets that the smallest boxes left open, by the largest disc that they share.
  void settle(const RegionPatches& patches, int heading, double least) {
    const BaseGrid& grid = patches.grid();
    for (const std::vector<TrayId>& set : open_) {
      if (monitor_.stopped()) return;
      if (found_.covers(set)) continue;
      const Intersection place = patches.shared(set, heading);
      const Eigen::Vector2d at = (place.centre - grid.origin) / grid.resolution;
      if (place.radius >= least) found_.add(set, {at.x(), at.y()});
    }
  }

  const MaximalSets& found() const { return found_; }

 private:
  /// A tray that may be served somewhere in a box, and what limits it there.
  struct Local {
    TrayId tray;
    std::vector<Square> squares;
  };
  struct Start {
    Window window;
    std::vector<Local> locals;
  };
  static std::size_t trays_of(const std::vector<Patch>& patches) {
    int last = -1;
    for (const Patch& patch : patches) last = std::max<int>(last, patch.tray);
    return last + 1;
  }

  std::vector<Start> cells() const {
    std::vector<std::pair<std::pair<int, int>, Local>> items;
    for (const Patch& patch : patches_) {
      for (int iy = patch.y0; iy < patch.y0 + patch.ny && !monitor_.stopped(); ++iy) {
        for (int ix = patch.x0; ix < patch.x0 + patch.nx; ++ix) {
          if (!patch.has(ix, iy)) continue;
          Local local{patch.tray, {}};
          const Window window{double(ix), ix + 1.0, double(iy), iy + 1.0};
          if (limit(patch.border, window, local.squares)) items.push_back({{iy, ix}, std::move(local)});
        }
      }
    }
    std::stable_sort(items.begin(), items.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Start> starts;
    for (auto& [cell, local] : items) {
      const Window window{double(cell.second), cell.second + 1.0, double(cell.first), cell.first + 1.0};
      if (starts.empty() || starts.back().window.x0 != window.x0 || starts.back().window.y0 != window.y0)
        starts.push_back({window, {}});
      starts.back().locals.push_back(std::move(local));
    }
    return starts;
  }

  /// Squares that limit the tray somewhere in the window; false when one of them rules out all of it.
  bool limit(const std::vector<Square>& squares, const Window& window, std::vector<Square>& out) const {
    for (const Square& s : squares) {
      if (squared_gap(s, window) >= least_squared_) continue;
      if (squared_farthest(s, window) < least_squared_) return false;
      out.push_back(s);
    }
    return true;
  }

  bool free_at(const Local& local, const Spot& p) const {
    const Window point{p.x, p.x, p.y, p.y};
    return std::all_of(local.squares.begin(), local.squares.end(),
                       [&](const Square& s) { return squared_gap(s, point) >= least_squared_; });
  }

  void add_at(const Spot& p, const std::vector<Local>& locals, const std::vector<TrayId>& proven) {
    std::vector<TrayId> set = proven;
    for (const Local& local : locals) {
      if (free_at(local, p)) set.push_back(local.tray);
    }
    std::sort(set.begin(), set.end());
    found_.add(set, p);
  }

  void search(const Window& window, std::vector<Local> locals, std::vector<TrayId> proven) {
    if (++boxes_ > max_boxes_ || monitor_.stopped()) return;
    for (std::size_t i = 0; i < locals.size();) {
      std::vector<Square> squares;
      const bool possible = limit(locals[i].squares, window, squares);
      locals[i].squares = std::move(squares);
      if (possible && !locals[i].squares.empty()) {
        ++i;
        continue;
      }
      if (possible) proven.push_back(locals[i].tray);
      locals.erase(locals.begin() + static_cast<std::ptrdiff_t>(i));
    }
    std::vector<TrayId> at_most = proven;
    for (const Local& local : locals) at_most.push_back(local.tray);
    std::sort(at_most.begin(), at_most.end());
    if (found_.covers(at_most)) return;
    const Spot middle{0.5 * (window.x0 + window.x1), 0.5 * (window.y0 + window.y1)};
    for (const Spot& p : {middle, Spot{window.x0, window.y0}, Spot{window.x1, window.y0}, Spot{window.x0, window.y1},
                          Spot{window.x1, window.y1}}) {
      add_at(p, locals, proven);
    }
    if (found_.covers(at_most)) return;
    if (std::max(window.x1 - window.x0, window.y1 - window.y0) < smallest_) {
      open_.insert(at_most);
      return;
    }
    Window first = window, second = window;
    split(window, locals, first, second);
    search(first, locals, proven);
    search(second, std::move(locals), std::move(proven));
  }

  /// Splits where a straight edge of what limits a tray crosses the window, else in the middle of its longer side:
  /// regions are made of squares, and two edges a hair apart would otherwise be separated only by boxes as small.
  void split(const Window& window, const std::vector<Local>& locals, Window& first, Window& second) const {
    const double margin = 1e-9;
    for (const Local& local : locals) {
      for (const Square& s : local.squares) {
        if (s.iy < window.y1 && s.iy + 1 > window.y0) {
          for (const double x : {s.ix - radius_, s.ix + 1 + radius_}) {
            if (!(x > window.x0 + margin && x < window.x1 - margin)) continue;
            first.x1 = second.x0 = x;
            return;
          }
        }
        if (s.ix < window.x1 && s.ix + 1 > window.x0) {
          for (const double y : {s.iy - radius_, s.iy + 1 + radius_}) {
            if (!(y > window.y0 + margin && y < window.y1 - margin)) continue;
            first.y1 = second.y0 = y;
            return;
          }
        }
      }
    }
    if (window.x1 - window.x0 >= window.y1 - window.y0) {
      first.x1 = second.x0 = 0.5 * (window.x0 + window.x1);
    } else {
      first.y1 = second.y0 = 0.5 * (window.y0 + window.y1);
    }
  }

  const std::vector<Patch>& patches_;
  double least_squared_, radius_, smallest_;  // least squared distance; least distance and smallest box

  std::size_t max_boxes_, boxes_ = 0;
  const Monitor& monitor_;
  MaximalSets found_;
  std::set<std::vector<TrayId>> open_;  // what the smallest boxes may serve at most
};

}  // namespace

Intersections maximal_intersections(const RegionPatches& patches, double min_radius, std::size_t max_boxes,
                                    const Monitor& monitor) {
  const double resolution = patches.grid().resolution;
  Intersections result;
  for (int heading = 0; heading < patches.headings(); ++heading) {
    LayerSearch search(patches.layer(heading), min_radius / resolution, resolution, max_boxes, monitor);
    result.complete = search.run() && result.complete;
    search.settle(patches, heading, min_radius - kRadiusSlack);
    for (const Found& found : search.found().sorted()) {
      if (monitor.stopped()) {
        result.complete = false;
        return result;
      }
      ++result.sets_tried;
      Intersection place = patches.shared(found.trays, heading);
      if (place.radius < min_radius) {  // by a rounding
        place.radius = min_radius - kRadiusSlack;
        place.centre = patches.grid().origin + Eigen::Vector2d(found.spot.x, found.spot.y) * resolution;
      }
      result.robust.push_back(std::move(place));
    }
  }
  return result;
}

}  // namespace detail

Intersections maximal_intersections(const BaseGrid& grid, const std::vector<BaseRegion>& regions, double min_radius,
                                    std::size_t max_boxes, const Monitor& monitor) {
  require_not_negative(min_radius, "min_radius");
  require_count(static_cast<std::int64_t>(max_boxes), "max_boxes");
  return detail::maximal_intersections(detail::RegionPatches(grid, regions), min_radius, max_boxes, monitor);
}

}  // namespace mmgrasp
