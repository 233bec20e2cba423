#include "mmgrasp/geometry/ray_caster.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "mmgrasp/core/detail/instruction_set.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/shape.hpp"

using namespace mmgrasp;
using Eigen::Vector3d;

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

Vector3d unit(Rng& rng) {
  return Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
}

Vector3d anywhere(Rng& rng, double spread) {
  return {rng.uniform(-spread, spread), rng.uniform(-spread, spread), rng.uniform(-spread, spread)};
}

/// Every hit by a test of every triangle in long double, nearest first.
std::vector<double> brute_force(const TriangleMesh& mesh, const Ray& ray) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  const Long o = ray.origin.cast<long double>(), d = ray.direction.cast<long double>();
  std::vector<double> out;
  for (const auto& t : mesh.triangles) {
    const Long a = mesh.vertices[t[0]].cast<long double>();
    const Long ab = mesh.vertices[t[1]].cast<long double>() - a, ac = mesh.vertices[t[2]].cast<long double>() - a;
    const Long p = d.cross(ac);
    const long double det = ab.dot(p);
    if (det == 0) continue;
    const Long s = o - a, q = s.cross(ab);
    const long double u = s.dot(p) / det, v = d.dot(q) / det, at = ac.dot(q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && at >= ray.nearest && at <= ray.farthest)
      out.push_back(static_cast<double>(at));
  }
  std::sort(out.begin(), out.end());
  return out;
}

void expect_as_brute_force(const TriangleMesh& mesh, const RayCaster& caster, const Ray& ray,
                           double tolerance = 1e-11) {
  const std::vector<double> truth = brute_force(mesh, ray);
  const RayHit hit = caster.closest_hit(ray);
  ASSERT_EQ(static_cast<bool>(hit), !truth.empty());
  EXPECT_EQ(caster.any_hit(ray), !truth.empty());
  const std::vector<RayHit> all = caster.all_hits(ray);
  ASSERT_EQ(all.size(), truth.size());
  if (truth.empty()) return;
  EXPECT_EQ(hit.distance, all.front().distance);
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_NEAR(all[i].distance, truth[i], tolerance * (1 + std::abs(truth[i])));
  EXPECT_NEAR(hit.normal.norm(), 1, 1e-14);
  EXPECT_EQ(hit.point, ray.origin + hit.distance * ray.direction);
  const auto& t = mesh.triangles[hit.triangle];
  const Vector3d a = mesh.vertices[t[0]];
  const Vector3d normal = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
  EXPECT_LT((hit.normal - normal).norm(), 1e-12);
  EXPECT_NEAR(normal.dot(hit.point - a), 0, tolerance * (1 + ray.origin.norm()));
  EXPECT_EQ(hit.front, normal.dot(ray.direction) < 0);
}

/// A sphere of some thousand faces whose corners are nowhere special.
std::shared_ptr<const TriangleMesh> ball(int facets = 40) {
  return shape_mesh(Sphere{0.7}, facets);
}

TriangleMesh soup(Rng& rng, int triangles, double size) {
  TriangleMesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const Vector3d middle = anywhere(rng, 1);
    for (int c = 0; c < 3; ++c) mesh.vertices.push_back(middle + anywhere(rng, size));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

}  // namespace

TEST(RayCaster, AgreesWithEveryTriangle) {
  Rng rng(1);
  // Small, large, sliver-thin and very unequal triangles; one, four, five, many.
  std::vector<TriangleMesh> meshes{soup(rng, 1, 0.5),   soup(rng, 4, 0.5),     soup(rng, 5, 0.5),
                                   soup(rng, 300, 0.1), soup(rng, 2000, 0.02), *ball()};
  meshes.push_back(soup(rng, 200, 1));
  for (Vector3d& v : meshes.back().vertices) v.z() *= 1e-9;  // a thin sheet in layers
  meshes.push_back(soup(rng, 200, 1));
  for (Vector3d& v : meshes.back().vertices) v *= std::pow(10, rng.uniform(-3, 1));
  for (const TriangleMesh& mesh : meshes) {
    const RayCaster caster(mesh);
    const double tolerance = &mesh == &meshes.back() ? 1e-7 : 1e-11;  // long slivers say less of where they are
    for (int i = 0; i < 1500; ++i) {
      Ray ray;
      ray.origin = anywhere(rng, i % 2 == 0 ? 0.3 : 3);
      ray.direction = (i % 3 == 0 ? unit(rng) : Vector3d(anywhere(rng, 0.8) - ray.origin)) * rng.uniform(0.1, 10);
      if (i % 5 == 0) ray.nearest = -kInf;
      if (i % 7 == 0) ray.farthest = rng.uniform(0.0, 0.5);
      if (i % 11 == 0) ray.nearest = rng.uniform(-0.5, 0.0);
      expect_as_brute_force(mesh, caster, ray, tolerance);
    }
  }
}

TEST(RayCaster, AgreesOnAScannedMesh) {
  const std::string path =
      std::string(MMGRASP_SHARED_DATA) + "/meshes/ycb/YcbMustardBottle/textured_simple_reoriented.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data";
  const auto mesh = load_mesh(path);
  const RayCaster caster(*mesh);
  Rng rng(4);
  for (int i = 0; i < 300; ++i) {
    const Vector3d eye = unit(rng);
    expect_as_brute_force(*mesh, caster, {eye, anywhere(rng, 0.1) - eye});
  }
}

TEST(RayCaster, SphereAndBoxInClosedForm) {
  Rng rng(2);
  const Vector3d half(0.2, 0.35, 0.1);
  const RayCaster box(*shape_mesh(Box{2 * half}));
  const RayCaster sphere(*shape_mesh(Sphere{0.5}, 200));
  for (int i = 0; i < 500; ++i) {
    const Vector3d o = 2 * unit(rng), d = (anywhere(rng, 0.4) - o).normalized();
    double enter = -kInf, leave = kInf;
    for (int k = 0; k < 3; ++k) {
      const double a = (-half[k] - o[k]) / d[k], b = (half[k] - o[k]) / d[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    const std::vector<RayHit> hits = box.all_hits({o, d});
    ASSERT_EQ(hits.size(), enter < leave ? 2u : 0u);
    if (enter < leave) {
      EXPECT_NEAR(hits[0].distance, enter, 1e-13);
      EXPECT_NEAR(hits[1].distance, leave, 1e-13);
      EXPECT_TRUE(hits[0].front);
      EXPECT_FALSE(hits[1].front);
    }
    const double b = o.dot(d), root = b * b - (o.squaredNorm() - 0.25);
    if (root < 0.01) continue;  // facets at the silhouette
    const RayHit hit = sphere.closest_hit({o, d});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit.distance, -b - std::sqrt(root), 1e-3);
    EXPECT_GT(hit.normal.dot(hit.point) / 0.5, 0.999);
  }
}

/// Aimed exactly at corners and at points of edges, from inside and outside, also along axes and from far away.
TEST(RayCaster, NothingSlipsThroughEdgesAndCorners) {
  Rng rng(3);
  for (const auto& mesh : {ball(24), shape_mesh(Box{{1, 1, 1}}), shape_mesh(Cylinder{0.3, 0.8}, 30)}) {
    const RayCaster caster(*mesh);
    for (int i = 0; i < 20000; ++i) {
      const auto& t =
          mesh->triangles[static_cast<std::size_t>(rng.uniform(0, 1) * static_cast<double>(mesh->triangles.size()))];
      const Vector3d &a = mesh->vertices[t[0]], &b = mesh->vertices[t[1]];
      const double s = i % 3 == 0 ? 0 : i % 3 == 1 ? 0.5 : rng.uniform();
      const Vector3d aim = a + s * (b - a);
      const Vector3d inside = i % 4 == 0 ? Vector3d::Zero() : anywhere(rng, 0.15);
      ASSERT_TRUE(caster.closest_hit({inside, aim - inside})) << i;
      ASSERT_TRUE(caster.any_hit({inside, aim - inside}));
      ASSERT_EQ(caster.all_hits({inside, aim - inside}).size() % 2, 1u);
      const Vector3d outside = aim + (aim - inside) * (i % 2 == 0 ? 1.0 : 1000.0);
      const RayHit hit = caster.closest_hit({outside, inside - outside});
      ASSERT_TRUE(hit) << i;
      ASSERT_LT(hit.distance, 1);
      ASSERT_EQ(caster.all_hits({outside, inside - outside, -kInf}).size(), 2u);
    }
  }
}

TEST(RayCaster, AxisParallelRaysAndCoplanarFaces) {
  const auto box = shape_mesh(Box{{1, 1, 1}});
  const RayCaster caster(*box);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Ray ray;
      ray.direction = sign * Vector3d::Unit(axis);
      ray.direction[(axis + 1) % 3] = -0.0;
      ray.origin = -3 * ray.direction;
      // Through the middle, where the diagonals of the faces may lie.
      EXPECT_NEAR(caster.closest_hit(ray).distance, 2.5, 1e-14);
      EXPECT_EQ(caster.all_hits(ray).size(), 2u);
      // Within the plane of a face: that face is seen edge-on, those it pierces are met or not as one.
      ray.origin[(axis + 1) % 3] = 0.5;
      ray.origin[(axis + 2) % 3] = 0.1;
      EXPECT_NEAR(caster.closest_hit(ray).distance, 2.5, 1e-14);
      EXPECT_EQ(caster.all_hits(ray).size() % 2, 0u);
      ray.origin[(axis + 1) % 3] = 0.5 + 1e-15;
      EXPECT_FALSE(caster.any_hit(ray));
    }
  }
}

TEST(RayCaster, RaysThatStartOnTheSurface) {
  const auto mesh = ball();
  const RayCaster caster(*mesh);
  Rng rng(6);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d out = unit(rng);
    const RayHit start = caster.closest_hit({Vector3d::Zero(), out});
    ASSERT_TRUE(start);
    EXPECT_FALSE(start.front);
    // On the way out nothing follows, on the way in the far wall.
    EXPECT_FALSE(caster.any_hit({start.point, out, 1e-12}));
    EXPECT_TRUE(caster.any_hit({start.point, out, -1e-12}));
    const RayHit far = caster.closest_hit({start.point, -out, 1e-12});
    ASSERT_TRUE(far);
    EXPECT_GT(far.distance, 1.3);
  }
}

TEST(RayCaster, ThinWalls) {
  // Two sheets a tenth of a nanometre apart: the nearer one is met, from either side.
  TriangleMesh mesh;
  for (const double z : {0.0, 1e-10})
    for (const Vector3d& v : {Vector3d(-1, -1, z), Vector3d(1, -1, z), Vector3d(0, 1, z)}) mesh.vertices.push_back(v);
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const RayCaster caster(mesh);
  Rng rng(7);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d aim(rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), 0);
    const Vector3d eye(rng.uniform(-1, 1), rng.uniform(-1, 1), i % 2 == 0 ? 1 : -1);
    EXPECT_EQ(caster.closest_hit({eye, aim - eye}).triangle, i % 2 == 0 ? 1 : 0);
    EXPECT_EQ(caster.all_hits({eye, aim - eye}).size(), 2u);
  }
}

TEST(RayCaster, DegenerateAndEmptyMeshes) {
  EXPECT_FALSE(RayCaster(TriangleMesh()).closest_hit({}));
  EXPECT_FALSE(RayCaster(TriangleMesh()).contains(Vector3d::Zero()));
  TriangleMesh flat;  // in the plane z = 0: the tree's boxes have no thickness
  TriangleMesh nothing;
  for (int i = 0; i < 40; ++i) {
    for (const Vector3d& v : {Vector3d(i, 0, 0), Vector3d(i + 1, 0, 0), Vector3d(i, 1, 0)}) flat.vertices.push_back(v);
    flat.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    nothing.vertices.push_back({1, 2, 3});
    nothing.triangles.push_back({i, i, i});
  }
  nothing.triangles.push_back({0, 1, 2});
  const RayCaster sheet(flat);
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(sheet.closest_hit({{i + 0.25, 0.25, 5}, {0, 0, -1}}).triangle, i);
    EXPECT_FALSE(sheet.any_hit({{i + 0.25, 0.25, 0}, {1, 0, 0}}));  // edge-on
  }
  EXPECT_FALSE(RayCaster(nothing).any_hit({{1, 2, 0}, {0, 0, 1}}));
}

/// Hundreds of copies of one triangle, and triangles that shrink towards a point: the tree stays flat.
TEST(RayCaster, TreesOfMeshesThatCannotBeSplit) {
  TriangleMesh copies, shrinking;
  for (int i = 0; i < 3000; ++i) {
    for (const Vector3d& v : {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)}) {
      copies.vertices.push_back(v);
      shrinking.vertices.push_back(std::pow(0.99, i) * (v + Vector3d(1, 1, 1)));
    }
    copies.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    shrinking.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Ray ray{{0.2, 0.3, -2}, {0, 0, 1}};
  EXPECT_EQ(RayCaster(copies).closest_hit(ray).triangle, 0);
  EXPECT_EQ(RayCaster(copies).all_hits(ray).size(), 3000u);
  const RayCaster caster(shrinking);
  Rng rng(8);
  for (int i = 0; i < 200; ++i) {
    const Vector3d eye = 5 * unit(rng);
    expect_as_brute_force(shrinking, caster, {eye, std::pow(0.99, rng.uniform(0, 1500)) * Vector3d(1.2, 1.3, 1) - eye});
  }
}

TEST(RayCaster, ContainsAsTheMeshSays) {
  Rng rng(9);
  const auto mesh = shape_mesh(Capsule{0.2, 0.6}, 24);
  const RayCaster caster(*mesh);
  int inside = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d p = i % 10 == 0 ? mesh->vertices[i % mesh->vertices.size()] : anywhere(rng, 0.5);
    EXPECT_EQ(caster.contains(p), mesh_contains(*mesh, p));
    inside += caster.contains(p);
  }
  EXPECT_GT(inside, 200);
}

TEST(RayCaster, SameAnswersAtAnyThreadCountAndInstructionSet) {
  const auto mesh = ball(64);
  const RayCaster caster(*mesh);
  Rng rng(10);
  std::vector<Ray> rays;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d eye = 2 * unit(rng);
    rays.push_back({eye, anywhere(rng, 1) - eye});
  }
  const auto same = [&](const std::vector<RayHit>& a, const std::vector<RayHit>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a[i].triangle != b[i].triangle || a[i].distance != b[i].distance || a[i].normal != b[i].normal) return false;
    }
    return a.size() == b.size();
  };
  std::vector<RayHit> single;
  for (const Ray& ray : rays) single.push_back(caster.closest_hit(ray));
  EXPECT_TRUE(same(caster.closest_hits(rays, 1), single));
  EXPECT_TRUE(same(caster.closest_hits(rays, 3), single));
  EXPECT_TRUE(same(caster.closest_hits(rays, 0), single));
  std::vector<RayHit> kept(rays.size() + 7, single.front());  // of another batch
  caster.closest_hits(rays, kept, 2);
  EXPECT_TRUE(same(kept, single));
  const std::vector<char> any = caster.any_hits(rays, 2);
  for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(any[i] != 0, static_cast<bool>(single[i]));
  const std::string best = detail::instruction_sets().front();
  detail::use_instruction_set("portable");
  EXPECT_TRUE(same(caster.closest_hits(rays, 1), single));
  EXPECT_EQ(caster.any_hits(rays), any);
  detail::use_instruction_set(best);
}

TEST(RayCaster, RefusesRaysThatAreNone) {
  const RayCaster caster(*ball());
  EXPECT_THROW(caster.closest_hit({Vector3d::Zero(), Vector3d::Zero()}), InvalidInput);
  EXPECT_THROW(caster.any_hit({Vector3d(0, std::nan(""), 0), Vector3d::UnitX()}), InvalidInput);
  EXPECT_THROW(caster.all_hits({Vector3d::Zero(), Vector3d(kInf, 0, 0)}), InvalidInput);
  EXPECT_THROW(caster.closest_hits({{Vector3d::Zero(), Vector3d::Zero()}}, 2), InvalidInput);
}
