#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

Eigen::VectorXd random_values(const Robot& robot, Rng& rng) {
  Eigen::VectorXd values(robot.value_count());
  for (const Joint& joint : robot.joints())
    for (int i = 0; joint.value_index >= 0 && i < joint.value_count(); ++i)
      values[joint.value_index + i] = rng.uniform(std::max(joint.lower, -3.0), std::min(joint.upper, 3.0));
  return values;
}

void expect_same_robot(const Robot& a, const Robot& b) {
  ASSERT_EQ(a.links().size(), b.links().size());
  ASSERT_EQ(a.value_count(), b.value_count());
  Rng rng(31);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd values = random_values(a, rng);
    const Poses pa = a.link_poses(values), pb = b.link_poses(values);
    for (std::size_t l = 0; l < pa.size(); ++l) EXPECT_LT((pa[l].matrix() - pb[l].matrix()).norm(), 1e-12);
  }
  for (std::size_t l = 0; l < a.links().size(); ++l) {
    const Link &x = a.links()[l], &y = b.links()[l];
    EXPECT_EQ(x.name, y.name);
    ASSERT_EQ(x.collisions.size(), y.collisions.size());
    for (std::size_t s = 0; s < x.collisions.size(); ++s) {
      const Eigen::AlignedBox3d bx = shape_bounds(x.collisions[s].shape, x.collisions[s].T_link_shape);
      const Eigen::AlignedBox3d by = shape_bounds(y.collisions[s].shape, y.collisions[s].T_link_shape);
      EXPECT_EQ(x.collisions[s].shape.index(), y.collisions[s].shape.index());
      EXPECT_LT((bx.min() - by.min()).norm() + (bx.max() - by.max()).norm(), 1e-12) << x.name;
    }
  }
  for (std::size_t j = 0; j < a.joints().size(); ++j) {
    const Joint &x = a.joints()[j], &y = b.joints()[j];
    EXPECT_EQ(x.name, y.name);
    EXPECT_EQ(x.type, y.type);
    EXPECT_EQ(x.lower, y.lower);
    EXPECT_EQ(x.upper, y.upper);
    EXPECT_EQ(x.velocity, y.velocity);
    EXPECT_EQ(x.effort, y.effort);
    EXPECT_EQ(x.mimic_joint, y.mimic_joint);
    EXPECT_EQ(x.mimic_multiplier, y.mimic_multiplier);
    EXPECT_EQ(x.mimic_offset, y.mimic_offset);
  }
  EXPECT_EQ(a.disabled_pairs(), b.disabled_pairs());
  ASSERT_EQ(a.groups().size(), b.groups().size());
  for (std::size_t g = 0; g < a.groups().size(); ++g) {
    EXPECT_EQ(a.groups()[g].name, b.groups()[g].name);
    EXPECT_EQ(a.groups()[g].joints, b.groups()[g].joints);
    EXPECT_EQ(a.groups()[g].links, b.groups()[g].links) << a.groups()[g].name;
    EXPECT_EQ(a.groups()[g].tip_link, b.groups()[g].tip_link);
  }
  EXPECT_EQ(a.group_states(), b.group_states());
  EXPECT_EQ(a.end_effectors().size(), b.end_effectors().size());
}

Robot reload(const Robot& robot) {
  const Robot again = Robot::from_strings(robot.to_urdf(), robot.to_srdf());
  EXPECT_TRUE(again.report().warnings.empty()) << again.report().warnings.front();
  return again;
}

Robot load_full(const std::string& urdf, const std::string& srdf = "", BaseKind base = BaseKind::fixed) {
  RobotOptions options;
  options.base = base;
  return Robot::load(shared(urdf), srdf.empty() ? "" : shared(srdf), options);
}

const char* kGripper2f85 = "robots/robotiq_2f85/robotiq_arg85_description/robots/robotiq_arg85_description.URDF";

}  // namespace

TEST(RobotCompose, WrittenRobotsReloadIdentically) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot panda = load_full("robots/panda/expanded/panda.urdf",
                                "robots/panda/moveit_resources_panda_moveit_config/config/panda.srdf");
  expect_same_robot(panda, reload(panda));
  for (const char* urdf :
       {kGripper2f85, "robots/ur/expanded/ur5e.urdf", "robots/wsg50/wsg_50_simulation/urdf/wsg_50.urdf"}) {
    const Robot robot = load_full(urdf);
    expect_same_robot(robot, reload(robot));
  }
  // Writing what was read back changes nothing more: rpy angles are printed with all their digits.
  EXPECT_EQ(reload(panda).to_srdf(), panda.to_srdf());
}

TEST(RobotCompose, GripperOnTiagoStandsWhereItWasPut) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot base = load_full("robots/tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf",
                               "robots/tiago/tiago_moveit_config/config/srdf/tiago_no-ee.srdf", BaseKind::diff_drive);
  const Robot gripper = load_full(kGripper2f85);
  const Pose T_tool_gripper = pose_from_xyz_rpy({0.01, -0.02, 0.03}, {0.1, 0.2, 0.3});
  const Robot robot = base.mount(gripper, "arm_tool_link", T_tool_gripper, "g_");
  EXPECT_EQ(robot.links().size(), base.links().size() + gripper.links().size());
  EXPECT_EQ(robot.value_count(), base.value_count() + gripper.value_count());
  EXPECT_EQ(robot.base(), BaseKind::diff_drive);
  EXPECT_TRUE(robot.has_srdf());

  Rng rng(32);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd values = random_values(robot, rng);
    Eigen::VectorXd base_values(base.value_count()), gripper_values(gripper.value_count());
    const auto pick = [&](const Robot& part, const std::string& prefix, Eigen::VectorXd& out) {
      for (const Joint& joint : part.joints())
        if (joint.value_index >= 0)
          out[joint.value_index] = values[robot.joints()[robot.joint_index(prefix + joint.name)].value_index];
    };
    pick(base, "", base_values);
    pick(gripper, "g_", gripper_values);
    const Poses whole = robot.link_poses(values), below = base.link_poses(base_values);
    const Pose T_world_gripper = below[base.link_index("arm_tool_link")] * T_tool_gripper;
    const Poses above = gripper.link_poses(gripper_values, T_world_gripper);
    for (std::size_t l = 0; l < base.links().size(); ++l)
      EXPECT_LT((whole[robot.link_index(base.links()[l].name)].matrix() - below[l].matrix()).norm(), 1e-12);
    for (std::size_t l = 0; l < gripper.links().size(); ++l)
      EXPECT_LT((whole[robot.link_index("g_" + gripper.links()[l].name)].matrix() - above[l].matrix()).norm(), 1e-12);
  }

  // Disabled pairs of the base are kept, the mounting pair is adjacent, the rest between the two is checked.
  for (const auto& [pair, reason] : base.disabled_pairs())
    EXPECT_TRUE(robot.pair_disabled(robot.link_index(base.links()[pair.first].name),
                                    robot.link_index(base.links()[pair.second].name)));
  const int root = robot.link_index("g_" + gripper.links()[0].name);
  EXPECT_TRUE(robot.pair_disabled(robot.link_index("arm_tool_link"), root));
  EXPECT_FALSE(robot.pair_disabled(robot.link_index("base_link"), root));
  expect_same_robot(robot, reload(robot));

  // The arm's SRDF group takes its tip beyond its own end, and IK reaches with it.
  const Robot with_tcp =
      robot.with_link("tcp", "g_" + gripper.links()[0].name, pose_from_xyz_rpy({0, 0, 0.15}, {0, 0, 0}));
  const JointGroup arm = with_tcp.group("arm_torso", "tcp");
  EXPECT_EQ(arm.size(), 8);
  const Eigen::VectorXd q = rng.uniform(arm.sample_lower(), arm.sample_upper());
  EXPECT_EQ(solve_ik(arm, arm.fk(q), (arm.sample_lower() + arm.sample_upper()) / 2).outcome, Outcome::solved);
}

TEST(RobotCompose, TwoOfTheSameArmKeepTheirSrdf) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot arm = load_full("robots/panda/expanded/panda.urdf",
                              "robots/panda/moveit_resources_panda_moveit_config/config/panda.srdf");
  const Robot table = Robot::from_strings(
      "<robot name='table'><link name='top'><collision><geometry><box size='1 1 "
      "0.1'/></geometry></collision></link></robot>");
  const Robot both = table.mount(arm, "top", pose_from_xyz_rpy({0, 0.4, 0.05}, {0, 0, 0}), "left_")
                         .mount(arm, "top", pose_from_xyz_rpy({0, -0.4, 0.05}, {0, 0, M_PI}), "right_");
  EXPECT_EQ(both.groups().size(), 6u);
  const JointGroup left = both.group("left_panda_arm"), right = both.group("right_panda_arm"),
                   alone = arm.group("panda_arm");
  Rng rng(33);
  const Eigen::VectorXd q = rng.uniform(left.lower(), left.upper());
  EXPECT_LT((left.fk(q).matrix() - (pose_from_xyz_rpy({0, 0.4, 0.05}, {0, 0, 0}) * alone.fk(q)).matrix()).norm(),
            1e-12);
  EXPECT_LT((right.fk(q).matrix() - (pose_from_xyz_rpy({0, -0.4, 0.05}, {0, 0, M_PI}) * alone.fk(q)).matrix()).norm(),
            1e-12);
  EXPECT_EQ(both.group_states().at("right_panda_arm").at("ready").at("right_panda_joint4"), -2.356);
  EXPECT_TRUE(both.pair_disabled(both.link_index("left_panda_leftfinger"), both.link_index("left_panda_link3")));
  EXPECT_FALSE(both.pair_disabled(both.link_index("left_panda_link5"), both.link_index("right_panda_link5")));
  EXPECT_TRUE(both.pair_disabled(both.link_index("top"), both.link_index("right_panda_link0")));
  expect_same_robot(both, reload(both));

  // Without a prefix the robot's name is used; mounting twice under one prefix is refused by name.
  EXPECT_TRUE(table.mount(arm, "top", Pose::Identity()).has_link("panda_panda_link0"));
  EXPECT_THROW(both.mount(arm, "top", Pose::Identity(), "left_"), InvalidInput);
  EXPECT_THROW(both.mount(arm, "nowhere", Pose::Identity(), "x_"), InvalidInput);
  Pose broken = Pose::Identity();
  broken.linear() *= 2;
  EXPECT_THROW(both.mount(arm, "top", broken, "x_"), InvalidInput);
}

TEST(RobotCompose, WithLinkAddsShapesAndChecksThem) {
  const Robot table = Robot::from_strings("<robot name='t'><link name='a'/></robot>");
  LinkShape bin;
  bin.shape = Capsule{0.1, 0.3};
  bin.T_link_shape = pose_from_xyz_rpy({0, 0, 0.2}, {0.3, 0, 0});
  const Robot robot = table.with_link("bin", "a", pose_from_xyz_rpy({1, 0, 0}, {0, 0, 0.5}), {bin});
  EXPECT_LT((robot.link_poses(robot.default_values())[1].translation() - Eigen::Vector3d(1, 0, 0)).norm(), 1e-15);
  expect_same_robot(robot, reload(robot));
  EXPECT_NE(robot.hash(), table.hash());
  EXPECT_THROW(robot.with_link("bin", "a", Pose::Identity()), InvalidInput);
  bin.shape = Sphere{0};
  EXPECT_THROW(table.with_link("ball", "a", Pose::Identity(), {bin}), InvalidInput);
  bin.shape = Plane{};
  EXPECT_THROW(table.with_link("floor", "a", Pose::Identity(), {bin}), InvalidInput);
  bin.shape = MeshShape{convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})};
  EXPECT_THROW(table.with_link("hull", "a", Pose::Identity(), {bin}).to_urdf(), InvalidInput);
}
