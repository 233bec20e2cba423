// distance(): signed distance and witness points of two placed solids, by pair of kinds.
#include <algorithm>

#include "collision/narrow/field_query.hpp"
#include "collision/narrow/narrow.hpp"
#include "collision/narrow/tree_clearance.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

Convex bounding_box(const Solid& solid) {
  Convex box;
  box.kind = ConvexKind::box;
  box.centre = solid.box_centre;
  box.half = solid.box_half;
  return box;
}

bool is_tree(const Solid& s) {
  return s.kind == SolidKind::mesh || s.kind == SolidKind::voxels;
}

// A convex body around the solid: itself, its hull or its bounding box.
Convex around(const Solid& s) {
  return !is_tree(s) || s.has_hull ? s.core : bounding_box(s);
}

// Lowest point of a body along a direction of its own frame.
std::pair<double, Eigen::Vector3d> lowest_point(const Solid& body, const Eigen::Vector3d& normal) {
  std::pair<double, Eigen::Vector3d> best{kInfinity, Eigen::Vector3d::Zero()};
  const auto take = [&](const Convex& piece) {
    const Eigen::Vector3d point = piece.support(-normal) - piece.radius * normal;
    if (normal.dot(point) < best.first) best = {normal.dot(point), point};
  };
  if (body.kind == SolidKind::convex) take(body.core);
  for (std::size_t i = 0; i < body.triangles.size() + body.cells.size(); ++i) take(body.piece(static_cast<int>(i)));
  return best;
}

// Frame of the plane's shape.
ConvexClearance plane_clearance(const Solid& plane, const Solid& b, const Rigid& b_in_a) {
  const auto [height, point] = lowest_point(b, b_in_a.R.transpose() * plane.normal);
  ConvexClearance clearance;
  clearance.distance = height + plane.normal.dot(b_in_a.t) - plane.offset;
  clearance.on_b = b_in_a * point;
  clearance.on_a = clearance.on_b - clearance.distance * plane.normal;
  clearance.normal = -plane.normal;
  return clearance;
}

ConvexClearance swapped(const ConvexClearance& clearance, const Rigid& T) {
  return {clearance.distance, T * clearance.on_b, T * clearance.on_a, -(T.R * clearance.normal)};
}

// Lets the deeper of two clearances stand.
void keep_deeper(const ConvexClearance& clearance, ConvexClearance& deepest) {
  if (clearance.distance < deepest.distance) deepest = clearance;
}

// The cell of `cloud` that lies deepest in b. Cells that could not be deeper, by their overlap along the cloud's axes,
// are passed over.
ConvexClearance deepest_cell(const Solid& cloud, const Convex& b, const Rigid& b_in_cloud) {
  Eigen::Vector3d low, high;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = b_in_cloud.R.row(k);
    low[k] = axis.dot(b.support(-axis)) + b_in_cloud.t[k] - b.radius;
    high[k] = axis.dot(b.support(axis)) + b_in_cloud.t[k] + b.radius;
  }
  const auto overlap = [&](const Eigen::Vector3d& centre, const Eigen::Vector3d& half) {
    return (centre + half - low).cwiseMin(high - centre + half).minCoeff();
  };
  ConvexClearance deepest;  // 0 where rounding finds no cell
  deepest.on_a = deepest.on_b = b_in_cloud * b.centre;
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(cloud.cell_half);
  int stack[64], size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const BoxTree::Node& node = cloud.tree.nodes()[stack[--size]];
    if (overlap(node.centre, node.half) < 0) continue;
    if (node.count == 0) {
      stack[size++] = node.first + 1;
      stack[size++] = node.first;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      if (overlap(cloud.cells[i], half) <= -deepest.distance) continue;
      const Convex cell = cloud.piece(i);
      ConvexClearance clearance;
      Eigen::Vector3d axis = Eigen::Vector3d::Zero();
      switch (convex_clearance(cell, b, b_in_cloud, deepest.distance, axis, clearance)) {
        case ClearanceKind::beyond:
          break;
        case ClearanceKind::apart:
          keep_deeper(clearance, deepest);
          break;
        case ClearanceKind::overlapping:
          keep_deeper(convex_penetration(cell, b, b_in_cloud), deepest);
      }
    }
  }
  return deepest;
}

// The depth of bodies that touch.
ConvexClearance overlap(const Solid& a, const Solid& b, const Rigid& b_in_a) {
  if (a.kind == SolidKind::voxels) return deepest_cell(a, around(b), b_in_a);
  if (b.kind == SolidKind::voxels) {
    const Rigid a_in_b(b_in_a.R.transpose(), -(b_in_a.R.transpose() * b_in_a.t));
    return swapped(deepest_cell(b, around(a), a_in_b), b_in_a);
  }
  return convex_penetration(around(a), around(b), b_in_a);
}

// Bodies with bounds. False when they are not nearer than `bound`; `clearance` is in the frame of a.
bool find_clearance(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b, double bound,
                    ConvexClearance& clearance) {
  const Rigid b_in_a = T_a.to(T_b);
  const bool trees = is_tree(a) || is_tree(b);
  const bool bounded = (!is_tree(a) || a.has_hull) && (!is_tree(b) || b.has_hull);
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  ConvexClearance outer;  // of the bodies, or of their hulls: then it comes from below
  ClearanceKind kind = ClearanceKind::overlapping;
  if (bounded) kind = convex_clearance(a.core, b.core, b_in_a, bound, axis, outer);
  if (kind == ClearanceKind::beyond) return false;
  if (!trees) {
    clearance = kind == ClearanceKind::apart ? outer : convex_penetration(a.core, b.core, b_in_a);
    return clearance.distance < bound;
  }
  if (!(kind == ClearanceKind::apart && outer.distance > 0)) {
    outer.distance = 0;
    axis.setZero();
    if (solids_collide(a, T_a, b, T_b)) {
      clearance = overlap(a, b, b_in_a);
      return clearance.distance < bound;
    }
  }
  // The surfaces lie at most their concavities behind their hulls, so no search beyond that.
  const bool concavity_known = bounded && (!is_tree(a) || a.has_inner) && (!is_tree(b) || b.has_inner);
  if (concavity_known) bound = std::min(bound, outer.distance + a.concavity + b.concavity + 1e-9);
  return bound > 0 && tree_clearance(a, b, b_in_a, bound, axis, clearance);
}

}  // namespace

double boxes_clearance(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b) {
  const auto unbounded = [](const Solid& s) { return s.kind == SolidKind::plane || s.kind == SolidKind::field; };
  if (unbounded(a) || unbounded(b)) return -kInfinity;
  const Rigid b_in_a = T_a.to(T_b);
  const double clearance =
      box_clearance(a.box_half, b.box_half, b_in_a.R, b_in_a.R.cwiseAbs(), b_in_a * b.box_centre - a.box_centre);
  return clearance > 0 ? clearance : -kInfinity;
}

SolidClearance solids_distance(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b, double bound) {
  SolidClearance out;
  if (a.never_collides() || b.never_collides()) return out;
  if (b.kind == SolidKind::field) return field_distance(a, T_a, *b.field, T_b, bound);
  if (a.kind != SolidKind::plane && b.kind == SolidKind::plane) {
    const SolidClearance clearance = solids_distance(b, T_b, a, T_a, bound);
    return {clearance.distance, clearance.on_b, clearance.on_a, -clearance.normal};
  }
  ConvexClearance clearance;
  if (a.kind == SolidKind::plane) {
    if (b.kind == SolidKind::plane) return out;
    clearance = plane_clearance(a, b, T_a.to(T_b));
    if (!(clearance.distance < bound)) return out;
  } else if (!find_clearance(a, T_a, b, T_b, bound, clearance)) {
    return out;
  }
  return {clearance.distance, T_a * clearance.on_a, T_a * clearance.on_b, T_a.R * clearance.normal};
}

}  // namespace mmgrasp::detail
