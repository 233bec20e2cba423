#include "mmgrasp/collision/detail/attached_checker.hpp"

#include <gtest/gtest.h>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/small_robots.hpp"

// One checker whose object is turned in the hand must say what a checker made for that pose says.
namespace mmgrasp::detail {
namespace {

struct Cell {
  Robot robot = Robot::from_strings(test::seven_joint_urdf(), "");
  JointGroup group = robot.chain(robot.links().front().name, robot.links().back().name);

  World world(const Pose& T_link_part, const std::string& link) const {
    World world;
    Pose T = Pose::Identity();
    T.translation() = Eigen::Vector3d(0.5, 0.1, 0.4);
    world.add("table", Shape(Box{{0.5, 0.8, 0.05}}), T);
    T.translation() = Eigen::Vector3d(0, 0, -0.3);
    world.add("floor", Shape(Plane{}), T);
    LinkShape bar, end;
    bar.shape = Box{{0.05, 0.4, 0.05}};
    end.shape = Cylinder{0.03, 0.2};
    end.T_link_shape.translation() = Eigen::Vector3d(0.1, 0.2, 0);
    world.add("part", WorldObject{{bar, end}, Pose::Identity()});
    world.attach("part", link, T_link_part);
    return world;
  }
};

Pose random_pose(Rng& rng) {
  Pose T = Pose::Identity();
  T.linear() = rng.rotation().toRotationMatrix();
  T.translation() = 0.15 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
  return T;
}

TEST(AttachedChecker, SaysWhatACheckerMadeForThePoseSays) {
  const Cell cell;
  // On the last link, on one in the middle (constant pairs differ), and on the one that never moves.
  for (const std::size_t link : {cell.robot.links().size() - 1, std::size_t{3}, std::size_t{0}}) {
    const std::string& name = cell.robot.links()[link].name;
    for (const bool attached_only : {true, false}) {
      Rng rng(7);
      CheckerOptions options;
      options.attached_only = attached_only;
      AttachedChecker turned(cell.group, cell.world(random_pose(rng), name), options);
      EdgeOptions edge;
      edge.workspace_step = 0.01;
      int free = 0, blocked = 0, free_edges = 0, blocked_edges = 0;
      for (int i = 0; i < 25; ++i) {
        const Pose T = random_pose(rng);
        CollisionChecker made(cell.group, cell.world(T, name), options);
        turned.place_attached(T);
        for (int k = 0; k < 40; ++k) {
          const Eigen::VectorXd a = rng.uniform(cell.group.sample_lower(), cell.group.sample_upper());
          const Eigen::VectorXd b = a + 0.1 * rng.uniform(cell.group.sample_lower(), cell.group.sample_upper());
          EXPECT_EQ(turned.is_free(a), made.is_free(a));
          EXPECT_EQ(turned.rejection(a), made.rejection(a));
          ++(made.is_free(a) ? free : blocked);
          // Steps need not be the same ones: the attached object's motion bounds them alone, not the robot's.
          const bool expected = check_edge(made, a, b, edge).free;
          if (!attached_only) {
            EXPECT_EQ(turned.edge_is_free(a, b, edge), expected);
          }
          edge.joint_step = 0.02;
          EXPECT_EQ(turned.edge_is_free(a, b, {0.02}), check_edge(made, a, b, {0.02}).free);
          ++(expected ? free_edges : blocked_edges);
        }
      }
      EXPECT_GT(blocked, 20);
      EXPECT_GT(blocked_edges, 20);
      if (link > 0) {
        EXPECT_GT(free, 50);
        EXPECT_GT(free_edges, 20);
      }
    }
  }
}

TEST(AttachedChecker, RefusesWorldsWithoutOneAttachedObject) {
  const Cell cell;
  EXPECT_THROW(AttachedChecker(cell.group, World()), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp::detail
