#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/geometry/distance_field.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/mapping/depth_camera.hpp"
#include "mmgrasp/mapping/depth_image.hpp"

namespace mmgrasp {

namespace detail {
struct SdfGrid;
}

/// How a depth becomes the distance of a voxel.
enum class SdfDistance {
  to_plane,   ///< To the plane through the measured point, with the normal that its neighbours in the image give.
  along_ray,  ///< As in P3 (4.12): along the ray, which is too far on slanted surfaces.
};

/// Resolution of a ProbabilisticSdf, which depths it takes in, and how they become distances of voxels.
struct MMGRASP_EXPORT SdfOptions {
  double voxel = 0.002;       ///< Distance of neighbouring voxels [m]; > 0.
  double truncation = 0.010;  ///< Voxels farther from a depth than this are not updated by it [m]; >= 3 voxels.
  SdfDistance distance = SdfDistance::to_plane;
  double max_incidence = 1.05;  ///< What is seen more slanted is not used [rad]; in (0, pi/2).
  /// Depths farther than this many standard deviations from what their neighbours, or three earlier frames, say are
  /// left out; >= 3, or 0: none are, as in P3. With a gate the order of frames matters where it shuts.
  double outlier_gate = 0;
  /// Most frames by which a surface can be ahead of those that looked through it, or behind: what is taken away is
  /// gone, and what is put back is there again, after at most twice as many; in [1, 254]. The order of frames matters
  /// for what moved.
  int persistence = 254;
  double max_memory = 2e9;  ///< A frame that would need more is refused before anything is allocated [bytes]; > 0.
  int threads = 0;          ///< 0: all. The map does not depend on it.
  void check() const;
};

/// What became of a frame.
struct MMGRASP_EXPORT IntegrationReport {
  int measured = 0;        ///< Pixels with a depth.
  int used = 0;            ///< Pixels whose surface went into the map.
  int out_of_range = 0;    ///< Nearer or farther than the camera sees.
  int too_noisy = 0;       ///< Standard deviation above a third of the truncation: cutting would bias the mean.
  int without_normal = 0;  ///< Too few neighbours on the same surface.
  int outliers = 0;        ///< Apart from what their neighbours measured by more than the outlier gate.
  int too_slanted = 0;     ///< Incidence above max_incidence.
  int invalid = 0;         ///< NaN, infinite or negative, hence not measured.
  int new_blocks = 0;
  int contradicted = 0;  ///< Voxels that this frame would have moved by more than the outlier gate, and did not.
  /// Share of this frame's pixels that confirm an earlier frame where both see the same place; NaN when they have too
  /// little in common.
  double agreement = std::numeric_limits<double>::quiet_NaN();
  std::string warning;  ///< What looks wrong but was integrated, or empty.
};

/// Values of the map at points; one entry a point.
struct MMGRASP_EXPORT SdfValues {
  Eigen::VectorXd mean;             ///< Signed distance, positive in front of the surface [m]; NaN where unknown.
  Eigen::VectorXd sigma;            ///< Its standard deviation [m]; NaN where unknown.
  std::vector<std::uint8_t> known;  ///< 1: seen near a surface, or free since.
};

/// Where rays meet the surface; one entry a ray.
struct MMGRASP_EXPORT SdfHits {
  std::vector<std::uint8_t> hit;  ///< 0: the ray meets no seen surface, and the other fields are NaN.
  Eigen::VectorXd distance;       ///< Along the ray, in multiples of the direction's length.
  Eigen::Matrix3Xd point;         ///< [m]
  Eigen::Matrix3Xd normal;        ///< Unit normal, away from the solid.
  Eigen::VectorXd sigma;          ///< Standard deviation of the surface along its normal [m].
};

/// The surface as triangles, normals towards the seen side.
struct MMGRASP_EXPORT SdfMesh {
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<double> sigma;  ///< One a vertex: standard deviation along the normal [m].
};

/// Points of the surface, one where it crosses an edge of the voxels' lattice.
struct MMGRASP_EXPORT SdfPoints {
  Eigen::Matrix3Xd point;   ///< [m]
  Eigen::Matrix3Xd normal;  ///< Unit normals, away from the solid.
  Eigen::VectorXd sigma;    ///< [m]
};

/// What a map says where no camera saw.
enum class UnknownSpace {
  unknown,   ///< NaN: the asker decides. Distance fields only.
  free,      ///< Distance fields: as far as the truncation from any surface.
  occupied,  ///< Distance fields: as deep as the truncation inside.
};

/// What of a map is an obstacle.
struct MMGRASP_EXPORT SdfObstacleOptions {
  double sigmas = 2.0;  ///< Surfaces are taken to lie this many standard deviations nearer; >= 0.
  /// Space that is not known to be in front of a surface: free or occupied. A map knows what is in front of a surface
  /// only about two voxels deep; for what cameras looked through see OccupancyMap.
  UnknownSpace unknown = UnknownSpace::free;
  Eigen::AlignedBox3d bounds;  ///< Where unknown space is occupied [m]; empty: in the map's bounds.
  void check() const;
};

/// A map of surfaces seen by depth cameras: the signed distance of every voxel near a surface, as a normal distribution
/// (P3 4.5.2, 4.5.3). Blocks of 8 x 8 x 8 voxels exist where a surface was seen.
///
/// Every frame updates mean and variance of the voxels near its surface by (4.16) and (4.17), which is weighted least
/// squares with weights 1 / sigma^2: the order of frames does not matter to them beyond the rounding of floats. Signs
/// are opposite to (4.12): positive in front. What lies deeper than the truncation behind a surface stays unknown; a
/// voxel behind a surface that later more frames looked through than saw is free: what moved away goes. Of each camera
/// with a systematic error the map keeps a mean of its own; they are combined when asked, so that the systematic error
/// does not average away.
///
///     ProbabilisticSdf sdf(options);
///     sdf.integrate(image, camera);
///     const SdfValues values = sdf.query(points);
///
/// Copies are cheap and independent. Const members may be called from several threads at once. The map does not depend
/// on the number of threads or on the machine's set of instructions.
class MMGRASP_EXPORT ProbabilisticSdf {
 public:
  explicit ProbabilisticSdf(const SdfOptions& options = {});
  const SdfOptions& options() const;

  /// Adds a frame. NaN, infinite and negative depths count as not measured. Throws InvalidInput, with the map as it
  /// was, for
  /// - an image of another size than the camera's, or taken with other intrinsics, or with nothing measured in it,
  /// - depths that are in the camera's range once multiplied or divided by 1000 (a wrong depth scale),
  /// - a pose that is no rigid motion, or, from the second frame on, one that fits once inverted,
  /// - another systematic error under the name of a known camera,
  /// - depths that are all too noisy for the truncation,
  /// - a frame that would take the map above options().max_memory.
  IntegrationReport integrate(const DepthImage& image, const DepthCamera& camera,
                              const FrameUncertainty& uncertainty = {});

  /// Mean and standard deviation at the columns of `points` (3, n), interpolated between voxels. Throws InvalidInput on
  /// a point that is not finite. `threads` = 0 means all.
  SdfValues query(const Eigen::Ref<const Eigen::Matrix3Xd>& points, int threads = 0) const;

  /// The first surface from the front along each ray origin + t direction, t >= 0 (columns of both). Unknown space does
  /// not stop a ray. Throws InvalidInput on numbers of columns that differ, on values that are not finite and on
  /// directions of zero.
  SdfHits cast_rays(const Eigen::Ref<const Eigen::Matrix3Xd>& origins,
                    const Eigen::Ref<const Eigen::Matrix3Xd>& directions, int threads = 0) const;

  /// The zero level by marching cubes, consistent across blocks: closed where the surface was seen all around.
  /// Empty when the monitor ended it.
  SdfMesh mesh(const Monitor& monitor = {}) const;
  /// The same of the cells between voxels that the box [m] touches, as an open surface: fast where it is small.
  SdfMesh mesh(const Eigen::AlignedBox3d& within, const Monitor& monitor = {}) const;
  /// The mesh's vertices with their normals.
  SdfPoints points(const Monitor& monitor = {}) const;

  /// The map as an obstacle of collision checks: solid cells of the voxels' lattice, one entry per edge length, finest
  /// first; none from a map without a surface. They hold
  /// - every point where mean - sigmas * sigma, as query() gives them, is zero or less, and the rest of its cell,
  /// - what is known behind the surface, about two voxels deep,
  /// - everything that these enclose and no camera saw: a body wholly inside a surface seen all around is not free,
  /// - with UnknownSpace::occupied all of the bounds that is not known to be in front of a surface.
  /// Throws InvalidInput on a bad option, naming it. docs/methods/mapping.md says what is proven.
  std::vector<Voxels> obstacle_cells(const SdfObstacleOptions& options = {}) const;

  /// The field mean - sigmas * sigma, so that a surface is nearer than it says with a probability that `sigmas` bounds.
  /// Later frames do not change it. Distances are to seen surfaces: how far unknown space is from a known point is not
  /// measured, whatever `unknown` says. Not for World::add_field: beside carved space, and where sigma changes from
  /// voxel to voxel, it can exceed the true distance by more than its stated error; obstacle_cells() is for that.
  std::shared_ptr<const DistanceField> distance_field(double sigmas = 2.0,
                                                      UnknownSpace unknown = UnknownSpace::unknown) const;

  /// A copy of the blocks around the box [m]: queries within it and rays from within it to what they meet there give
  /// the same.
  ProbabilisticSdf cropped(const Eigen::AlignedBox3d& box) const;

  int frames() const;                  ///< Integrated so far.
  std::size_t blocks() const;          ///< Blocks of 8 x 8 x 8 voxels.
  std::size_t memory() const;          ///< Size of the blocks and their index [bytes].
  Eigen::AlignedBox3d bounds() const;  ///< Box around all blocks [m]; empty without any.

  /// Writes a file of its own format, under a temporary name first. Throws IoError naming the file.
  void save(const std::string& path) const;
  /// Reads what save() wrote. Throws IoError naming the file when it is missing, no such map, of another version,
  /// truncated or damaged. `threads` = 0 means all, for later calls.
  static ProbabilisticSdf load(const std::string& path, int threads = 0);

 private:
  explicit ProbabilisticSdf(std::shared_ptr<detail::SdfGrid> grid);
  std::shared_ptr<detail::SdfGrid> grid_;
};

}  // namespace mmgrasp
