#pragma once

// The independent answer to "do these two shapes touch": FCL called directly on primitives and raw triangles, and a
// brute-force inside test for closed meshes.

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <memory>
#include <vector>

#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace fcl_reference {

using mmgrasp::Pose;
using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

struct Part {
  Geometry geometry;
  Pose T = Pose::Identity();
};

struct Body {
  std::vector<Part> parts;
  std::shared_ptr<const mmgrasp::TriangleMesh> closed_mesh;
  Eigen::AlignedBox3d bounds;           ///< Of the closed mesh.
  std::vector<Eigen::Vector3d> probes;  ///< At least a point of each connected piece.
};

inline Geometry mesh_geometry(const mmgrasp::TriangleMesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel();
  for (const auto& t : mesh.triangles)
    model->addTriangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  model->endModel();
  return model;
}

inline Body make_body(const mmgrasp::Shape& shape) {
  using namespace mmgrasp;
  Body body;
  body.probes = {Eigen::Vector3d::Zero()};
  if (const auto* s = std::get_if<Box>(&shape)) body.parts.push_back({std::make_shared<fcl::Boxd>(s->size)});
  if (const auto* s = std::get_if<Sphere>(&shape)) body.parts.push_back({std::make_shared<fcl::Sphered>(s->radius)});
  if (const auto* s = std::get_if<Cylinder>(&shape))
    body.parts.push_back({std::make_shared<fcl::Cylinderd>(s->radius, s->length)});
  if (const auto* s = std::get_if<Capsule>(&shape))
    body.parts.push_back({std::make_shared<fcl::Capsuled>(s->radius, s->length)});
  if (const auto* s = std::get_if<Plane>(&shape)) {
    body.parts.push_back({std::make_shared<fcl::Halfspaced>(s->normal, s->offset)});
    body.probes.clear();  // nothing holds a half-space
  }
  if (const auto* s = std::get_if<MeshShape>(&shape)) {
    body.parts.push_back({mesh_geometry(*s->mesh)});
    // Every vertex is a probe: the reference need not know which triangles hang together.
    body.probes = s->mesh->vertices;
    if (s->mesh->closed) body.closed_mesh = s->mesh;
    for (const Eigen::Vector3d& v : s->mesh->vertices) body.bounds.extend(v);
  }
  if (const auto* s = std::get_if<Voxels>(&shape)) {
    body.probes = *s->centres;
    for (const Eigen::Vector3d& c : *s->centres) {
      Part part{std::make_shared<fcl::Boxd>(s->resolution, s->resolution, s->resolution)};
      part.T.translation() = c;
      body.parts.push_back(part);
    }
  }
  return body;
}

inline bool surfaces_touch(const Body& a, const Pose& T_a, const Body& b, const Pose& T_b) {
  for (const Part& pa : a.parts) {
    for (const Part& pb : b.parts) {
      fcl::CollisionObjectd oa(pa.geometry, Pose(T_a * pa.T)), ob(pb.geometry, Pose(T_b * pb.T));
      if (!oa.getAABB().overlap(ob.getAABB())) continue;
      fcl::CollisionRequestd request(1, false);
      fcl::CollisionResultd result;
      if (fcl::collide(&oa, &ob, request, result) > 0) return true;
    }
  }
  return false;
}

inline bool inside(const Body& outer, const Pose& T_outer, const Body& inner, const Pose& T_inner) {
  if (!outer.closed_mesh) return false;
  const Pose T = T_outer.inverse() * T_inner;
  for (const Eigen::Vector3d& probe : inner.probes) {
    if (outer.bounds.contains(T * probe) && mmgrasp::mesh_contains(*outer.closed_mesh, T * probe)) return true;
  }
  return false;
}

inline bool touch(const Body& a, const Pose& T_a, const Body& b, const Pose& T_b) {
  return surfaces_touch(a, T_a, b, T_b) || inside(a, T_a, b, T_b) || inside(b, T_b, a, T_a);
}

/// True when a shift of b by `band` changes the answer: the pair is too close to touching to be judged.
inline bool on_the_edge(const Body& a, const Pose& T_a, const Body& b, const Pose& T_b, double band = 1e-6) {
  const bool answer = touch(a, T_a, b, T_b);
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d direction(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (direction.norm() == 0) continue;
    Pose moved = T_b;
    moved.translation() += band * direction.normalized();
    if (touch(a, T_a, b, moved) != answer) return true;
  }
  return false;
}

}  // namespace fcl_reference
