#pragma once

#ifdef MMGRASP_WITH_COAL

#include <coal/BVH/BVH_model.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

#include <memory>
#include <vector>

#include "mmgrasp/geometry/shape.hpp"

namespace bench {

/// A shape as coal's users have it: convex meshes as Convex, others as trees of boxes.
inline std::shared_ptr<coal::CollisionGeometry> coal_geometry(const mmgrasp::Shape& shape) {
  using namespace mmgrasp;
  if (const auto* s = std::get_if<Box>(&shape)) return std::make_shared<coal::Box>(s->size);
  if (const auto* s = std::get_if<Sphere>(&shape)) return std::make_shared<coal::Sphere>(s->radius);
  if (const auto* s = std::get_if<Cylinder>(&shape)) return std::make_shared<coal::Cylinder>(s->radius, s->length);
  if (const auto* s = std::get_if<Capsule>(&shape)) return std::make_shared<coal::Capsule>(s->radius, s->length);
  const TriangleMesh& mesh = *std::get<MeshShape>(shape).mesh;
  if (mesh.convex) {
    auto points = std::make_shared<std::vector<coal::Vec3s>>(mesh.vertices.begin(), mesh.vertices.end());
    auto faces = std::make_shared<std::vector<coal::Triangle>>();
    for (const auto& t : mesh.triangles) faces->emplace_back(t[0], t[1], t[2]);
    return std::make_shared<coal::Convex<coal::Triangle>>(points, static_cast<unsigned>(points->size()), faces,
                                                          static_cast<unsigned>(faces->size()));
  }
  auto model = std::make_shared<coal::BVHModel<coal::OBBRSS>>();
  model->beginModel();
  for (const auto& t : mesh.triangles)
    model->addTriangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  model->endModel();
  return model;
}

}  // namespace bench

#endif
