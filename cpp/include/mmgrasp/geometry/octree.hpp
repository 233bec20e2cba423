#pragma once

#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp {

/// Occupied leaves of an OctoMap file (.bt, or .ot with log odds of at least 0), one entry per edge length, finest
/// first. Throws IoError naming the file and what is wrong with it: missing, another tree type, truncated, deeper than
/// 16 levels, another number of nodes than announced, or nothing occupied.
MMGRASP_EXPORT std::vector<Voxels> load_octree(const std::string& path);

/// An OctoMap file that keeps the format's rules.
struct OctreeFile {
  std::string content;    ///< Every byte.
  double resolution = 0;  ///< Edge of the smallest cell [m].
  bool binary = false;    ///< .bt; else .ot.
  long nodes = 0;         ///< Number of the tree's nodes, inner ones too.
  std::size_t data = 0;   ///< Where in the content the tree begins.
};

/// Reads the file for OctoMap's own reader, which trusts what it reads. Throws what load_octree throws, but a tree
/// without an occupied leaf will do.
MMGRASP_EXPORT OctreeFile read_octree_file(const std::string& path);

/// The cells of a grid of edge `resolution` [m] through the origin that hold a point, in order of x, y, z. Throws
/// InvalidInput on a resolution that is not positive, no points, or one that is not finite (naming its index).
MMGRASP_EXPORT Voxels voxelize(const std::vector<Eigen::Vector3d>& points, double resolution);

}  // namespace mmgrasp
