#include "verify/floor.hpp"

#include <CbcModel.hpp>
#include <CoinPackedMatrix.hpp>
#include <OsiClpSolverInterface.hpp>
#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstdint>

namespace mmgrasp::verify::detail {
namespace {

constexpr int kHalvings = 8;
constexpr double kMaxWork = 1e8;  // Cells read and sets compared in a search for discs: below a second.

bool holds(const RegionSet& outer, const RegionSet& inner) {
  return std::includes(outer.begin(), outer.end(), inner.begin(), inner.end());
}

/// A set of regions as bits: the search asks for supersets far too often for trees.
class Bits {
 public:
  explicit Bits(int size = 0) : words_((static_cast<std::size_t>(size) + 63) / 64, 0) {}
  void insert(int i) { words_[static_cast<std::size_t>(i) / 64] |= std::uint64_t{1} << (i % 64); }
  bool has(int i) const { return words_[static_cast<std::size_t>(i) / 64] >> (i % 64) & 1u; }
  bool empty() const {
    return std::all_of(words_.begin(), words_.end(), [](std::uint64_t word) { return word == 0; });
  }
  bool holds(const Bits& inner) const {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (inner.words_[i] & ~words_[i]) return false;
    }
    return true;
  }
  int count() const {
    std::size_t bits = 0;
    for (const std::uint64_t word : words_) bits += std::bitset<64>(word).count();
    return static_cast<int>(bits);
  }
  bool operator<(const Bits& other) const { return words_ < other.words_; }

 private:
  std::vector<std::uint64_t> words_;
};

/// Where discs are that lie in several regions. A disc of at most half a cell's size fits into a single cell, and no
/// disc lies in cells that its middle's cell is not one of: then the cells themselves are the answer. Larger ones are
/// found by halving squares, level by level: what the coarse levels find spares most of the fine ones.
class DiscSearch {
 public:
  DiscSearch(const Floor& floor, double radius, const Monitor& monitor)
      : floor_(floor), radius_(radius), monitor_(monitor) {}

  std::vector<RegionSet> run() {
    if (floor_.regions() == 0) return {};  // nor is anything known then about the grid's size
    std::vector<Square> squares = cells();
    if (radius_ > 0 && radius_ <= 0.5 * floor_.grid().resolution) {
      note_all(squares);
      return sets();
    }
    double half = 0.5 * floor_.grid().resolution, work = 0;
    for (int depth = 0; !squares.empty() && !monitor_.stopped(); ++depth, half *= 0.5) {
      for (Square& square : squares) look(square, half);
      if (depth == kHalvings) break;
      squares = halved(squares, half);
      work += cells_read(squares, half);
      if (work > kMaxWork) break;
    }
    return sets();
  }

 private:
  struct Square {
    int layer = 0;
    Eigen::Vector2d centre;
    Bits possible;  // regions that may hold a disc centred somewhere in the square
  };

  /// The cells that lie in some region: for a disc in a region, its middle's cell has to be there.
  std::vector<Square> cells() const {
    const CheckedGrid& grid = floor_.grid();
    std::vector<Square> squares;
    for (int layer = 0; layer < static_cast<int>(grid.headings.size()); ++layer) {
      for (int iy = 0; iy < grid.ny; ++iy) {
        for (int ix = 0; ix < grid.nx; ++ix) {
          Bits here(floor_.regions());
          for (int region = 0; region < floor_.regions(); ++region) {
            if (floor_.inside(region, layer, ix, iy)) here.insert(region);
          }
          if (here.empty()) continue;
          squares.push_back(
              {layer, grid.origin + grid.resolution * Eigen::Vector2d(ix + 0.5, iy + 0.5), std::move(here)});
        }
      }
    }
    return squares;
  }

  void note(const Bits& set) {
    if (std::any_of(found_.begin(), found_.end(), [&](const Bits& other) { return other.holds(set); })) return;
    found_.erase(std::remove_if(found_.begin(), found_.end(), [&](const Bits& other) { return set.holds(other); }),
                 found_.end());
    found_.push_back(set);
  }

  /// Large sets first: they settle most of the small ones.
  void note_all(const std::vector<Square>& squares) {
    std::set<Bits> different;
    for (const Square& square : squares) different.insert(square.possible);
    std::vector<Bits> by_size(different.begin(), different.end());
    std::stable_sort(by_size.begin(), by_size.end(),
                     [](const Bits& a, const Bits& b) { return a.count() > b.count(); });
    for (const Bits& set : by_size) note(set);
  }

  std::vector<RegionSet> sets() const {
    std::vector<RegionSet> sets;
    for (const Bits& bits : found_) {
      RegionSet set;
      for (int region = 0; region < floor_.regions(); ++region) {
        if (bits.has(region)) set.insert(set.end(), region);
      }
      sets.push_back(std::move(set));
    }
    return sets;
  }

  /// What looking at these squares costs.
  double cells_read(const std::vector<Square>& squares, double half) const {
    const double reach = (radius_ + half * std::sqrt(2.0)) / floor_.grid().resolution;
    double regions = 0;
    for (const Square& square : squares) regions += square.possible.count();
    return regions * (2 * reach + 1) * (2 * reach + 1) + static_cast<double>(squares.size() * found_.size());
  }

  /// Notes the discs at the square's middle and narrows down what may be in the rest of it.
  void look(Square& square, double half) {
    const double diagonal = half * std::sqrt(2.0);
    Bits certain(floor_.regions()), possible(floor_.regions());
    for (int region = 0; region < floor_.regions(); ++region) {
      if (!square.possible.has(region)) continue;
      const double clearance = floor_.clearance(region, square.layer, square.centre, radius_ + diagonal);
      if (clearance >= radius_) certain.insert(region);
      if (clearance + diagonal >= radius_) possible.insert(region);
    }
    if (!certain.empty()) note(certain);
    square.possible = std::move(possible);
  }

  std::vector<Square> halved(const std::vector<Square>& squares, double half) const {
    const double quarter = 0.5 * half;
    std::vector<Square> next;
    for (const Square& square : squares) {
      const auto known = [&square](const Bits& set) { return set.holds(square.possible); };
      if (square.possible.empty() || std::any_of(found_.begin(), found_.end(), known)) continue;
      for (const double dx : {-quarter, quarter}) {
        for (const double dy : {-quarter, quarter}) {
          next.push_back({square.layer, square.centre + Eigen::Vector2d(dx, dy), square.possible});
        }
      }
    }
    return next;
  }

  const Floor& floor_;
  double radius_;
  const Monitor& monitor_;
  std::vector<Bits> found_;
};

}  // namespace

int Floor::layer(double heading) const {
  for (std::size_t i = 0; i < grid_.headings.size(); ++i) {
    if (std::abs(wrap_angle(heading - grid_.headings[i])) <= 1e-6) return static_cast<int>(i);
  }
  return -1;
}

bool Floor::inside(int region, int layer, int ix, int iy) const {
  if (ix < 0 || iy < 0 || ix >= grid_.nx || iy >= grid_.ny) return false;
  const std::size_t index = (static_cast<std::size_t>(layer) * grid_.ny + iy) * grid_.nx + ix;
  return regions_[region]->cells[index] != 0;
}

bool Floor::any(int region, int layer) const {
  const std::size_t size = static_cast<std::size_t>(grid_.nx) * static_cast<std::size_t>(grid_.ny);
  const auto first = regions_[region]->cells.begin() + static_cast<std::ptrdiff_t>(layer * size);
  return std::any_of(first, first + static_cast<std::ptrdiff_t>(size), [](std::uint8_t cell) { return cell != 0; });
}

double Floor::clearance(int region, int layer, const Eigen::Vector2d& point, double cap) const {
  const Eigen::Vector2d cell = (point - grid_.origin) / grid_.resolution;  // in cells
  const double reach = cap / grid_.resolution;
  if (!cell.allFinite()) return -cap;
  // One ring of cells around the grid stands for all that lies outside.
  const auto index = [](double value, int size) {
    return static_cast<int>(std::floor(std::clamp(value, -1.0, size + 0.5)));
  };
  const int x0 = index(cell.x() - reach, grid_.nx), x1 = index(cell.x() + reach, grid_.nx);
  const int y0 = index(cell.y() - reach, grid_.ny), y1 = index(cell.y() + reach, grid_.ny);
  double to_outside = reach * reach, to_inside = reach * reach;
  if (cell.minCoeff() < 0 || cell.x() > grid_.nx || cell.y() > grid_.ny) to_outside = 0;
  for (int iy = y0; iy <= y1; ++iy) {
    const double dy = std::max({iy - cell.y(), cell.y() - (iy + 1), 0.0});
    for (int ix = x0; ix <= x1; ++ix) {
      const double dx = std::max({ix - cell.x(), cell.x() - (ix + 1), 0.0});
      double& least = inside(region, layer, ix, iy) ? to_inside : to_outside;
      least = std::min(least, dx * dx + dy * dy);
    }
  }
  return (std::sqrt(to_outside) - (to_outside > 0 ? 0.0 : std::sqrt(to_inside))) * grid_.resolution;
}

std::vector<RegionSet> common_discs(const Floor& floor, double radius, const Monitor& monitor) {
  return DiscSearch(floor, radius, monitor).run();
}

void add_maximal(std::vector<RegionSet>& sets, const RegionSet& set) {
  if (std::any_of(sets.begin(), sets.end(), [&](const RegionSet& other) { return holds(other, set); })) return;
  sets.erase(std::remove_if(sets.begin(), sets.end(), [&](const RegionSet& other) { return holds(set, other); }),
             sets.end());
  sets.push_back(set);
}

int smallest_cover(const std::vector<RegionSet>& sets, const RegionSet& wanted) {
  if (wanted.empty()) return 0;
  const int columns = static_cast<int>(sets.size());
  CoinPackedMatrix matrix(false, 0, 0);
  matrix.setDimensions(0, columns);
  std::vector<double> row_lower, row_upper;
  for (const int region : wanted) {
    CoinPackedVector row;
    for (int column = 0; column < columns; ++column) {
      if (sets[column].count(region)) row.insert(column, 1.0);
    }
    if (row.getNumElements() == 0) return -1;
    matrix.appendRow(row);
    row_lower.push_back(1.0);
    row_upper.push_back(COIN_DBL_MAX);
  }
  const std::vector<double> lower(columns, 0.0), upper(columns, 1.0), cost(columns, 1.0);
  OsiClpSolverInterface solver;
  solver.messageHandler()->setLogLevel(0);
  solver.loadProblem(matrix, lower.data(), upper.data(), cost.data(), row_lower.data(), row_upper.data());
  for (int column = 0; column < columns; ++column) solver.setInteger(column);
  CbcModel model(solver);
  model.setLogLevel(0);
  model.branchAndBound();
  return model.isProvenOptimal() ? static_cast<int>(std::lround(model.getObjValue())) : -1;
}

}  // namespace mmgrasp::verify::detail
