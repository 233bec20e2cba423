#include "mmgrasp/robot/joint_group.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/kinematics_support.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

const char* kMimicUrdf = R"(
<robot name="mimic">
  <link name="root"/><link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="tip"/>
  <joint name="j1" type="revolute"><parent link="root"/><child link="a"/><origin xyz="0 0 0.5" rpy="0.1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="j2" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.4 0 0" rpy="0 0.2 0"/>
    <axis xyz="1 2 2"/><limit lower="-2" upper="2" velocity="1"/>
    <mimic joint="j1" multiplier="-0.5" offset="0.3"/></joint>
  <joint name="j3" type="prismatic"><parent link="b"/><child link="c"/><origin xyz="0.1 0.2 0" rpy="0 0 0.3"/>
    <axis xyz="0 0 -1"/><limit lower="-1" upper="1" velocity="1"/></joint>
  <joint name="j4" type="prismatic"><parent link="c"/><child link="d"/>
    <axis xyz="0 3 0"/><limit lower="-9" upper="9" velocity="1"/><mimic joint="j2" multiplier="2" offset="0.1"/></joint>
  <joint name="jt" type="fixed"><parent link="d"/><child link="tip"/><origin xyz="0 0 0.3" rpy="0 0.4 0"/></joint>
</robot>)";

}  // namespace

TEST(JointGroup, MatchesPinocchioReference) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Json reference = Json::read(shared("reference/transcribed/fk_pinocchio.json"));
  int cases = 0;
  for (const auto& [name, entry] : reference["robots"].object) {
    const Robot robot = load_kinematics("robots/" + entry["urdf"].string);
    const JointGroup group = robot.chain(robot.links()[0].name, entry["tip"].string);
    ASSERT_EQ(group.names().size(), entry["joints"].array.size());
    for (const Json& test : entry["cases"].array) {
      Eigen::VectorXd q(group.size());
      for (int i = 0; i < group.size(); ++i) {
        EXPECT_EQ(group.names()[i], entry["joints"].array[i].string);
        q[i] = test["q"][group.names()[i]].number;
      }
      Pose T;
      Matrix6Xd J(6, group.size());
      group.fk_jacobian(q, T, J);
      EXPECT_LT((T.translation() - test["p"].vector()).cwiseAbs().maxCoeff(), 1e-8) << name;
      const Pose expected = pose_from_xyz_quat({0, 0, 0}, test["quat"].vector());
      EXPECT_LT(rotation_distance(expected, T), 1e-8) << name;
      for (int row = 0; row < 6; ++row)
        EXPECT_LT((J.row(row).transpose() - test["J"].array[row].vector()).cwiseAbs().maxCoeff(), 1e-8) << name;
      ++cases;
    }
  }
  EXPECT_EQ(cases, 48);
}

TEST(JointGroup, MatchesKdlOnRandomConfigurations) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot ur = load_kinematics("robots/ur/expanded/ur5e.urdf");
  for (const JointGroup& group :
       {panda().group("panda_arm"), tiago().group("arm_torso"), ur.chain("base_link", "tool0")}) {
    Rng rng(11);
    for (int i = 0; i < 200; ++i) {
      const Eigen::VectorXd q = random_configuration(group, rng);
      expect_kdl_agrees(group, q);
      Pose T;
      Matrix6Xd J(6, group.size());
      group.fk_jacobian(q, T, J);
      EXPECT_EQ((group.fk(q).matrix() - T.matrix()).norm(), 0.0);
      EXPECT_EQ((group.jacobian(q) - J).norm(), 0.0);
    }
  }
}

TEST(JointGroup, JacobianMatchesFiniteDifferencesWithBaseAndMimic) {
  const Robot mimic = Robot::from_strings(kMimicUrdf);
  std::vector<JointGroup> groups{mimic.chain("root", "tip"),
                                 mimic.chain("root", "tip").at(pose_from_xyz_rpy({30, -70, 1}, {1, 2, 3}))};
  RobotOptions omni;
  omni.base = BaseKind::omni;
  groups.push_back(Robot::from_strings(kMimicUrdf, "", omni).chain("root", "tip", true));
  Rng rng(12);
  for (const JointGroup& group : groups)
    for (int i = 0; i < 50; ++i) {
      const Eigen::VectorXd q = random_configuration(group, rng);
      EXPECT_LT((group.jacobian(q) - numeric_jacobian(group, q)).cwiseAbs().maxCoeff(), 2e-7);
      expect_link_poses_agree(group, q);
    }
}

TEST(JointGroup, MimicJointsFollowInClosedForm) {
  const Robot robot = Robot::from_strings(kMimicUrdf);
  EXPECT_EQ(robot.value_count(), 2);
  const JointGroup group = robot.chain("root", "tip");
  EXPECT_EQ(group.names(), (std::vector<std::string>{"j1", "j3"}));
  const Eigen::Vector2d q(0.7, -0.2);
  const double q2 = -0.5 * 0.7 + 0.3, q4 = 2 * q2 + 0.1;
  const Pose expected = pose_from_xyz_rpy({0, 0, 0.5}, {0.1, 0, 0}) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                        pose_from_xyz_rpy({0.4, 0, 0}, {0, 0.2, 0}) *
                        Eigen::AngleAxisd(q2, Eigen::Vector3d(1, 2, 2) / 3) *
                        pose_from_xyz_rpy({0.1, 0.2, 0}, {0, 0, 0.3}) * Eigen::Translation3d(0, 0, 0.2) *
                        Eigen::Translation3d(0, q4, 0) * pose_from_xyz_rpy({0, 0, 0.3}, {0, 0.4, 0});
  EXPECT_LT((group.fk(q).matrix() - expected.matrix()).norm(), 1e-14);
}

TEST(JointGroup, BaseColumnsMoveTheRootOverTheFloor) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot robot = tiago();
  const JointGroup arm = robot.group("arm_torso"), whole = robot.group("arm_torso", "", true);
  EXPECT_EQ(whole.size(), arm.size() + 3);
  EXPECT_EQ(whole.names()[2], "theta");
  EXPECT_TRUE(whole.wraps()[2]);
  EXPECT_EQ(whole.moving_links().size(), robot.links().size());
  Rng rng(5);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = random_configuration(whole, rng);
    const Pose T_world_base = pose_from_planar(q.head<3>());
    EXPECT_LT((whole.fk(q).matrix() - (T_world_base * arm.fk(q.tail(arm.size()))).matrix()).norm(), 1e-12);
    EXPECT_LT((arm.at(T_world_base).fk(q.tail(arm.size())).matrix() - whole.fk(q).matrix()).norm(), 1e-12);
    expect_link_poses_agree(whole, q);
  }
  EXPECT_THROW(whole.at(Pose::Identity()), InvalidInput);
  EXPECT_THROW(tiago(BaseKind::fixed).group("arm_torso", "", true), InvalidInput);
}

TEST(JointGroup, MovedOnlyRecomputesExactlyWhatMoves) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = tiago().group("arm");
  Rng rng(6);
  const Eigen::VectorXd a = random_configuration(group, rng), b = random_configuration(group, rng);
  Poses reused, fresh, first;
  group.link_poses(a, reused);
  first = reused;
  group.link_poses(b, reused, true);
  group.link_poses(b, fresh);
  std::vector<int> moved;
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    EXPECT_EQ((fresh[i].matrix() - reused[i].matrix()).norm(), 0.0);
    if ((fresh[i].matrix() - first[i].matrix()).norm() > 1e-12) moved.push_back(static_cast<int>(i));
  }
  EXPECT_EQ(moved, group.moving_links());
  EXPECT_TRUE(std::is_sorted(moved.begin(), moved.end()));
}

TEST(JointGroup, ReferenceHoldsTheOtherJoints) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot robot = tiago();
  const Eigen::VectorXd lifted = robot.values({{"torso_lift_joint", 0.3}, {"head_1_joint", 0.5}});
  const JointGroup low = robot.group("arm"), high = low.with_reference(lifted);
  Rng rng(7);
  const Eigen::VectorXd q = random_configuration(low, rng);
  EXPECT_LT((high.fk(q).translation() - low.fk(q).translation() - Eigen::Vector3d(0, 0, 0.3)).norm(), 1e-12);
  expect_link_poses_agree(high, q);
  EXPECT_EQ(high.full_values(q).size(), robot.value_count());
  EXPECT_THROW(low.with_reference(Eigen::VectorXd::Zero(3)), InvalidInput);
}

TEST(JointGroup, TipMayBeAnyLinkTheLastJointCarries) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot robot = panda().with_link("tcp", "panda_hand", pose_from_xyz_rpy({0, 0, 0.1034}, {0, 0, 0}));
  const JointGroup flange = robot.group("panda_arm"), tcp = robot.group("panda_arm", "tcp");
  Rng rng(8);
  const Eigen::VectorXd q = random_configuration(flange, rng);
  const Pose T_flange_hand = pose_from_xyz_rpy({0, 0, 0.1034}, {0, 0, -M_PI / 4});
  EXPECT_LT((tcp.fk(q).matrix() - (flange.fk(q) * T_flange_hand).matrix()).norm(), 1e-9);  // URDF prints pi/4 rounded
  EXPECT_NO_THROW(robot.group("panda_arm", "panda_leftfinger"));
  EXPECT_THROW(robot.group("panda_arm", "panda_link3"), InvalidInput);
  EXPECT_THROW(robot.group("panda_arm", "no_such_link"), InvalidInput);
  EXPECT_THROW(robot.group("panda_amr"), InvalidInput);
  EXPECT_THROW(robot.chain("panda_link5", "panda_link2"), InvalidInput);
  EXPECT_THROW(robot.chain("panda_link8", "panda_hand"), InvalidInput);  // nothing moves
}

TEST(JointGroup, LimitsWrapsAndDefaults) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  EXPECT_NEAR(group.lower()[3], -3.1416, 1e-12);
  EXPECT_NEAR(group.velocity_limits()[0], 2.3925, 1e-12);
  EXPECT_NEAR(group.acceleration_limits()[0], 4 * 2.3925, 1e-12);
  Eigen::VectorXd q = group.lower();
  EXPECT_TRUE(group.within_limits(q));
  q[2] -= 1e-6;
  EXPECT_FALSE(group.within_limits(q));
  EXPECT_TRUE(group.within_limits(q, 1e-5));
  q[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(group.within_limits(q));
  EXPECT_THROW(group.check_configuration(q, "goal"), InvalidInput);
  EXPECT_THROW(group.check_configuration(Eigen::VectorXd::Zero(6), "goal"), InvalidInput);
  const Eigen::VectorXd faster = Eigen::VectorXd::Constant(7, 12.0);
  EXPECT_EQ(group.with_acceleration_limits(faster).acceleration_limits(), faster);
  EXPECT_THROW(group.with_acceleration_limits(-faster), InvalidInput);
}

TEST(JointGroup, EveryWayThroughThePr2MatchesKdlOnEveryInstructionSet) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot robot = load_kinematics("reference/trac_ik/launch/pr2.urdf");
  std::vector<JointGroup> chains;
  for (const Link& link : robot.links()) {
    // KDL chains know no mimic joints: ends below one are left to the comparison with Robot::link_poses.
    bool plain = true, moves = false;
    for (int at = robot.link_index(link.name); at > 0; at = robot.joints()[at - 1].parent_link) {
      plain = plain && robot.joints()[at - 1].mimic_joint < 0;
      moves = moves || robot.joints()[at - 1].value_index >= 0;
    }
    if (plain && moves) chains.push_back(robot.chain(robot.links()[0].name, link.name));
  }
  EXPECT_GE(chains.size(), 60u);
  on_every_instruction_set([&] {
    Rng rng(21);
    for (const JointGroup& group : chains) {
      SCOPED_TRACE(group.name());
      for (int i = 0; i < 5; ++i) {
        const Eigen::VectorXd q = random_configuration(group, rng);
        expect_kdl_agrees(group, q);
        expect_link_poses_agree(group, q);
      }
    }
  });
}

TEST(JointGroup, PointJacobianMatchesKdlOnChains) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot robot = panda();
  const JointGroup arm = robot.group("panda_arm");
  Rng rng(31);
  for (const char* name : {"panda_link8", "panda_link5", "panda_link2"}) {
    const JointGroup part = robot.chain("panda_link0", name);
    for (int i = 0; i < 20; ++i) {
      const Eigen::VectorXd q = random_configuration(arm, rng);
      const Eigen::Vector3d point = rng.uniform(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1));
      Pose T;
      Matrix6Xd expected;
      ASSERT_NO_FATAL_FAILURE(kdl_kinematics(part, q.head(part.size()), point, T, expected));
      const Matrix6Xd J = arm.jacobian(q, robot.link_index(name), point);
      EXPECT_LT((J.leftCols(part.size()) - expected).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_EQ(J.rightCols(arm.size() - part.size()).norm(), 0.0);
      Poses poses;
      arm.link_poses(q, poses);
      Matrix6Xd in_place(6, arm.size());
      arm.point_jacobian(poses, q, robot.link_index(name), T.translation(), in_place);
      EXPECT_LT((in_place - J).cwiseAbs().maxCoeff(), 1e-12);
    }
  }
  EXPECT_LT(
      (arm.jacobian(arm.sample_lower(), arm.tip_link(), Eigen::Vector3d::Zero()) - arm.jacobian(arm.sample_lower()))
          .norm(),
      1e-12);
  EXPECT_THROW(arm.jacobian(arm.sample_lower(), -1, Eigen::Vector3d::Zero()), InvalidInput);
  EXPECT_THROW(arm.jacobian(arm.sample_lower(), 1000, Eigen::Vector3d::Zero()), InvalidInput);
}

TEST(JointGroup, PointJacobianMatchesFiniteDifferencesOnTreesWithBaseAndMimic) {
  MMGRASP_NEEDS_SHARED_DATA();
  RobotOptions omni;
  omni.base = BaseKind::omni;
  const std::vector<JointGroup> groups{tiago().group("arm_torso", "", true), two_hands().group("all", "left_tip"),
                                       Robot::from_strings(kMimicUrdf, "", omni).chain("root", "tip", true)};
  Rng rng(32);
  for (const JointGroup& group : groups) {
    const int links = static_cast<int>(group.robot().links().size());
    for (int link = 0; link < links; ++link) {
      SCOPED_TRACE(group.robot().links()[link].name);
      Eigen::VectorXd q = random_configuration(group, rng);
      if (group.has_base()) q.head<2>() /= 50;
      const Eigen::Vector3d point(0.3, -0.2, 0.5);
      EXPECT_LT((group.jacobian(q, link, point) - numeric_jacobian(group, q, link, point)).cwiseAbs().maxCoeff(), 2e-8);
    }
  }
}

TEST(JointGroup, TreesWithAMimicInTheOtherBranch) {
  const JointGroup right = two_hands().group("all", "right_tip"), left = two_hands().group("all", "left_tip");
  const JointGroup mobile = two_hands(BaseKind::omni).group("all", "right_tip", true);
  on_every_instruction_set([&] {
    Rng rng(33);
    for (const JointGroup& group : {right, left, mobile})
      for (int i = 0; i < 20; ++i) {
        Eigen::VectorXd q = random_configuration(group, rng);
        if (group.has_base()) q.head<2>() /= 50;
        expect_link_poses_agree(group, q);
        // Storage that is not clean beforehand, and wider than the Jacobian.
        Eigen::MatrixXd storage = Eigen::MatrixXd::Constant(9, group.size(), 7.0);
        Eigen::Map<Matrix6Xd, 0, Eigen::OuterStride<>> J(storage.data(), 6, group.size(), Eigen::OuterStride<>(9));
        Pose T;
        group.fk_jacobian(q, T, J);
        EXPECT_LT((J - numeric_jacobian(group, q)).cwiseAbs().maxCoeff(), 2e-8);
        EXPECT_EQ((storage.bottomRows(3).array() - 7.0).matrix().norm(), 0.0);
        if (group.tip_link() == left.tip_link()) {
          EXPECT_EQ(J.col(2).norm(), 0.0);
        }
      }
  });
}

TEST(JointGroup, FarAngles) {
  const Robot robot = Robot::from_strings(R"(<robot name="wheel"><link name="a"/><link name="b"/>
    <joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>)");
  const JointGroup group = robot.chain("a", "b");
  on_every_instruction_set([&] {
    const auto expect_turned = [&](double angle) {
      const Pose T = group.fk(Eigen::VectorXd::Constant(1, angle));
      Poses poses;
      group.link_poses(Eigen::VectorXd::Constant(1, angle), poses);
      for (const Pose& each : {T, poses[1]}) {
        EXPECT_NEAR(each(0, 0), std::cos(angle), 2.3e-16) << angle;  // an ulp below 1 is 1.1e-16
        EXPECT_NEAR(each(1, 0), std::sin(angle), 2.3e-16) << angle;
      }
    };
    Rng rng(41);
    for (int i = 0; i < 20000; ++i) expect_turned(rng.uniform(-20.0, 20.0));
    for (int i = 0; i < 20000; ++i) expect_turned(rng.uniform(-1e5, 1e5));
    for (int i = -200; i <= 200; ++i)
      for (const double off : {0.0, 1e-15, -1e-9, 1e-4}) expect_turned(i * M_PI_2 + off);
    for (const double angle : {1e5, -100000.1, 1e6, 3e9, -1e17, 1e300, 0.0, -0.0, 5e-324}) expect_turned(angle);
    // What is no number stays none, on every way.
    for (const double angle : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      EXPECT_TRUE(std::isnan(group.fk(Eigen::VectorXd::Constant(1, angle))(0, 0)));
      EXPECT_TRUE(std::isnan(group.jacobian(Eigen::VectorXd::Constant(1, angle)).sum()) ||
                  group.jacobian(Eigen::VectorXd::Constant(1, angle)).allFinite());
    }
  });
}
