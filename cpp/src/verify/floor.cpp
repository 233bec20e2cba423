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

/// Depth-first halving of squares over the floor.
class DiscSearch {
 public:
  DiscSearch(const Floor& floor, double radius, const Monitor& monitor) : floor_(floor), radius_(radius), monitor_(monitor) {}

  std::vector<RegionSet> run() {
    RegionSet all;
    for (int region = 0; region < floor_.regions(); ++region) all.insert(region);
    const CheckedGrid& grid = floor_.grid();
    for (int layer = 0; layer < static_cast<int>(grid.headings.size()); ++layer) {
      layer_ = layer;
      for (int iy = 0; iy < grid.ny && !monitor_.stopped(); ++iy) {
        for (int ix = 0; ix < grid.nx; ++ix) {
          const Eigen::Vector2d centre = grid.origin + grid.resolution * Eigen::Vector2d(ix + 0.5, iy + 0.5);
          visit(centre, 0.5 * grid.resolution, all, 0);
        }
      }
    }
    return found_;
  }

 private:
  /// `possible`: regions that may hold a disc centred somewhere in the square.
  void visit(const Eigen::Vector2d& centre, double half, const RegionSet& possible, int depth) {
    const double diagonal = half * std::sqrt(2.0);
    RegionSet certain, still_possible;
    for (const int region : possible) {
      const double clearance = floor_.clearance(region, layer_, centre, radius_ + diagonal);
      if (clearance >= radius_) certain.insert(region);
      if (clearance + diagonal >= radius_) still_possible.insert(region);
    }
    if (!certain.empty()) add_maximal(found_, certain);
    const bool known = still_possible.empty() || std::any_of(found_.begin(), found_.end(), [&](const RegionSet& set) {
      return holds(set, still_possible);
    });
    if (known || depth == kHalvings) return;
    const double quarter = 0.5 * half;
    for (const double dx : {-quarter, quarter}) {
      for (const double dy : {-quarter, quarter}) {
        visit(centre + Eigen::Vector2d(dx, dy), quarter, still_possible, depth + 1);
      }
    }
  }

  const Floor& floor_;
  double radius_;
  const Monitor& monitor_;
  int layer_ = 0;
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
  if (!cell.allFinite() || cell.minCoeff() < 0 || cell.x() > grid_.nx || cell.y() > grid_.ny) return 0;
  const int x0 = static_cast<int>(std::floor(cell.x() - reach)), x1 = static_cast<int>(std::floor(cell.x() + reach));
  const int y0 = static_cast<int>(std::floor(cell.y() - reach)), y1 = static_cast<int>(std::floor(cell.y() + reach));
  double least = reach * reach;
  for (int iy = y0; iy <= y1; ++iy) {
    const double dy = std::max({iy - cell.y(), cell.y() - (iy + 1), 0.0});
    for (int ix = x0; ix <= x1; ++ix) {
      const double dx = std::max({ix - cell.x(), cell.x() - (ix + 1), 0.0});
      const double squared = dx * dx + dy * dy;
      if (squared < least && !inside(region, layer, ix, iy)) least = squared;
    }
  }
  return std::sqrt(least) * grid_.resolution;
}

std::vector<RegionSet> common_discs(const Floor& floor, double radius, const Monitor& monitor) {
  return DiscSearch(floor, radius, monitor).run();
}

void add_maximal(std::vector<RegionSet>& sets, const RegionSet& set) {
  if (std::any_of(sets.begin(), sets.end(), [&](const RegionSet& other) { return holds(other, set); })) return;
  sets.erase(std::remove_if(sets.begin(), sets.end(), [&](const RegionSet& other) { return holds(set, other); }), sets.end());
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
