// STL, text and binary: a mesh that was read is clean, and the hull of its vertices exists or is refused.
#include "expect.hpp"
#include "geometry/readers/mesh_readers.hpp"
#include "mmgrasp/core/error.hpp"

using namespace mmgrasp;
using fuzzing::expect;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  std::shared_ptr<const TriangleMesh> mesh;
  MeshReport report;
  try {
    mesh = detail::parse_mesh("fuzz.stl", content, {1, -2, 0.001}, &report);
  } catch (const IoError& refusal) {
    fuzzing::expect_names(refusal, "fuzz.stl");
    return 0;
  }
  expect(!mesh->triangles.empty(), "a mesh has triangles");
  expect(report.triangles == static_cast<int>(mesh->triangles.size()), "the report counts the triangles");
  expect(report.closed == mesh->closed && report.convex == mesh->convex, "the report says what the mesh is");
  const int vertices = static_cast<int>(mesh->vertices.size());
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& vertex : mesh->vertices) {
    expect(vertex.allFinite(), "vertices are finite");
    centre += vertex / vertices;
  }
  for (const auto& triangle : mesh->triangles)
    for (const int corner : triangle) expect(corner >= 0 && corner < vertices, "corners are vertices");
  expect(!mesh->convex || mesh->closed, "what is convex is closed");
  expect(!mesh->closed || mesh_volume(*mesh) > 0, "a closed mesh has a volume");
  mesh_contains(*mesh, centre);
  try {
    const auto hull = convex_hull(mesh->vertices);
    expect(hull->closed && hull->convex, "a hull is closed and convex");
  } catch (const InvalidInput&) {
    // flat
  }
  return 0;
}
