#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/task/base_region.hpp"

// Storerooms without a robot: a tray's region is a sector of a ring in front of it, as an arm's reach makes it, less
// where the robot would stand in a tray.
namespace mmgrasp::test {

struct LaidTray {
  Eigen::Vector2d at;
  double facing = 0;  // a robot in front of it looks along this direction [rad]
  double reach = 0;   // in place of the larger outer radius of the shape [m]; 0: that one
};

struct Layout {
  std::string name;
  BaseGrid grid;
  std::vector<BaseRegion> regions;
};

struct SectorShape {
  double inner = 0.45, outer = 0.90, half_angle = 0.9;  // [m], [m], [rad]
  double keep_off = 0.40;                               // Of the robot's middle from any tray's [m].
  int headings = 1;                                     // Layers; more than one: a tray must be in front, namely
  double front = 0.7;                                   // no farther off the heading than this [rad].
};

inline Layout make_layout(const std::string& name, const std::vector<LaidTray>& trays, const SectorShape& shape = {},
                          double resolution = 0.05) {
  Layout layout;
  layout.name = name;
  Eigen::AlignedBox2d bounds;
  for (const LaidTray& tray : trays) bounds.extend(tray.at);
  BaseGrid& grid = layout.grid;
  grid.resolution = resolution;
  grid.origin = bounds.min().array() - shape.outer - resolution;
  grid.nx = static_cast<int>(std::ceil((bounds.sizes().x() + 2 * shape.outer) / resolution)) + 2;
  grid.ny = static_cast<int>(std::ceil((bounds.sizes().y() + 2 * shape.outer) / resolution)) + 2;
  grid.headings.clear();
  for (int h = 0; h < shape.headings; ++h) grid.headings.push_back(2 * M_PI * h / shape.headings);
  CellMask blocked(static_cast<std::size_t>(grid.nx) * grid.ny, 0);
  const auto near_cells = [&](const LaidTray& tray, double reach, const auto& visit) {
    const Eigen::Vector2d low = (tray.at - grid.origin).array() / resolution - reach / resolution - 1;
    const int span = static_cast<int>(2 * reach / resolution) + 3;
    for (int iy = std::max(0, static_cast<int>(low.y())); iy < std::min(grid.ny, static_cast<int>(low.y()) + span);
         ++iy) {
      for (int ix = std::max(0, static_cast<int>(low.x())); ix < std::min(grid.nx, static_cast<int>(low.x()) + span);
           ++ix) {
        visit(grid.index(0, ix, iy), Eigen::Vector2d(grid.centre(0, ix, iy).head<2>() - tray.at));
      }
    }
  };
  for (const LaidTray& tray : trays) {
    near_cells(tray, shape.keep_off, [&](std::size_t cell, const Eigen::Vector2d& d) {
      if (d.norm() < shape.keep_off) blocked[cell] = 1;
    });
  }
  for (const LaidTray& tray : trays) {
    BaseRegion region;
    region.tray = "tray_" + std::to_string(layout.regions.size());
    region.cells.assign(grid.size(), 0);
    const Eigen::Vector2d front(-std::cos(tray.facing), -std::sin(tray.facing));
    const double outer = tray.reach > 0 ? tray.reach : shape.outer;
    near_cells(tray, outer, [&](std::size_t cell, const Eigen::Vector2d& d) {
      const double r = d.norm();
      const bool inside = r >= shape.inner && r <= outer && d.dot(front) >= r * std::cos(shape.half_angle);
      if (!inside || blocked[cell]) return;
      for (int h = 0; h < shape.headings; ++h) {
        const double heading = grid.headings[h];
        const bool ahead = -d.dot(Eigen::Vector2d(std::cos(heading), std::sin(heading))) >= r * std::cos(shape.front);
        if (shape.headings == 1 || ahead) region.cells[cell + static_cast<std::size_t>(h) * blocked.size()] = 1;
      }
    });
    layout.regions.push_back(std::move(region));
  }
  return layout;
}

/// Trays along x, all facing +y.
inline Layout row_layout(int trays, double spacing) {
  std::vector<LaidTray> laid;
  for (int i = 0; i < trays; ++i) laid.push_back({{spacing * i, 0}, M_PI / 2});
  return make_layout("row of " + std::to_string(trays), laid);
}

/// Two rows that face each other across an aisle.
inline Layout aisle_layout(int trays, double spacing, double width) {
  std::vector<LaidTray> laid;
  for (int i = 0; i < trays; ++i) {
    const bool left = i % 2 == 0;
    laid.push_back({{spacing * (i / 2), left ? width / 2 : -width / 2}, left ? M_PI / 2 : -M_PI / 2});
  }
  return make_layout("aisle of " + std::to_string(trays), laid);
}

/// Shelves of several boards, along one row or on both sides of an aisle (`width` > 0): trays stand above each other
/// wherever they were put, a little turned, and the higher the board the shorter the reach. Regions overlap deeply.
inline Layout board_layout(int trays, int boards, double spacing, double width, int headings, unsigned seed) {
  Rng rng(seed);
  const int sides = width > 0 ? 2 : 1;
  std::vector<LaidTray> laid;
  for (int i = 0; i < trays; ++i) {
    const int board = i / sides % boards;
    const double x = spacing * (i / (sides * boards)) + rng.uniform(-0.5, 0.5) * spacing;
    const double turn = rng.uniform(-0.5, 0.5), depth = rng.uniform(0, 0.15);
    const bool left = i % sides == 0;
    laid.push_back({{x, (left ? 1 : -1) * (width / 2 + depth)},
                    (left ? M_PI / 2 : -M_PI / 2) + turn,
                    0.90 - 0.2 * board / boards});
  }
  SectorShape shape;
  shape.headings = headings;
  return make_layout((width > 0 ? "aisle of " : "row of ") + std::to_string(trays) + " on " + std::to_string(boards) +
                         " boards, " + std::to_string(headings) + " headings",
                     laid, shape);
}

/// Shelves back to back with aisles between them, trays on both sides and at the ends.
inline Layout block_layout(int trays, double spacing, double aisle) {
  const int per_row = std::max(2, static_cast<int>(std::lround(std::sqrt(2.0 * trays))));
  std::vector<LaidTray> laid;
  for (int i = 0; i < trays; ++i) {
    const int row = i / per_row;
    const bool upper = row % 2 == 1;
    laid.push_back(
        {{spacing * (i % per_row), row / 2 * (aisle + 0.5) + (upper ? 0.4 : 0.0)}, upper ? -M_PI / 2 : M_PI / 2});
  }
  return make_layout("block of " + std::to_string(trays), laid);
}

/// Trays anywhere in a square, facing anywhere, each with room for a robot in front of it; `area` [m^2] a tray.
inline Layout random_layout(int trays, unsigned seed, double area = 1.2) {
  Rng rng(seed);
  const double side = std::sqrt(area * trays), apart = 0.45, stand = 0.68, room = 0.58;  // [m]
  std::vector<LaidTray> laid;
  const auto place = [&](const LaidTray& tray) {
    return Eigen::Vector2d(tray.at - stand * Eigen::Vector2d(std::cos(tray.facing), std::sin(tray.facing)));
  };
  while (static_cast<int>(laid.size()) < trays) {
    const LaidTray tray{{rng.uniform(0, side), rng.uniform(0, side)}, rng.uniform(-M_PI, M_PI)};
    const bool fits = std::all_of(laid.begin(), laid.end(), [&](const LaidTray& other) {
      return (other.at - tray.at).norm() > apart && (other.at - place(tray)).norm() > room &&
             (tray.at - place(other)).norm() > room;
    });
    if (fits) laid.push_back(tray);
  }
  return make_layout("random storeroom of " + std::to_string(trays) + ", seed " + std::to_string(seed), laid);
}

/// Trays so high that the robot drives below them, anywhere: regions overlap deeply.
inline Layout overhead_layout(int trays, unsigned seed, double area = 0.15) {
  Rng rng(seed);
  const double side = std::sqrt(area * trays);
  SectorShape shape;
  shape.keep_off = 0;
  std::vector<LaidTray> laid;
  for (int i = 0; i < trays; ++i) {
    const double x = rng.uniform(0, side), y = rng.uniform(0, side);
    laid.push_back({{x, y}, rng.uniform(-M_PI, M_PI)});
  }
  return make_layout("overhead storeroom of " + std::to_string(trays) + ", seed " + std::to_string(seed), laid, shape);
}

}  // namespace mmgrasp::test
