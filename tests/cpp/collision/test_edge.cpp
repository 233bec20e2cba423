#include "mmgrasp/collision/edge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/free_body.hpp"
#include "support/mesh_robots.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;
using testing_support::shared;

namespace {

Eigen::VectorXd at(double x, double y, double z) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
  q.head<3>() << x, y, z;
  return q;
}

JointGroup panda_arm() {
  RobotOptions options;
  options.package_dirs["moveit_resources_panda_description"] =
      shared("robots/panda/moveit_resources_panda_description");
  return Robot::load(shared("robots/panda/expanded/panda.urdf"),
                     shared("robots/panda/moveit_resources_panda_moveit_config/config/panda.srdf"), options)
      .group("panda_arm");
}

// Boxes, a sphere, a sheet of voxels and a floor, so that every way of checking a body along an edge has its turn.
World clutter(unsigned seed, int boxes) {
  Rng rng(seed);
  World world;
  const auto place = [&] {
    Pose T = Pose::Identity();
    const double angle = rng.uniform(-M_PI, M_PI), r = rng.uniform(0.45, 0.8);
    T.translation() << r * std::cos(angle), r * std::sin(angle), rng.uniform(0.1, 1.0);
    T.linear() = rng.rotation().toRotationMatrix();
    return T;
  };
  for (int i = 0; i < boxes; ++i) world.add("box" + std::to_string(i), Box{{0.1, 0.06, 0.08}}, place());
  world.add("ball", Sphere{0.08}, place());
  world.add("floor", Plane{Eigen::Vector3d::UnitZ(), -0.05}, Pose::Identity());
  auto centres = std::make_shared<std::vector<Eigen::Vector3d>>();
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) centres->emplace_back(0.01 * i, 0.01 * j, 0);
  }
  world.add("sheet", Voxels{centres, 0.01}, place());
  return world;
}

}  // namespace

TEST(Edge, TheFirstRefusedStepIsThatOfLookingAtEachOne) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda_arm();
  Rng rng(4);
  int free = 0, hit = 0;
  for (const int boxes : {10, 80}) {  // swept one by one, and through the tree
    const World world = clutter(boxes, boxes);
    CollisionChecker checker(group, world), reference(group, world);
    for (int n = 0; n < 150; ++n) {
      const Eigen::VectorXd from = rng.uniform(group.lower(), group.upper());
      if (!reference.is_free(from)) continue;
      const Eigen::VectorXd way = rng.uniform(group.lower(), group.upper()) - from;
      const Eigen::VectorXd to = from + way * (0.6 / way.cwiseAbs().maxCoeff());
      int first = 0;
      while (first <= 30 && reference.is_free(from + (to - from) * (first / 30.0))) ++first;
      const EdgeResult result = check_edge(checker, from, to);
      ASSERT_EQ(result.free, first > 30);
      ASSERT_EQ(checker.edge_is_free(from, to), first > 30);
      ++(first > 30 ? free : hit);
      if (result.free) continue;
      ASSERT_NEAR(result.fraction, first / 30.0, 1e-12);
      const Eigen::VectorXd q = from + (to - from) * result.fraction;
      if (!group.within_limits(q, 1e-5)) {
        EXPECT_FALSE(result.contact.has_value());
        continue;
      }
      ASSERT_TRUE(result.contact.has_value());
      bool named = false;
      for (const Contact& c : reference.contacts(q))
        named = named || (c.a == result.contact->a && c.b == result.contact->b);
      EXPECT_TRUE(named) << result.contact->a << " " << result.contact->b;
    }
  }
  EXPECT_GT(free, 30);
  EXPECT_GT(hit, 30);
}

// Meshes that pass each other closely (UR5's wrist and forearm), a lift (TIAGo), long edges in fine steps; the checker
// keeps what it remembers from one edge to the next.
TEST(Edge, TheAnswerIsThatOfCheckingEveryStep) {
  for (const auto& arm : {testing_support::ur5_arm(), testing_support::tiago_arm()}) {
    SCOPED_TRACE(arm.name);
    const JointGroup& group = arm.group;
    const World world = clutter(7, 12);
    CollisionChecker checker(group, world), reference(group, world);
    Rng rng(9);
    int free = 0, hit = 0;
    while (free + hit < 60) {
      const Eigen::VectorXd from = rng.uniform(group.sample_lower(), group.sample_upper());
      if (!reference.is_free(from)) continue;
      const Eigen::VectorXd way = rng.uniform(group.sample_lower(), group.sample_upper()) - from;
      const double length = rng.uniform(0.1, 2), step = rng.uniform(0.003, 0.05);
      const Eigen::VectorXd to = from + way * (length / way.cwiseAbs().maxCoeff());
      const int pieces = static_cast<int>(std::ceil(length / step - 1e-9));
      int first = 1;
      while (first < pieces && reference.is_free(from + (to - from) * (static_cast<double>(first) / pieces))) ++first;
      const bool inner = first >= pieces;
      ASSERT_EQ(checker.edge_stays_free(from, to, step, true), inner);
      ASSERT_EQ(checker.edge_stays_free(from, to, step), inner && reference.is_free(to));
      ASSERT_EQ(checker.edge_is_free(from, to, step), inner && reference.is_free(to));
      ++(inner ? free : hit);
    }
    EXPECT_GT(free, 10);
    EXPECT_GT(hit, 10);
  }
}

TEST(Edge, WorkspaceStepFindsWhatJointStepsJumpOver) {
  World world;
  world.add("wire", Box{{0.002, 2, 2}}, pose_from_xyz_rpy({0.371, 0, 0}, {0, 0, 0}));
  CollisionChecker checker(free_body::group({free_body::link_shape(Sphere{0.001})}), world);
  EdgeOptions options;
  options.joint_step = 0.1;
  EXPECT_TRUE(check_edge(checker, at(-1, 0, 0), at(1, 0, 0), options).free);
  options.workspace_step = 0.002;
  const EdgeResult result = check_edge(checker, at(-1, 0, 0), at(1, 0, 0), options);
  EXPECT_FALSE(result.free);
  EXPECT_NEAR(-1 + 2 * result.fraction, 0.371, 0.004);
  ASSERT_TRUE(result.contact.has_value());
  EXPECT_EQ(result.contact->a, "body");
  EXPECT_EQ(result.contact->b, "wire");
  EXPECT_TRUE(result.contact->with_scene);
}

TEST(Edge, NoPointMovesMoreThanTheBound) {
  MMGRASP_NEEDS_SHARED_DATA();
  RobotOptions load;
  load.base = BaseKind::diff_drive;
  load.package_dirs["example-robot-data"] = shared("robots/tiago/example-robot-data");
  const Robot tiago = Robot::load(
      shared("robots/tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf"), "", load);
  World world;
  world.add("bar", Box{{0.02, 0.02, 0.8}}, Pose::Identity());
  world.attach("bar", "arm_tool_link", pose_from_xyz_rpy({0.1, 0, 0.3}, {0.3, 0.2, 0}));
  const JointGroup groups[] = {tiago.chain("torso_fixed_link", "arm_7_link"),
                               tiago.chain("torso_fixed_link", "arm_7_link", true)};
  for (const JointGroup& group : groups) {
    const CollisionChecker checker(group, world);
    const Eigen::VectorXd bounds = motion_bounds(checker);
    ASSERT_EQ(bounds.size(), group.size());
    // Vertices of every moving link's shapes, and the bar's.
    std::vector<std::pair<int, Eigen::Vector3d>> points;
    const auto add = [&](int link, const Pose& T, const Shape& shape) {
      const auto mesh = shape_mesh(shape);
      for (std::size_t v = 0; v < mesh->vertices.size(); v += 1 + mesh->vertices.size() / 40)
        points.emplace_back(link, T * mesh->vertices[v]);
    };
    for (const int link : group.moving_links()) {
      for (const LinkShape& shape : tiago.links()[link].collisions) add(link, shape.T_link_shape, shape.shape);
    }
    const AttachedObject& bar = world.attached().at("bar");
    add(tiago.link_index(bar.link), bar.T_link_object, bar.shapes[0].shape);
    Rng rng(3);
    Poses before, after;
    Eigen::VectorXd tightest = Eigen::VectorXd::Zero(group.size());
    for (int n = 0; n < 300; ++n) {
      Eigen::VectorXd q = rng.uniform(group.sample_lower(), group.sample_upper());
      if (group.has_base()) q.head<2>() << rng.uniform(-3, 3), rng.uniform(-3, 3);
      for (int i = 0; i < group.size(); ++i) {
        Eigen::VectorXd moved = q;
        moved[i] += 1e-4;
        group.link_poses(q, before);
        group.link_poses(moved, after);
        double most = 0;
        for (const auto& [link, p] : points) most = std::max(most, (after[link] * p - before[link] * p).norm());
        ASSERT_LE(most, bounds[i] * 1e-4 * (1 + 1e-6)) << group.names()[i];
        tightest[i] = std::max(tightest[i], most / 1e-4);
      }
    }
    // A bound that is far too large would be true and useless.
    for (int i = 0; i < group.size(); ++i) EXPECT_LT(bounds[i], 3 * tightest[i] + 0.5) << group.names()[i];
  }
}

TEST(Edge, BatchesAnswerAlikeOnAnyNumberOfThreads) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda_arm();
  CollisionChecker checker(group, clutter(2, 20));
  Rng rng(8);
  Eigen::MatrixXd Q(group.size(), 1500);
  for (Eigen::Index i = 0; i < Q.cols(); ++i) Q.col(i) = rng.uniform(group.lower(), group.upper());
  const std::vector<char> one = are_free(checker, Q, 1);
  EXPECT_EQ(are_free(checker, Q, 8), one);
  int free = 0;
  for (Eigen::Index i = 0; i < Q.cols(); ++i) {
    ASSERT_EQ(one[i] != 0, checker.is_free(Q.col(i)));
    free += one[i];
  }
  EXPECT_GT(free, 100);
  EXPECT_LT(free, 1400);
  EXPECT_TRUE(are_free(checker, Eigen::MatrixXd(group.size(), 0)).empty());
  EXPECT_THROW(are_free(checker, Eigen::MatrixXd::Zero(group.size() + 1, 2)), InvalidInput);
  Q(3, 17) = std::numeric_limits<double>::quiet_NaN();
  try {
    are_free(checker, Q);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("17"), std::string::npos) << error.what();
  }
}

TEST(Edge, BadOptionsAreNamed) {
  CollisionChecker checker(free_body::group({free_body::link_shape(Sphere{0.1})}), World());
  EdgeOptions options;
  options.joint_step = 0;
  EXPECT_THROW(check_edge(checker, at(0, 0, 0), at(1, 0, 0), options), InvalidInput);
  options = {};
  options.workspace_step = -1;
  EXPECT_THROW(check_edge(checker, at(0, 0, 0), at(1, 0, 0), options), InvalidInput);
  options = {};
  options.tolerance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(check_edge(checker, at(0, 0, 0), at(1, 0, 0), options), InvalidInput);
  EXPECT_THROW(check_edge(checker, Eigen::VectorXd::Zero(5), at(1, 0, 0)), InvalidInput);
  EXPECT_TRUE(check_edge(checker, at(0, 0, 0), at(0, 0, 0)).free);
  const EdgeResult beyond = check_edge(checker, at(0, 0, 9.9), at(0, 0, 10.3));
  EXPECT_FALSE(beyond.free);
  EXPECT_FALSE(beyond.contact.has_value());
  EXPECT_NEAR(beyond.fraction, 0.3, 1e-9);  // the first of 20 steps beyond 10
}
