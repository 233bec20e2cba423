#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/mapping/depth_image.hpp"

namespace mmgrasp {

/// Heights over a rectangle of square cells, seen along -z of its frame: a depth image without perspective.
///
///     const HeightMap map = make_height_map(image, T_world_tray, {0.4, 0.3});
///     const float height = map.height[map.index(10, 20)];  // NaN: not seen
struct MMGRASP_EXPORT HeightMap {
  Pose T_world_map = Pose::Identity();  ///< Middle of the rectangle at height 0, z up.
  double resolution = 0.002;            ///< Edge of a cell [m], > 0.
  int nx = 0, ny = 0;
  std::vector<float> height;  ///< Best estimate at the cell's centre [m], row by row (x fastest); NaN: not seen.
  /// No surface of the cell lies higher than this [m]: silhouettes are grown by a pixel and what is hidden counts as
  /// filled up to the line of sight above it. NaN: nothing is known.
  std::vector<float> upper;
  double pixel = 0;  ///< What a pixel of the image covers at the height of the map [m]: the coarseness of silhouettes.

  void check() const;  ///< Throws InvalidInput on sizes that do not fit or a bad frame.
  std::size_t index(int ix, int iy) const { return static_cast<std::size_t>(iy) * nx + ix; }
  Eigen::Vector2d centre(int ix, int iy) const {  ///< The cell's centre in the map's frame [m].
    return {(ix + 0.5 - 0.5 * nx) * resolution, (iy + 0.5 - 0.5 * ny) * resolution};
  }
};

/// How finely make_height_map() resamples a depth image, and which of its holes are filled.
struct MMGRASP_EXPORT HeightMapOptions {
  double resolution = 0.002;  ///< Edge of a cell [m]; > 0.
  int hole_radius = 2;  ///< Holes up to this many pixels from a measurement are filled with the nearest one; >= 0.
  double jump = 0.01;   ///< Neighbouring pixels whose depths differ by more show different surfaces [m]; > 0.
  void check() const;
};

/// Resamples a depth image over a rectangle of `size` [m] around the frame, whatever way the camera looked.
MMGRASP_EXPORT HeightMap make_height_map(const DepthImage& image, const Pose& T_world_map, const Eigen::Vector2d& size,
                                         const HeightMapOptions& options = {});

}  // namespace mmgrasp
