#include "collision/narrow/simplex.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

// A face of the simplex (corner numbers and weights) and its point closest to the origin.
struct Foot {
  int size = 0;
  int corner[3] = {0, 0, 0};
  double weight[3] = {1, 0, 0};
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double squared = kInfinity;
};

Foot on_corner(const SimplexPoint* p, int i) {
  Foot foot;
  foot.size = 1;
  foot.corner[0] = i;
  foot.point = p[i].w;
  foot.squared = foot.point.squaredNorm();
  return foot;
}

Foot on_segment(const SimplexPoint* p, int i, int j) {
  const Eigen::Vector3d& a = p[i].w;
  const Eigen::Vector3d ab = p[j].w - a;
  const double length = ab.squaredNorm(), along = -a.dot(ab);
  if (!(along > 0)) return on_corner(p, i);
  if (along >= length) return on_corner(p, j);
  const double s = along / length;
  Foot foot;
  foot.size = 2;
  foot.corner[0] = i;
  foot.corner[1] = j;
  foot.weight[0] = 1 - s;
  foot.weight[1] = s;
  foot.point = a + s * ab;
  foot.squared = foot.point.squaredNorm();
  return foot;
}

// Inside the triangle when the origin's shadow is on the inner side of every edge; else on the closest edge it is
// outside of.
Foot on_triangle(const SimplexPoint* p, int i, int j, int k) {
  const Eigen::Vector3d &a = p[i].w, &b = p[j].w, &c = p[k].w;
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const double weight[3] = {n.dot(b.cross(c)), n.dot(c.cross(a)), n.dot(a.cross(b))};
  if (weight[0] > 0 && weight[1] > 0 && weight[2] > 0) {
    const double sum = weight[0] + weight[1] + weight[2];
    Foot foot;
    foot.size = 3;
    const int corners[3] = {i, j, k};
    for (int m = 0; m < 3; ++m) {
      foot.corner[m] = corners[m];
      foot.weight[m] = weight[m] / sum;
    }
    foot.point = n * (n.dot(a) / n.squaredNorm());
    foot.squared = foot.point.squaredNorm();
    return foot;
  }
  Foot best;
  const int edges[3][2] = {{j, k}, {k, i}, {i, j}};
  for (int e = 0; e < 3; ++e) {
    if (weight[e] > 0) continue;
    const Foot foot = on_segment(p, edges[e][0], edges[e][1]);
    if (foot.squared < best.squared) best = foot;
  }
  return best;
}

// False when the origin lies inside.
bool on_tetrahedron(const SimplexPoint* p, Foot& best) {
  constexpr int faces[4][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}};
  bool outside = false;
  for (const auto& f : faces) {
    const Eigen::Vector3d& a = p[f[0]].w;
    const Eigen::Vector3d ad = p[f[3]].w - a;
    const Eigen::Vector3d n = (p[f[1]].w - a).cross(p[f[2]].w - a);
    const double origin_side = -n.dot(a), inner_side = n.dot(ad);
    // A flat tetrahedron has no inside: every face counts then.
    const bool flat = inner_side * inner_side <= 1e-26 * n.squaredNorm() * ad.squaredNorm();
    if (!flat && origin_side * inner_side > 0) continue;
    outside = true;
    const Foot foot = on_triangle(p, f[0], f[1], f[2]);
    if (foot.squared < best.squared) best = foot;
  }
  return outside;
}

}  // namespace

bool Simplex::holds(const Eigen::Vector3d& w) const {
  for (int i = 0; i < size_; ++i) {
    if (points_[i].w == w) return true;
  }
  return false;
}

void Simplex::witness(Eigen::Vector3d& on_a, Eigen::Vector3d& on_b) const {
  on_a.setZero();
  on_b.setZero();
  for (int i = 0; i < size_; ++i) {
    on_a += weights_[i] * points_[i].on_a;
    on_b += weights_[i] * points_[i].on_b;
  }
}

bool Simplex::reduce() {
  Foot foot;
  if (size_ == 1) foot = on_corner(points_, 0);
  if (size_ == 2) foot = on_segment(points_, 0, 1);
  if (size_ == 3) foot = on_triangle(points_, 0, 1, 2);
  if (size_ == 4 && !on_tetrahedron(points_, foot)) return true;
  closest_ = foot.point;
  // Corners come in rising order from every face above except for rotations of it, so sort before moving in place.
  for (int m = 1; m < foot.size; ++m) {
    for (int l = m; l > 0 && foot.corner[l] < foot.corner[l - 1]; --l) {
      std::swap(foot.corner[l], foot.corner[l - 1]);
      std::swap(foot.weight[l], foot.weight[l - 1]);
    }
  }
  for (int m = 0; m < foot.size; ++m) {
    if (foot.corner[m] != m) points_[m] = points_[foot.corner[m]];
    weights_[m] = foot.weight[m];
  }
  size_ = foot.size;
  return false;
}

}  // namespace mmgrasp::detail
