#include "verify/robot/solid.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/bvh/detail/BV_splitter.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <variant>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp::verify::detail {
namespace {

using BvhModel = fcl::BVHModel<fcl::OBBRSSd>;

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

Bounds centred(const Eigen::Vector3d& size) {
  return {-0.5 * size, 0.5 * size};
}

/// FCL's own way to split, which can be stopped: the tree of a million triangles takes seconds.
class StoppableSplitter : public fcl::detail::BVSplitter<fcl::OBBRSSd> {
 public:
  StoppableSplitter() : BVSplitter(fcl::detail::SPLIT_METHOD_MEAN) {}
  void computeRule(const fcl::OBBRSSd& bounds, unsigned int* primitives, int count) override {
    if (count > 1000) mmgrasp::detail::throw_if_interrupted();
    BVSplitter::computeRule(bounds, primitives, count);
  }
};

std::shared_ptr<BvhModel> bvh(const TriangleMesh& mesh) {
  auto model = std::make_shared<BvhModel>();
  model->bv_splitter = std::make_shared<StoppableSplitter>();
  model->beginModel(static_cast<int>(mesh.triangles.size()), static_cast<int>(mesh.vertices.size()));
  std::vector<fcl::Vector3d> vertices(mesh.vertices.begin(), mesh.vertices.end());
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->addSubModel(vertices, triangles);
  model->endModel();
  model->computeLocalAABB();
  return model;
}

/// A vertex of each connected piece: a piece that is swallowed whole shows in none of the others.
std::vector<Eigen::Vector3d> piece_probes(const TriangleMesh& mesh) {
  std::vector<int> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& t : mesh.triangles) {
    parent[root(t[0])] = root(t[1]);
    parent[root(t[1])] = root(t[2]);
    for (const int v : t) used[v] = true;
  }
  std::vector<Eigen::Vector3d> probes;
  for (int v = 0; v < static_cast<int>(parent.size()); ++v) {
    if (used[v] && parent[v] == v) probes.push_back(mesh.vertices[v]);
  }
  return probes;
}

Solid primitive(std::shared_ptr<fcl::CollisionGeometryd> geometry, const Pose& T, const Bounds& local) {
  geometry->computeLocalAABB();
  Solid solid;
  solid.geometry = std::move(geometry);
  solid.T_body_shape = T;
  solid.local = local;
  solid.probes = {Eigen::Vector3d::Zero()};
  return solid;
}

Solid mesh_solid(const std::shared_ptr<const TriangleMesh>& mesh, const Pose& T) {
  Solid solid;
  solid.geometry = solid.faces = bvh(*mesh);
  solid.T_body_shape = T;
  for (const Eigen::Vector3d& v : mesh->vertices) solid.local.extend(v);
  solid.mesh = mesh;
  solid.probes = piece_probes(*mesh);
  return solid;
}

/// `faces`: the triangles of the box.
Solid box_solid(std::shared_ptr<fcl::Boxd> box, std::shared_ptr<const BvhModel> faces, const Pose& T) {
  const Eigen::Vector3d size = box->side;
  Solid solid = primitive(std::move(box), T, centred(size));
  solid.faces = std::move(faces);
  return solid;
}

Solid plane_solid(const Plane& plane, const Pose& T) {
  const Eigen::Vector3d normal = plane.normal.normalized();
  Solid solid = primitive(std::make_shared<fcl::Halfspaced>(normal, plane.offset / plane.normal.norm()), T, Bounds());
  solid.unbounded = true;
  solid.probes.clear();
  return solid;
}

void add_solids(const LinkShape& item, std::vector<Solid>& out) {
  const Pose& T = item.T_link_shape;
  std::visit(
      Overloaded{
          [&](const Box& s) { out.push_back(box_solid(std::make_shared<fcl::Boxd>(s.size), bvh(*shape_mesh(s)), T)); },
          [&](const Sphere& s) {
            out.push_back(primitive(std::make_shared<fcl::Sphered>(s.radius), T,
                                    centred(Eigen::Vector3d::Constant(2 * s.radius))));
          },
          [&](const Cylinder& s) {
            out.push_back(primitive(std::make_shared<fcl::Cylinderd>(s.radius, s.length), T,
                                    centred({2 * s.radius, 2 * s.radius, s.length})));
          },
          [&](const Capsule& s) {
            out.push_back(primitive(std::make_shared<fcl::Capsuled>(s.radius, s.length), T,
                                    centred({2 * s.radius, 2 * s.radius, s.length + 2 * s.radius})));
          },
          [&](const Plane& s) { out.push_back(plane_solid(s, T)); },
          [&](const MeshShape& s) { out.push_back(mesh_solid(s.mesh, T)); },
          [&](const Voxels& s) {
            const Eigen::Vector3d size = Eigen::Vector3d::Constant(s.resolution);
            const auto box = std::make_shared<fcl::Boxd>(size);
            const auto faces = bvh(*shape_mesh(Box{size}));
            for (const Eigen::Vector3d& centre : *s.centres)
              out.push_back(box_solid(box, faces, T * Eigen::Translation3d(centre)));
          },
      },
      item.shape);
}

void check_item(const LinkShape& item) {
  if (const auto* mesh = std::get_if<MeshShape>(&item.shape)) {
    require(mesh->mesh && !mesh->mesh->triangles.empty(), "mesh", "empty", "must have triangles");
  }
  if (const auto* voxels = std::get_if<Voxels>(&item.shape)) {
    require(voxels->centres != nullptr, "voxels", "null", "must have centres");
  }
  check_shape(item.shape, "shape");
  require(item.T_link_shape.matrix().allFinite(), "shape pose", "NaN", "must be finite");
}

/// True when a piece of `inner` lies inside the closed mesh `outer`.
bool swallows(const Solid& outer, const Pose& T_world_outer, const Solid& inner, const Pose& T_world_inner) {
  if (!outer.mesh || !outer.mesh->closed) return false;
  const Pose T_outer_inner = T_world_outer.inverse() * T_world_inner;
  return std::any_of(inner.probes.begin(), inner.probes.end(), [&](const Eigen::Vector3d& probe) {
    const Eigen::Vector3d point = T_outer_inner * probe;
    if (!outer.local.contains(point)) return false;
    mmgrasp::detail::throw_if_interrupted();  // the question goes to every triangle
    return mesh_contains(*outer.mesh, point);
  });
}

/// True when a mesh reaches below a plane. FCL gives a half-space no bounds in its tree and looks at every triangle.
bool mesh_below_plane(const Solid& mesh, const Pose& T_mesh, const Solid& plane, const Pose& T_plane) {
  const auto& half_space = static_cast<const fcl::Halfspaced&>(*plane.geometry);
  const Eigen::Vector3d normal = T_mesh.linear().transpose() * (T_plane.linear() * half_space.n);
  const double offset =
      half_space.d - half_space.n.dot(T_plane.linear().transpose() * (T_mesh.translation() - T_plane.translation()));
  const double least_of_bounds = normal.dot(mesh.local.center()) - 0.5 * normal.cwiseAbs().dot(mesh.local.sizes());
  if (least_of_bounds > offset) return false;
  const auto below = [&](int vertex) { return normal.dot(mesh.mesh->vertices[vertex]) <= offset; };
  const auto& triangles = mesh.mesh->triangles;
  return std::any_of(triangles.begin(), triangles.end(),
                     [&](const auto& t) { return below(t[0]) || below(t[1]) || below(t[2]); });
}

/// A plane moved outwards; other solids stay as they are.
Solid grown_plane(const Solid& solid, double by) {
  if (!solid.unbounded) return solid;
  const auto& half_space = static_cast<const fcl::Halfspaced&>(*solid.geometry);
  Solid grown = solid;
  grown.geometry = std::make_shared<fcl::Halfspaced>(half_space.n, half_space.d + by);
  return grown;
}

}  // namespace

void check_shapes(const std::vector<LinkShape>& shapes) {
  for (const LinkShape& item : shapes) check_item(item);
}

std::vector<Solid> make_solids(const std::vector<LinkShape>& shapes) {
  check_shapes(shapes);
  std::vector<Solid> solids;
  for (const LinkShape& item : shapes) {
    mmgrasp::detail::throw_if_interrupted();
    add_solids(item, solids);
  }
  return solids;
}

Bounds bounds_at(const Solid& solid, const Pose& T) {
  if (solid.unbounded) {
    const Eigen::Vector3d far = Eigen::Vector3d::Constant(mmgrasp::detail::kInfinity);
    return {-far, far};
  }
  const Eigen::Vector3d centre = T * solid.local.center();
  const Eigen::Vector3d half = T.linear().cwiseAbs() * (0.5 * solid.local.sizes());
  return {centre - half, centre + half};
}

bool touches(const Solid& a, const Pose& T_a, const Solid& b, const Pose& T_b) {
  if (a.unbounded && b.mesh) return mesh_below_plane(b, T_b, a, T_a);
  if (b.unbounded && a.mesh) return mesh_below_plane(a, T_a, b, T_b);
  static const fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  fcl::collide(a.geometry.get(), T_a, b.geometry.get(), T_b, request, result);
  return result.isCollision() || swallows(a, T_a, b, T_b) || swallows(b, T_b, a, T_a);
}

bool closer_than(double margin, const Solid& a, const Pose& T_a, const Solid& b, const Pose& T_b) {
  if (touches(a, T_a, b, T_b)) return true;
  if (a.unbounded || b.unbounded) return touches(grown_plane(a, margin), T_a, grown_plane(b, margin), T_b);
  static const fcl::DistanceRequestd request = [] {
    fcl::DistanceRequestd of;
    of.gjk_solver_type = fcl::GST_INDEP;  // libccd says 0.34 m of a point that is 0.25 m above the middle of a face
    return of;
  }();
  const auto geometry = [](const Solid& solid) { return solid.faces ? solid.faces.get() : solid.geometry.get(); };
  fcl::DistanceResultd result;
  fcl::distance(geometry(a), T_a, geometry(b), T_b, request, result);
  return result.min_distance < margin;
}

double radius_of(const std::vector<Solid>& solids) {
  double radius = 0;
  for (const Solid& solid : solids) {
    if (solid.unbounded) return mmgrasp::detail::kInfinity;
    const Eigen::Vector3d centre = solid.T_body_shape * solid.local.center();
    radius = std::max(radius, centre.norm() + 0.5 * solid.local.diagonal().norm());
  }
  return radius;
}

double lowest_z(const std::vector<LinkShape>& shapes, const Pose& T_world_body) {
  double lowest = mmgrasp::detail::kInfinity;
  for (const LinkShape& item : shapes) {
    const Pose T = T_world_body * item.T_link_shape;
    const Eigen::Vector3d up = T.linear().row(2);  // world z in the shape's axes
    const double z = T.translation().z();
    const double side = std::hypot(up.x(), up.y());
    const double value =
        std::visit(Overloaded{
                       [&](const Box& s) { return z - 0.5 * up.cwiseAbs().dot(s.size); },
                       [&](const Sphere& s) { return z - s.radius; },
                       [&](const Cylinder& s) { return z - 0.5 * s.length * std::abs(up.z()) - s.radius * side; },
                       [&](const Capsule& s) { return z - 0.5 * s.length * std::abs(up.z()) - s.radius; },
                       [&](const Plane&) { return -mmgrasp::detail::kInfinity; },
                       [&](const MeshShape& s) {
                         double least = mmgrasp::detail::kInfinity;
                         for (const Eigen::Vector3d& v : s.mesh->vertices) least = std::min(least, z + up.dot(v));
                         return least;
                       },
                       [&](const Voxels& s) {
                         double least = mmgrasp::detail::kInfinity;
                         for (const Eigen::Vector3d& c : *s.centres) least = std::min(least, z + up.dot(c));
                         return least - 0.5 * s.resolution * up.cwiseAbs().sum();
                       },
                   },
                   item.shape);
    lowest = std::min(lowest, value);
  }
  return lowest;
}

}  // namespace mmgrasp::verify::detail
