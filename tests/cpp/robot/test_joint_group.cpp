#include "mmgrasp/robot/joint_group.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

Eigen::VectorXd random_configuration(const JointGroup& group, Rng& rng) {
  return rng.uniform(group.sample_lower(), group.sample_upper());
}

Matrix6Xd numeric_jacobian(const JointGroup& group, const Eigen::VectorXd& q) {
  const double h = 1e-6;
  Matrix6Xd J(6, group.size());
  for (int i = 0; i < group.size(); ++i) {
    Eigen::VectorXd a = q, b = q;
    a[i] -= h;
    b[i] += h;
    J.col(i) = pose_difference(group.fk(a), group.fk(b)) / (2 * h);
  }
  return J;
}

/// Group and Robot::link_poses must agree on every link; the latter is the plain, slow way.
void expect_link_poses_agree(const JointGroup& group, const Eigen::VectorXd& q) {
  const Poses expected = group.robot().link_poses(group.full_values(q), group.root_pose(q));
  Poses actual;
  group.link_poses(q, actual);
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i)
    EXPECT_LT((actual[i].matrix() - expected[i].matrix()).norm(), 1e-12) << group.robot().links()[i].name;
  EXPECT_LT((group.fk(q).matrix() - expected[static_cast<std::size_t>(group.tip_link())].matrix()).norm(), 1e-12);
}

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
        EXPECT_EQ(group.names()[static_cast<std::size_t>(i)],
                  entry["joints"].array[static_cast<std::size_t>(i)].string);
        q[i] = test["q"][group.names()[static_cast<std::size_t>(i)]].number;
      }
      Pose T;
      Matrix6Xd J(6, group.size());
      group.fk_jacobian(q, T, J);
      EXPECT_LT((T.translation() - test["p"].vector()).cwiseAbs().maxCoeff(), 1e-8) << name;
      const Pose expected = pose_from_xyz_quat({0, 0, 0}, test["quat"].vector());
      EXPECT_LT(rotation_distance(expected, T), 1e-8) << name;
      for (int row = 0; row < 6; ++row)
        EXPECT_LT(
            (J.row(row).transpose() - test["J"].array[static_cast<std::size_t>(row)].vector()).cwiseAbs().maxCoeff(),
            1e-8)
            << name;
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
    const KDL::Chain chain = kdl_chain(group.robot(), group.tip_link());
    ASSERT_EQ(static_cast<int>(chain.getNrOfJoints()), group.size());
    KDL::ChainFkSolverPos_recursive fk(chain);
    KDL::ChainJntToJacSolver jacobian(chain);
    Rng rng(11);
    for (int i = 0; i < 200; ++i) {
      const Eigen::VectorXd q = random_configuration(group, rng);
      KDL::JntArray angles(chain.getNrOfJoints());
      angles.data = q;
      KDL::Frame frame;
      KDL::Jacobian expected(chain.getNrOfJoints());
      ASSERT_GE(fk.JntToCart(angles, frame), 0);
      ASSERT_GE(jacobian.JntToJac(angles, expected), 0);
      Pose T;
      Matrix6Xd J(6, group.size());
      group.fk_jacobian(q, T, J);
      for (int r = 0; r < 3; ++r) {
        EXPECT_NEAR(T(r, 3), frame.p[r], 1e-12);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(T(r, c), frame.M(r, c), 1e-12);
      }
      EXPECT_LT((J - expected.data).cwiseAbs().maxCoeff(), 1e-12);
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
  const Pose T_flange_tcp = pose_from_xyz_rpy({0, 0, 0.1034}, {0, 0, -M_PI / 4});
  EXPECT_LT((tcp.fk(q).matrix() - (flange.fk(q) * T_flange_tcp).matrix()).norm(), 1e-9);  // URDF prints pi/4 rounded
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

TEST(JointGroup, ManipulabilityMatchesSingularValues) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  Rng rng(9);
  for (int i = 0; i < 50; ++i) {
    const Eigen::VectorXd q = random_configuration(group, rng);
    const double expected = Eigen::JacobiSVD<Eigen::MatrixXd>(group.jacobian(q)).singularValues().prod();
    EXPECT_NEAR(group.manipulability(q), expected, 1e-10);
  }
}
