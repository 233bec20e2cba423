#pragma once

#include <algorithm>

#include "collision/distance_field.hpp"
#include "collision/solid.hpp"

namespace mmgrasp::detail {

inline bool pieces_collide(const Convex& a, const Convex& b, const Rigid& b_in_a, double margin) {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  return convex_collide(a, b, b_in_a, margin, axis);
}

// The space a triangle takes, for boxes that do not meet it: its bounds, its plane and the planes through its edges.
class TriangleSpace {
 public:
  TriangleSpace(const Convex& triangle, const Rigid& placed, double margin) {
    const double* p = triangle.points;
    Eigen::Vector3d corner[3];
    Eigen::AlignedBox3d bounds;
    for (int i = 0; i < 3; ++i) {
      corner[i] = placed * Eigen::Vector3d(p[i], p[3 + i], p[6 + i]);
      bounds.extend(corner[i]);
    }
    const double grown = margin + 1e-9;
    centre_ = bounds.center();
    half_ = 0.5 * bounds.sizes() + Eigen::Vector3d::Constant(grown);
    const Eigen::Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    add(normal, corner[0], grown);
    add(-normal, corner[0], grown);
    for (int i = 0; i < 3; ++i) add((corner[(i + 1) % 3] - corner[i]).cross(normal), corner[i], grown);
  }

  bool misses(const BoxTree::Node& box) const {
    if (((box.centre - centre_).cwiseAbs() - box.half - half_).maxCoeff() > 0) return true;
    for (int i = 0; i < count_; ++i) {
      if (normal_[i].dot(box.centre) - normal_[i].cwiseAbs().dot(box.half) > offset_[i]) return true;
    }
    return false;
  }

 private:
  // Slivers have no direction worth trusting.
  void add(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double grown) {
    const double length = normal.norm();
    if (!(length > 1e-10 * half_.squaredNorm())) return;
    normal_[count_] = normal / length;
    offset_[count_] = normal_[count_].dot(point) + grown;
    ++count_;
  }

  Eigen::Vector3d centre_, half_, normal_[5];
  double offset_[5];
  int count_ = 0;
};

// A single triangle (a hull of three points) of another body against the tree; true also once `budget` is used up.
inline bool tree_hits_triangle(const Solid& a, const Convex& triangle, const Rigid& b_in_a, double margin,
                               long& budget) {
  const TriangleSpace space(triangle, b_in_a, margin);
  int stack[64], size = 0;
  stack[size++] = 0;
  while (size > 0) {
    if (--budget < 0) return true;
    const BoxTree::Node& node = a.tree.nodes()[stack[--size]];
    if (space.misses(node)) continue;
    if (node.count == 0) {
      stack[size++] = node.first + 1;
      stack[size++] = node.first;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      if (pieces_collide(a.piece(i), triangle, b_in_a, margin)) return true;
    }
  }
  return false;
}

// True when the field proves the triangle farther away than the margin, cutting it in halves where it must.
inline bool field_clears(const DistanceField& field, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const Eigen::Vector3d& c, double margin, int cuts) {
  const Eigen::Vector3d middle = (a + b + c) / 3;
  const double distance = field.distance(middle) - margin;
  if (distance <= 0) return false;
  const double squared = std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()});
  if (distance * distance > squared) return true;
  if (cuts == 0) return false;
  const auto halves = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& other) {
    const Eigen::Vector3d half = 0.5 * (from + to);
    return field_clears(field, from, half, other, margin, cuts - 1) &&
           field_clears(field, half, to, other, margin, cuts - 1);
  };
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  if (ab >= bc && ab >= ca) return halves(a, b, c);
  return bc >= ca ? halves(b, c, a) : halves(c, a, b);
}

// More halves cost more than the exact look they may save.
constexpr int kCuts = 1;

/// Triangles of b that the field of a cannot rule out, against the tree of a; true when one comes as near as `margin`,
/// or once `budget` is used up. margin(points, count, radius) tells how near the points within `radius` of the hull of
/// these, in the frame of a, may come.
template <class Margin>
bool tree_hits_field(const Solid& a, const DistanceField& field, const Solid& b, const Rigid& b_in_a,
                     const Margin& margin, long& budget) {
  int stack[64], size = 0;
  stack[size++] = 0;
  while (size > 0) {
    if (--budget < 0) return true;
    const BoxTree::Node& node = b.tree.nodes()[stack[--size]];
    const Eigen::Vector3d centre = b_in_a * node.centre;
    const double radius = node.half.norm();
    const double room = field.distance(centre) - radius;
    if (room > 0 && room > margin(&centre, 1, radius)) continue;
    if (node.count == 0) {
      stack[size++] = node.first + 1;
      stack[size++] = node.first;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Convex triangle = b.piece(i);
      const double* p = triangle.points;
      Eigen::Vector3d corner[3];
      for (int c = 0; c < 3; ++c) corner[c] = b_in_a * Eigen::Vector3d(p[c], p[3 + c], p[6 + c]);
      const double own = margin(corner, 3, 0.0);
      if (field_clears(field, corner[0], corner[1], corner[2], own, kCuts)) continue;
      if (tree_hits_triangle(a, triangle, b_in_a, own, budget)) return true;
    }
  }
  return false;
}

}  // namespace mmgrasp::detail
