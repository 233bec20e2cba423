#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <memory>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp {

namespace detail {
class TriangleTree;
}

/// Where and how well a distance field knows its body.
struct MMGRASP_EXPORT DistanceFieldProperties {
  /// Outside this box (in the field's frame) nothing is known; infinite for a body known everywhere.
  Eigen::AlignedBox3d domain;
  /// A known distance differs from the true one by at most this [m], besides the rounding of doubles. The true distance
  /// changes by at most the way walked (Lipschitz constant 1), so from a point with distance d no surface is nearer
  /// than |d| - error, and after a step s the distance has changed by at most |s| + 2 error.
  double error = 0;
  /// Distances are clipped to [-truncation, truncation]: at the limit the true one may be larger [m].
  double truncation = std::numeric_limits<double>::infinity();
};

/// Signed distance from the surface of a body, in the field's own frame: negative inside, positive outside [m]. The
/// common face of exact meshes and of maps, for those who ask how far away something is.
///
///     const MeshDistanceField field(mesh);
///     Eigen::Matrix3Xd gradients;
///     const Eigen::VectorXd distances = field.distances(points, gradients);
///
/// Many points are one call, and one virtual call. What a field does not know (outside its domain, or a cell that no
/// camera saw) is NaN, with gradient zero: whether that counts as free is the asker's decision. Const members may be
/// called from several threads at once.
class MMGRASP_EXPORT DistanceField {
 public:
  virtual ~DistanceField();
  virtual DistanceFieldProperties properties() const = 0;

  /// Signed distance of one point; throws InvalidInput when it is not finite.
  double distance(const Eigen::Vector3d& point) const;
  /// Signed distances of the columns of `points` (3, n). Throws InvalidInput on one that is not finite, naming its
  /// index.
  Eigen::VectorXd distances(const Eigen::Matrix3Xd& points) const;
  /// The same with the gradients (3, n): unit vectors along which the distance grows fastest, away from the nearest
  /// point of the surface when outside and towards it when inside. Zero where unknown. Where several points of the
  /// surface are nearest, it belongs to one of them.
  Eigen::VectorXd distances(const Eigen::Matrix3Xd& points, Eigen::Matrix3Xd& gradients) const;

 private:
  /// `points` are finite. `gradients` is null when not wanted, else holds n columns to be written.
  virtual void evaluate(const Eigen::Matrix3Xd& points, Eigen::VectorXd& distances,
                        Eigen::Matrix3Xd* gradients) const = 0;
};

/// The exact distance from a closed mesh, through a bounding-volume hierarchy over its triangles.
///
/// Inside is where mesh_contains() says so. Where shells of the mesh overlap, walls inside the solid count as surface:
/// the sign is right there, and the distance is to the nearest wall.
class MMGRASP_EXPORT MeshDistanceField : public DistanceField {
 public:
  /// Copies the triangles. Throws InvalidInput for a mesh that is not closed.
  explicit MeshDistanceField(const TriangleMesh& mesh);
  /// Known everywhere, without error.
  DistanceFieldProperties properties() const override;

 private:
  void evaluate(const Eigen::Matrix3Xd& points, Eigen::VectorXd& distances, Eigen::Matrix3Xd* gradients) const override;

  std::shared_ptr<const detail::TriangleTree> tree_;
};

}  // namespace mmgrasp
