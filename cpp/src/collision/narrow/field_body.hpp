#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "collision/narrow/box_tree.hpp"

namespace mmgrasp::detail {

struct Solid;

/// A solid cut into convex pieces for those who ask a distance field about it. The body is the union of the pieces,
/// grown by `radius`. Cylinders are taken as prisms around them, wider by less than 4e-4 of their radius.
class FieldBody {
 public:
  /// A box in the body's frame, or a simplex of one to four corners.
  struct Piece {
    std::array<Eigen::Vector3d, 4> corners;
    int count = 0;  ///< 0: the box.
    Eigen::AlignedBox3d box;
  };

  /// `solid` must outlive it.
  explicit FieldBody(const Solid& solid);

  const BoxTree& tree() const;  ///< Hierarchy over the pieces.
  Piece piece(int position) const;
  double radius() const { return radius_; }
  /// The corners of a body whose pieces make one convex polytope about middle(); else none.
  const std::vector<Eigen::Vector3d>& corners() const { return corners_; }
  const Eigen::Vector3d& middle() const { return middle_; }
  /// The pieces are the surface of a closed mesh, whose inside belongs to the body too.
  bool hollow() const { return hollow_; }
  /// Whether a box of the body's frame meets the inside of a hollow body or its surface.
  bool meets(const Eigen::AlignedBox3d& box) const;
  bool contains(const Eigen::Vector3d& point) const;

 private:
  void add_box(const Eigen::AlignedBox3d& box);
  void add_fan(const std::vector<Eigen::Vector3d>& points, const std::vector<std::array<int, 3>>& triangles,
               const Eigen::Vector3d& middle);
  void build();

  const Solid& solid_;
  std::vector<Piece> pieces_;  ///< Ordered as in `tree_`; empty where the solid's own tree serves.
  BoxTree tree_;
  std::vector<Eigen::Vector3d> corners_;
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double radius_ = 0;
  bool hollow_ = false;
};

}  // namespace mmgrasp::detail
