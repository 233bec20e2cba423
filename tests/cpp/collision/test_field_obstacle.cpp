// Distance fields as obstacles: answers against those of the bodies that the fields describe.
#include "mmgrasp/collision/field_obstacle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/grid_distance_field.hpp"
#include "support/free_body.hpp"

using namespace mmgrasp;
using Eigen::Vector3d;

namespace {

constexpr double kResolution = 1e-4;

/// The exact field of a box, by its formula.
class BoxField : public DistanceField {
 public:
  explicit BoxField(const Vector3d& size) : half_(0.5 * size) {}
  DistanceFieldProperties properties() const override {
    const Vector3d all = Vector3d::Constant(std::numeric_limits<double>::infinity());
    return {Eigen::AlignedBox3d(Vector3d(-all), all)};
  }

 private:
  double at(const Vector3d& p) const {
    const Vector3d off = p.cwiseAbs() - half_;
    return off.cwiseMax(0).norm() + std::min(0.0, off.maxCoeff());
  }
  void evaluate(const Eigen::Matrix3Xd& points, Eigen::VectorXd& distances,
                Eigen::Matrix3Xd* gradients) const override {
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const Vector3d p = points.col(i), off = p.cwiseAbs() - half_;
      distances[i] = at(p);
      if (!gradients) continue;
      Vector3d g = off.cwiseMax(0);
      if (g.norm() == 0) {
        Eigen::Index axis = 0;
        off.maxCoeff(&axis);
        g = Vector3d::Unit(axis);
      }
      gradients->col(i) = g.normalized().cwiseProduct(p.cwiseSign());
      if (gradients->col(i).norm() == 0) gradients->col(i) = Vector3d::UnitX();
      gradients->col(i).normalize();
    }
  }
  Vector3d half_;
};

FieldObstacle obstacle(std::shared_ptr<const DistanceField> field, double resolution = kResolution) {
  FieldObstacle out;
  out.field = std::move(field);
  out.resolution = resolution;
  out.T_world_field = pose_from_xyz_rpy({0.1, -0.2, 0.05}, {0.3, -0.5, 0.8});
  return out;
}

/// Bodies of every kind, all about as large as the obstacles.
std::vector<Shape> bodies() {
  auto bent = std::make_shared<TriangleMesh>();  // an L, closed and not convex
  {
    const auto add = [&](const Vector3d& size, const Vector3d& at) {
      const auto box = shape_mesh(Box{size});
      const int first = static_cast<int>(bent->vertices.size());
      for (const Vector3d& v : box->vertices) bent->vertices.push_back(v + at);
      for (const auto& t : box->triangles) bent->triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    };
    add({0.3, 0.05, 0.05}, {0, 0, 0});
    add({0.05, 0.05, 0.2}, {0.12, 0, 0.125});
    bent->closed = true;
  }
  auto hull = std::make_shared<TriangleMesh>(*convex_hull(
      {{0.1, 0, 0}, {-0.1, 0.02, 0}, {0, 0.12, 0.01}, {0.02, 0, 0.15}, {0, -0.03, -0.08}, {0.05, 0.08, 0.06}}));
  return {Box{{0.2, 0.1, 0.15}}, Sphere{0.08},    Cylinder{0.06, 0.2},
          Capsule{0.04, 0.2},    MeshShape{hull}, MeshShape{bent}};
}

Eigen::VectorXd random_pose(Rng& rng, double spread) {
  Eigen::VectorXd q(6);
  for (int i = 0; i < 3; ++i) q[i] = rng.uniform(-spread, spread);
  for (int i = 3; i < 6; ++i) q[i] = rng.uniform(-3.0, 3.0);
  return q;
}

CollisionChecker checker(const Shape& body, const World& world, const CheckerOptions& options = {}) {
  return CollisionChecker(free_body::group({free_body::link_shape(body)}), world, options);
}

World world_of(const FieldObstacle& field) {
  World world;
  world.add_field("field", field);
  return world;
}

World world_of(const Shape& shape, const Pose& T) {
  World world;
  world.add("shape", shape, T);
  return world;
}

}  // namespace

/// Random poses of every kind of body: the field of a box, a sphere or a mesh answers as the shape itself does, but in
/// the band that its resolution and error leave open.
TEST(FieldObstacle, AnswersAsTheShapeItHolds) {
  Rng rng(1);
  const Box wall{{0.4, 0.3, 0.02}};
  const auto ball = shape_mesh(Sphere{0.15}, 20);
  struct Case {
    Shape shape;
    FieldObstacle field;
  };
  const std::vector<Case> cases{{wall, obstacle(std::make_shared<BoxField>(wall.size))},
                                {MeshShape{ball}, obstacle(std::make_shared<MeshDistanceField>(*ball), 1e-3)}};
  for (const Case& each : cases) {
    for (const Shape& body : bodies()) {
      CollisionChecker by_shape = checker(body, world_of(each.shape, each.field.T_world_field));
      CollisionChecker by_field = checker(body, world_of(each.field));
      int free = 0, hit = 0, band = 0;
      for (int i = 0; i < 200; ++i) {
        const Eigen::VectorXd q = random_pose(rng, 0.25);
        const double distance = by_shape.distance(q).value;
        const bool is_free = by_field.is_free(q);
        if (distance <= 0) {
          EXPECT_FALSE(is_free) << shape_kind(body) << " at " << distance;
          ++hit;
        } else if (distance > 1.2 * each.field.resolution) {
          EXPECT_TRUE(is_free) << shape_kind(body) << " at " << distance;
          ++free;
          // From below, by no more than the resolution (and the prism around a cylinder).
          const double found = by_field.distance(q).value;
          EXPECT_LE(found, distance + 1e-9) << shape_kind(body);
          EXPECT_GE(found, distance - 2 * each.field.resolution - 1e-5) << shape_kind(body);
        } else {
          ++band;
        }
      }
      EXPECT_GT(free, 20);
      EXPECT_GT(hit, 20);
      EXPECT_LT(band, 5);
    }
  }
}

/// A body lowered onto a wall: it touches where the wall begins, to the resolution.
TEST(FieldObstacle, JustTouching) {
  const Box wall{{0.6, 0.6, 0.02}};
  for (const Shape& body :
       {Shape(Box{{0.2, 0.1, 0.15}}), Shape(Sphere{0.075}), Shape(Capsule{0.04, 0.07}), Shape(Cylinder{0.06, 0.15})}) {
    FieldObstacle field = obstacle(std::make_shared<BoxField>(wall.size));
    field.T_world_field = Pose::Identity();
    CollisionChecker by_field = checker(body, world_of(field));
    Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
    const double touching = 0.01 + 0.075;
    for (const double above : {1e-6, 1e-5}) {
      q[2] = touching - above;
      EXPECT_FALSE(by_field.is_free(q)) << shape_kind(body);
    }
    q[2] = touching + 1.01 * kResolution;
    EXPECT_TRUE(by_field.is_free(q)) << shape_kind(body);
    EXPECT_EQ(by_field.first_contact(Eigen::VectorXd::Zero(6))->b, "field");
  }
}

/// Far thinner than the body, and wholly inside it: no sample of the body need lie in it.
TEST(FieldObstacle, ThinWallsAndObstaclesInsideABody) {
  FieldObstacle sheet = obstacle(std::make_shared<BoxField>(Vector3d(0.5, 0.5, 1e-6)));
  FieldObstacle crumb = obstacle(std::make_shared<BoxField>(Vector3d::Constant(0.002)));
  sheet.T_world_field = Pose::Identity();
  crumb.T_world_field = Pose(Eigen::Translation3d(0.013, 0.007, 0.011));
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(6, 0.01);
  for (const Shape& body : bodies()) {
    EXPECT_FALSE(checker(body, world_of(sheet)).is_free(q)) << shape_kind(body);
    EXPECT_FALSE(checker(body, world_of(crumb)).is_free(q)) << shape_kind(body);
  }
}

TEST(FieldObstacle, PaddingAndGradient) {
  Rng rng(3);
  const Box wall{{0.4, 0.3, 0.1}};
  const FieldObstacle field = obstacle(std::make_shared<BoxField>(wall.size));
  CheckerOptions options;
  options.padding = 0.03;
  const Shape body = Sphere{0.05};
  CollisionChecker padded = checker(body, world_of(field), options);
  World grown = world_of(field), touched = grown;
  Padding padding;
  padding.by_name["field"] = 0.03;
  grown.set_padding(padding);
  touched.allow("body", "field");
  CollisionChecker by_object = checker(body, grown), allowed = checker(body, touched);
  EXPECT_TRUE(allowed.is_free(Eigen::VectorXd::Zero(6)));
  CollisionChecker by_shape = checker(body, world_of(wall, field.T_world_field));
  CollisionChecker by_field = checker(body, world_of(field));
  int near = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::VectorXd q = random_pose(rng, 0.3);
    const DistanceResult truth = by_shape.distance_and_gradient(q);
    if (truth.value <= 0.03) {
      EXPECT_FALSE(padded.is_free(q));
      EXPECT_FALSE(by_object.is_free(q));
    } else if (truth.value > 0.03 + 2 * kResolution) {
      EXPECT_TRUE(padded.is_free(q));
      EXPECT_TRUE(by_object.is_free(q));
    }
    near += truth.value > 0 && truth.value < 0.03;
    if (truth.value < 0.01) continue;
    const DistanceResult found = by_field.distance_and_gradient(q);
    EXPECT_LT((found.gradient - truth.gradient).norm(), 1e-6);
    EXPECT_LT((found.point_b - truth.point_b).norm(), 3 * kResolution);
  }
  EXPECT_GT(near, 20);
}

/// Straight edges, in steps and continuous: never free where the box itself is hit.
TEST(FieldObstacle, Edges) {
  Rng rng(4);
  const Box wall{{0.4, 0.4, 0.02}};
  const FieldObstacle field = obstacle(std::make_shared<BoxField>(wall.size), 1e-3);
  const Shape body = Box{{0.15, 0.05, 0.1}};
  CollisionChecker by_shape = checker(body, world_of(wall, field.T_world_field));
  CollisionChecker by_field = checker(body, world_of(field));
  EdgeOptions continuous;
  continuous.continuous = true;
  continuous.tolerance = 1e-3;
  int free = 0, hit = 0;
  for (int i = 0; i < 60; ++i) {
    const Eigen::VectorXd q0 = random_pose(rng, 0.4);
    Eigen::VectorXd q1 = random_pose(rng, 0.4);
    if (!by_shape.edge_is_free(q0, q1, 0.002)) {
      EXPECT_FALSE(by_field.edge_is_free(q0, q1, 0.002));
      EXPECT_FALSE(check_edge(by_field, q0, q1, continuous).free);
      ++hit;
    } else if (by_field.edge_is_free(q0, q1, 0.002)) {
      ++free;
    }
  }
  EXPECT_GT(free, 5);
  EXPECT_GT(hit, 5);
}

/// A grid is off by up to its stated error: what it calls free is free, what is farther than twice that is called so.
TEST(FieldObstacle, GridsKeepTheirStatedError) {
  const Vector3d half(0.1, 0.15, 0.06);
  GridDistanceField::Grid grid;
  grid.spacing = 0.01;
  grid.size = {61, 61, 61};
  grid.origin = Vector3d::Constant(-0.3);
  const BoxField exact(2 * half);
  for (int i = 0; i < 61; ++i)
    for (int j = 0; j < 61; ++j)
      for (int k = 0; k < 61; ++k)
        grid.values.push_back(exact.distance(grid.origin + grid.spacing * Vector3d(i, j, k)));
  const auto field = std::make_shared<GridDistanceField>(grid);
  const double error = field->properties().error;
  EXPECT_NEAR(error, 0.01 * std::sqrt(3.0) / 2, 1e-15);
  Rng rng(5);
  double largest = 0;
  for (int i = 0; i < 20000; ++i) {
    Vector3d p;
    for (int k = 0; k < 3; ++k) p[k] = rng.uniform(-0.3, 0.3);
    largest = std::max(largest, std::abs(field->distance(p) - exact.distance(p)));
  }
  EXPECT_LE(largest, error);
  EXPECT_GT(largest, 0.001);
  FieldObstacle free_beyond = obstacle(field, 1e-3), closed_beyond = free_beyond;
  free_beyond.unknown_is_free = true;
  free_beyond.T_world_field = closed_beyond.T_world_field = Pose::Identity();
  const Shape body = Capsule{0.03, 0.1};
  CollisionChecker open = checker(body, world_of(free_beyond)), shut = checker(body, world_of(closed_beyond));
  CollisionChecker truth = checker(body, world_of(Box{2 * half}, Pose::Identity()));
  int free = 0, hit = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::VectorXd q = random_pose(rng, 0.28);
    const double distance = truth.distance(q).value;
    if (distance <= 0) {
      EXPECT_FALSE(open.is_free(q));
      ++hit;
    }
    if (distance > 2 * error + 1.1e-3) {
      EXPECT_TRUE(open.is_free(q)) << distance;
      ++free;
    }
    const Pose T = free_body::pose(q);
    double reach = 0;
    for (const double end : {-0.05, 0.05})
      reach = std::max(reach, (T * Vector3d(0, 0, end)).cwiseAbs().maxCoeff() + 0.03);
    if (reach > 0.3) {
      EXPECT_FALSE(shut.is_free(q)) << "reaches out of what is known";
    }
    if (shut.is_free(q)) {
      EXPECT_TRUE(open.is_free(q));
    }
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(hit, 20);
}

/// Where no camera looked: NaN inside the domain.
TEST(FieldObstacle, CellsNobodySaw) {
  GridDistanceField::Grid grid;
  grid.size = {3, 3, 3};
  grid.spacing = 0.5;
  grid.origin = Vector3d::Constant(-0.5);
  grid.values.assign(27, 2.0);
  grid.values[0] = std::nan("");
  FieldObstacle field = obstacle(std::make_shared<GridDistanceField>(grid), 0.05);
  field.T_world_field = Pose::Identity();
  const Shape body = Box{{0.1, 0.1, 0.1}};
  Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
  q.head<3>().setConstant(-0.25);
  EXPECT_FALSE(checker(body, world_of(field)).is_free(q));
  field.unknown_is_free = true;
  EXPECT_TRUE(checker(body, world_of(field)).is_free(q));
  q.head<3>().setConstant(0.2);
  field.unknown_is_free = false;
  EXPECT_TRUE(checker(body, world_of(field)).is_free(q));
}

TEST(FieldObstacle, WorldsHoldThemByName) {
  World world;
  const FieldObstacle field = obstacle(std::make_shared<BoxField>(Vector3d::Ones()));
  world.add_field("map", field);
  EXPECT_TRUE(world.has("map"));
  EXPECT_THROW(world.add("map", Sphere{1}, Pose::Identity()), InvalidInput);
  EXPECT_THROW(world.add_field("map", field), InvalidInput);
  EXPECT_THROW(world.attach("map", "hand", Pose::Identity()), InvalidInput);
  FieldObstacle none, fine = field;
  fine.resolution = 0;
  EXPECT_THROW(world.add_field("none", none), InvalidInput);
  EXPECT_THROW(world.add_field("fine", fine), InvalidInput);
  const Pose T = Pose(Eigen::Translation3d(0, 0, 5));
  world.move("map", T);
  EXPECT_TRUE(world.fields().at("map").T_world_field.isApprox(T));
  EXPECT_TRUE(checker(Box{{1, 1, 1}}, world).is_free(Eigen::VectorXd::Zero(6)));
  world.remove("map");
  EXPECT_FALSE(world.has("map"));
}
