#pragma once

#include <array>
#include <memory>
#include <vector>

#include "collision/narrow/box_tree.hpp"
#include "collision/narrow/convex.hpp"
#include "collision/narrow/distance_grid.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp::detail {

class FieldBody;
struct FieldView;

enum class SolidKind { convex, mesh, voxels, plane, field };

/// A shape prepared for collision queries: what takes time is done once here. Immutable, shared between checkers and
/// threads.
struct MMGRASP_EXPORT Solid {
  SolidKind kind = SolidKind::convex;

  /// Kind convex: the body. Kind mesh: its hull when `has_hull`, an outer bound. Frame of the shape.
  Convex core;
  bool has_hull = false;
  /// Kind mesh: a convex body that lies wholly inside a closed, nearly convex mesh. What meets it collides for certain.
  Convex inner;
  bool has_inner = false;
  double concavity = 0;  ///< With `has_inner`: no point of the hull is farther than this from the mesh [m].
  double margin = 0;     ///< Meshes and voxels grown by padding: they collide at this distance already [m].

  Eigen::Vector3d box_centre = Eigen::Vector3d::Zero();  ///< Bounding box in the shape's frame (margin not included).
  Eigen::Vector3d box_half = Eigen::Vector3d::Zero();
  Eigen::Vector3d sphere_centre =
      Eigen::Vector3d::Zero();  ///< Bounding sphere (margin included); radius infinite for planes.
  double sphere_radius = 0;
  bool is_box = false;  ///< The bounding box is the shape.

  BoxTree tree;                                  ///< Hierarchy over triangles or voxels.
  std::vector<std::array<double, 9>> triangles;  ///< Corners in tree order: x of the three, then y, then z.
  std::vector<Eigen::Vector3d> cells;            ///< Voxel centres in tree order.
  double cell_half = 0;
  std::shared_ptr<const DistanceGrid> grid;  ///< Kind voxels: distances to the cells.
  bool closed = false;                       ///< Mesh with an inside.
  /// One point of each connected part: with no contact of surfaces, the part is inside a solid if and only if its point
  /// is.
  std::vector<Eigen::Vector3d> part_points;

  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Plane: solid where normal . x <= offset.
  double offset = 0;

  std::shared_ptr<const FieldView> field;  ///< Kind field: an obstacle of the scene, without bounds.

  /// The pieces in which distance fields are asked about the solid, made when first needed. Safe from several threads.
  const FieldBody& field_body() const;

  /// Point inside a closed mesh (winding number along a generic ray, by the tree).
  bool contains(const Eigen::Vector3d& point) const;
  bool never_collides() const { return (kind == SolidKind::mesh || kind == SolidKind::voxels) && tree.empty(); }

  /// One triangle or voxel as a convex body.
  Convex piece(int position) const;

 private:
  friend std::shared_ptr<const Solid> make_solid(const Shape& shape, double padding);
  struct LazyFieldBody;
  std::vector<double> hull_points_, inner_points_;
  std::vector<float> rough_points_;
  std::shared_ptr<LazyFieldBody> field_body_;
};

/// `padding` grows the shape: primitives exactly (a box gets 2 x padding longer per axis), planes by their offset,
/// meshes and voxels through `margin`.
MMGRASP_EXPORT std::shared_ptr<const Solid> make_solid(const Shape& shape, double padding = 0);

}  // namespace mmgrasp::detail
