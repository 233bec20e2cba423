#pragma once

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision_object.h>

#include <memory>
#include <vector>

#include "mmgrasp/geometry/shape.hpp"

namespace bench {

/// A shape as FCL's users have it: convex meshes as Convex when `convex`, others as trees of boxes.
inline std::shared_ptr<fcl::CollisionGeometryd> fcl_geometry(const mmgrasp::Shape& shape, bool convex) {
  using namespace mmgrasp;
  if (const auto* s = std::get_if<Box>(&shape)) return std::make_shared<fcl::Boxd>(s->size);
  if (const auto* s = std::get_if<Sphere>(&shape)) return std::make_shared<fcl::Sphered>(s->radius);
  if (const auto* s = std::get_if<Cylinder>(&shape)) return std::make_shared<fcl::Cylinderd>(s->radius, s->length);
  if (const auto* s = std::get_if<Capsule>(&shape)) return std::make_shared<fcl::Capsuled>(s->radius, s->length);
  const TriangleMesh& mesh = *std::get<MeshShape>(shape).mesh;
  if (mesh.convex && convex) {
    auto faces = std::make_shared<std::vector<int>>();
    for (const auto& t : mesh.triangles) faces->insert(faces->end(), {3, t[0], t[1], t[2]});
    return std::make_shared<fcl::Convexd>(std::make_shared<std::vector<Eigen::Vector3d>>(mesh.vertices),
                                          static_cast<int>(mesh.triangles.size()), faces);
  }
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel();
  for (const auto& t : mesh.triangles)
    model->addTriangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  model->endModel();
  return model;
}

}  // namespace bench
