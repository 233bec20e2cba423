#include "mmgrasp/geometry/distance_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/shape.hpp"

using namespace mmgrasp;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

Matrix3Xd random_points(Rng& rng, int count, double spread) {
  Matrix3Xd points(3, count);
  for (double& each : points.reshaped()) each = rng.uniform(-spread, spread);
  return points;
}

/// Nearest point of a triangle by its Voronoi regions (Ericson, Real-Time Collision Detection, 5.1.5), in long double.
long double triangle_distance(const Vector3d& point, const Vector3d& va, const Vector3d& vb, const Vector3d& vc) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  const Long p = point.cast<long double>(), a = va.cast<long double>(), b = vb.cast<long double>(),
             c = vc.cast<long double>();
  const Long ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const long double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
                    d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return ap.norm();
  if (d3 >= 0 && d4 <= d3) return bp.norm();
  if (d6 >= 0 && d5 <= d6) return cp.norm();
  const long double wc = d1 * d4 - d3 * d2, wb = d5 * d2 - d1 * d6, wa = d3 * d6 - d5 * d4;
  if (wc <= 0 && d1 >= 0 && d3 <= 0) return (ap - ab * (d1 / (d1 - d3))).norm();
  if (wb <= 0 && d2 >= 0 && d6 <= 0) return (ap - ac * (d2 / (d2 - d6))).norm();
  if (wa <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return (bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))).norm();
  return (ap - (ab * wb + ac * wc) / (wa + wb + wc)).norm();
}

double brute_force(const TriangleMesh& mesh, const Vector3d& p) {
  long double best = std::numeric_limits<long double>::infinity();
  for (const auto& t : mesh.triangles)
    best = std::min(best, triangle_distance(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  return static_cast<double>(mesh_contains(mesh, p) ? -best : best);
}

void expect_as_brute_force(const TriangleMesh& mesh, const Matrix3Xd& points) {
  const MeshDistanceField field(mesh);
  Matrix3Xd gradients;
  const VectorXd distances = field.distances(points, gradients);
  EXPECT_EQ(field.distances(points), distances);
  int inside = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Vector3d p = points.col(i), g = gradients.col(i);
    EXPECT_NEAR(distances[i], brute_force(mesh, p), 1e-12 * (1 + p.norm()));
    EXPECT_EQ(field.distance(p), distances[i]);
    EXPECT_NEAR(g.norm(), 1, 1e-12);
    // Against the gradient for as long as the distance is, the surface is reached.
    EXPECT_NEAR(brute_force(mesh, p - distances[i] * g), 0, 1e-9 * (1 + p.norm()));
    inside += distances[i] < 0;
  }
  EXPECT_GT(inside, 0);
  EXPECT_LT(inside, points.cols());
}

/// A field in closed form, known within a box: what a map will look like.
class BallInABox : public DistanceField {
 public:
  DistanceFieldProperties properties() const override {
    return {Eigen::AlignedBox3d(Vector3d(-1, -1, -1), Vector3d(1, 1, 1)), 0.01, 0.5};
  }

 private:
  void evaluate(const Matrix3Xd& points, VectorXd& distances, Matrix3Xd* gradients) const override {
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const bool known = properties().domain.contains(Vector3d(points.col(i)));
      distances[i] = known ? std::min(points.col(i).norm() - 0.4, 0.5) : std::nan("");
      if (gradients) gradients->col(i) = known ? Vector3d(points.col(i).normalized()) : Vector3d::Zero();
    }
  }
};

}  // namespace

TEST(MeshDistanceField, BoxInClosedForm) {
  const Vector3d half(0.2, 0.3, 0.5);
  const MeshDistanceField field(*shape_mesh(Box{2 * half}));
  Rng rng(1);
  const Matrix3Xd points = random_points(rng, 4000, 0.8);
  Matrix3Xd gradients;
  const VectorXd distances = field.distances(points, gradients);
  for (int i = 0; i < points.cols(); ++i) {
    const Vector3d q = points.col(i).cwiseAbs() - half;
    const double truth = q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
    EXPECT_NEAR(distances[i], truth, 1e-14);
    if (truth > 1e-6) {
      const Vector3d away = q.cwiseMax(0).cwiseProduct(points.col(i).cwiseSign()).normalized();
      EXPECT_LT((gradients.col(i) - away).norm(), 1e-9);
    }
  }
  EXPECT_TRUE(field.properties().domain.contains(Vector3d(1e9, 0, 0)));
  EXPECT_EQ(field.properties().error, 0);
}

TEST(MeshDistanceField, AgreesWithEveryTriangle) {
  Rng rng(2);
  expect_as_brute_force(*shape_mesh(Sphere{0.5}, 40), random_points(rng, 400, 0.8));
  expect_as_brute_force(*shape_mesh(Capsule{0.1, 0.9}, 40), random_points(rng, 400, 0.5));
  // Two balls in one mesh, one in the other: the inner one changes nothing of inside, but is surface.
  TriangleMesh nested = *shape_mesh(Sphere{0.5}, 30);
  const TriangleMesh inner = *shape_mesh(Sphere{0.2}, 16);
  const int first = static_cast<int>(nested.vertices.size());
  for (const Vector3d& v : inner.vertices) nested.vertices.push_back(v);
  for (const auto& t : inner.triangles) nested.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  expect_as_brute_force(nested, random_points(rng, 300, 0.6));
}

TEST(MeshDistanceField, AgreesOnAScannedMesh) {
  const std::string path =
      std::string(MMGRASP_SHARED_DATA) + "/meshes/ycb/YcbMustardBottle/textured_simple_reoriented.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data";
  const auto scan = load_mesh(path);
  const auto mesh = scan->closed ? scan : convex_hull(scan->vertices);
  Rng rng(3);
  expect_as_brute_force(*mesh, random_points(rng, 150, 0.12));
}

TEST(MeshDistanceField, OnAndFarFromTheSurface) {
  const auto mesh = shape_mesh(Sphere{0.5}, 24);
  const MeshDistanceField field(*mesh);
  Matrix3Xd points(3, static_cast<Eigen::Index>(mesh->vertices.size())), gradients;
  for (std::size_t i = 0; i < mesh->vertices.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = mesh->vertices[i];
  const VectorXd on = field.distances(points, gradients);
  EXPECT_LT(on.cwiseAbs().maxCoeff(), 1e-15);
  for (Eigen::Index i = 0; i < points.cols(); ++i) EXPECT_GT(gradients.col(i).dot(points.col(i).normalized()), 0.9);
  for (const double far : {1e3, 1e6}) EXPECT_NEAR(field.distance({far, 0, 0}) / far, 1, 1e-3);
  for (const double far : {1.1e6, 1e12, 1e30}) EXPECT_THROW(field.distance({far, 0, 0}), InvalidInput) << far;
}

/// 1-Lipschitz: the distance changes by no more than the way walked, also across the surface.
TEST(MeshDistanceField, ChangesNoFasterThanTheWayWalked) {
  const MeshDistanceField field(*shape_mesh(Cylinder{0.3, 0.7}, 30));
  Rng rng(5);
  const Matrix3Xd a = random_points(rng, 3000, 0.6), b = a + random_points(rng, 3000, 0.05);
  const VectorXd change = (field.distances(a) - field.distances(b)).cwiseAbs();
  for (int i = 0; i < a.cols(); ++i) EXPECT_LE(change[i], (a.col(i) - b.col(i)).norm() + 1e-14);
}

TEST(MeshDistanceField, RefusesOpenMeshesAndPointsThatAreNone) {
  TriangleMesh open = *shape_mesh(Sphere{0.5});
  open.closed = false;
  EXPECT_THROW(MeshDistanceField{open}, InvalidInput);
  EXPECT_THROW(MeshDistanceField{TriangleMesh()}, InvalidInput);
  const MeshDistanceField field(*shape_mesh(Sphere{0.5}));
  Matrix3Xd points = Matrix3Xd::Zero(3, 4);
  points(1, 2) = std::nan("");
  try {
    field.distances(points);
    FAIL();
  } catch (const InvalidInput& e) {
    EXPECT_NE(std::string(e.what()).find("point 2"), std::string::npos) << e.what();
  }
  EXPECT_EQ(field.distances(Matrix3Xd(3, 0)).size(), 0);
}

TEST(DistanceField, WhatIsUnknownIsNotANumber) {
  const BallInABox ball;
  const DistanceField& field = ball;
  Matrix3Xd points(3, 3), gradients;
  points << 0.6, 0, 2, 0, 0, 0, 0, 0.1, 0;
  const VectorXd distances = field.distances(points, gradients);
  EXPECT_NEAR(distances[0], 0.2, 1e-15);
  EXPECT_NEAR(distances[1], -0.3, 1e-15);
  EXPECT_TRUE(std::isnan(distances[2]));
  EXPECT_EQ(Vector3d(gradients.col(0)), Vector3d::UnitX());
  EXPECT_TRUE(gradients.col(2).isZero(0));
  EXPECT_EQ(field.properties().truncation, 0.5);
}
