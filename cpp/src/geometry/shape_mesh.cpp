// Surfaces of shapes as triangles, for drawing.
#include <cmath>
#include <set>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp {

namespace {

using Vertices = std::vector<Eigen::Vector3d>;
using Triangles = std::vector<std::array<int, 3>>;

void add_quad(Triangles& triangles, int a, int b, int c, int d) {
  triangles.push_back({a, b, c});
  triangles.push_back({a, c, d});
}

std::shared_ptr<const TriangleMesh> box_mesh(const Eigen::Vector3d& size) {
  Vertices vertices;
  for (int i = 0; i < 8; ++i) {
    vertices.push_back(0.5 * Eigen::Vector3d(i & 1 ? size.x() : -size.x(), i & 2 ? size.y() : -size.y(),
                                             i & 4 ? size.z() : -size.z()));
  }
  Triangles triangles;
  add_quad(triangles, 0, 2, 3, 1);
  add_quad(triangles, 4, 5, 7, 6);
  add_quad(triangles, 0, 1, 5, 4);
  add_quad(triangles, 2, 6, 7, 3);
  add_quad(triangles, 0, 4, 6, 2);
  add_quad(triangles, 1, 3, 7, 5);
  return make_mesh(std::move(vertices), std::move(triangles));
}

// A surface of revolution about z through rings of (radius, z), from bottom to top, closed by poles at both ends.
std::shared_ptr<const TriangleMesh> revolve(const std::vector<Eigen::Vector2d>& rings, double bottom, double top,
                                            int segments) {
  Vertices vertices{{0, 0, bottom}, {0, 0, top}};
  Triangles triangles;
  const auto at = [&](std::size_t ring, int s) { return 2 + static_cast<int>(ring) * segments + s % segments; };
  for (const Eigen::Vector2d& ring : rings) {
    detail::throw_if_interrupted();
    for (int s = 0; s < segments; ++s) {
      const double angle = detail::kTwoPi * s / segments;
      vertices.emplace_back(ring.x() * std::cos(angle), ring.x() * std::sin(angle), ring.y());
    }
  }
  for (int s = 0; s < segments; ++s) {
    detail::throw_if_interrupted();
    triangles.push_back({0, at(0, s + 1), at(0, s)});
    triangles.push_back({1, at(rings.size() - 1, s), at(rings.size() - 1, s + 1)});
    for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
      add_quad(triangles, at(r, s), at(r, s + 1), at(r + 1, s + 1), at(r + 1, s));
    }
  }
  return make_mesh(std::move(vertices), std::move(triangles));
}

// Sphere (length 0) or capsule: two half spheres `length` apart.
std::shared_ptr<const TriangleMesh> round_mesh(double radius, double length, int segments) {
  const int half = std::max(2, segments / 4);
  std::vector<Eigen::Vector2d> rings;
  for (int i = 1; i <= half; ++i) {
    const double angle = -detail::kPi / 2 + detail::kPi / 2 * i / half;
    rings.emplace_back(radius * std::cos(angle), radius * std::sin(angle) - length / 2);
  }
  if (length > 0) rings.emplace_back(radius, length / 2);
  for (int i = 1; i < half; ++i) {
    const double angle = detail::kPi / 2 * i / half;
    rings.emplace_back(radius * std::cos(angle), radius * std::sin(angle) + length / 2);
  }
  return revolve(rings, -length / 2 - radius, length / 2 + radius, segments);
}

// Outer faces only: a face between two occupied cells is left out.
std::shared_ptr<const TriangleMesh> voxel_mesh(const Voxels& voxels) {
  const double h = voxels.resolution;
  if (voxels.centres->empty()) throw InvalidInput("voxels.centres = 0 cells: a surface needs at least one");
  const Eigen::Vector3d origin = voxels.centres->front();
  using Cell = std::array<long, 3>;
  std::set<Cell> cells;
  detail::InterruptionPoll poll(1024);
  for (const Eigen::Vector3d& c : *voxels.centres) {
    poll();
    const Eigen::Vector3d index = (c - origin) / h;
    cells.insert({std::lround(index.x()), std::lround(index.y()), std::lround(index.z())});
  }
  Vertices vertices;
  Triangles triangles;
  for (const Cell& cell : cells) {
    poll();
    const Eigen::Vector3d centre = origin + h * Eigen::Vector3d(cell[0], cell[1], cell[2]);
    for (int axis = 0; axis < 3; ++axis) {
      for (const int sign : {-1, 1}) {
        Cell next = cell;
        next[axis] += sign;
        if (cells.count(next) != 0) continue;
        const Eigen::Vector3d n = sign * Eigen::Vector3d::Unit(axis), u = Eigen::Vector3d::Unit((axis + 1) % 3);
        const Eigen::Vector3d v = n.cross(u);
        const int first = static_cast<int>(vertices.size());
        for (const auto& corner :
             {Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, -1), Eigen::Vector2d(1, 1), Eigen::Vector2d(-1, 1)}) {
          vertices.push_back(centre + 0.5 * h * (n + corner.x() * u + corner.y() * v));
        }
        add_quad(triangles, first, first + 1, first + 2, first + 3);
      }
    }
  }
  return make_mesh(std::move(vertices), std::move(triangles));
}

}  // namespace

std::shared_ptr<const TriangleMesh> shape_mesh(const Shape& shape, int segments) {
  require_within(segments, 3, 10000, "segments", "");
  check_shape(shape, "shape");
  if (const auto* s = std::get_if<Box>(&shape)) return box_mesh(s->size);
  if (const auto* s = std::get_if<Sphere>(&shape)) return round_mesh(s->radius, 0, segments);
  if (const auto* s = std::get_if<Capsule>(&shape)) return round_mesh(s->radius, s->length, segments);
  if (const auto* s = std::get_if<MeshShape>(&shape)) return s->mesh;
  if (const auto* s = std::get_if<Voxels>(&shape)) return voxel_mesh(*s);
  if (const auto* s = std::get_if<Cylinder>(&shape)) {
    return revolve({{s->radius, -s->length / 2}, {s->radius, s->length / 2}}, -s->length / 2, s->length / 2, segments);
  }
  throw InvalidInput("shape = plane: it has no bounded surface");
}

}  // namespace mmgrasp
