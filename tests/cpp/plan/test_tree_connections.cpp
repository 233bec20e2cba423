#include "plan/manipulation/rrt_star_mg/tree_connections.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/tree_setting.hpp"

namespace mmgrasp::detail {
namespace {

using test::TreeSetting;

class Connecting : public ::testing::Test {
 protected:
  /// Makes a path of the first grasp through (-0.5, y) and (0.5, y); returns its length.
  double connect_at(double y) {
    const int a = setting_.add(setting_.root(0, GraspEnds::kStart), {-0.5, y, 0});
    const int b = setting_.add(setting_.root(0, GraspEnds::kGoal), {0.5, y, 0});
    connections_.add(b, a);
    return 2 * std::hypot(0.5, y) + 1;
  }

  TreeSetting setting_{test::three_grasps()};
  TreeConnections connections_{setting_.trees};
};

TEST_F(Connecting, TheCheapestLivingConnectionIsTheGraspsPath) {
  EXPECT_LT(connections_.update(0).connection, 0);
  const double far = connect_at(1), near = connect_at(0.2), middle = connect_at(0.5);
  EXPECT_NEAR(connections_.update(0).cost, near, 1e-12);
  TreeConnections::Branches path;
  ASSERT_TRUE(connections_.trace_path(0, path));
  ASSERT_EQ(path[0].size(), 2u);
  ASSERT_EQ(path[1].size(), 2u);
  EXPECT_EQ(path[0].back(), setting_.root(0, GraspEnds::kStart));
  EXPECT_EQ(path[1].back(), setting_.root(0, GraspEnds::kGoal));
  std::size_t crossing = 0;
  const std::vector<int> vertices = connections_.vertices(connections_.best(0).connection, crossing);
  EXPECT_EQ(crossing, 2u);
  EXPECT_EQ(vertices, (std::vector<int>{path[0][1], path[0][0], path[1][0], path[1][1]}));
  // A removed vertex takes its connections along.
  setting_.trees.remove_leaf(path[0][0]);
  EXPECT_FALSE(connections_.trace_path(0, path));
  EXPECT_NEAR(connections_.update(0).cost, middle, 1e-12);
  connections_.remove(0, connections_.best(0).connection);
  EXPECT_NEAR(connections_.update(0).cost, far, 1e-12);
  EXPECT_FALSE(connections_.any(1));
}

TEST_F(Connecting, CostsFollowRewiring) {
  connect_at(1);
  const int index = connections_.update(0).connection;
  const int a = connections_.connection(index).start_vertex;
  const int shortcut = setting_.add(setting_.root(0, GraspEnds::kStart), {-0.9, 0, 0});
  const double before = connections_.cost(index), change = setting_.trees.vertex(shortcut).cost +
                                                           setting_.trees.vertex_distance(shortcut, a) -
                                                           setting_.trees.vertex(a).cost;
  setting_.trees.reparent(a, shortcut, setting_.trees.vertex_distance(shortcut, a));
  EXPECT_NEAR(connections_.cost(index), before + change, 1e-12);
}

TEST_F(Connecting, DrawsOnlyGraspsThatHaveAPath) {
  connect_at(0.3);
  connections_.update(0);
  connections_.list_grasp(0);
  connections_.list_grasp(1);  // Has none.
  Rng rng(1);
  std::set<int> drawn;
  for (int i = 0; i < 50; ++i) drawn.insert(connections_.draw_grasp(rng, 3));
  EXPECT_EQ(drawn, (std::set<int>{-1, 0}));
  EXPECT_EQ(connections_.draw_grasp(rng, 0), -1);  // None can win any more.
  EXPECT_FALSE(connections_.any_listed());
}

}  // namespace
}  // namespace mmgrasp::detail
