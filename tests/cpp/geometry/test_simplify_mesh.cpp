#include "mmgrasp/geometry/simplify_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
using MeshPtr = std::shared_ptr<const TriangleMesh>;

Pose turned(const Vector3d& xyz, const Vector3d& rpy) {
  return pose_from_xyz_rpy(xyz, rpy);
}

MeshPtr moved(const MeshPtr& mesh, const Pose& T) {
  std::vector<Vector3d> vertices;
  for (const Vector3d& v : mesh->vertices) vertices.push_back(T * v);
  return make_mesh(vertices, mesh->triangles);
}

MeshPtr box_mesh(const Vector3d& size) {
  return shape_mesh(Box{size});
}

/// Both as one mesh of two shells.
MeshPtr joined(const MeshPtr& a, const MeshPtr& b) {
  std::vector<Vector3d> vertices = a->vertices;
  std::vector<std::array<int, 3>> triangles = a->triangles;
  const int shift = static_cast<int>(vertices.size());
  vertices.insert(vertices.end(), b->vertices.begin(), b->vertices.end());
  for (const auto& t : b->triangles) triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return make_mesh(vertices, triangles);
}

/// Distance from a triangle by the regions of its plane in which a corner, a side or the inside is nearest.
double triangle_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return ap.norm();
  if (d3 >= 0 && d4 <= d3) return bp.norm();
  if (d6 >= 0 && d5 <= d6) return cp.norm();
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).norm();
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).norm();
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).norm();
  const double total = va + vb + vc;
  return (ap - vb / total * ab - vc / total * ac).norm();
}

/// Distance from the solid (closed mesh) or surface (open one), by asking every triangle.
double slow_distance(const TriangleMesh& mesh, const Vector3d& p) {
  if (mesh_contains(mesh, p)) return 0;
  double best = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles)
    best = std::min(best, triangle_distance(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  return best;
}

bool shape_contains(const Shape& shape, const Vector3d& p, double slack) {
  if (const auto* box = std::get_if<Box>(&shape)) return (p.cwiseAbs() - 0.5 * box->size).maxCoeff() <= slack;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return p.norm() <= sphere->radius + slack;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    return p.head<2>().norm() <= cylinder->radius + slack && std::abs(p.z()) <= 0.5 * cylinder->length + slack;
  const TriangleMesh& mesh = *std::get<MeshShape>(shape).mesh;
  if (!mesh.convex) return mesh_contains(mesh, p) || slow_distance(mesh, p) <= slack;
  for (const auto& t : mesh.triangles) {  // convex: behind every face
    const Vector3d& a = mesh.vertices[t[0]];
    const Vector3d n = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
    if (n.dot(p - a) > slack) return false;
  }
  return true;
}

/// What the header promises, by looking at vertices and at many random points of the stand-in.
void expect_promise(const MeshPtr& mesh, const MeshStandIn& found, double tolerance, unsigned seed) {
  EXPECT_LE(found.deviation, tolerance);
  if (found.chosen == "mesh") return;
  const Pose T_shape_mesh = found.T_mesh_shape.inverse();
  for (const Vector3d& v : mesh->vertices) EXPECT_TRUE(shape_contains(found.shape, T_shape_mesh * v, 1e-9));
  const Eigen::AlignedBox3d box = shape_bounds(found.shape);
  Rng rng(seed, 0);
  double farthest = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d p =
        box.min() + Vector3d(rng.uniform(0, 1), rng.uniform(0, 1), rng.uniform(0, 1)).cwiseProduct(box.sizes());
    if (shape_contains(found.shape, p, 0)) farthest = std::max(farthest, slow_distance(*mesh, found.T_mesh_shape * p));
  }
  EXPECT_LE(farthest, found.deviation + 1e-9) << found.chosen;
}

TEST(SimplifyMesh, WithoutToleranceOnlyTheSameSolidIsChosen) {
  // A box in any pose is that box.
  const Pose T = turned({0.3, -0.2, 1}, {0.4, 0.5, -0.6});
  const MeshPtr crate = moved(box_mesh({0.2, 0.3, 0.5}), T);
  const MeshStandIn box = simplify_mesh(crate);
  EXPECT_EQ(box.chosen, "box");
  EXPECT_EQ(box.triangles_saved, 12);
  EXPECT_EQ(box.deviation, 0);
  Vector3d sizes = std::get<Box>(box.shape).size;
  std::sort(sizes.data(), sizes.data() + 3);
  EXPECT_LT((sizes - Vector3d(0.2, 0.3, 0.5)).norm(), 1e-9);
  EXPECT_LT((box.T_mesh_shape.translation() - T.translation()).norm(), 1e-12);
  EXPECT_NEAR(box.T_mesh_shape.linear().determinant(), 1, 1e-12);
  expect_promise(crate, box, 0, 1);
  // One corner off by a micrometre: no box any more, but convex still (or not): never replaced by another solid.
  std::vector<Vector3d> vertices = box_mesh({0.2, 0.3, 0.5})->vertices;
  vertices[3] *= 1 + 1e-6;
  const MeshPtr bent = make_mesh(vertices, box_mesh({0.2, 0.3, 0.5})->triangles);
  EXPECT_NE(simplify_mesh(bent).chosen, "box");
  EXPECT_EQ(std::get<MeshShape>(simplify_mesh(bent).shape).mesh, bent);
  // A prism with eight corners whose base is a trapezium.
  const MeshPtr wedge =
      convex_hull({{0, 0, 0}, {2, 0, 0}, {1.5, 1, 0}, {0.5, 1, 0}, {0, 0, 1}, {2, 0, 1}, {1.5, 1, 1}, {0.5, 1, 1}});
  EXPECT_EQ(simplify_mesh(wedge).chosen, "hull");
  // Convex, but no box: its own hull, the very same mesh. Not convex or open: stays.
  const MeshPtr ball = shape_mesh(Sphere{0.1});
  EXPECT_EQ(simplify_mesh(ball).chosen, "hull");
  EXPECT_EQ(std::get<MeshShape>(simplify_mesh(ball).shape).mesh, ball);
  EXPECT_EQ(simplify_mesh(ball).triangles_saved, 0);
  const MeshPtr two = joined(box_mesh({1, 1, 1}), moved(box_mesh({1, 1, 1}), turned({3, 0, 0}, {0, 0, 0})));
  EXPECT_EQ(simplify_mesh(two).chosen, "mesh");
  std::vector<std::array<int, 3>> open = box_mesh({1, 1, 1})->triangles;
  open.pop_back();
  EXPECT_EQ(simplify_mesh(make_mesh(box_mesh({1, 1, 1})->vertices, open)).chosen, "mesh");
}

TEST(SimplifyMesh, PrimitivesWithinTheToleranceInClosedForm) {
  // A ball of 24 segments: its facets lie inside the sphere by r (1 - cos) of small angles.
  const Pose T = turned({0.1, 0.2, 0.3}, {1, 0.5, 0.2});
  const MeshPtr ball = moved(shape_mesh(Sphere{0.1}, 32), T);
  const MeshStandIn sphere = simplify_mesh(ball, 0.002);
  EXPECT_EQ(sphere.chosen, "sphere");
  EXPECT_LT((sphere.T_mesh_shape.translation() - T.translation()).norm(), 1e-3);
  EXPECT_GT(sphere.deviation, 0.1 * (1 - std::cos(M_PI / 32)));
  expect_promise(ball, sphere, 0.002, 2);

  const MeshPtr can = moved(shape_mesh(Cylinder{0.05, 0.3}, 48), T);
  const MeshStandIn cylinder = simplify_mesh(can, 0.001);
  EXPECT_EQ(cylinder.chosen, "cylinder");
  EXPECT_NEAR(std::get<Cylinder>(cylinder.shape).length, 0.3, 1e-9);
  EXPECT_NEAR(std::get<Cylinder>(cylinder.shape).radius, 0.05, 2e-4);
  expect_promise(can, cylinder, 0.001, 3);
  EXPECT_EQ(simplify_mesh(can, 1e-5).chosen, "hull");  // facets of 0.1 mm

  // A cube with one corner cut off by s along each edge: the lost corner is s / sqrt(3) away from the cut.
  const double s = 0.01;
  const MeshPtr cut = convex_hull({{0, 0, 0},
                                   {1, 0, 0},
                                   {0, 1, 0},
                                   {0, 0, 1},
                                   {1, 1, 0},
                                   {1, 0, 1},
                                   {0, 1, 1},
                                   {1 - s, 1, 1},
                                   {1, 1 - s, 1},
                                   {1, 1, 1 - s}});
  const MeshStandIn box = simplify_mesh(cut, 0.006);
  EXPECT_EQ(box.chosen, "box");
  EXPECT_NEAR(box.deviation, s / std::sqrt(3.0), 1e-9);
  expect_promise(cut, box, 0.006, 4);
  EXPECT_EQ(simplify_mesh(cut, 0.0057).chosen, "hull");
}

TEST(SimplifyMesh, HullsOfDentedSolids) {
  // Two cubes with a gap of g: the middle of the gap is g / 2 from either.
  const double g = 0.2;
  const MeshPtr two = joined(box_mesh({1, 1, 1}), moved(box_mesh({1, 1, 1}), turned({1 + g, 0, 0}, {0, 0, 0})));
  ASSERT_TRUE(two->closed);
  const MeshPtr around = convex_hull(two->vertices);
  const double bound = bound_deviation(*around, *two, 0.2);
  EXPECT_GE(bound, 0.5 * g);
  EXPECT_LE(bound, 1.1 * 0.5 * g);
  EXPECT_EQ(bound_deviation(*around, *two, 0.4 * g), std::numeric_limits<double>::infinity());
  EXPECT_EQ(simplify_mesh(two, 0.4 * g).chosen, "mesh");
  const MeshStandIn found = simplify_mesh(two, 0.2);
  EXPECT_EQ(found.chosen, "box");
  expect_promise(two, found, 0.2, 5);

  // A step in a block: an L. The hull's largest distance lies on the slanted face over the notch.
  const MeshPtr l =
      joined(box_mesh({1, 0.2, 0.2}), moved(box_mesh({0.2, 0.25, 0.2}), turned({-0.4, 0.2, 0}, {0, 0, 0})));
  const MeshPtr l_hull = convex_hull(l->vertices);
  const double l_bound = bound_deviation(*l_hull, *l, 0.2);
  double sampled = 0;
  Rng rng(6, 0);
  for (int i = 0; i < 20000; ++i) {
    const Vector3d p(rng.uniform(-0.5, 0.5), rng.uniform(-0.1, 0.325), rng.uniform(-0.1, 0.1));
    if (shape_contains(MeshShape{l_hull}, p, 0)) sampled = std::max(sampled, slow_distance(*l, p));
  }
  EXPECT_GE(l_bound, sampled);
  EXPECT_LE(l_bound, 1.15 * sampled);
  // An empty cavity counts, although the hull's own surface touches the mesh everywhere.
  std::vector<std::array<int, 3>> inwards = box_mesh({0.5, 0.5, 0.5})->triangles;
  for (auto& t : inwards) std::swap(t[0], t[1]);
  std::vector<Vector3d> inner = box_mesh({0.5, 0.5, 0.5})->vertices, outer = box_mesh({1, 1, 1})->vertices;
  std::vector<std::array<int, 3>> triangles = box_mesh({1, 1, 1})->triangles;
  for (const auto& t : inwards) triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  outer.insert(outer.end(), inner.begin(), inner.end());
  const MeshPtr hollow = make_mesh(outer, triangles);
  ASSERT_TRUE(hollow->closed);
  ASSERT_FALSE(mesh_contains(*hollow, Vector3d::Zero()));
  const double cavity = bound_deviation(*convex_hull(hollow->vertices), *hollow, 1);
  EXPECT_GE(cavity, 0.25);
  EXPECT_LE(cavity, 1.1 * 0.25);
}

/// A tube: ring of `sides` quadrilaterals inside and out.
MeshPtr tube(double inner, double outer, double length, int sides) {
  std::vector<Vector3d> v;
  std::vector<std::array<int, 3>> t;
  for (int i = 0; i < sides; ++i) {
    const double c = std::cos(2 * M_PI * i / sides), s = std::sin(2 * M_PI * i / sides);
    for (const double r : {inner, outer})
      for (const double z : {0.0, length}) v.emplace_back(r * c, r * s, z);
  }
  for (int i = 0; i < sides; ++i) {
    const int a = 4 * i, b = 4 * ((i + 1) % sides);
    const std::array<std::array<int, 2>, 4> strips = {{{0, 1}, {3, 2}, {1, 3}, {2, 0}}};
    for (const auto& [p, q] : strips) {
      t.push_back({a + p, b + p, b + q});
      t.push_back({a + p, b + q, a + q});
    }
  }
  return make_mesh(v, t);
}

TEST(SimplifyMesh, DecimatedMeshesContainTheirOriginal) {
  // A pipe's bore must stay open: its hull would fill it.
  const MeshPtr pipe = tube(0.05, 0.06, 0.1, 96);
  ASSERT_TRUE(pipe->closed);
  ASSERT_FALSE(mesh_contains(*pipe, {0, 0, 0.05}));
  ASSERT_TRUE(mesh_contains(*pipe, {0.055, 0, 0.05}));
  const MeshStandIn found = simplify_mesh(pipe, 0.002);
  EXPECT_EQ(found.chosen, "decimated");
  const TriangleMesh& fewer = *std::get<MeshShape>(found.shape).mesh;
  EXPECT_TRUE(fewer.closed);
  EXPECT_LT(fewer.triangles.size(), pipe->triangles.size() / 3);
  EXPECT_EQ(found.triangles_saved, static_cast<int>(pipe->triangles.size() - fewer.triangles.size()));
  EXPECT_GT(mesh_volume(fewer), mesh_volume(*pipe));
  EXPECT_FALSE(mesh_contains(fewer, {0, 0, 0.05}));
  expect_promise(pipe, found, 0.002, 9);
  // Random points of the pipe itself, not only its corners, are inside.
  Rng rng(11, 0);
  for (int i = 0; i < 4000; ++i) {
    const Vector3d p(rng.uniform(-0.06, 0.06), rng.uniform(-0.06, 0.06), rng.uniform(0, 0.1));
    EXPECT_TRUE(!mesh_contains(*pipe, p) || shape_contains(found.shape, p, 1e-9)) << p.transpose();
  }
  EXPECT_EQ(simplify_mesh(pipe).chosen, "mesh");
  // Finer tolerances save less and deviate less.
  const MeshStandIn finer = simplify_mesh(pipe, 0.001);
  EXPECT_LE(finer.deviation, 0.001);
  EXPECT_LE(finer.triangles_saved, found.triangles_saved);
}

TEST(SimplifyMesh, OpenMeshesAreSurfaces) {
  // A lid of 0.02 m: the middle of the hull is 0.01 m from the surface; a cube without lid is 0.5 m away inside.
  const auto without_lid = [](const Vector3d& size) {
    const MeshPtr box = box_mesh(size);
    std::vector<std::array<int, 3>> open;
    for (const auto& t : box->triangles) {
      const double height = (box->vertices[t[0]] + box->vertices[t[1]] + box->vertices[t[2]]).z() / 3;
      if (height < 0.49 * size.z()) open.push_back(t);
    }
    return make_mesh(box->vertices, open);
  };
  const MeshPtr lid = without_lid({1, 1, 0.02});
  ASSERT_FALSE(lid->closed);
  EXPECT_EQ(simplify_mesh(lid).chosen, "mesh");
  const MeshStandIn plate = simplify_mesh(lid, 0.025);
  EXPECT_EQ(plate.chosen, "box");
  EXPECT_GE(plate.deviation, 0.02 - 1e-9);  // the middle of the missing top
  expect_promise(lid, plate, 0.025, 7);
  EXPECT_EQ(simplify_mesh(without_lid({1, 1, 1}), 0.2).chosen, "mesh");
}

TEST(SimplifyMesh, HoldsItsPromiseOnRealMeshes) {
  const std::string folder = std::string(MMGRASP_SHARED_DATA) + "/robots/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared test data at " << folder;
  int simpler = 0, same = 0, decimated = 0;
  unsigned seed = 10;
  const std::string tiago = "tiago/example-robot-data/robots/tiago_description/meshes/";
  for (const std::string& file : {std::string("ur/ur_description/meshes/ur5e/collision/forearm.stl"),
                                  std::string("ur/ur_description/meshes/ur5e/collision/wrist3.stl"),
                                  std::string("panda/moveit_resources_panda_description/meshes/collision/link5.stl"),
                                  std::string("panda/moveit_resources_panda_description/meshes/collision/finger.stl"),
                                  tiago + "torso/torso_fix_collision.stl", tiago + "pmb2/base/base_collision.stl"}) {
    if (!std::filesystem::exists(folder + file)) continue;
    SCOPED_TRACE(file);
    const MeshPtr mesh = load_mesh(folder + file);
    for (const double tolerance : {0.0, 0.005, 0.03}) {
      const MeshStandIn found = simplify_mesh(mesh, tolerance);
      expect_promise(mesh, found, tolerance, ++seed);
      if (found.chosen == "decimated") ++decimated;
      ++(found.chosen == "mesh" ? same : simpler);
      EXPECT_TRUE(tolerance > 0 || mesh->convex || found.chosen == "mesh");
    }
  }
  EXPECT_GT(simpler, 0);
  EXPECT_GT(same, 0);
  EXPECT_GT(decimated, 0);
}

TEST(SimplifyMesh, FlatMeshesAndBadTolerances) {
  const MeshPtr sheet = make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}});
  EXPECT_EQ(simplify_mesh(sheet, 0.1).chosen, "mesh");
  EXPECT_THROW(simplify_mesh(sheet, -1), InvalidInput);
  EXPECT_THROW(simplify_mesh(sheet, std::numeric_limits<double>::infinity()), InvalidInput);
  EXPECT_THROW(simplify_mesh(sheet, std::nan("")), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
