#pragma once

// The hot loop of integration. Plain arrays only, because it is compiled for several sets of instructions, which give
// the same bits.

#include <cstdint>

namespace mmgrasp::detail {

/// What a pixel tells the voxels on its ray: the plane n . X = c of the camera's frame. The distance of a voxel is
/// n . X - c.
struct PixelPlane {
  float free_depth = -1;          ///< Voxels with a smaller z are in front of everything here [m].
  float n[3] = {0, 0, 0}, c = 0;  ///< n towards the camera.
  float weight = 0;               ///< 1 / variance [1 / m^2]; 0: no surface known.
  float reach = -1;               ///< Voxels nearer to the plane than this are updated [m].
  float unused = 0;               ///< Eight numbers fill half a line of the cache.
};

/// How a pixel's error is shared with others, times its weight.
struct PixelShare {
  float white = 0;       ///< The share of the variance that is the pixel's own.
  float systematic = 0;  ///< The systematic standard deviation [m].
};

struct KernelFrame {
  const PixelPlane* pixels = nullptr;
  const PixelShare* shares = nullptr;  ///< Null: all errors are the pixels' own.
  bool surfaces = true;                ///< Else only what is looked through counts.
  int width = 0, height = 0;
  float fx = 0, fy = 0, cx = 0, cy = 0;  ///< cx, cy with 0.5 added: pixel = floor of the projection.
  float nearest = 0;                     ///< [m]
  float gate_squared = 0;                ///< Square of SdfOptions::outlier_gate; 0: no gate.
  float gate_least = 0;                  ///< Differences below this are no contradiction [m].
  int persistence = 254;                 ///< Most that `near` and `free` differ by.
  float step[3][3] = {};                 ///< Step of one voxel along the map's axis [k], in the camera's frame [m].
};

struct KernelBlock {
  float origin[3] = {0, 0, 0};  ///< First voxel in the camera's frame [m].
  float* rows = nullptr;        ///< 64 rows of eight means and their eight weights.
  std::uint8_t *near = nullptr, *free = nullptr;
  float sum_weight = 0, sum_white = 0, sum_systematic = 0;  ///< Over this frame's updates.
  int contradicted = 0;                                     ///< Voxels at which the gate shut.
  bool touched = false;                                     ///< A voxel was seen near a surface.
  bool looked_through = false;                              ///< A voxel of a surface was looked through.
};

/// P3 (4.16), (4.17) for the voxels near a surface, and the count of those looked through.
void integrate_block(const KernelFrame& frame, KernelBlock& block);

}  // namespace mmgrasp::detail
