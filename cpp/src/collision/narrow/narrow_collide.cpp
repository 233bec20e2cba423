// collide(): whether two placed solids overlap, by pair of kinds.
#include <algorithm>

#include "collision/narrow/convex_clearance.hpp"
#include "collision/narrow/distance_grid.hpp"
#include "collision/narrow/field_query.hpp"
#include "collision/narrow/narrow.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

// Everything about a pair that its tests share: b seen from a.
struct PairFrame {
  PairFrame(const Rigid& T_a, const Rigid& T_b) : b_in_a(T_a.to(T_b)), abs_R(b_in_a.R.cwiseAbs()) {}
  Rigid b_in_a;
  Eigen::Matrix3d abs_R;
};

bool nodes_overlap(const BoxTree::Node& a, const BoxTree::Node& b, const PairFrame& frame, double margin) {
  return boxes_overlap(a.half, b.half, frame.b_in_a.R, frame.abs_R, frame.b_in_a * b.centre - a.centre, margin);
}

bool pieces_collide(const Convex& a, const Convex& b, const Rigid& b_in_a, double margin) {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  return convex_collide(a, b, b_in_a, margin, axis);
}

// Some triangle or voxel of a against the convex body b; `hit` is set to it.
bool tree_hits_convex(const Solid& a, const Solid& b, const PairFrame& frame, double margin, int& hit) {
  BoxTree::Node body;
  body.centre = b.box_centre;
  body.half = b.box_half;
  int stack[64], size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const BoxTree::Node& node = a.tree.nodes()[stack[--size]];
    if (!nodes_overlap(node, body, frame, margin)) continue;
    if (node.count == 0) {
      stack[size++] = node.first + 1;
      stack[size++] = node.first;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      if (!pieces_collide(a.piece(i), b.core, frame.b_in_a, margin)) continue;
      hit = i;
      return true;
    }
  }
  return false;
}

bool leaves_collide(const Solid& a, const BoxTree::Node& na, const Solid& b, const BoxTree::Node& nb,
                    const Rigid& b_in_a, double margin) {
  for (int i = na.first; i < na.first + na.count; ++i) {
    const Convex piece = a.piece(i);
    for (int j = nb.first; j < nb.first + nb.count; ++j) {
      if (pieces_collide(piece, b.piece(j), b_in_a, margin)) return true;
    }
  }
  return false;
}

// Triangles and voxels of both, larger node first.
bool tree_hits_tree(const Solid& a, const Solid& b, const PairFrame& frame, double margin) {
  std::pair<int, int> stack[160];
  int size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const auto [ia, ib] = stack[--size];
    const BoxTree::Node &na = a.tree.nodes()[ia], &nb = b.tree.nodes()[ib];
    if (!nodes_overlap(na, nb, frame, margin)) continue;
    if (na.count > 0 && nb.count > 0) {
      if (leaves_collide(a, na, b, nb, frame.b_in_a, margin)) return true;
    } else if (nb.count > 0 || (na.count == 0 && na.half.squaredNorm() > nb.half.squaredNorm())) {
      stack[size++] = {na.first + 1, ib};
      stack[size++] = {na.first, ib};
    } else {
      stack[size++] = {ia, nb.first + 1};
      stack[size++] = {ia, nb.first};
    }
  }
  return false;
}

// The space a triangle takes, for boxes and triangles that do not meet it: its bounds, its plane and the planes through
// its edges, each grown by how far one of the two bodies moves across it.
class TriangleSpace {
 public:
  TriangleSpace(const Convex& triangle, const Rigid& placed, double margin, const Closing& closing) {
    const double* p = triangle.points;
    Eigen::Vector3d corner[3];
    Eigen::AlignedBox3d bounds;
    for (int i = 0; i < 3; ++i) {
      corner[i] = placed * Eigen::Vector3d(p[i], p[3 + i], p[6 + i]);
      bounds.extend(corner[i]);
    }
    const auto grown = [&](const Eigen::Vector3d& unit) {
      double way = closing.along(unit);
      if (closing.directed && !closing.first_moves) {
        double of_corners = 0;
        for (const Eigen::Vector3d& c : corner) of_corners = std::max(of_corners, closing.along_at(unit, c));
        way = std::min(way, of_corners);
      }
      return margin + way + 1e-9;
    };
    centre_ = bounds.center();
    half_ = 0.5 * bounds.sizes();
    for (int i = 0; i < 3; ++i) half_[i] += grown(Eigen::Vector3d::Unit(i));
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

  bool misses(const std::array<double, 9>& corners) const {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({corners[3 * k], corners[3 * k + 1], corners[3 * k + 2]});
      if (low - centre_[k] > half_[k] || centre_[k] - high > half_[k]) return true;
    }
    for (int i = 0; i < count_; ++i) {
      const auto along = [&](int c) {
        return normal_[i][0] * corners[c] + normal_[i][1] * corners[3 + c] + normal_[i][2] * corners[6 + c];
      };
      if (std::min({along(0), along(1), along(2)}) > offset_[i]) return true;
    }
    return false;
  }

 private:
  // Slivers have no direction worth trusting.
  template <class Grown>
  void add(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, const Grown& grown) {
    const double length = normal.norm();
    if (!(length > 1e-10 * half_.squaredNorm())) return;
    normal_[count_] = normal / length;
    offset_[count_] = normal_[count_].dot(point) + grown(normal_[count_]);
    ++count_;
  }

  Eigen::Vector3d centre_, half_, normal_[5];
  double offset_[5];
  int count_ = 0;
};

// Two triangles that come within the margin and the farthest way of the body that moves. `closing` in the frame of a.
bool triangles_stay_apart(const Convex& a, const Convex& b, const Rigid& b_in_a, double margin,
                          const Closing& closing) {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  ConvexClearance clearance;
  if (convex_clearance(a, b, b_in_a, kInfinity, axis, clearance) != ClearanceKind::apart) return false;
  const double* p = closing.first_moves ? a.points : b.points;
  double way = 0;
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector3d corner(p[c], p[3 + c], p[6 + c]);
    way = std::max(way, closing.along_at(clearance.normal, closing.first_moves ? corner : b_in_a * corner));
  }
  return clearance.distance > margin + way;
}

// A single triangle (a hull of three points) of another body against the tree.
bool tree_hits_triangle(const Solid& a, const Convex& triangle, const Rigid& b_in_a, double margin,
                        const Closing& closing) {
  const double reach = margin + closing.most;
  const TriangleSpace space(triangle, b_in_a, margin, closing);
  int stack[64], size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const BoxTree::Node& node = a.tree.nodes()[stack[--size]];
    if (space.misses(node)) continue;
    if (node.count == 0) {
      stack[size++] = node.first + 1;
      stack[size++] = node.first;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      if (a.kind == SolidKind::mesh && space.misses(a.triangles[i])) continue;
      const Convex piece = a.piece(i);
      if (!pieces_collide(piece, triangle, b_in_a, reach)) continue;
      if (!closing.directed || !triangles_stay_apart(piece, triangle, b_in_a, margin, closing)) return true;
    }
  }
  return false;
}

// True when the grid proves the triangle farther away than the margin, cutting it in halves where it must.
bool grid_clears(const DistanceGrid& grid, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                 double margin, int cuts) {
  const Eigen::Vector3d middle = (a + b + c) / 3;
  const double distance = grid.distance(middle) - margin;
  if (distance <= 0) return false;
  const double squared = std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()});
  if (distance * distance > squared) return true;
  if (cuts == 0) return false;
  const auto halves = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& other) {
    const Eigen::Vector3d half = 0.5 * (from + to);
    return grid_clears(grid, from, half, other, margin, cuts - 1) &&
           grid_clears(grid, half, to, other, margin, cuts - 1);
  };
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  if (ab >= bc && ab >= ca) return halves(a, b, c);
  return bc >= ca ? halves(b, c, a) : halves(c, a, b);
}

// More halves cost more than the exact test they may save.
constexpr int kCuts = 1;

// Triangles of b that the grid of a cannot rule out, against the tree of a.
bool tree_hits_grid(const Solid& a, const DistanceGrid& grid, const Solid& b, const PairFrame& frame, double margin,
                    const Closing& closing) {
  const double reach = margin + closing.most;
  int stack[64], size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const BoxTree::Node& node = b.tree.nodes()[stack[--size]];
    if (grid.distance(frame.b_in_a * node.centre) > node.half.norm() + reach) continue;
    if (node.count == 0) {
      stack[size++] = node.first + 1;
      stack[size++] = node.first;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Convex triangle = b.piece(i);
      const double* p = triangle.points;
      Eigen::Vector3d corner[3];
      for (int c = 0; c < 3; ++c) corner[c] = frame.b_in_a * Eigen::Vector3d(p[c], p[3 + c], p[6 + c]);
      if (grid_clears(grid, corner[0], corner[1], corner[2], reach, kCuts)) continue;
      if (tree_hits_triangle(a, triangle, frame.b_in_a, margin, closing)) return true;
    }
  }
  return false;
}

// b inside the closed mesh a, given that their surfaces do not meet: then each connected part is in or out as a whole.
bool inside(const Solid& a, const Solid& b, const Rigid& b_in_a) {
  if (a.kind != SolidKind::mesh || !a.closed) return false;
  if (b.kind == SolidKind::convex) return a.contains(b_in_a * b.core.centre);
  for (const Eigen::Vector3d& point : b.part_points) {
    if (a.contains(b_in_a * point)) return true;
  }
  return false;
}

double lowest_along(const Solid& body, const Eigen::Vector3d& normal) {
  if (body.kind == SolidKind::convex) return normal.dot(body.core.support(-normal)) - body.core.radius * normal.norm();
  double lowest = kInfinity;
  for (const auto& t : body.triangles) {
    for (int c = 0; c < 3; ++c)
      lowest = std::min(lowest, normal[0] * t[c] + normal[1] * t[3 + c] + normal[2] * t[6 + c]);
  }
  const double half = body.cell_half * normal.lpNorm<1>();
  for (const Eigen::Vector3d& cell : body.cells) lowest = std::min(lowest, normal.dot(cell) - half);
  return lowest;
}

bool plane_collides(const Solid& plane, const Solid& b, const Rigid& b_in_a, double margin) {
  const Eigen::Vector3d normal = b_in_a.R.transpose() * plane.normal;  // in the frame of b
  const double shift = plane.normal.dot(b_in_a.t);
  if (b.kind == SolidKind::plane) {
    // Half-spaces miss each other only when they face away from each other with a clearance between.
    const bool opposite = (normal + b.normal).norm() < 1e-9;
    return !opposite || shift - b.offset <= plane.offset + margin;
  }
  return lowest_along(b, normal) + shift <= plane.offset + margin;
}

}  // namespace

bool solids_collide(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b, double more, bool hulls_meet,
                    int* hit_piece) {
  if (a.never_collides() || b.never_collides()) return false;
  if (a.kind == SolidKind::field) return field_collides(b, T_b, *a.field, T_a, more + a.margin);
  if (b.kind == SolidKind::field) return field_collides(a, T_a, *b.field, T_b, more + b.margin);
  if (a.kind != SolidKind::plane && b.kind == SolidKind::plane) return solids_collide(b, T_b, a, T_a, more);
  const bool a_is_tree = a.kind == SolidKind::mesh || a.kind == SolidKind::voxels;
  const bool b_is_tree = b.kind == SolidKind::mesh || b.kind == SolidKind::voxels;
  if (!a_is_tree && b_is_tree && a.kind != SolidKind::plane)
    return solids_collide(b, T_b, a, T_a, more, hulls_meet, hit_piece);

  const PairFrame frame(T_a, T_b);
  const double margin = a.margin + b.margin + more;
  if (a.kind == SolidKind::plane) return plane_collides(a, b, frame.b_in_a, margin);

  const Eigen::Vector3d between = frame.b_in_a * b.box_centre - a.box_centre;
  if (!boxes_overlap(a.box_half, b.box_half, frame.b_in_a.R, frame.abs_R, between, margin)) return false;
  if (a.is_box && b.is_box) return true;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  const bool a_bounded = !a_is_tree || a.has_hull, b_bounded = !b_is_tree || b.has_hull;
  if (a_bounded && b_bounded && !(hulls_meet && a_is_tree)) {
    const bool hit = convex_collide(a.core, b.core, frame.b_in_a, margin, axis);
    if (!hit || (!a_is_tree && !b_is_tree)) return hit;
  }
  if ((!a_is_tree || a.has_inner) && (!b_is_tree || b.has_inner)) {
    if (convex_collide(a_is_tree ? a.inner : a.core, b_is_tree ? b.inner : b.core, frame.b_in_a, margin, axis))
      return true;
  }
  int hit = -1;
  if (b_is_tree ? tree_hits_tree(a, b, frame, margin) : tree_hits_convex(a, b, frame, margin, hit)) {
    if (hit_piece != nullptr) *hit_piece = hit;
    return true;
  }
  return inside(a, b, frame.b_in_a) || inside(b, a, T_b.to(T_a));
}

bool piece_collides(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b, int piece) {
  if (a.kind == SolidKind::convex) return b.kind != SolidKind::convex && piece_collides(b, T_b, a, T_a, piece);
  const bool pieces = a.kind == SolidKind::mesh || a.kind == SolidKind::voxels;
  return pieces && b.kind == SolidKind::convex &&
         pieces_collide(a.piece(piece), b.core, T_a.to(T_b), a.margin + b.margin);
}

bool meshes_collide(const Solid& a, const Rigid& T_a, const DistanceGrid& grid, const Solid& b, const Rigid& T_b,
                    const Closing& closing, bool hulls_meet) {
  const PairFrame frame(T_a, T_b);
  const double margin = a.margin + b.margin, reach = margin + closing.most;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  if (!hulls_meet && a.has_hull && b.has_hull && !convex_collide(a.core, b.core, frame.b_in_a, reach, axis))
    return false;
  if (a.has_inner && b.has_inner && convex_collide(a.inner, b.inner, frame.b_in_a, margin, axis)) return true;
  if (tree_hits_grid(a, grid, b, frame, margin, closing.seen_from(T_a))) return true;
  return inside(a, b, frame.b_in_a) || inside(b, a, T_b.to(T_a));
}

}  // namespace mmgrasp::detail
