#include "collision/narrow/solid.hpp"

#include <mutex>
#include <numeric>
#include <unordered_map>

#include "collision/narrow/convex_clearance.hpp"
#include "collision/narrow/field_body.hpp"
#include "collision/narrow/stages.hpp"
#include "mmgrasp/core/detail/cell_key.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/detail/mesh_topology.hpp"

namespace mmgrasp::detail {

namespace {

// Larger hulls cost more than they save as an outer bound: some of their corners stand for all.
constexpr std::size_t kMaxHullBound = 400;
constexpr int kHullDirections = 200;

// x of all points, then y, then z; whole vectors of them, the last point repeated.
std::vector<double> by_coordinate(const std::vector<Eigen::Vector3d>& points) {
  const std::size_t count = (points.size() + kLanes - 1) / kLanes * kLanes;
  std::vector<double> out(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d& p = points[std::min(i, points.size() - 1)];
    for (std::size_t k = 0; k < 3; ++k) out[k * count + i] = p[static_cast<int>(k)];
  }
  return out;
}

void set_hull(Convex& core, const std::vector<double>& points) {
  core.kind = ConvexKind::hull;
  core.points = points.data();
  core.count = static_cast<int>(points.size() / 3);
  core.centre.setZero();
  for (int i = 0; i < core.count; ++i) {
    core.centre += Eigen::Vector3d(points[i], points[core.count + i], points[2 * core.count + i]) / core.count;
  }
}

// The hull's points in single precision as well. Coordinates and sums of their products are rounded a few times.
void set_rough(Convex& core, std::vector<float>& rough) {
  rough.assign(core.points, core.points + 3 * core.count);
  core.rough = rough.data();
  for (int i = 0; i < 3 * core.count; ++i)
    core.rough_error = std::max(core.rough_error, 2e-6 * std::abs(core.points[i]));
}

// The smaller of two simple choices: around the box, or around the farthest vertex from the box's middle.
void set_bounds(Solid& solid, const Eigen::AlignedBox3d& box, double sphere_radius) {
  solid.box_centre = box.center();
  solid.box_half = 0.5 * box.sizes();
  solid.sphere_centre = solid.box_centre;
  solid.sphere_radius = std::min(sphere_radius, solid.box_half.norm()) + solid.margin;
}

void set_mesh_bounds(Solid& solid, const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
  double radius = 0;
  for (const Eigen::Vector3d& v : mesh.vertices) radius = std::max(radius, (v - box.center()).norm());
  set_bounds(solid, box, radius);
}

// How deep the mesh's surface dips below its hull, from above: over a triangle the depth under the nearest hull face is
// at most the least, over faces, of the deepest corner.
double deepest_concavity(const TriangleMesh& mesh, const std::vector<Eigen::Vector4d>& planes) {
  double deepest = 0;
  InterruptionPoll poll(64);
  for (const auto& t : mesh.triangles) {
    poll();
    double least = kInfinity;
    for (const Eigen::Vector4d& plane : planes) {
      double corner_depth = 0;
      for (const int corner : t) {
        corner_depth = std::max(corner_depth, plane[3] - plane.head<3>().dot(mesh.vertices[corner]));
      }
      least = std::min(least, corner_depth);
    }
    deepest = std::max(deepest, least);
  }
  return deepest;
}

// The hull scaled down about its middle until no point of it is less deep than the deepest concavity: no surface
// reaches it, so it is inside as a whole when its middle is.
bool set_inner(Solid& solid, const TriangleMesh& mesh, const TriangleMesh& hull, std::vector<double>& inner_points) {
  const Eigen::Vector3d middle = solid.core.centre;
  std::vector<Eigen::Vector4d> planes;
  double middle_depth = kInfinity;
  for (const auto& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[t[0]];
    const Eigen::Vector3d normal = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a).normalized();
    planes.emplace_back(normal[0], normal[1], normal[2], normal.dot(a));
    middle_depth = std::min(middle_depth, normal.dot(a - middle));
  }
  const double shrink = (deepest_concavity(mesh, planes) + solid.core.radius) / middle_depth;
  if (!(middle_depth > 0) || shrink > 0.5 || !solid.contains(middle)) return false;
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& v : hull.vertices) {
    points.push_back(middle + (1 - shrink) * (v - middle));
    // From any point of the hull the way to the middle meets the mesh before it enters the inner body.
    solid.concavity = std::max(solid.concavity, shrink * (v - middle).norm() + solid.core.radius);
  }
  inner_points = by_coordinate(points);
  set_hull(solid.inner, inner_points);
  solid.inner.half = solid.core.half;
  return true;
}

// The farthest corners along directions spread evenly over the sphere.
std::vector<Eigen::Vector3d> farthest_corners(const std::vector<Eigen::Vector3d>& corners) {
  std::vector<char> taken(corners.size(), 0);
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < kHullDirections; ++i) {
    throw_if_interrupted();
    const double z = 1 - (2 * i + 1.0) / kHullDirections, r = std::sqrt(1 - z * z), turn = i * 2.399963229728653;
    const Eigen::Vector3d direction(r * std::cos(turn), r * std::sin(turn), z);
    std::size_t best = 0;
    for (std::size_t k = 1; k < corners.size(); ++k) {
      if (direction.dot(corners[k]) > direction.dot(corners[best])) best = k;
    }
    if (!taken[best]) out.push_back(corners[best]);
    taken[best] = 1;
  }
  return out;
}

// How far the corners lie outside a hull at most.
double farthest_outside(const std::vector<Eigen::Vector3d>& corners, const Convex& hull) {
  double farthest = 0;
  ConvexClearance clearance;
  InterruptionPoll poll(64);
  for (const Eigen::Vector3d& corner : corners) {
    poll();
    Convex point;
    point.centre = corner;
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    const ClearanceKind kind = convex_clearance(point, hull, Rigid(), kInfinity, axis, clearance);
    if (kind == ClearanceKind::apart) farthest = std::max(farthest, clearance.distance);
  }
  return farthest;
}

void set_mesh(Solid& solid, const TriangleMesh& mesh, std::vector<double>& hull_points, std::vector<float>& rough,
              std::vector<double>& inner_points) {
  set_mesh_bounds(solid, mesh);
  solid.core.half = solid.box_half;
  if (mesh.convex) {
    // Its core grows by the margin like a sphere does: within `margin` counts as touching.
    hull_points = by_coordinate(mesh.vertices);
    set_hull(solid.core, hull_points);
    set_rough(solid.core, rough);
    solid.kind = SolidKind::convex;
    return;
  }
  solid.kind = SolidKind::mesh;
  solid.closed = mesh.closed;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const auto& t : mesh.triangles) {
    Eigen::AlignedBox3d box;
    for (const int corner : t) box.extend(mesh.vertices[corner]);
    boxes.push_back(box);
  }
  solid.tree = BoxTree(boxes, 2);
  for (const int item : solid.tree.items()) {
    std::array<double, 9> corners{};
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) corners[3 * k + c] = mesh.vertices[mesh.triangles[item][c]][k];
    }
    solid.triangles.push_back(corners);
  }
  const Shells shells = find_shells(mesh.triangles);
  std::vector<bool> seen(shells.count, false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int shell = shells.shell_of_triangle[t];
    if (!seen[shell]) solid.part_points.push_back(mesh.vertices[mesh.triangles[t][0]]);
    seen[shell] = true;
  }
  try {
    const auto hull = convex_hull(mesh.vertices);
    const bool whole = hull->vertices.size() <= kMaxHullBound;
    hull_points = by_coordinate(whole ? hull->vertices : farthest_corners(hull->vertices));
    set_hull(solid.core, hull_points);
    set_rough(solid.core, rough);
    // The hull's own rounding must not cut anything off.
    solid.core.radius = 1e-6 * solid.box_half.norm();
    if (!whole) solid.core.radius += farthest_outside(hull->vertices, solid.core);
    solid.has_hull = runs(kHullStage);
    solid.has_inner = runs(kHullStage) && mesh.closed && whole && set_inner(solid, mesh, *hull, inner_points);
  } catch (const InvalidInput&) {
    solid.has_hull = false;  // a flat sheet has no hull
  }
}

// One cell of each group of cells that touch (27 neighbours).
std::vector<Eigen::Vector3d> cell_groups(const std::vector<Eigen::Vector3d>& cells, double resolution) {
  std::unordered_map<CellKey, int, CellKeyHash> index;
  index.reserve(cells.size());
  const auto key = [&](const Eigen::Vector3d& c) {
    const Eigen::Vector3d k = (c / resolution).array().floor();
    return CellKey{static_cast<std::int64_t>(k[0]), static_cast<std::int64_t>(k[1]), static_cast<std::int64_t>(k[2])};
  };
  std::vector<int> parent(cells.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  InterruptionPoll poll;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    poll();
    const auto [it, is_new] = index.emplace(key(cells[i]), static_cast<int>(i));
    if (!is_new) parent[i] = it->second;
  }
  for (const auto& [k, i] : index) {
    poll();
    for (int n = 0; n < 13; ++n) {  // the others see this cell as their neighbour
      const auto it = index.find({k[0] + n % 3 - 1, k[1] + n / 3 % 3 - 1, k[2] + n / 9 - 1});
      if (it == index.end()) continue;
      const bool touch = (cells[it->second] - cells[i]).cwiseAbs().maxCoeff() <= resolution * (1 + 1e-9);
      if (!touch) continue;
      // The group's first cell stands for it.
      const int one = find(it->second), other = find(i);
      parent[std::max(one, other)] = std::min(one, other);
    }
  }
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (find(static_cast<int>(i)) == static_cast<int>(i)) out.push_back(cells[i]);
  }
  return out;
}

void set_voxels(Solid& solid, const Voxels& voxels) {
  solid.kind = SolidKind::voxels;
  solid.cell_half = 0.5 * voxels.resolution;
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(solid.cell_half);
  std::vector<Eigen::AlignedBox3d> boxes;
  Eigen::AlignedBox3d all;
  for (const Eigen::Vector3d& c : *voxels.centres) {
    boxes.emplace_back(Eigen::Vector3d(c - half), Eigen::Vector3d(c + half));
    all.extend(boxes.back());
  }
  if (boxes.empty()) return;
  solid.tree = BoxTree(boxes, 1);
  for (const int item : solid.tree.items()) solid.cells.push_back((*voxels.centres)[item]);
  set_bounds(solid, all, all.diagonal().norm());
  solid.part_points = cell_groups(*voxels.centres, voxels.resolution);
  solid.grid = std::make_shared<const DistanceGrid>(*voxels.centres, voxels.resolution);
}

void set_primitive(Solid& solid, const Shape& shape, double padding) {
  Convex& core = solid.core;
  if (const auto* s = std::get_if<Box>(&shape)) {
    core.kind = ConvexKind::box;
    core.half = 0.5 * s->size + Eigen::Vector3d::Constant(padding);
    solid.is_box = true;
  } else if (const auto* s = std::get_if<Sphere>(&shape)) {
    core.kind = ConvexKind::point;
    core.radius = s->radius + padding;
  } else if (const auto* s = std::get_if<Cylinder>(&shape)) {
    core.kind = ConvexKind::cylinder;
    core.half = {s->radius + padding, s->radius + padding, 0.5 * s->length + padding};
  } else if (const auto* s = std::get_if<Capsule>(&shape)) {
    core.kind = ConvexKind::segment;
    core.half = {0, 0, 0.5 * s->length};
    core.radius = s->radius + padding;
  }
  solid.box_half = core.half + Eigen::Vector3d::Constant(core.radius);
  solid.sphere_radius =
      core.kind == ConvexKind::cylinder ? std::hypot(core.half[0], core.half[2]) : core.half.norm() + core.radius;
}

// Signed crossings of the generic ray from the point with the triangles of the tree.
bool ray_meets_box(const BoxTree::Node& node, const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  double enter = 0, leave = kInfinity;
  for (int k = 0; k < 3; ++k) {  // every component of the generic direction is positive
    const double slack = 1e-12 * (1 + std::abs(from[k]));
    enter = std::max(enter, (node.centre[k] - node.half[k] - slack - from[k]) / direction[k]);
    leave = std::min(leave, (node.centre[k] + node.half[k] + slack - from[k]) / direction[k]);
  }
  return enter <= leave;
}

}  // namespace

struct Solid::LazyFieldBody {
  std::once_flag once;
  std::unique_ptr<const FieldBody> body;
};

const FieldBody& Solid::field_body() const {
  std::call_once(field_body_->once, [&] { field_body_->body = std::make_unique<const FieldBody>(*this); });
  return *field_body_->body;
}

bool Solid::contains(const Eigen::Vector3d& point) const {
  if (!closed || ((point - box_centre).cwiseAbs() - box_half).maxCoeff() > 0) return false;
  const Eigen::Vector3d direction = ray_direction();
  int stack[64], size = 0, winding = 0;
  stack[size++] = 0;
  while (size > 0) {
    const BoxTree::Node& node = tree.nodes()[stack[--size]];
    if (!ray_meets_box(node, point, direction)) continue;
    if (node.count == 0) {
      stack[size++] = node.first;
      stack[size++] = node.first + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const auto& t = triangles[i];
      winding += ray_crossing({t[0] - point[0], t[3] - point[1], t[6] - point[2]},
                              {t[1] - point[0], t[4] - point[1], t[7] - point[2]},
                              {t[2] - point[0], t[5] - point[1], t[8] - point[2]});
    }
  }
  return winding > 0;
}

Convex Solid::piece(int position) const {
  Convex out;
  if (kind == SolidKind::voxels) {
    out.kind = ConvexKind::box;
    out.centre = cells[position];
    out.half.setConstant(cell_half);
  } else {
    const auto& t = triangles[position];
    out.kind = ConvexKind::hull;
    out.points = t.data();
    out.count = 3;
    out.centre = Eigen::Vector3d(t[0] + t[1] + t[2], t[3] + t[4] + t[5], t[6] + t[7] + t[8]) / 3;
  }
  return out;
}

std::shared_ptr<const Solid> make_solid(const Shape& shape, double padding) {
  auto solid = std::make_shared<Solid>();
  solid->field_body_ = std::make_shared<Solid::LazyFieldBody>();
  if (const auto* s = std::get_if<MeshShape>(&shape)) {
    solid->margin = padding;
    set_mesh(*solid, *s->mesh, solid->hull_points_, solid->rough_points_, solid->inner_points_);
  } else if (const auto* s = std::get_if<Voxels>(&shape)) {
    solid->margin = padding;
    set_voxels(*solid, *s);
  } else if (const auto* s = std::get_if<Plane>(&shape)) {
    solid->kind = SolidKind::plane;
    solid->normal = s->normal;
    solid->offset = s->offset + padding;
    solid->box_half.setConstant(kInfinity);
    solid->sphere_radius = kInfinity;
  } else {
    set_primitive(*solid, shape, padding);
  }
  return solid;
}

}  // namespace mmgrasp::detail
