#pragma once

#include <vector>

#include "mapping/segmentation/surface_cells.hpp"

namespace mmgrasp::detail {

/// Small, nearly plane pieces of a surface.
struct SurfacePatches {
  std::vector<int> patch_of;            ///< One a cell.
  std::vector<Eigen::Vector3d> centre;  ///< Mean of each patch's cells [m].
  int size() const { return static_cast<int>(centre.size()); }
};

/// Patches that grow from seeds about `spacing` [m] apart: the cell nearest to a neighbouring patch by place, direction
/// and height over the patch's plane comes next (simple non-iterative clustering, Achanta and Suesstrunk, CVPR 2017,
/// with what tells supervoxels apart, Papon et al., CVPR 2013). Every cell belongs to a patch. `cells` have normals.
SurfacePatches surface_patches(const SurfaceCells& cells, double spacing);

}  // namespace mmgrasp::detail
