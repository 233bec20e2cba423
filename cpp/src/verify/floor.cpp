#include "verify/floor.hpp"

#include <CbcModel.hpp>
#include <CoinPackedMatrix.hpp>
#include <OsiClpSolverInterface.hpp>
#include <algorithm>
#include <cmath>

namespace mmgrasp::verify {
namespace {

constexpr int kHalvings = 8;

bool holds(const RegionSet& outer, const RegionSet& inner) {
  return std::includes(outer.begin(), outer.end(), inner.begin(), inner.end());
}

/// Halving of squares over the floor, level by level: what the coarse levels find spares most of the fine ones.
class DiscSearch {
 public:
  DiscSearch(const Floor& floor, double radius, const Monitor& monitor)
      : floor_(floor), radius_(radius), monitor_(monitor) {}

  std::vector<RegionSet> run() {
    if (floor_.regions() == 0) return {};  // nor is anything known then about the grid's size
    double half = 0.5 * floor_.grid().resolution;
    std::vector<Square> squares = cells();
    for (int depth = 0; !squares.empty() && !monitor_.stopped(); ++depth, half *= 0.5) {
      for (Square& square : squares) look(square, half);
      if (depth == kHalvings) break;
      squares = halved(squares, half);
    }
    return found_;
  }

 private:
  struct Square {
    int layer = 0;
    Eigen::Vector2d centre;
    RegionSet possible;  // regions that may hold a disc centred somewhere in the square
  };

  std::vector<Square> cells() const {
    RegionSet all;
    for (int region = 0; region < floor_.regions(); ++region) all.insert(region);
    const CheckedGrid& grid = floor_.grid();
    std::vector<Square> squares;
    for (int layer = 0; layer < static_cast<int>(grid.headings.size()); ++layer) {
      for (int iy = 0; iy < grid.ny; ++iy) {
        for (int ix = 0; ix < grid.nx; ++ix) {
          squares.push_back({layer, grid.origin + grid.resolution * Eigen::Vector2d(ix + 0.5, iy + 0.5), all});
        }
      }
    }
    return squares;
  }

  /// Notes the discs at the square's middle and narrows down what may be in the rest of it.
  void look(Square& square, double half) {
    const double diagonal = half * std::sqrt(2.0);
    RegionSet certain, possible;
    for (const int region : square.possible) {
      const double clearance = floor_.clearance(region, square.layer, square.centre, radius_ + diagonal);
      if (clearance >= radius_) certain.insert(region);
      if (clearance + diagonal >= radius_) possible.insert(region);
    }
    if (!certain.empty()) add_maximal(found_, certain);
    square.possible = std::move(possible);
  }

  std::vector<Square> halved(const std::vector<Square>& squares, double half) const {
    const double quarter = 0.5 * half;
    std::vector<Square> next;
    for (const Square& square : squares) {
      const auto known = [&square](const RegionSet& set) { return holds(set, square.possible); };
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
  std::vector<RegionSet> found_;
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

}  // namespace mmgrasp::verify
