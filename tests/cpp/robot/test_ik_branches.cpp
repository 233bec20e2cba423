#include "mmgrasp/robot/ik_branches.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/robot_support.hpp"
#include "support/small_robots.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

JointGroup ur5() {
  return load_kinematics("robots/ur5_vamp/ur5/ur5.urdf").chain("base_link", "ee_link");
}

/// Largest joint difference, whole turns taken off.
double branch_distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double largest = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i)
    largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], 2 * M_PI)));
  return largest;
}

/// How far q stays from the nearest limit.
double limit_gap(const JointGroup& group, const Eigen::VectorXd& q) {
  return std::min((q - group.lower()).minCoeff(), (group.upper() - q).minCoeff());
}

bool holds(const std::vector<Eigen::VectorXd>& all, const Eigen::VectorXd& q, double within) {
  return std::any_of(all.begin(), all.end(), [&](const auto& other) { return branch_distance(other, q) < within; });
}

/// Position and rotation error of q by KDL.
void expect_right(const JointGroup& group, const Eigen::VectorXd& q, const Pose& target) {
  const KDL::Chain chain = kdl_chain(group.robot(), group.tip_link());
  KDL::ChainFkSolverPos_recursive fk(chain);
  KDL::JntArray joints(chain.getNrOfJoints());
  joints.data = q;
  KDL::Frame frame;
  ASSERT_GE(fk.JntToCart(joints, frame), 0);
  const KDL::Twist error = KDL::diff(frame, to_kdl(target));
  EXPECT_LE(error.vel.Norm(), 1e-8);
  EXPECT_LE(error.rot.Norm(), 1e-8);
  EXPECT_TRUE(group.within_limits(q));
}

/// Every answer is right, the configuration that made the pose is among them, and thousands of random descents find no
/// branch that is missing.
void expect_complete(const JointGroup& group, int poses, int descents, std::size_t most) {
  Rng rng(77);
  IkWorkspace workspace;
  IkOptions exact;
  exact.position_tolerance = exact.rotation_tolerance = 1e-9;
  std::size_t total = 0;
  for (int i = 0; i < poses; ++i) {
    const Eigen::VectorXd made = rng.uniform(group.sample_lower(), group.sample_upper());
    const Pose target = group.fk(made);
    const IkBranches branches = solve_ik_branches(group, target);
    EXPECT_TRUE(branches.complete);
    EXPECT_EQ(branches.redundant_joint, -1);
    EXPECT_LE(branches.solutions.size(), most);
    total += branches.solutions.size();
    for (std::size_t a = 0; a < branches.solutions.size(); ++a) {
      expect_right(group, branches.solutions[a], target);
      for (std::size_t b = 0; b < a; ++b)
        EXPECT_GT(branch_distance(branches.solutions[a], branches.solutions[b]), 1e-5);
    }
    EXPECT_TRUE(holds(branches.solutions, made, 1e-4)) << "pose " << i << ", " << made.transpose();
    for (int j = 0; j < descents; ++j) {
      Eigen::VectorXd q = rng.uniform(group.sample_lower(), group.sample_upper());
      if (!refine_ik(group, target, q, exact, workspace)) continue;
      if (group.jacobian(q).fullPivLu().rcond() < 1e-4) continue;  // a meeting of two branches
      EXPECT_TRUE(holds(branches.solutions, q, 1e-4)) << "pose " << i << ", " << q.transpose();
    }
  }
  EXPECT_GT(total, 2 * poses);
}

std::string six_joint_urdf(const std::vector<std::pair<std::string, std::string>>& xyz_axis,
                           const std::string& flange = "0 0 0.1") {
  std::string urdf = "<robot name='six'>" + test::urdf_link("l0");
  for (std::size_t i = 0; i < xyz_axis.size(); ++i) {
    const std::string link = "l" + std::to_string(i + 1);
    urdf += test::urdf_link(link) + test::urdf_joint("j" + std::to_string(i + 1), "revolute", "l" + std::to_string(i),
                                                     link, xyz_axis[i].first, xyz_axis[i].second, "-3.1", "3.1");
  }
  return urdf + test::urdf_link("tool") +
         test::urdf_joint("flange", "fixed", "l" + std::to_string(xyz_axis.size()), "tool", flange, "0 0 1") +
         "</robot>";
}

JointGroup arm_of(const std::string& urdf) {
  const Robot robot = Robot::from_strings(urdf);
  return robot.chain("l0", "tool");
}

}  // namespace

TEST(IkBranches, Ur5HasUpToEight) {
  MMGRASP_NEEDS_SHARED_DATA();
  expect_complete(ur5(), 40, 300, 8);
}

TEST(IkBranches, Ur5MakingConfigurationIsAlwaysAmongThem) {
  MMGRASP_NEEDS_SHARED_DATA();
  expect_complete(ur5(), 3000, 0, 8);
}

TEST(IkBranches, TurnsBeyondOnceGiveOneSolutionNearestTheMiddle) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = load_kinematics("robots/ur/expanded/ur5e.urdf").chain("base_link", "tool0");
  ASSERT_GT(group.upper()[0], 6.2);
  Rng rng(5);
  for (int i = 0; i < 300; ++i) {
    const Eigen::VectorXd made = rng.uniform(group.sample_lower(), group.sample_upper());
    const IkBranches branches = solve_ik_branches(group, group.fk(made));
    EXPECT_LE(branches.solutions.size(), 8u);
    EXPECT_TRUE(holds(branches.solutions, made, 1e-4));
    for (const Eigen::VectorXd& q : branches.solutions) EXPECT_LE(q.cwiseAbs().maxCoeff(), M_PI + 1e-9);
  }
}

TEST(IkBranches, SphericalWristOnEveryKindOfShoulder) {
  using Joints = std::vector<std::pair<std::string, std::string>>;
  const Joints wrist{{"0 0 0.3", "1 0 0"}, {"0 0 0", "0 1 0"}, {"0 0 0", "1 0 0"}};
  const auto with = [&](Joints shoulder) {
    shoulder.insert(shoulder.end(), wrist.begin(), wrist.end());
    return arm_of(six_joint_urdf(shoulder));
  };
  // 1 and 2 meet, 2 and 3 parallel: a Puma without offsets, and one with.
  expect_complete(with({{"0 0 0.3", "0 0 1"}, {"0 0 0", "0 1 0"}, {"0 0 0.4", "0 1 0"}}), 15, 150, 8);
  expect_complete(with({{"0 0 0.3", "0 0 1"}, {"0.1 0.15 0", "0 1 0"}, {"0 0 0.4", "0 1 0"}}), 15, 150, 8);
  // 2 and 3 meet behind an offset; 1 and 2 parallel; 1 and 2 meet with 3 skew.
  expect_complete(with({{"0 0 0.3", "0 0 1"}, {"0.2 0 0", "0 1 0"}, {"0 0 0", "1 0 0"}}), 15, 150, 8);
  expect_complete(with({{"0 0 0.3", "0 0 1"}, {"0.4 0 0", "0 0 1"}, {"0.3 0 0", "0 1 0"}}), 15, 150, 8);
  expect_complete(with({{"0 0 0.3", "0 0 1"}, {"0 0 0", "0 1 0"}, {"0.1 0.05 0.3", "1 0 0"}}), 15, 150, 8);
}

TEST(IkBranches, SphericalShoulderIsSolvedFromTheTip) {
  expect_complete(arm_of(six_joint_urdf({{"0 0 0.3", "0 0 1"},
                                         {"0 0 0", "0 1 0"},
                                         {"0 0 0", "1 0 0"},
                                         {"0.05 0 0.4", "0 1 0"},
                                         {"0 0 0.4", "0 1 0"},
                                         {"0.1 0.03 0", "0 0 1"}})),
                  15, 150, 8);
}

TEST(IkBranches, ParallelJointsMayTurnAgainstEachOther) {
  expect_complete(arm_of(six_joint_urdf({{"0 0 0.1", "0 0 1"},
                                         {"0 0.1 0", "0 1 0"},
                                         {"0 0 0.4", "0 -1 0"},
                                         {"0 0 0.4", "0 1 0"},
                                         {"0 0.1 0", "0 0 1"},
                                         {"0 0 0.1", "0 1 0"}},
                                        "0 0.1 0")),
                  15, 150, 8);
}

TEST(IkBranches, GeometryThatIsOnlyNearlySpecialIsPolished) {
  // Offsets of 0.05 mm and angles of 5e-5 rad, as a calibration writes them.
  std::string urdf = six_joint_urdf({{"0 0 0.1", "0 0 1"},
                                     {"0 0.1 0", "0.00005 1 0"},
                                     {"0 0 0.4", "0 1 0.00004"},
                                     {"0 0 0.4", "0.00003 1 0"},
                                     {"0 0.1 0", "0 0 1"},
                                     {"0.00005 0 0.1", "0 1 0"}},
                                    "0 0.1 0");
  expect_complete(arm_of(urdf), 30, 0, 8);
}

TEST(IkBranches, PandaBranchesForEverySampledValueOfItsLastJoint) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  Rng rng(8);
  IkWorkspace workspace;
  IkOptions exact;
  exact.position_tolerance = exact.rotation_tolerance = 1e-9;
  for (int i = 0; i < 40; ++i) {
    const Pose target = group.fk(rng.uniform(group.lower(), group.upper()));
    const IkBranches branches = solve_ik_branches(group, target);
    EXPECT_TRUE(branches.complete || branches.solutions.empty());
    EXPECT_EQ(branches.redundant_joint, 6);
    for (const Eigen::VectorXd& q : branches.solutions) expect_right(group, q, target);
    // Descents with the last joint weighted down to (nearly) rest, from one of the sampled values.
    const double cell = (group.upper()[6] - group.lower()[6]) / 24;
    exact.joint_weights = {1, 1, 1, 1, 1, 1, 1e12};
    for (int j = 0; j < 100; ++j) {
      Eigen::VectorXd q = rng.uniform(group.lower(), group.upper());
      const double value = group.lower()[6] + (static_cast<double>(rng.index(24)) + 0.5) * cell;
      q[6] = value;
      if (!refine_ik(group, target, q, exact, workspace) || std::abs(q[6] - value) > 1e-7) continue;
      if (group.jacobian(q).leftCols<6>().fullPivLu().rcond() < 1e-3) continue;
      if (limit_gap(group, q) < 1e-6) continue;
      EXPECT_TRUE(holds(branches.solutions, q, 1e-4)) << "pose " << i << ", " << q.transpose();
    }
  }
}

TEST(IkBranches, Pr2HasAClosedFormToo) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup pr2 =
      load_kinematics("reference/trac_ik/launch/pr2.urdf").chain("torso_lift_link", "r_wrist_roll_link");
  Rng rng(9);
  int solved = 0, complete = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose target = pr2.fk(rng.uniform(pr2.sample_lower(), pr2.sample_upper()));
    const IkBranches branches = solve_ik_branches(pr2, target);
    EXPECT_GE(branches.redundant_joint, 0);
    solved += !branches.solutions.empty();
    complete += branches.complete;
    for (const Eigen::VectorXd& q : branches.solutions) {
      const Vector6d error = pose_difference(pr2.fk(q), target);
      EXPECT_LE(error.norm(), branches.complete ? 1e-7 : 1.1e-4);  // searched ones keep the tolerances only
      EXPECT_TRUE(pr2.within_limits(q));
    }
  }
  EXPECT_GE(solved, 99);
  EXPECT_GE(complete, 80);  // the others have less room than lies between two sampled values
}

TEST(IkBranches, FirstOnesAreFarthestApart) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  Rng rng(10);
  const Pose target = group.fk(0.5 * (group.lower() + group.upper()));
  const std::vector<Eigen::VectorXd> all = solve_ik_branches(group, target).solutions;
  ASSERT_GT(all.size(), 8u);
  const auto nearest = [&](const Eigen::VectorXd& q, std::size_t among) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < among; ++i) least = std::min(least, (all[i] - q).norm());
    return least;
  };
  for (std::size_t i = 1; i < all.size(); ++i)
    for (std::size_t later = i + 1; later < all.size(); ++later)
      EXPECT_GE(nearest(all[i], i), nearest(all[later], i) - 1e-12);
}

TEST(IkBranches, FilterAndLimitsAreCounted) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = ur5();
  Eigen::VectorXd q(6);
  q << 0.3, -1.2, 1.5, -0.9, 0.7, 0.2;
  const Pose target = group.fk(q);
  const IkBranches all = solve_ik_branches(group, target);
  ASSERT_EQ(all.solutions.size(), 8u);
  EXPECT_EQ(all.rejections.total(), 0u);
  const auto elbow = [](const Eigen::VectorXd& c) { return c[2] > 0 ? Rejection::none : Rejection::scene; };
  const IkBranches up = solve_ik_branches(group, target, {}, elbow);
  EXPECT_EQ(up.solutions.size(), 4u);
  EXPECT_EQ(up.rejections.scene, 4u);
  Pose far = target;
  far.translation().x() = 3;
  const IkBranches none = solve_ik_branches(group, far);
  EXPECT_TRUE(none.solutions.empty());
  EXPECT_TRUE(none.complete);
  EXPECT_GT(none.rejections.unreachable, 0u);
}

TEST(IkBranches, SingularWristStillGivesSolutions) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = ur5();
  Eigen::VectorXd q(6);
  q << 0.3, -1.2, 1.5, -0.9, 0.0, 0.2;  // axes 4 and 6 parallel: one freedom is left over
  const IkBranches branches = solve_ik_branches(group, group.fk(q));
  ASSERT_FALSE(branches.solutions.empty());
  for (const Eigen::VectorXd& found : branches.solutions) expect_right(group, found, group.fk(q));
}

TEST(IkBranches, WithoutClosedFormSolutionsAreSearched) {
  // Wrist axes that miss each other by 8 cm.
  const JointGroup group = arm_of(six_joint_urdf({{"0 0 0.3", "0 0 1"},
                                                  {"0.1 0 0", "0 1 0"},
                                                  {"0 0.05 0.4", "1 0 0"},
                                                  {"0.08 0 0.3", "0 1 0"},
                                                  {"0 0.08 0", "0 0 1"},
                                                  {"0.08 0 0.05", "1 0 0"}}));
  Rng rng(11);
  int solved = 0;
  for (int i = 0; i < 50; ++i) {
    const Eigen::VectorXd made = rng.uniform(group.lower(), group.upper());
    const IkBranches branches = solve_ik_branches(group, group.fk(made));
    EXPECT_FALSE(branches.complete);
    solved += !branches.solutions.empty();
    for (const Eigen::VectorXd& q : branches.solutions)
      EXPECT_LE(pose_difference(group.fk(q), group.fk(made)).head<3>().norm(), 1.001e-5);
  }
  EXPECT_EQ(solved, 50);
}

TEST(IkBranches, BadInputNamesTheField) {
  const JointGroup group = arm_of(six_joint_urdf({{"0 0 0.3", "0 0 1"}}));
  EXPECT_THROW(solve_ik_branches(group, Pose::Identity(), {}, {}, -1), InvalidInput);
  IkOptions options;
  options.joint_weights = {1, 2};
  try {
    solve_ik_branches(group, Pose::Identity(), options);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("joint_weights length"), std::string::npos) << error.what();
  }
}

TEST(IkBranches, ASingularWristIsNotCalledComplete) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = ur5();
  Eigen::VectorXd made(6);
  made << 0.3, -1.2, 1.5, -0.9, 0, 0.2;
  EXPECT_FALSE(solve_ik_branches(group, group.fk(made)).complete);
  // What the kept split fails at, descents may mend.
  const auto valid = [&](const Eigen::VectorXd& q) {
    return std::abs(std::remainder(q[5] - 1.7, 2 * M_PI)) < 0.6 ? Rejection::none : Rejection::scene;
  };
  const IkBranches searched = solve_ik_branches(group, group.fk(made), {}, valid);
  EXPECT_FALSE(searched.complete);
  ASSERT_FALSE(searched.solutions.empty());
  for (const Eigen::VectorXd& q : searched.solutions) {
    EXPECT_EQ(valid(q), Rejection::none);
    EXPECT_LE(pose_difference(group.fk(q), group.fk(made)).norm(), 1.1e-4);
  }
  made[4] = 0.01;
  EXPECT_TRUE(solve_ik_branches(group, group.fk(made)).complete);
}

TEST(IkBranches, SearchTellsLimitsFromReachAndStops) {
  // One joint of +-0.5 rad has no closed form: a pose at 1 rad is there without the limit only.
  const JointGroup group =
      Robot::from_strings("<robot name='r'>" + test::urdf_link("a") + test::urdf_link("b") + test::urdf_link("c") +
                          test::urdf_joint("j", "revolute", "a", "b", "0 0 0", "0 0 1", "-0.5", "0.5") +
                          test::urdf_joint("f", "fixed", "b", "c", "1 0 0", "0 0 1") + "</robot>")
          .chain("a", "c");
  const Pose outside = pose_from_xyz_rpy({std::cos(1.0), std::sin(1.0), 0}, {0, 0, 1});
  const IkBranches limits = solve_ik_branches(group, outside);
  EXPECT_GT(limits.rejections.limits, 0u);
  EXPECT_EQ(limits.rejections.unreachable, 0u);
  const IkBranches reach = solve_ik_branches(group, pose_from_xyz_rpy({1, 0, 0}, {0, 0, 0.4}));
  EXPECT_GT(reach.rejections.unreachable, 0u);
  EXPECT_EQ(reach.rejections.limits, 0u);
  Monitor monitor;
  monitor.stop.stop();
  const IkBranches stopped = solve_ik_branches(group, outside, {}, {}, 0, monitor);
  EXPECT_EQ(stopped.rejections.total(), 0u);
  EXPECT_FALSE(stopped.complete);
}
