#include "collision/narrow/field_body.hpp"

#include <cmath>

#include "collision/narrow/narrow.hpp"
#include "collision/narrow/solid.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

constexpr int kSides = 128;  // of the prism around a cylinder

Eigen::AlignedBox3d bounds_of(const FieldBody::Piece& piece) {
  if (piece.count == 0) return piece.box;
  Eigen::AlignedBox3d box;
  for (int i = 0; i < piece.count; ++i) box.extend(piece.corners[i]);
  return box;
}

std::vector<Eigen::Vector3d> hull_points(const Convex& core) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < core.count; ++i)
    points.emplace_back(core.points[i], core.points[core.count + i], core.points[2 * core.count + i]);
  return points;
}

TriangleMesh prism(double radius, double half_length) {
  TriangleMesh mesh;
  const double outer = radius / std::cos(kPi / kSides);
  for (const double z : {-half_length, half_length})
    for (int i = 0; i < kSides; ++i) {
      const double angle = kTwoPi * i / kSides;
      mesh.vertices.emplace_back(outer * std::cos(angle), outer * std::sin(angle), z);
    }
  for (const double z : {-half_length, half_length}) mesh.vertices.emplace_back(0, 0, z);
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides;
    mesh.triangles.push_back({i, next, kSides + i});
    mesh.triangles.push_back({next, kSides + next, kSides + i});
    mesh.triangles.push_back({i, next, 2 * kSides});
    mesh.triangles.push_back({kSides + i, kSides + next, 2 * kSides + 1});
  }
  return mesh;
}

}  // namespace

FieldBody::FieldBody(const Solid& solid) : solid_(solid) {
  if (solid.kind != SolidKind::convex) {
    hollow_ = solid.kind == SolidKind::mesh && solid.closed;
    return;
  }
  const Convex& core = solid.core;
  radius_ = core.radius;
  if (core.kind == ConvexKind::hull) {
    const auto hull = convex_hull(hull_points(core));
    add_fan(hull->vertices, hull->triangles, core.centre);
  } else if (core.kind == ConvexKind::cylinder) {
    const TriangleMesh around = prism(core.half[0], core.half[2]);
    add_fan(around.vertices, around.triangles, core.centre);
  } else {
    add_box({Eigen::Vector3d(core.centre - core.half), Eigen::Vector3d(core.centre + core.half)});
  }
  build();
}

void FieldBody::add_box(const Eigen::AlignedBox3d& box) {
  Piece piece;
  piece.box = box;
  pieces_.push_back(piece);
}

// A convex body as the tetrahedra between its surface and a point inside.
void FieldBody::add_fan(const std::vector<Eigen::Vector3d>& points, const std::vector<std::array<int, 3>>& triangles,
                        const Eigen::Vector3d& middle) {
  corners_ = points;
  middle_ = middle;
  for (const auto& t : triangles) {
    Piece piece;
    piece.corners = {points[t[0]], points[t[1]], points[t[2]], middle};
    piece.count = 4;
    pieces_.push_back(piece);
  }
}

void FieldBody::build() {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Piece& piece : pieces_) boxes.push_back(bounds_of(piece));
  tree_ = BoxTree(boxes, 2);
  std::vector<Piece> sorted;
  for (const int item : tree_.items()) sorted.push_back(pieces_[item]);
  pieces_ = std::move(sorted);
}

const BoxTree& FieldBody::tree() const {
  return pieces_.empty() ? solid_.tree : tree_;
}

FieldBody::Piece FieldBody::piece(int position) const {
  if (!pieces_.empty()) return pieces_[position];
  Piece out;
  if (solid_.kind == SolidKind::voxels) {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(solid_.cell_half);
    out.box = {Eigen::Vector3d(solid_.cells[position] - half), Eigen::Vector3d(solid_.cells[position] + half)};
    return out;
  }
  const auto& t = solid_.triangles[position];
  out.count = 3;
  for (int c = 0; c < 3; ++c) out.corners[c] = {t[c], t[3 + c], t[6 + c]};
  return out;
}

bool FieldBody::contains(const Eigen::Vector3d& point) const {
  return solid_.contains(point);
}

bool FieldBody::meets(const Eigen::AlignedBox3d& box) const {
  Solid cell;
  cell.core.kind = ConvexKind::box;
  cell.core.half = 0.5 * box.sizes();
  cell.box_half = cell.core.half;
  return solids_collide(solid_, Rigid(), cell, {Eigen::Matrix3d::Identity(), box.center()});
}

}  // namespace mmgrasp::detail
