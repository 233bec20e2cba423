/// Groups with planar and floating joints. KDL knows neither: the references are closed forms, Robot::link_poses (the
/// slow general way) and finite differences.
#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/manipulability.hpp"
#include "support/kinematics_support.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& inside) {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + inside + "</joint>";
}

/// A deck that slides on a tilted plane, an arm joint, a buoy, a slide that follows the arm joint, a kite beside it.
std::string spatial_urdf() {
  std::string links;
  for (const char* name : {"root", "deck", "arm", "buoy", "slide", "kite", "tip"})
    links += std::string("<link name=\"") + name + "\"/>";
  return "<robot name=\"spatial\">" + links +
         joint("deck_joint", "planar", "root", "deck",
               "<origin xyz=\"0.1 0.2 0.3\" rpy=\"0.3 -0.2 0.5\"/><axis xyz=\"0.6 0 0.8\"/>") +
         joint("arm_joint", "revolute", "deck", "arm",
               "<origin xyz=\"0 0.4 0.1\" rpy=\"0 0.7 0\"/><axis xyz=\"1 -1 0.5\"/>"
               "<limit lower=\"-2\" upper=\"2\" velocity=\"1\" effort=\"1\"/>") +
         joint("buoy_joint", "floating", "arm", "buoy", "<origin xyz=\"0.2 0 0.5\" rpy=\"0.1 0.2 0.3\"/>") +
         joint("slide_joint", "prismatic", "buoy", "slide",
               "<origin xyz=\"0 0 0.1\" rpy=\"1 0 0\"/><axis xyz=\"0 1 0\"/>"
               "<limit lower=\"-9\" upper=\"9\" velocity=\"1\" effort=\"1\"/>"
               "<mimic joint=\"arm_joint\" multiplier=\"-1.5\" offset=\"0.25\"/>") +
         joint("kite_joint", "floating", "slide", "kite", "<origin xyz=\"0.3 0.1 0\" rpy=\"0 0 -0.4\"/>") +
         joint("tip_joint", "fixed", "kite", "tip", "<origin xyz=\"0 0.2 0.3\" rpy=\"0.5 0 0\"/>") + "</robot>";
}

/// Translations within metres: differences of numbers near the workspace bound of 100 m would test rounding only.
Eigen::VectorXd near_configuration(const JointGroup& group, Rng& rng) {
  Eigen::VectorXd q = random_configuration(group, rng);
  for (Eigen::Index i = 0; i < q.size(); ++i)
    if (group.upper()[i] == group.robot().base_limits().workspace) q[i] /= 50;
  return q;
}

}  // namespace

TEST(SpatialJoints, ColumnsNamesLimitsAndWraps) {
  const Robot robot = Robot::from_strings(spatial_urdf());
  const JointGroup group = robot.chain("root", "tip");
  EXPECT_EQ(group.names(),
            (std::vector<std::string>{"deck_joint/x", "deck_joint/y", "deck_joint/theta", "arm_joint", "buoy_joint/x",
                                      "buoy_joint/y", "buoy_joint/z", "buoy_joint/rx", "buoy_joint/ry", "buoy_joint/rz",
                                      "kite_joint/x", "kite_joint/y", "kite_joint/z", "kite_joint/rx", "kite_joint/ry",
                                      "kite_joint/rz"}));
  ASSERT_EQ(group.size(), 16);
  const int deck = robot.joint_index("deck_joint"), buoy = robot.joint_index("buoy_joint");
  EXPECT_EQ(group.joints()[0], deck);
  EXPECT_EQ(group.joints()[2], deck);
  EXPECT_EQ(group.joints()[3], robot.joint_index("arm_joint"));
  EXPECT_EQ(group.joints()[9], buoy);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(group.wraps()[i], i == 2) << i;
  EXPECT_TRUE(group.sample_lower().allFinite());
  EXPECT_TRUE(group.sample_upper().allFinite());
  EXPECT_EQ(group.upper()[0], robot.base_limits().workspace);
  EXPECT_EQ(group.sample_lower()[2], -M_PI);
  EXPECT_TRUE(std::isinf(group.upper()[2]));
  EXPECT_EQ(group.upper()[9], M_PI);
}

TEST(SpatialJoints, ValuesReachTheRobotInTheirOwnPlaces) {
  const Robot robot = Robot::from_strings(spatial_urdf());
  ASSERT_EQ(robot.value_count(), 16);
  const JointGroup group = robot.chain("root", "tip");
  Eigen::VectorXd q(16);
  for (int i = 0; i < 16; ++i) q[i] = 0.1 * i - 0.7;
  const Eigen::VectorXd values = group.full_values(q);
  for (int i = 0; i < 16;) {
    const Joint& each = robot.joints()[group.joints()[i]];
    for (int k = 0; k < each.value_count(); ++k, ++i) EXPECT_EQ(values[each.value_index + k], q[i]);
  }
  // A part of the robot: what it leaves out stays where the reference holds it.
  const JointGroup part = robot.chain("deck", "buoy").with_reference(values);
  EXPECT_EQ(part.size(), 7);
  EXPECT_EQ(part.full_values(q.segment(3, 7)), values);
  EXPECT_LT((part.fk(q.segment(3, 7)).matrix() - robot.link_poses(values)[part.tip_link()].matrix()).norm(), 1e-12);
}

TEST(SpatialJoints, ClosedForms) {
  const Robot floor = Robot::from_strings(
      "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>" +
      joint("p", "planar", "a", "b", "<origin xyz=\"1 2 3\" rpy=\"0 0 0.4\"/><axis xyz=\"0 0 1\"/>") + "</robot>");
  const Pose on_floor = floor.chain("a", "b").fk(Eigen::Vector3d(0.5, -0.3, 2.1));
  EXPECT_LT(
      (on_floor.matrix() - (pose_from_xyz_rpy({1, 2, 3}, {0, 0, 0.4}) * pose_from_planar({0.5, -0.3, 2.1})).matrix())
          .norm(),
      1e-14);
  const Robot free = Robot::from_strings("<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>" +
                                         joint("f", "floating", "a", "b", "") + "</robot>");
  const JointGroup group = free.chain("a", "b");
  // About an axis through the angle that is the vector's length; the Jacobian along the vector itself is the axis.
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 2) / 3;
  for (const double angle : {0.0, 1e-9, 1e-5, 0.3, 3.0, M_PI}) {
    Eigen::VectorXd q(6);
    q << 0.1, 0.2, 0.3, angle * axis;
    const Pose T = group.fk(q);
    EXPECT_LT((T.linear() - Eigen::AngleAxisd(angle, axis).toRotationMatrix()).norm(), 1e-14);
    EXPECT_LT((T.translation() - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-15);
    const Matrix6Xd J = group.jacobian(q);
    EXPECT_LT((J.bottomRightCorner<3, 3>() * axis - axis).norm(), 1e-14);
    // Across the axis it stretches by 2 sin(angle / 2) / angle.
    const Eigen::Vector3d across = axis.unitOrthogonal();
    const double stretch = angle > 0 ? 2 * std::sin(angle / 2) / angle : 1;
    EXPECT_NEAR((J.bottomRightCorner<3, 3>() * across).norm(), stretch, 1e-14);
    EXPECT_LT((J.leftCols<3>().topRows<3>() - Eigen::Matrix3d::Identity()).norm(), 1e-15);
    EXPECT_EQ((J.bottomLeftCorner<3, 3>().norm()), 0.0);
  }
}

TEST(SpatialJoints, PosesAndJacobiansOnEveryInstructionSet) {
  RobotOptions omni;
  omni.base = BaseKind::omni;
  const Robot fixed = Robot::from_strings(spatial_urdf()), mobile = Robot::from_strings(spatial_urdf(), "", omni);
  std::vector<JointGroup> groups{
      fixed.chain("root", "tip"), fixed.chain("root", "tip").at(pose_from_xyz_rpy({3, -7, 1}, {1, 2, 3})),
      mobile.chain("root", "tip", true), mobile.chain("deck", "kite", true), fixed.chain("root", "deck")};
  on_every_instruction_set([&] {
    Rng rng(51);
    for (const JointGroup& group : groups) {
      SCOPED_TRACE(group.name());
      for (int i = 0; i < 20; ++i) {
        const Eigen::VectorXd q = near_configuration(group, rng);
        expect_link_poses_agree(group, q);
        EXPECT_LT((group.jacobian(q) - numeric_jacobian(group, q)).cwiseAbs().maxCoeff(), 1e-7);
        for (int link = 0; link < static_cast<int>(group.robot().links().size()); ++link) {
          const Eigen::Vector3d point(0.2, -0.1, 0.4);
          EXPECT_LT((group.jacobian(q, link, point) - numeric_jacobian(group, q, link, point)).cwiseAbs().maxCoeff(),
                    1e-7);
        }
      }
    }
  });
}

TEST(SpatialJoints, MovedOnlyAndBatchesGiveTheSame) {
  const JointGroup group = Robot::from_strings(spatial_urdf()).chain("arm", "tip");
  Rng rng(52);
  Eigen::MatrixXd Q(group.size(), 11);
  for (Eigen::Index i = 0; i < Q.cols(); ++i) Q.col(i) = near_configuration(group, rng);
  Poses tips, reused, fresh;
  Matrix6Xd J;
  fk_jacobian_batch(group, Q, tips, J);
  for (Eigen::Index i = 0; i < Q.cols(); ++i) {
    EXPECT_EQ((tips[i].matrix() - group.fk(Q.col(i)).matrix()).norm(), 0.0);
    EXPECT_EQ((J.middleCols(i * group.size(), group.size()) - group.jacobian(Q.col(i))).norm(), 0.0);
    group.link_poses(Q.col(i), reused, i > 0);
    fresh.clear();
    group.link_poses(Q.col(i), fresh);
    for (std::size_t k = 0; k < fresh.size(); ++k) EXPECT_EQ((fresh[k].matrix() - reused[k].matrix()).norm(), 0.0);
  }
}
