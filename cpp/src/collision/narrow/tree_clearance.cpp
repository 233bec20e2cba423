#include "collision/narrow/tree_clearance.hpp"

#include <algorithm>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

// Depth first, nearer child first. The direction of the best clearance so far separates most other pairs of pieces:
// those farther apart along it are skipped.
class TreeClearance {
 public:
  TreeClearance(const Solid& a, const Solid& b, const Rigid& b_in_a, double bound)
      : a_(a), b_(b), b_in_a_(b_in_a), abs_R_(b_in_a.R.cwiseAbs()) {
    best_.distance = bound;
    leaf_a_ = whole(a);
    leaf_b_ = whole(b);
  }

  bool run(const Eigen::Vector3d& axis, ConvexClearance& clearance) {
    if (axis.squaredNorm() > 0) {
      set_direction(axis.normalized());
    } else {
      const Eigen::Vector3d between = a_.box_centre - b_in_a_ * b_.box_centre;
      set_direction(between.norm() > 0 ? between.normalized() : Eigen::Vector3d::UnitX());
    }
    visit(node_a(0), node_b(0));
    if (found_) clearance = best_;
    return found_;
  }

 private:
  using Node = BoxTree::Node;

  static bool is_tree(const Solid& s) { return s.kind != SolidKind::convex; }
  // A convex body as a leaf.
  static Node whole(const Solid& s) {
    Node node;
    node.centre = s.box_centre;
    node.half = s.box_half;
    node.count = 1;
    return node;
  }
  const Node& node_a(int i) const { return is_tree(a_) ? a_.tree.nodes()[i] : leaf_a_; }
  const Node& node_b(int i) const { return is_tree(b_) ? b_.tree.nodes()[i] : leaf_b_; }

  void set_direction(const Eigen::Vector3d& normal) {
    normal_ = normal;
    normal_in_b_ = b_in_a_.R.transpose() * normal;
    shift_ = normal.dot(b_in_a_.t);
    if (!is_tree(a_)) lowest_a_ = normal.dot(a_.core.support(-normal)) - a_.core.radius;
    if (!is_tree(b_)) highest_b_ = normal_in_b_.dot(b_.core.support(normal_in_b_)) + b_.core.radius + shift_;
  }

  double lowest_of(const Node& na) const {
    return is_tree(a_) ? normal_.dot(na.centre) - normal_.cwiseAbs().dot(na.half) : lowest_a_;
  }
  double highest_of(const Node& nb) const {
    return is_tree(b_) ? normal_in_b_.dot(nb.centre) + normal_in_b_.cwiseAbs().dot(nb.half) + shift_ : highest_b_;
  }

  double bound(const Node& na, const Node& nb) const {
    const double apart = lowest_of(na) - highest_of(nb);
    if (apart >= best_.distance) return apart;
    const Eigen::Vector3d t = b_in_a_ * nb.centre - na.centre;
    return std::max(apart, box_clearance(na.half, nb.half, b_in_a_.R, abs_R_, t));
  }

  // Lowest and highest point of one piece along the current direction.
  double lowest_piece(int i) const {
    if (!is_tree(a_)) return lowest_a_;
    if (a_.kind == SolidKind::voxels) return normal_.dot(a_.cells[i]) - a_.cell_half * normal_.lpNorm<1>();
    const auto& t = a_.triangles[i];
    double low = kInfinity;
    for (int c = 0; c < 3; ++c) low = std::min(low, normal_[0] * t[c] + normal_[1] * t[3 + c] + normal_[2] * t[6 + c]);
    return low;
  }
  double highest_piece(int j) const {
    if (!is_tree(b_)) return highest_b_;
    const Eigen::Vector3d& n = normal_in_b_;
    if (b_.kind == SolidKind::voxels) return n.dot(b_.cells[j]) + b_.cell_half * n.lpNorm<1>() + shift_;
    const auto& t = b_.triangles[j];
    double high = -kInfinity;
    for (int c = 0; c < 3; ++c) high = std::max(high, n[0] * t[c] + n[1] * t[3 + c] + n[2] * t[6 + c]);
    return high + shift_;
  }

  void visit_leaves(const Node& na, const Node& nb) {
    for (int i = na.first; i < na.first + na.count; ++i) {
      for (int j = nb.first; j < nb.first + nb.count; ++j) {
        if (lowest_piece(i) - highest_piece(j) >= best_.distance) continue;
        measure(is_tree(a_) ? a_.piece(i) : a_.core, is_tree(b_) ? b_.piece(j) : b_.core);
        if (best_.distance <= 0) return;
      }
    }
  }

  void measure(const Convex& a, const Convex& b) {
    Eigen::Vector3d axis = normal_;
    switch (convex_clearance(a, b, b_in_a_, best_.distance, axis, best_)) {
      case ClearanceKind::beyond:
        return;
      case ClearanceKind::apart:
        found_ = true;
        set_direction(best_.normal);
        return;
      case ClearanceKind::overlapping:
        found_ = true;
        best_.distance = 0;
        best_.on_a = best_.on_b = a.centre;
        best_.normal = normal_;
    }
  }

  void visit(const Node& na, const Node& nb) {
    if (best_.distance <= 0) return;
    if (na.count > 0 && nb.count > 0) return visit_leaves(na, nb);
    const bool split_a = nb.count > 0 || (na.count == 0 && na.half.squaredNorm() > nb.half.squaredNorm());
    const Node* parts[2] = {split_a ? &node_a(na.first) : &node_b(nb.first),
                            split_a ? &node_a(na.first + 1) : &node_b(nb.first + 1)};
    double bounds[2];
    for (int k = 0; k < 2; ++k) bounds[k] = split_a ? bound(*parts[k], nb) : bound(na, *parts[k]);
    const int nearer = bounds[1] < bounds[0] ? 1 : 0;
    for (const int k : {nearer, 1 - nearer}) {
      if (bounds[k] >= best_.distance) continue;
      split_a ? visit(*parts[k], nb) : visit(na, *parts[k]);
    }
  }

  const Solid &a_, &b_;
  const Rigid& b_in_a_;
  Eigen::Matrix3d abs_R_;
  Node leaf_a_, leaf_b_;
  ConvexClearance best_;
  bool found_ = false;
  Eigen::Vector3d normal_, normal_in_b_;  // the direction pieces are compared along, from b to a
  double shift_ = 0, lowest_a_ = 0, highest_b_ = 0;
};

}  // namespace

bool tree_clearance(const Solid& a, const Solid& b, const Rigid& b_in_a, double bound, const Eigen::Vector3d& axis,
                    ConvexClearance& clearance) {
  return TreeClearance(a, b, b_in_a, bound).run(axis, clearance);
}

}  // namespace mmgrasp::detail
