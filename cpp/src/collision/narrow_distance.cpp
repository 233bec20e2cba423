#include <algorithm>
#include <functional>

#include "collision/narrow.hpp"

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

// Smallest gap between pieces below `best`; both bodies as trees, a convex body being a tree of one leaf.
class GapSearch {
 public:
  GapSearch(const Solid& a, const Solid& b, const Rigid& b_in_a, double bound)
      : a_(a), b_(b), b_in_a_(b_in_a), abs_R_(b_in_a.R.cwiseAbs()) {
    best_.distance = bound;
  }

  // False when nothing is closer than the bound.
  bool run(ConvexGap& gap) {
    visit(0, 0);
    if (found_) gap = best_;
    return found_;
  }

 private:
  static BoxTree::Node node_of(const Solid& s, int i) {
    if (is_tree(s)) return s.tree.nodes()[i];
    BoxTree::Node node;
    node.centre = s.box_centre;
    node.half = s.box_half;
    node.count = 1;
    return node;
  }
  static Convex piece_of(const Solid& s, int i) { return is_tree(s) ? s.piece(i) : s.core; }

  // Widest gap along the face normals of both boxes: cheap, and never more than the distance.
  double lower_bound(const BoxTree::Node& na, const BoxTree::Node& nb) const {
    const Eigen::Vector3d t = b_in_a_ * nb.centre - na.centre;
    const Eigen::Vector3d along_a = t.cwiseAbs() - na.half - abs_R_ * nb.half;
    const Eigen::Vector3d along_b = (b_in_a_.R.transpose() * t).cwiseAbs() - nb.half - abs_R_.transpose() * na.half;
    return std::max(0.0, std::max(along_a.maxCoeff(), along_b.maxCoeff()));
  }

  void visit_leaves(const BoxTree::Node& na, const BoxTree::Node& nb) {
    for (int i = na.first; i < na.first + na.count; ++i) {
      for (int j = nb.first; j < nb.first + nb.count; ++j) {
        const ConvexGap gap = convex_distance(piece_of(a_, i), piece_of(b_, j), b_in_a_);
        if (gap.distance >= best_.distance) continue;
        best_ = gap;
        found_ = true;
      }
    }
  }

  void visit(int ia, int ib) {
    if (best_.distance <= 0) return;
    const BoxTree::Node na = node_of(a_, ia), nb = node_of(b_, ib);
    if (na.count > 0 && nb.count > 0) return visit_leaves(na, nb);
    const bool split_a = nb.count > 0 || (na.count == 0 && na.half.squaredNorm() > nb.half.squaredNorm());
    const int first = split_a ? na.first : nb.first;
    double bounds[2];
    for (int k = 0; k < 2; ++k) {
      bounds[k] = split_a ? lower_bound(node_of(a_, first + k), nb) : lower_bound(na, node_of(b_, first + k));
    }
    const int nearer = bounds[1] < bounds[0] ? 1 : 0;
    for (const int k : {nearer, 1 - nearer}) {
      if (bounds[k] >= best_.distance) continue;
      split_a ? visit(first + k, ib) : visit(ia, first + k);
    }
  }

  const Solid &a_, &b_;
  Rigid b_in_a_;
  Eigen::Matrix3d abs_R_;
  ConvexGap best_;
  bool found_ = false;
};

// Lowest point of a body along a direction of its own frame.
std::pair<double, Eigen::Vector3d> lowest_point(const Solid& body, const Eigen::Vector3d& normal) {
  std::pair<double, Eigen::Vector3d> best{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero()};
  const auto look_at = [&](const Convex& piece) {
    const Eigen::Vector3d point = piece.support(-normal) - piece.radius * normal;
    if (normal.dot(point) < best.first) best = {normal.dot(point), point};
  };
  if (body.kind == SolidKind::convex) look_at(body.core);
  for (std::size_t i = 0; i < body.triangles.size() + body.cells.size(); ++i) look_at(body.piece(static_cast<int>(i)));
  return best;
}

// Frame of the plane's shape.
ConvexGap plane_gap(const Solid& plane, const Solid& b, const Rigid& b_in_a) {
  const auto [height, point] = lowest_point(b, b_in_a.R.transpose() * plane.normal);
  ConvexGap gap;
  gap.distance = height + plane.normal.dot(b_in_a.t) - plane.offset;
  gap.on_b = b_in_a * point;
  gap.on_a = gap.on_b - gap.distance * plane.normal;
  return gap;
}

ConvexGap overlap(const Solid& a, const Solid& b, const Rigid& b_in_a) {
  const bool a_core = !is_tree(a) || a.has_hull, b_core = !is_tree(b) || b.has_hull;
  ConvexGap gap = convex_penetration(a_core ? a.core : bounding_box(a), b_core ? b.core : bounding_box(b), b_in_a);
  gap.distance = -gap.distance;
  return gap;
}

}  // namespace

SolidGap solids_distance(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b, double bound) {
  SolidGap out;
  if (a.never_collides() || b.never_collides()) return out;
  if (a.kind != SolidKind::plane && b.kind == SolidKind::plane) {
    const SolidGap gap = solids_distance(b, T_b, a, T_a, bound);
    return {gap.distance, gap.on_b, gap.on_a};
  }
  const Rigid b_in_a = T_a.to(T_b);
  ConvexGap gap;
  if (a.kind == SolidKind::plane) {
    if (b.kind == SolidKind::plane) return out;
    gap = plane_gap(a, b, b_in_a);
    return {gap.distance, T_a * gap.on_a, T_a * gap.on_b};
  }
  const bool bounded = (!is_tree(a) || a.has_hull) && (!is_tree(b) || b.has_hull);
  if (bounded) gap = convex_distance(a.core, b.core, b_in_a);  // exact for convex bodies, from below for hulls
  if (gap.distance >= bound) return out;
  if (gap.distance == 0 && solids_collide(a, T_a, b, T_b)) {
    gap = overlap(a, b, b_in_a);
  } else if (is_tree(a) || is_tree(b)) {
    // The surfaces lie at most their dents behind their hulls, so no search beyond that.
    const bool dents_known = bounded && (!is_tree(a) || a.has_inner) && (!is_tree(b) || b.has_inner);
    if (dents_known) bound = std::min(bound, gap.distance + a.dent + b.dent + 1e-9);
    if (!GapSearch(a, b, b_in_a, bound).run(gap)) return out;
  }
  return {gap.distance, T_a * gap.on_a, T_a * gap.on_b};
}

}  // namespace mmgrasp::detail
