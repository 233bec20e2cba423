#include "verify/base/shared_discs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "mmgrasp/core/detail/interruption.hpp"
#include "verify/base/region_bits.hpp"

// Lengths in here are in cells: cell (ix, iy) is the square [ix, ix + 1] x [iy, iy + 1].
namespace mmgrasp::verify::detail {
namespace {

constexpr int kHalvings = 10;
constexpr std::size_t kFewEdges = 24;   // Squares with more edges are halved first.
constexpr double kMaxWork = 1e9;        // Cells read and sets compared: some seconds.
constexpr std::size_t kMaxSets = 3000;  // More are no storeroom, and a cover of so many takes minutes.
constexpr double kBeyond = 1e-6;        // [cells] Crossings so far outside of a square are tried with it.

using Point = Eigen::Vector2d;

double squared(double v) {
  return v * v;
}

/// Whole cells outside of a region, named by their lower corners.
struct Cell {
  int ix, iy;
};

double squared_gap(const Cell& cell, const Point& p) {
  return squared(std::max({cell.ix - p.x(), 0.0, p.x() - cell.ix - 1})) +
         squared(std::max({cell.iy - p.y(), 0.0, p.y() - cell.iy - 1}));
}

/// Sets of regions of which none holds another.
class Maximal {
 public:
  bool covers(const RegionBits& set) const {
    compared_ += static_cast<double>(sets_.size());
    return std::any_of(sets_.begin(), sets_.end(), [&](const RegionBits& other) { return other.holds(set); });
  }
  void add(const RegionBits& set) {
    if (set.empty() || covers(set)) return;
    sets_.erase(std::remove_if(sets_.begin(), sets_.end(), [&](const RegionBits& other) { return set.holds(other); }),
                sets_.end());
    sets_.push_back(set);
  }
  const std::vector<RegionBits>& sets() const { return sets_; }
  double compared() const { return compared_; }  ///< How many sets were checked so far.

 private:
  std::vector<RegionBits> sets_;
  mutable double compared_ = 0;
};

struct Square {
  int layer = 0;
  Point centre;
  double half = 0.5;
  RegionBits possible;  // regions that may hold a disc centred somewhere in the square
};

/// Edges of the places that a cell outside of a region leaves to discs of a radius: lines beside the cell's sides and
/// arcs about its corners, as far as they meet a square.
class Edges {
 public:
  Edges(const Square& square, double radius)
      : low_(square.centre.array() - square.half - kBeyond),
        high_(square.centre.array() + square.half + kBeyond),
        radius_(radius) {}

  void add(const Cell& cell) {
    if (overlap(cell.iy, cell.iy + 1, 1)) {
      line(0, cell.ix - radius_);
      line(0, cell.ix + 1 + radius_);
    }
    if (overlap(cell.ix, cell.ix + 1, 0)) {
      line(1, cell.iy - radius_);
      line(1, cell.iy + 1 + radius_);
    }
    for (const int dx : {0, 1}) {
      for (const int dy : {0, 1}) arc({cell.ix + dx, cell.iy + dy}, dx, dy);
    }
  }

  std::size_t count() const { return lines_[0].size() + lines_[1].size() + arcs_.size(); }

  /// Where two edges cross in the square.
  std::vector<Point> crossings() const {
    std::vector<Point> points;
    const auto take = [&](double x, double y) {
      if (x >= low_.x() && x <= high_.x() && y >= low_.y() && y <= high_.y()) points.emplace_back(x, y);
    };
    for (const double x : lines_[0]) {
      for (const double y : lines_[1]) take(x, y);
    }
    for (const auto& [cx, cy] : arcs_) {
      for (const double x : lines_[0]) {
        const double rest = squared(radius_) - squared(x - cx);
        for (const double sign : {-1.0, 1.0})
          if (rest >= 0) take(x, cy + sign * std::sqrt(rest));
      }
      for (const double y : lines_[1]) {
        const double rest = squared(radius_) - squared(y - cy);
        for (const double sign : {-1.0, 1.0})
          if (rest >= 0) take(cx + sign * std::sqrt(rest), y);
      }
    }
    for (auto a = arcs_.begin(); a != arcs_.end(); ++a) {
      for (auto b = std::next(a); b != arcs_.end(); ++b) {
        const Point from(a->first, a->second), to(b->first, b->second);
        const double apart = (to - from).norm(), rest = squared(radius_) - squared(0.5 * apart);
        if (rest < 0) continue;
        const Point along = (to - from) / apart, middle = 0.5 * (from + to);
        for (const double side : {-1.0, 1.0}) {
          const Point p = middle + side * std::sqrt(rest) * Point(-along.y(), along.x());
          take(p.x(), p.y());
        }
      }
    }
    return points;
  }

 private:
  bool overlap(double from, double to, int axis) const { return from <= high_[axis] && to >= low_[axis]; }

  void line(int axis, double at) {
    if (at >= low_[axis] && at <= high_[axis]) lines_[axis].insert(at);
  }

  /// The quarter of a circle about a corner that looks away from its cell.
  void arc(const Cell& corner, bool right, bool up) {
    if (right ? high_.x() < corner.ix : low_.x() > corner.ix) return;
    if (up ? high_.y() < corner.iy : low_.y() > corner.iy) return;
    const Point c(corner.ix, corner.iy);
    const Point nearest = c.cwiseMax(low_).cwiseMin(high_);
    const Point farthest((c - low_).cwiseAbs().cwiseMax((c - high_).cwiseAbs()));
    if ((nearest - c).squaredNorm() <= squared(radius_) && farthest.squaredNorm() >= squared(radius_))
      arcs_.insert({corner.ix, corner.iy});
  }

  Point low_, high_;
  double radius_;
  std::array<std::set<double>, 2> lines_;  // at x, at y
  std::set<std::pair<int, int>> arcs_;     // centres
};

/// Finds which sets of regions share a disc, by splitting squares of disc centres until each is decided.
class DiscSearch {
 public:
  DiscSearch(const Floor& floor, double radius, const Monitor& monitor)
      : floor_(floor), grid_(floor.grid()), monitor_(monitor), radius_(radius / grid_.resolution) {
    // Places shrink to points where discs fit exactly. Radii a little smaller give them crossings that are well apart,
    // and are still within the slack; for what is merely possible they are smaller than it.
    const double slack = kRadiusSlack / grid_.resolution;
    least_ = std::max(0.0, radius_ - slack);
    certain_edge_ = std::max(0.0, radius_ - 0.5 * slack);
    possible_edge_ = std::max(0.0, radius_ - 3 * slack);
    possible_least_ = std::max(0.0, radius_ - 9 * slack);
  }

  SharedDiscs run() {
    if (floor_.regions() == 0) return {};  // nor is anything known then about the grid's size
    std::vector<Square> squares = cells();
    if (radius_ <= 0.5) {
      for (const Square& square : squares) certain_.add(square.possible);
      return result();
    }
    for (int depth = 0; !squares.empty(); ++depth) {
      by_size(squares);
      std::vector<Square> open;
      for (std::size_t i = 0; i < squares.size() && !cut_; ++i) {
        Square& square = squares[i];
        if (!known(square.possible)) {
          look(square);
          if (!known(square.possible) && !decide(square, depth == kHalvings)) open.push_back(square);
        }
        cut_ = work_ + certain_.compared() + possible_.compared() > kMaxWork || certain_.sets().size() > kMaxSets ||
               monitor_.stopped();
        if (!cut_) continue;
        RegionBits anything(floor_.regions());  // nothing is known of what is left
        for (const Square& left : open) anything.insert(left.possible);
        for (std::size_t left = i + 1; left < squares.size(); ++left) anything.insert(squares[left].possible);
        possible_.add(anything);
      }
      if (cut_) break;
      squares = halved(open);
    }
    return result();
  }

 private:
  /// The cells that lie in some region: for a disc in a region, its middle's cell has to be there.
  std::vector<Square> cells() const {
    std::vector<Square> squares;
    for (int layer = 0; layer < static_cast<int>(grid_.headings.size()); ++layer) {
      for (int iy = 0; iy < grid_.ny; ++iy) {
        mmgrasp::detail::throw_if_interrupted();
        for (int ix = 0; ix < grid_.nx; ++ix) {
          RegionBits here(floor_.regions());
          for (int region = 0; region < floor_.regions(); ++region) {
            if (floor_.inside(region, layer, ix, iy)) here.insert(region);
          }
          if (!here.empty()) squares.push_back({layer, Point(ix + 0.5, iy + 0.5), 0.5, std::move(here)});
        }
      }
    }
    return squares;
  }

  /// Large sets first: they settle most of the small ones.
  static void by_size(std::vector<Square>& squares) {
    std::stable_sort(squares.begin(), squares.end(),
                     [](const Square& a, const Square& b) { return a.possible.count() > b.possible.count(); });
  }

  bool known(const RegionBits& set) const { return set.empty() || certain_.covers(set); }

  /// Notes the discs at the square's middle and narrows down what may be in the rest of it.
  void look(Square& square) {
    const double diagonal = square.half * std::sqrt(2.0);
    const Point centre = grid_.origin + grid_.resolution * square.centre;
    RegionBits certain(floor_.regions()), possible(floor_.regions());
    for (int region = 0; region < floor_.regions(); ++region) {
      if (!square.possible.has(region)) continue;
      const double cap = (radius_ + diagonal) * grid_.resolution;
      const double room = floor_.clearance(region, square.layer, centre, cap) / grid_.resolution;
      work_ += squared(2 * (radius_ + diagonal) + 1);
      if (room >= least_) certain.insert(region);
      if (room + diagonal >= possible_least_) possible.insert(region);
    }
    certain_.add(certain);
    square.possible = std::move(possible);
  }

  /// A region that may hold discs of a square, and the cells outside that keep them from some places.
  struct Limited {
    int region;
    std::vector<Cell> cells;
  };

  /// Tries all crossings in a square; false when there are too many edges for that.
  bool decide(const Square& square, bool at_any_cost) {
    Edges certain(square, certain_edge_), possible(square, possible_edge_);
    std::vector<Limited> limited;
    for (int region = 0; region < floor_.regions(); ++region) {
      if (!square.possible.has(region)) continue;
      limited.push_back({region, cells_outside(region, square)});
      for (const Cell& cell : limited.back().cells) {
        certain.add(cell);
        possible.add(cell);
      }
      if (!at_any_cost && possible.count() > kFewEdges) return false;
    }
    for (const Point& p : certain.crossings()) {
      mmgrasp::detail::throw_if_interrupted();
      certain_.add(free_at(p, limited, least_));
    }
    for (const Point& p : possible.crossings()) {
      mmgrasp::detail::throw_if_interrupted();
      const RegionBits set = free_at(p, limited, possible_least_);
      if (!known(set)) possible_.add(set);
    }
    // Regions without a limit in the square have no edge there, and places without a crossing have one elsewhere.
    return true;
  }

  /// Cells at a region's border that come nearer to some place of the square than a disc may.
  std::vector<Cell> cells_outside(int region, const Square& square) {
    const double reach = square.half + radius_;
    const auto low = [&](double at) { return static_cast<int>(std::floor(at - reach)) - 1; };
    const auto high = [&](double at) { return static_cast<int>(std::floor(at + reach)) + 1; };
    // One ring of cells around the grid stands for all that lies outside.
    const int x0 = std::max(-1, low(square.centre.x())), x1 = std::min(grid_.nx, high(square.centre.x()));
    const int y0 = std::max(-1, low(square.centre.y())), y1 = std::min(grid_.ny, high(square.centre.y()));
    work_ += static_cast<double>(x1 - x0 + 1) * static_cast<double>(y1 - y0 + 1);
    std::vector<Cell> found;
    for (int iy = y0; iy <= y1; ++iy) {
      for (int ix = x0; ix <= x1; ++ix) {
        if (floor_.inside(region, square.layer, ix, iy)) continue;
        const double dx = std::max(std::abs(ix + 0.5 - square.centre.x()) - 0.5 - square.half, 0.0);
        const double dy = std::max(std::abs(iy + 0.5 - square.centre.y()) - 0.5 - square.half, 0.0);
        if (dx * dx + dy * dy < squared(radius_ + kBeyond) && at_border(region, square.layer, ix, iy))
          found.push_back({ix, iy});
      }
    }
    return found;
  }

  bool at_border(int region, int layer, int ix, int iy) const {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (floor_.inside(region, layer, ix + dx, iy + dy)) return true;
      }
    }
    return false;
  }

  /// The regions of which no cell outside comes nearer to the point than `least`.
  RegionBits free_at(const Point& p, const std::vector<Limited>& limited, double least) {
    RegionBits free(floor_.regions());
    for (const Limited& some : limited) {
      work_ += static_cast<double>(some.cells.size());
      if (std::all_of(some.cells.begin(), some.cells.end(),
                      [&](const Cell& cell) { return squared_gap(cell, p) >= squared(least); }))
        free.insert(some.region);
    }
    return free;
  }

  std::vector<Square> halved(const std::vector<Square>& squares) const {
    std::vector<Square> next;
    for (const Square& square : squares) {
      if (known(square.possible)) continue;
      const double half = 0.5 * square.half;
      for (const double dx : {-half, half}) {
        for (const double dy : {-half, half})
          next.push_back({square.layer, square.centre + Point(dx, dy), half, square.possible});
      }
    }
    return next;
  }

  SharedDiscs result() const {
    SharedDiscs result;
    result.certain = as_sets(certain_);
    Maximal all = certain_;
    for (const RegionBits& set : possible_.sets()) all.add(set);
    result.possible = as_sets(all);
    result.cut = cut_;
    return result;
  }

  std::vector<RegionSet> as_sets(const Maximal& maximal) const {
    std::vector<RegionSet> sets;
    for (const RegionBits& bits : maximal.sets()) {
      RegionSet set;
      for (int region = 0; region < floor_.regions(); ++region) {
        if (bits.has(region)) set.insert(set.end(), region);
      }
      sets.push_back(std::move(set));
    }
    return sets;
  }

  const Floor& floor_;
  const CheckedGrid& grid_;
  const Monitor& monitor_;
  double radius_, least_ = 0, certain_edge_ = 0, possible_edge_ = 0, possible_least_ = 0;  // see the constructor
  double work_ = 0;
  bool cut_ = false;
  Maximal certain_, possible_;
};

}  // namespace

SharedDiscs shared_discs(const Floor& floor, double radius, const Monitor& monitor) {
  return DiscSearch(floor, radius, monitor).run();
}

}  // namespace mmgrasp::verify::detail
