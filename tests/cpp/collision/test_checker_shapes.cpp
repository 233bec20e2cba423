// Every kind of shape against every other, compared with FCL called directly.

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/detail/instruction_set.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/fcl_reference.hpp"
#include "support/free_body.hpp"

using namespace mmgrasp;

namespace {

std::shared_ptr<const TriangleMesh> random_hull(unsigned seed) {
  Rng rng(seed);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 40; ++i) points.emplace_back(0.2 * rng.normal(), 0.1 * rng.normal(), 0.15 * rng.normal());
  return convex_hull(points);
}

// An L of two boxes that share a face, welded into one closed concave mesh.
std::shared_ptr<const TriangleMesh> l_shape() {
  const std::vector<Eigen::Vector2d> outline{{0, 0}, {0.4, 0}, {0.4, 0.1}, {0.1, 0.1}, {0.1, 0.5}, {0, 0.5}};
  std::vector<Eigen::Vector3d> v;
  for (const double z : {-0.1, 0.1}) {
    for (const auto& p : outline) v.emplace_back(p.x() - 0.1, p.y() - 0.1, z);
  }
  std::vector<std::array<int, 3>> t{{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}};
  const std::size_t caps = t.size();
  for (std::size_t i = 0; i < caps; ++i) {
    const auto c = t[i];
    t.push_back({c[0] + 6, c[1] + 6, c[2] + 6});
    t[i] = {c[0], c[2], c[1]};
  }
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    t.push_back({i, j, j + 6});
    t.push_back({i, j + 6, i + 6});
  }
  return make_mesh(v, t);
}

// A box without its lid.
std::shared_ptr<const TriangleMesh> open_bin() {
  const auto box = shape_mesh(Box{{0.5, 0.4, 0.3}});
  std::vector<std::array<int, 3>> t;
  for (const auto& triangle : box->triangles) {
    bool top = true;
    for (const int corner : triangle) top = top && box->vertices[corner].z() > 0;
    if (!top) t.push_back(triangle);
  }
  return make_mesh(box->vertices, t);
}

std::shared_ptr<const TriangleMesh> torus() {
  std::vector<Eigen::Vector3d> v;
  std::vector<std::array<int, 3>> t;
  const int n = 20, m = 10;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double a = 2 * M_PI * i / n, b = 2 * M_PI * j / m, r = 0.3 + 0.08 * std::cos(b);
      v.emplace_back(r * std::cos(a), r * std::sin(a), 0.08 * std::sin(b));
      const int i1 = (i + 1) % n, j1 = (j + 1) % m;
      t.push_back({i * m + j, i1 * m + j, i1 * m + j1});
      t.push_back({i * m + j, i1 * m + j1, i * m + j1});
    }
  }
  return make_mesh(v, t);
}

Voxels random_voxels() {
  Rng rng(3);
  auto centres = std::make_shared<std::vector<Eigen::Vector3d>>();
  for (int i = 0; i < 60; ++i) {
    centres->emplace_back(0.05 * std::floor(rng.uniform(-5, 5)), 0.05 * std::floor(rng.uniform(-5, 5)),
                          0.05 * std::floor(rng.uniform(-3, 3)));
  }
  return {centres, 0.05};
}

struct Case {
  std::string name;
  Shape shape;
};

std::vector<Case> all_shapes() {
  return {{"box", Box{{0.3, 0.2, 0.5}}},     {"plate", Box{{0.6, 0.4, 0.002}}}, {"sphere", Sphere{0.2}},
          {"cylinder", Cylinder{0.15, 0.4}}, {"capsule", Capsule{0.1, 0.4}},    {"hull", MeshShape{random_hull(1)}},
          {"l_shape", MeshShape{l_shape()}}, {"torus", MeshShape{torus()}},     {"open_bin", MeshShape{open_bin()}},
          {"voxels", random_voxels()}};
}

double radius_of(const Shape& shape) {
  const Eigen::AlignedBox3d box = shape_bounds(shape);
  return box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
}

Eigen::VectorXd random_offset(Rng& rng, double reach) {
  Eigen::VectorXd q(6);
  const Eigen::Vector3d direction = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
  q << reach * rng.uniform() * direction, rng.uniform(-M_PI, M_PI), rng.uniform(-M_PI, M_PI), rng.uniform(-M_PI, M_PI);
  return q;
}

}  // namespace

TEST(CheckerShapes, MeshesAreWhatTheNamesSay) {
  EXPECT_TRUE(random_hull(1)->convex);
  EXPECT_TRUE(l_shape()->closed);
  EXPECT_FALSE(l_shape()->convex);
  EXPECT_NEAR(mesh_volume(*l_shape()), (0.4 * 0.1 + 0.1 * 0.4) * 0.2, 1e-12);
  EXPECT_TRUE(torus()->closed);
  EXPECT_FALSE(open_bin()->closed);
}

namespace {

class CheckerShapesOnKernels : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { detail::use_instruction_set(GetParam()); }
  void TearDown() override { detail::use_instruction_set(detail::instruction_sets().front()); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, CheckerShapesOnKernels, ::testing::ValuesIn(detail::instruction_sets()),
                         [](const auto& info) { return info.param; });

}  // namespace

// Capsules have few spheres and no finer ones, next to bodies with three levels of them.
TEST_P(CheckerShapesOnKernels, LongCapsulesAgreeWithFcl) {
  Rng rng(21);
  int free = 0, hit = 0, unjudged = 0;
  for (const Capsule& capsule : {Capsule{0.1, 0.4}, Capsule{0.03, 0.6}, Capsule{0.1, 0.05}}) {
    const fcl_reference::Body body = fcl_reference::make_body(capsule);
    for (const Case& other : {Case{"voxels", random_voxels()}, Case{"dented", MeshShape{l_shape()}}}) {
      const fcl_reference::Body reference = fcl_reference::make_body(other.shape);
      const Pose T = pose_from_xyz_rpy({0.3, -0.2, 0.5}, {0.4, -0.9, 2.0});
      for (const std::string where : {"link", "held", "self"}) {
        if (where == "self" && other.name == "voxels") continue;  // links are not made of voxels
        World world;
        if (where != "self") world.add(other.name, other.shape, T);
        if (where == "held") {
          world.add("part", capsule, Pose::Identity());
          world.attach("part", "carrier", Pose::Identity());
        }
        Robot robot = free_body::robot(where == "held" ? std::vector<LinkShape>{}
                                                       : std::vector<LinkShape>{free_body::link_shape(capsule)});
        if (where == "self") robot = robot.with_link("obstacle", "root", T, {free_body::link_shape(other.shape)});
        CollisionChecker checker(robot.chain("root", "carrier"), world);
        for (int i = 0; i < 400; ++i) {
          Eigen::VectorXd q = random_offset(rng, 0.6 * (radius_of(capsule) + radius_of(other.shape)));
          q.head<3>() += T.translation();
          const bool expected = fcl_reference::touch(body, free_body::pose(q), reference, T);
          const bool answer = !checker.is_free(q);
          if (answer != expected && fcl_reference::on_the_edge(body, free_body::pose(q), reference, T)) {
            ++unjudged;
            continue;
          }
          ASSERT_EQ(answer, expected) << capsule.radius << " " << capsule.length << " " << where << " against "
                                      << other.name << ", q = " << q.transpose();
          ++(expected ? hit : free);
        }
      }
    }
  }
  EXPECT_GT(hit, 1000);
  EXPECT_GT(free, 1000);
  EXPECT_LT(unjudged, 5);
}

TEST_P(CheckerShapesOnKernels, EveryPairAgreesWithFcl) {
  const int samples = 250;
  int free = 0, hit = 0, unjudged = 0;
  for (const Case& mover : all_shapes()) {
    // A link cannot be made of voxels, an attached object can.
    const bool attached = mover.name == "voxels";
    const JointGroup group = free_body::group(attached ? std::vector<LinkShape>{}
                                                       : std::vector<LinkShape>{free_body::link_shape(mover.shape)});
    const fcl_reference::Body body = fcl_reference::make_body(mover.shape);
    std::vector<Case> others = all_shapes();
    others.push_back({"plane", Plane{Eigen::Vector3d(0.6, 0, 0.8), 0.1}});
    for (const Case& other : others) {
      World world;
      const Pose T = pose_from_xyz_rpy({0.3, -0.2, 0.5}, {0.4, -0.9, 2.0});
      if (attached) {
        world.add("held", mover.shape, Pose::Identity());
        world.attach("held", "carrier", Pose::Identity());
      }
      world.add(other.name, other.shape, T);
      CollisionChecker checker(group, world);
      const fcl_reference::Body reference = fcl_reference::make_body(other.shape);
      Rng rng(7, free + hit);
      const double reach = radius_of(mover.shape) + (other.name == "plane" ? 1.0 : radius_of(other.shape));
      for (int i = 0; i < samples; ++i) {
        Eigen::VectorXd q = random_offset(rng, reach);
        q.head<3>() += T.translation();
        const bool expected = fcl_reference::touch(body, free_body::pose(q), reference, T);
        const bool answer = checker.rejection(q) == Rejection::scene;
        if (answer != expected && fcl_reference::on_the_edge(body, free_body::pose(q), reference, T)) {
          ++unjudged;
          continue;
        }
        ASSERT_EQ(answer, expected) << mover.name << " against " << other.name << ", q = " << q.transpose();
        ++(expected ? hit : free);
      }
    }
  }
  RecordProperty("free", free);
  RecordProperty("hit", hit);
  std::printf("agreement with FCL: %d free, %d colliding, %d in the 1e-6 m band\n", free, hit, unjudged);
  EXPECT_GT(hit, 5000);
  EXPECT_GT(free, 5000);
  EXPECT_LT(unjudged, 5);
}
