/// The frames that kinematics and collision share, against products of joint transforms link by link
/// (Robot::link_poses) and, for what rotates about -z and about axes close to it, closed forms.
#include "mmgrasp/robot/detail/frame_tree.hpp"

#include <gtest/gtest.h>

#include <set>

#include "mmgrasp/robot/detail/joint_group_data.hpp"
#include "support/kinematics_support.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;
using detail::ElementaryMotion;
using detail::FrameTree;

namespace {

std::string numbers(const Eigen::Vector3d& v) {
  char text[100];
  std::snprintf(text, sizeof text, "%.17g %.17g %.17g", v[0], v[1], v[2]);
  return text;
}

/// A tree of 24 links with joints of every type; every fourth axis is -z.
Robot random_tree(Rng& rng) {
  static const char* const kTypes[] = {"revolute", "fixed", "prismatic", "continuous", "planar", "floating"};
  std::string urdf = "<robot name=\"tree\"><link name=\"l0\"/>";
  for (std::size_t i = 1; i < 24; ++i) {
    const std::string type = kTypes[rng.index(i % 5 == 0 ? 6 : 4)];
    const Eigen::Vector3d axis =
        i % 4 == 0 ? Eigen::Vector3d(0, 0, -1) : Eigen::Vector3d(rng.rotation() * Eigen::Vector3d::UnitX());
    const std::string name = std::to_string(i), parent = std::to_string(rng.index(i));
    urdf += "<link name=\"l" + name + "\"/><joint name=\"j" + name + "\" type=\"" + type + "\"><parent link=\"l" +
            parent + "\"/><child link=\"l" + name + "\"/><origin xyz=\"" +
            numbers(rng.uniform(Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1))) + "\" rpy=\"" +
            numbers(rng.uniform(Eigen::Vector3d::Constant(-3), Eigen::Vector3d::Constant(3))) + "\"/><axis xyz=\"" +
            numbers(axis) + "\"/><limit lower=\"-2\" upper=\"2\" velocity=\"1\" effort=\"1\"/></joint>";
  }
  return Robot::from_strings(urdf + "</robot>");
}

/// A chain to the outermost link that something moves.
JointGroup longest_chain(const Robot& robot) {
  int best = 1, length = 0;
  for (int link = 1; link < static_cast<int>(robot.links().size()); ++link) {
    int moving = 0;
    for (int at = link; at > 0; at = robot.joints()[at - 1].parent_link)
      moving += robot.joints()[at - 1].value_index >= 0;
    if (moving > length) best = link, length = moving;
  }
  return robot.chain("l0", robot.links()[best].name);
}

}  // namespace

TEST(FrameTree, LinksAndTipOfRandomTreesEqualProductsOfTransforms) {
  on_every_instruction_set([] {
    Rng rng(17);
    for (int round = 0; round < 60; ++round) {
      const JointGroup group = longest_chain(random_tree(rng));
      for (int i = 0; i < 5; ++i) {
        Eigen::VectorXd q = rng.uniform(group.sample_lower(), group.sample_upper());
        q = q.cwiseMax(-3.0).cwiseMin(3.0);
        expect_link_poses_agree(group, q);
        EXPECT_LT((group.jacobian(q) - numeric_jacobian(group, q)).cwiseAbs().maxCoeff(), 2e-7);
      }
    }
  });
}

TEST(FrameTree, MotionsComeFromTheRootOutwardsAndReachEveryLink) {
  Rng rng(18);
  for (int round = 0; round < 20; ++round) {
    const Robot robot = random_tree(rng);
    const JointGroup group = longest_chain(robot);
    const FrameTree& tree = group.data().kinematics->tree;
    std::set<int> placed{0};
    std::set<int> columns;
    for (const ElementaryMotion& motion : tree.motions) {
      EXPECT_TRUE(placed.count(motion.parent)) << "a parent comes first";
      EXPECT_TRUE(placed.insert(motion.frame).second);
      for (int k = 0; k < (motion.motion == detail::Motion::spherical ? 3 : 1); ++k)
        EXPECT_TRUE(columns.insert(motion.drive.column + k).second);
      EXPECT_NEAR(motion.axis.norm(), 1, 1e-12);
    }
    EXPECT_EQ(static_cast<int>(columns.size()), group.size());
    std::vector<int> moving;
    for (int link = 0; link < static_cast<int>(robot.links().size()); ++link) {
      EXPECT_TRUE(placed.count(tree.frame_of_link[link]));
      if (tree.frame_of_link[link] != 0) moving.push_back(link);
    }
    EXPECT_EQ(moving, group.moving_links());
  }
}

// An axis along -z has no rotation from z of its own: any will do, but it must be one exactly.
TEST(FrameTree, AxesAlongMinusZLoseNoDigits) {
  std::string urdf = "<robot name=\"r\"><link name=\"l0\"/>";
  constexpr int kJoints = 40;
  for (int i = 1; i <= kJoints; ++i) {
    const std::string own = std::to_string(i), parent = std::to_string(i - 1);
    urdf += "<link name=\"l" + own + "\"/><joint name=\"j" + own + "\" type=\"continuous\"><parent link=\"l" + parent +
            "\"/><child link=\"l" + own + "\"/><axis xyz=\"0 0 -1\"/></joint>";
  }
  const JointGroup group = Robot::from_strings(urdf + "</robot>").chain("l0", "l" + std::to_string(kJoints));
  for (const ElementaryMotion& motion : group.data().kinematics->tree.motions) {
    const Eigen::Matrix3d R = detail::rotation_from_z(motion.axis);
    EXPECT_EQ((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 0.0);
    EXPECT_EQ(R.col(2), motion.axis);
  }
  // At zero and at half turns everything stays on the axes: sin(pi) alone, 1.2e-16, may be seen.
  on_every_instruction_set([&] {
    Poses poses;
    group.link_poses(Eigen::VectorXd::Zero(kJoints), poses);
    EXPECT_EQ((poses.back().matrix() - Eigen::Matrix4d::Identity()).norm(), 0.0);
    EXPECT_EQ((group.fk(Eigen::VectorXd::Zero(kJoints)).matrix() - Eigen::Matrix4d::Identity()).norm(), 0.0);
    Eigen::VectorXd q = Eigen::VectorXd::Zero(kJoints);
    q[3] = 0.5;
    group.link_poses(q, poses);
    EXPECT_NEAR(poses.back()(1, 0), -std::sin(0.5), 1.2e-16);
    EXPECT_NEAR(group.fk(q)(1, 0), -std::sin(0.5), 1.2e-16);
  });
}
