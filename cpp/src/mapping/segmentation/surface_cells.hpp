#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmgrasp::detail {

/// Points thinned to one a cell of a cubic lattice.
struct SurfaceCells {
  double leaf = 0;                        ///< Edge of a cell [m].
  std::vector<Eigen::Vector3d> position;  ///< Mean of each cell's points [m].
  std::vector<int> cell_of;               ///< One a point.
  std::vector<int> neighbours;            ///< Those of the 26 cells around that hold points, cell after cell.
  std::vector<int> first_neighbour;       ///< Cell c's stand at [first_neighbour[c], first_neighbour[c + 1]).
  std::vector<Eigen::Vector3d> normal;    ///< Unit, away from the solid; zero where the points do not tell. Or empty.

  int size() const { return static_cast<int>(position.size()); }
};

/// Cells with their neighbours, without normals. Points are finite.
SurfaceCells surface_cells(const std::vector<Eigen::Vector3d>& points, double leaf);

/// Normals that are the mean of the given ones, one a point.
void average_normals(const std::vector<Eigen::Vector3d>& normals, SurfaceCells& cells);

/// Normals of planes fitted to the points (those `cells` were made of) around each cell, towards `eye`. Beside an edge
/// a round window would mix two faces, so each cell takes, of its own and its neighbours' planes, the one that fits
/// its window best among those it lies on: windows that keep to one face win, and edges stay sharp (after Kuwahara's
/// filter, 1976).
void fit_normals(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& eye, SurfaceCells& cells);

}  // namespace mmgrasp::detail
