#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/mapping/depth_image.hpp"

namespace mmgrasp {

/// What segment_objects() takes for the supporting plane, for the border between two objects, and for noise.
struct MMGRASP_EXPORT ObjectSegmentationOptions {
  double leaf = 0.004;             ///< Cell to which points are thinned [m]; in [1e-5, 1], above the points' spacing.
  double plane_tolerance = 0.007;  ///< Points no farther than this from the supporting plane belong to it [m]; > 0.
  /// Upwards; the supporting plane's normal lies within `up_angle` of it, and most other points lie on that side. Zero:
  /// any plane will do, and up is away from the solid: as the normals say, without normals to the side of the eye.
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  double up_angle = 0.35;         ///< [rad], in (0, pi/2].
  double min_plane_share = 0.15;  ///< Planes with a smaller share of the thinned points support nothing; in [0, 1].
  double max_height = 0.5;        ///< Points higher above the plane are left out [m]; > plane_tolerance.
  double max_beside = 0.05;       ///< Objects farther than this beside a plane that was found are left out [m]; >= 0.
  double patch = 0.02;            ///< Distance of the patches that convexity is judged between [m]; >= 2 leaf.
  double concavity = 0.45;        ///< Creases of up to this angle do not part objects [rad]; in (0, pi).
  int min_points = 100;           ///< Smaller objects are left out; > 0.
  int plane_iterations = 1000;    ///< Random planes tried; > 0.
  void check() const;
};

/// A plane that objects stand on: normal . x = offset.
struct MMGRASP_EXPORT SupportingPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Unit, towards the objects.
  double offset = 0;                                  ///< [m]
};

/// One of the objects on the plane: which points were measured on it.
struct MMGRASP_EXPORT SegmentedObject {
  std::vector<int> indices;    ///< Indices of its points, ascending.
  Eigen::AlignedBox3d bounds;  ///< Box around its points, along the axes of their frame [m].
};

/// Measured points divided into the plane, the objects that stand on it, and the rest.
struct MMGRASP_EXPORT ObjectSegmentation {
  std::optional<SupportingPlane> plane;  ///< Found or given. Without a plane there are no objects.
  std::vector<int> plane_inliers;        ///< Indices of the points that belong to the plane, ascending.
  std::vector<SegmentedObject> objects;  ///< Those with most points first.
  std::vector<int> labels;  ///< One a point: index of its object, -1 the plane, -2 left out or not measured.
  std::string warning;      ///< What makes the answer doubtful, or empty.
};

/// Objects that stand on a plane, also ones that touch. What rises above the plane is cut into patches of about
/// `patch`; an edge between two patches speaks for one object when the surface there is flat or bulges, and against it
/// when it has a crease, by its angle and the length of the border (the convexity of Stein et al., CVPR 2014). Which
/// patches make an object is then the multicut of that signed graph, found greedily (Keuper et al., ICCV 2015), so that
/// a few wrong edges along a border do not join two objects.
///
/// Convexity is all that is known: the arms of an L are two objects, as are the inside and the outside of a bowl, and
/// two boxes whose faces are flush and in one plane are one.
///
/// `points`: columns; what is not finite counts as not measured. `normals`: unit normals, away from the solid, one a
/// point, or none (3, 0): then they are fitted to the points around, towards `eye`, which a scan from several sides has
/// not. What is wholly beside the plane that was found, a chair or a far wall, is left out; a `plane` that is given
/// has no end. The same input gives the same answer. Throws InvalidInput on bad options, on normals of another number
/// than the points or not finite where a point is, on coordinates beyond 1e6 m, on a plane whose normal has not unit
/// length within 1e-6.
MMGRASP_EXPORT ObjectSegmentation segment_objects(const Eigen::Matrix3Xd& points,
                                                  const Eigen::Matrix3Xd& normals = Eigen::Matrix3Xd(3, 0),
                                                  const ObjectSegmentationOptions& options = {},
                                                  const std::optional<SupportingPlane>& plane = std::nullopt,
                                                  const Eigen::Vector3d& eye = Eigen::Vector3d::Zero());

/// The same for what one camera sees: labels are one a pixel, row by row, plane and bounds in the world. Throws
/// InvalidInput also where DepthImage::check() does.
MMGRASP_EXPORT ObjectSegmentation segment_depth_image(const DepthImage& image,
                                                      const ObjectSegmentationOptions& options = {},
                                                      const std::optional<SupportingPlane>& plane = std::nullopt);

}  // namespace mmgrasp
