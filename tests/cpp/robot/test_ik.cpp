#include "mmgrasp/robot/ik.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/robot_support.hpp"
#include "support/small_robots.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

/// Distance of a solution from the target by the robot's plain kinematics, not the group's fast path.
Vector6d plain_error(const JointGroup& group, const Eigen::VectorXd& q, const Pose& target) {
  const Poses poses = group.robot().link_poses(group.full_values(q), group.root_pose(q));
  return pose_difference(poses[group.tip_link()], target);
}

int count_solved(const JointGroup& group, int poses) {
  Rng rng(21);
  int solved = 0;
  const Eigen::VectorXd seed = (group.sample_lower() + group.sample_upper()) / 2;
  for (int i = 0; i < poses; ++i) {
    const Pose target = group.fk(rng.uniform(group.sample_lower(), group.sample_upper()));
    const IkResult result = solve_ik(group, target, seed);
    if (result.outcome != Outcome::solved) continue;
    ++solved;
    const Vector6d error = plain_error(group, result.q, target);
    EXPECT_LE(error.head<3>().norm(), 1.001e-5);
    EXPECT_LE(error.tail<3>().norm(), 1.001e-4);
    EXPECT_NEAR(error.head<3>().norm(), result.position_error, 1e-12);
    EXPECT_TRUE(group.within_limits(result.q));
  }
  return solved;
}

}  // namespace

TEST(Ik, SolvesReachablePosesOfPanda) {
  MMGRASP_NEEDS_SHARED_DATA();
  EXPECT_GE(count_solved(panda().group("panda_arm"), 10000), 9995);
}

TEST(Ik, SolvesReachablePosesOfUr5e) {
  MMGRASP_NEEDS_SHARED_DATA();
  EXPECT_EQ(count_solved(load_kinematics("robots/ur/expanded/ur5e.urdf").chain("base_link", "tool0"), 3000), 3000);
}

TEST(Ik, SolvesReachablePosesOfTiagoWithAndWithoutBase) {
  MMGRASP_NEEDS_SHARED_DATA();
  EXPECT_GE(count_solved(tiago().group("arm_torso"), 2000), 1998);
  EXPECT_GE(count_solved(tiago().group("arm_torso", "", true), 500), 500);
}

TEST(Ik, LeavesASingularSeed) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  const Eigen::VectorXd seed = Eigen::VectorXd::Zero(7);  // singular, and joint 4 is outside its limits
  Pose target = group.fk(seed);
  target.translation().z() -= 0.1;
  const IkResult result = solve_ik(group, target, seed);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_LE(plain_error(group, result.q, target).head<3>().norm(), 1.001e-5);
}

TEST(Ik, SolvedSeedComesBackUnchanged) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  Rng rng(3);
  const Eigen::VectorXd q = rng.uniform(group.lower(), group.upper());
  const IkResult result = solve_ik(group, group.fk(q), q);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.q, q);
  EXPECT_EQ(result.iterations, 0);
}

TEST(Ik, RefineStaysNearAndInsideLimits) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  Rng rng(4);
  IkWorkspace workspace;
  int solved = 0;
  const Eigen::VectorXd inner_lower = group.lower().array() + 0.2, inner_upper = group.upper().array() - 0.2;
  for (int i = 0; i < 500; ++i) {
    const Eigen::VectorXd goal = rng.uniform(inner_lower, inner_upper);
    Eigen::VectorXd q = goal;
    for (Eigen::Index j = 0; j < q.size(); ++j) q[j] += rng.uniform(-0.1, 0.1);
    if (!refine_ik(group, group.fk(goal), q, {}, workspace)) continue;
    ++solved;
    EXPECT_TRUE(group.within_limits(q));
    EXPECT_LT((q - goal).norm(), 2.0);
    EXPECT_LE(plain_error(group, q, group.fk(goal)).head<3>().norm(), 1.001e-5);
  }
  EXPECT_GE(solved, 499);
}

TEST(Ik, OutOfReachIsAValueAndCounted) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  const Eigen::VectorXd seed = (group.lower() + group.upper()) / 2;
  for (const double x : {0.95, 1.2, 5.0}) {  // the arm ends before 0.9 m in front of joint 1 at this height
    const IkResult result = solve_ik(group, pose_from_xyz_rpy({x, 0, 0.333}, {0, M_PI / 2, 0}), seed);
    EXPECT_EQ(result.outcome, x > 1 ? Outcome::infeasible : Outcome::not_found) << x;  // the links end before 1.2 m
    EXPECT_EQ(result.q.size(), 0);
    EXPECT_GT(result.position_error, 1e-3);
    EXPECT_GT(result.rejections.unreachable, 0u);
    EXPECT_EQ(result.rejections.total(), result.rejections.unreachable);
  }
}

TEST(Ik, OutOfReachIsProvenOnlyBeyondTheTolerance) {
  const Robot robot = Robot::from_strings(R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
    <joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
      <limit lower="-0.5" upper="0.5" velocity="1"/></joint>
    <joint name="f" type="fixed"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/></joint></robot>)");
  const JointGroup group = robot.chain("a", "c");
  IkOptions options;
  options.position_tolerance = 0.01;
  const auto solve = [&](double x) {
    return solve_ik(group, pose_from_xyz_rpy({x, 0, 0}, {0, 0, 0}), Eigen::VectorXd::Constant(1, 0.2), options).outcome;
  };
  EXPECT_EQ(solve(1.005), Outcome::solved);
  EXPECT_EQ(solve(1.011), Outcome::infeasible);
}

TEST(Ik, LimitsAreToldFromReach) {
  // One joint, +-0.5 rad: a pose at 1 rad is there without the limit only.
  const Robot robot = Robot::from_strings(R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
    <joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
      <limit lower="-0.5" upper="0.5" velocity="1"/></joint>
    <joint name="f" type="fixed"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/></joint></robot>)");
  const JointGroup group = robot.chain("a", "c");
  const auto solve = [&](double x, double y, double yaw) {
    return solve_ik(group, pose_from_xyz_rpy({x, y, 0}, {0, 0, yaw}), Eigen::VectorXd::Zero(1));
  };
  EXPECT_EQ(solve(std::cos(0.5), std::sin(0.5), 0.5).outcome, Outcome::solved);
  const IkResult outside = solve(std::cos(1.0), std::sin(1.0), 1.0);
  EXPECT_EQ(outside.outcome, Outcome::not_found);
  EXPECT_EQ(outside.rejections.limits, 31u);  // the seed and every restart
  EXPECT_EQ(outside.rejections.unreachable, 0u);
  const IkResult twisted = solve(1, 0, 0.4);  // right place, wrong angle
  EXPECT_EQ(twisted.rejections.unreachable, 31u);
}

TEST(Ik, FilterDecidesAndIsCounted) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = load_kinematics("robots/ur/expanded/ur5e.urdf").chain("base_link", "tool0");
  Eigen::VectorXd q(6);
  q << 0.3, -1.2, 1.5, -0.9, 0.7, 0.2;
  int calls = 0;
  const auto valid = [&calls](const Eigen::VectorXd& c) {
    ++calls;
    return c[2] < 0 ? Rejection::none : Rejection::scene;  // elbow the other way
  };
  const IkResult result = solve_ik(group, group.fk(q), q, {}, valid);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_LT(result.q[2], 0);
  EXPECT_EQ(result.rejections.scene, calls - 1);
  EXPECT_GE(calls, 2);
}

TEST(Ik, RefusedSeedOfSixJointsStillGetsEveryBranch) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = load_kinematics("robots/ur/expanded/ur5e.urdf").chain("base_link", "tool0");
  Eigen::VectorXd q(6);
  q << 0.3, -1.2, 1.5, -0.9, 0.7, 0.2;
  IkOptions options;
  options.restarts = 0;
  const auto other_shoulder = [&](const Eigen::VectorXd& c) {
    return std::abs(wrap_angle(c[0] - q[0])) > 1 ? Rejection::none : Rejection::scene;
  };
  const IkResult result = solve_ik(group, group.fk(q), q, options, other_shoulder);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_GT(result.rejections.scene, 0u);
  EXPECT_LE(plain_error(group, result.q, group.fk(q)).norm(), 1e-4);
}

TEST(Ik, SplitsOfASingularWristThatTheClosedFormDropsAreFound) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = load_kinematics("robots/ur/expanded/ur5e.urdf").chain("base_link", "tool0");
  Rng rng(91);
  int refused = 0;
  IkOptions options;
  options.restarts = 100;  // the filter leaves a quarter of the splits, limits not all of those
  for (int i = 0; i < 30; ++i) {
    Eigen::VectorXd made = rng.uniform(Eigen::VectorXd::Constant(6, -2.5), Eigen::VectorXd::Constant(6, 2.5));
    made[4] = 0;  // axis 6 parallel to 2, 3 and 4
    made[2] = 0.8 + 0.05 * i;
    const Pose target = group.fk(made);
    // Only a narrow range of joint 6 around the making configuration will do.
    const auto valid = [&](const Eigen::VectorXd& q) {
      return std::abs(wrap_angle(q[5] - made[5])) < 0.8 ? Rejection::none : Rejection::scene;
    };
    const IkResult result = solve_ik(group, target, Eigen::VectorXd::Zero(6), options, valid);
    ASSERT_EQ(result.outcome, Outcome::solved) << made.transpose() << "\n" << result.rejections.summary();
    refused += result.rejections.scene > 0;
    EXPECT_EQ(valid(result.q), Rejection::none);
    const Vector6d error = plain_error(group, result.q, target);
    EXPECT_LE(error.head<3>().norm(), 1.001e-5);
    EXPECT_LE(error.tail<3>().norm(), 1.001e-4);
  }
  EXPECT_GT(refused, 15);
}

TEST(Ik, SingularWristAtAJointLimitIsSolved) {
  // A Puma-like arm whose joint 4 cannot be 0, where the closed form splits; joints 1 and 3 stand on their limits.
  const std::string urdf = [] {
    const char* xyz[] = {"0 0 0.3", "0 0 0", "0 0 0.4", "0 0 0.3", "0 0 0", "0 0 0"};
    const char* axis[] = {"0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1"};
    std::string text = "<robot name='six'>" + test::urdf_link("l0");
    for (int i = 0; i < 6; ++i) {
      const std::string link = "l" + std::to_string(i + 1);
      text += test::urdf_link(link) + test::urdf_joint("j" + std::to_string(i + 1), "revolute", "l" + std::to_string(i),
                                                       link, xyz[i], axis[i], i == 3 ? "0.2" : "-1.5", "1.5");
    }
    return text + test::urdf_link("tool") + test::urdf_joint("flange", "fixed", "l6", "tool", "0 0 0.1", "0 0 1") +
           "</robot>";
  }();
  const Robot robot = Robot::from_strings(urdf);
  const JointGroup group = robot.chain("l0", "tool");
  Rng rng(92);
  for (const double tilt : {0.0, 1e-9, 1e-7, 1e-5}) {
    for (int i = 0; i < 20; ++i) {
      Eigen::VectorXd made(6);
      made << 1.5, rng.uniform(-1.4, 1.4), 1.5, rng.uniform(0.3, 1.4), tilt, rng.uniform(-1.0, 1.0);
      const Pose target = group.fk(made);
      const IkResult result = solve_ik(group, target, 0.5 * (group.lower() + group.upper()));
      ASSERT_EQ(result.outcome, Outcome::solved) << made.transpose() << "\n" << result.rejections.summary();
      EXPECT_LE(plain_error(group, result.q, target).norm(), 1.1e-4);
      EXPECT_TRUE(group.within_limits(result.q));
    }
  }
}

TEST(Ik, SameSeedSameAnswer) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  Rng rng(14);
  for (int i = 0; i < 50; ++i) {
    const Pose target = group.fk(rng.uniform(group.lower(), group.upper()));
    const Eigen::VectorXd seed = rng.uniform(group.lower(), group.upper());
    const IkResult a = solve_ik(group, target, seed), b = solve_ik(group, target, seed);
    EXPECT_EQ(a.q, b.q);
    EXPECT_EQ(a.iterations, b.iterations);
  }
}

TEST(Ik, AllFindsTheEightBranchesOfASixJointArm) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = load_kinematics("robots/ur/expanded/ur5e.urdf").chain("base_link", "tool0");
  Eigen::VectorXd q(6);
  q << 0.3, -1.2, 1.5, -0.9, 0.7, 0.2;
  const Pose target = group.fk(q);
  const std::vector<Eigen::VectorXd> solutions = solve_ik_all(group, target, 200);
  // Counted modulo full turns: shoulder left/right x elbow up/down x wrist flipped or not.
  std::vector<Eigen::VectorXd> branches;
  for (const Eigen::VectorXd& s : solutions) {
    EXPECT_TRUE(group.within_limits(s));
    EXPECT_LE(plain_error(group, s, target).head<3>().norm(), 1.001e-5);
    bool known = false;
    for (const Eigen::VectorXd& b : branches) {
      double d = 0;
      for (int i = 0; i < 6; ++i) d = std::max(d, std::abs(wrap_angle(s[i] - b[i])));
      known = known || d < 0.01;
    }
    if (!known) branches.push_back(s);
  }
  EXPECT_EQ(branches.size(), 8u);
  for (std::size_t i = 0; i < solutions.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT((solutions[i] - solutions[j]).norm(), 0.1);
  const std::vector<Eigen::VectorXd> again = solve_ik_all(group, target, 5);
  ASSERT_EQ(again.size(), 5u);
  for (std::size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again[i], solutions[i]);
}

TEST(Ik, CancelTokenAndBadInput) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  const Eigen::VectorXd seed = (group.lower() + group.upper()) / 2;
  Monitor monitor;
  monitor.stop.stop();
  EXPECT_EQ(solve_ik(group, group.fk(seed), seed, {}, {}, monitor).outcome, Outcome::stopped);
  EXPECT_THROW(solve_ik(group, Pose::Identity(), Eigen::VectorXd::Zero(3)), InvalidInput);
  Pose broken = Pose::Identity();
  broken.translation()[0] = std::nan("");
  EXPECT_THROW(solve_ik(group, broken, seed), InvalidInput);
  IkOptions options;
  options.position_tolerance = 0;
  EXPECT_THROW(solve_ik(group, Pose::Identity(), seed, options), InvalidInput);
}

TEST(Ik, MoveItsCasesOfPanda) {
  // reference/transcribed/moveit_ik_panda_kdl.xml: 100 random poses from its non-singular seed to 1e-5; and, from the
  // zero configuration (singular, joint 4 outside its limits here), the pose 0.1 m below the one there.
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  ASSERT_EQ(group.robot().links()[group.tip_link()].name, "panda_link8");
  Eigen::VectorXd seed(7);
  seed << -0.5, -0.5, 0.3, -2, 0.8, 1.8, 1.9;
  IkOptions options;
  options.position_tolerance = options.rotation_tolerance = 1e-5;
  Rng rng(30);
  for (int i = 0; i < 100; ++i) {
    const Pose target = group.fk(rng.uniform(group.lower(), group.upper()));
    const IkResult result = solve_ik(group, target, seed, options);
    ASSERT_EQ(result.outcome, Outcome::solved);
    EXPECT_LE(plain_error(group, result.q, target).norm(), 2e-5);
  }
  Pose target = group.fk(Eigen::VectorXd::Zero(7));
  target.translation().z() -= 0.1;
  const IkResult result = solve_ik(group, target, Eigen::VectorXd::Zero(7), options);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_LE(plain_error(group, result.q, target).norm(), 2e-5);
  // Its consistency limits: a pose made within 0.4 rad of the seed has an answer within 0.4 rad of it.
  int near = 0;
  for (int i = 0; i < 100; ++i) {
    const Eigen::VectorXd made = rng.uniform(Eigen::VectorXd(seed.array() - 0.2), Eigen::VectorXd(seed.array() + 0.2));
    const IkResult answer = solve_ik(group, group.fk(made), seed, options);
    ASSERT_EQ(answer.outcome, Outcome::solved);
    near += (answer.q - seed).cwiseAbs().maxCoeff() <= 0.4;
  }
  EXPECT_GE(near, 98);
}

TEST(Ik, TracIksRobot) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot robot = load_kinematics("reference/trac_ik/launch/pr2.urdf");
  for (const char* base : {"torso_lift_link", "base_link"}) {  // 7 joints; 8 with the torso's lift
    const JointGroup group = robot.chain(base, "r_wrist_roll_link");
    ASSERT_EQ(group.size(), base == std::string("base_link") ? 8 : 7);
    EXPECT_EQ(count_solved(group, 1000), 1000) << base;
  }
}

TEST(Ik, BaseAndArmAreOneChain) {
  MMGRASP_NEEDS_SHARED_DATA();
  const auto expect_all = [](const JointGroup& group, double room, int count) {
    Rng rng(31);
    Eigen::VectorXd lower = group.sample_lower(), upper = group.sample_upper();
    lower.head<2>().setConstant(-room);
    upper.head<2>().setConstant(room);
    int solved = 0;
    double arm_motion = 0;
    for (int i = 0; i < count; ++i) {
      const Pose target = group.fk(rng.uniform(lower, upper));
      // The seed stands anywhere in the room: the base has to drive there.
      const Eigen::VectorXd seed = rng.uniform(lower, upper);
      const IkResult result = solve_ik(group, target, seed);
      solved += result.outcome == Outcome::solved;
      if (result.outcome != Outcome::solved) continue;
      const Vector6d error = plain_error(group, result.q, target);
      EXPECT_LE(error.head<3>().norm(), 1.001e-5);
      EXPECT_LE(error.tail<3>().norm(), 1.001e-4);
      EXPECT_TRUE(group.within_limits(result.q));
      EXPECT_LE(std::abs(result.q[2] - seed[2]), M_PI + 1e-9);  // the way round that is shorter
      arm_motion += (result.q - seed).tail(group.size() - 3).cwiseAbs().maxCoeff();
    }
    EXPECT_EQ(solved, count) << group.name();
  };
  expect_all(tiago(BaseKind::diff_drive).group("arm_torso", "", true), 5, 500);
  expect_all(tiago(BaseKind::omni).group("arm", "", true), 20, 500);
  RobotOptions options;
  options.base = BaseKind::diff_drive;
  const std::string folder = std::string(MMGRASP_ASSETS) + "/robots/fetchlike/fetchlike";
  const Robot fetchlike = Robot::load(folder + ".urdf", folder + ".srdf", options);
  expect_all(fetchlike.group("arm_with_torso", "gripper_tcp", true), 5, 500);
}
