#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/mapping/depth_camera.hpp"
#include "mmgrasp/mapping/depth_image.hpp"

namespace mmgrasp {

/// Cells of an occupancy map, and how much one ray says about those it ends in and those it passes.
struct MMGRASP_EXPORT OccupancyOptions {
  double resolution = 0.02;  ///< Edge of the smallest cell [m]; in [1e-4, 1e3].
  double hit = 0.7;          ///< Probability of being occupied that a cell gets from one depth in it; in (0.5, 1).
  double miss = 0.4;         ///< The same from a ray through it; in (0, 0.5).
  /// A longer ray counts up to here only, as free [m]; > 0.
  double max_range = std::numeric_limits<double>::infinity();
  void check() const;
};

/// What an occupancy map knows of a place.
enum class Occupancy : std::uint8_t { unknown, free, occupied };

/// What became of a frame.
struct MMGRASP_EXPORT OccupancyReport {
  int measured = 0;      ///< Pixels with a depth.
  int used = 0;          ///< Pixels whose ray went into the map.
  int out_of_range = 0;  ///< Nearer or farther than the camera sees.
  int invalid = 0;       ///< NaN, infinite or negative, hence not measured.
};

/// Which cells of an occupancy map are an obstacle.
struct MMGRASP_EXPORT OccupancyObstacleOptions {
  /// Whether cells that no ray passed are an obstacle, within the bounds.
  bool unknown_is_free = true;
  Eigen::AlignedBox3d bounds;  ///< Where unknown cells are obstacles [m]; empty: the bounds of what is known.
  void check() const;
};

/// An octree of free, occupied and unknown cells, filled by OctoMap's ray insertion (A. Hornung et al., Autonomous
/// Robots 34(3), 2013) from depth images, the same that a ProbabilisticSdf takes: it keeps surfaces coarser, and knows
/// also which space was looked through. Log odds are clamped to OctoMap's usual probabilities 0.1192 and 0.971, a cell
/// is occupied from 0.5 on.
///
///     OccupancyMap map(options);
///     map.integrate(image, camera);
///     add_cells(world, "space", map.obstacle_cells({false}));   // unknown space is an obstacle
///
/// Copies are cheap and independent. Const members may be called from several threads at once.
class MMGRASP_EXPORT OccupancyMap {
 public:
  explicit OccupancyMap(const OccupancyOptions& options = {});
  const OccupancyOptions& options() const;

  /// Casts a ray through every measured pixel in range; of pixels whose ends share a cell one. Every cell changes at
  /// most once a frame, and one that holds an end is not taken to be free. Throws InvalidInput, with the map as it was,
  /// for what ProbabilisticSdf::integrate() refuses of a single frame, and for ends beyond the octree's 32767 cells
  /// from the origin.
  OccupancyReport integrate(const DepthImage& image, const DepthCamera& camera);

  /// One a column of `points`. Throws InvalidInput on a point that is not finite.
  std::vector<Occupancy> states(const Eigen::Matrix3Xd& points) const;

  /// Occupied cells as solid voxels, with those that are unknown if they are not free; one entry per edge length,
  /// finest first, none from a map that holds nothing of the kind. Unknown cells reach at most a cell beyond the
  /// bounds. Throws InvalidInput on bounds that are not finite or not within the octree.
  std::vector<Voxels> obstacle_cells(const OccupancyObstacleOptions& options = {}) const;

  int frames() const;                  ///< Integrated since the map was made or loaded.
  std::size_t cells() const;           ///< Leaves, free and occupied.
  std::size_t memory() const;          ///< [bytes]
  Eigen::AlignedBox3d bounds() const;  ///< Box around the known cells [m]; empty without any.

  /// Writes OctoMap's format, under a temporary name first: .bt (occupied or free) or .ot (with probabilities) by the
  /// name's ending, another is refused. Throws IoError naming the file.
  void save(const std::string& path) const;
  /// Reads an OctoMap file; of `options` the file's resolution replaces the one given. Throws IoError naming the file
  /// when it is missing, another kind of tree, truncated or damaged.
  static OccupancyMap load(const std::string& path, OccupancyOptions options = {});

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace mmgrasp
