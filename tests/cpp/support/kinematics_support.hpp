#pragma once

#include <gtest/gtest.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include "mmgrasp/core/detail/instruction_set.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/kinematics_batch.hpp"
#include "support/robot_support.hpp"

namespace mmgrasp::testing_support {

inline Eigen::VectorXd random_configuration(const JointGroup& group, Rng& rng) {
  return rng.uniform(group.sample_lower(), group.sample_upper());
}

/// Two hands on one turning trunk; a joint of the right one follows the left one's.
inline Robot two_hands(BaseKind base = BaseKind::fixed) {
  std::string urdf = "<robot name=\"hands\">";
  for (const char* link : {"root", "trunk", "left", "left_tip", "right", "right_slide", "right_tip"})
    urdf += std::string("<link name=\"") + link + "\"/>";
  const auto joint = [&](const char* name, const char* type, const char* parent, const char* child, const char* rest) {
    urdf += std::string("<joint name=\"") + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
            "\"/><child link=\"" + child + "\"/>" + rest + "<limit lower=\"-2\" upper=\"2\" velocity=\"1\"/></joint>";
  };
  joint("turn", "revolute", "root", "trunk", "<origin xyz=\"0 0 1\" rpy=\"0.1 0.2 0\"/><axis xyz=\"0 0 1\"/>");
  joint("left_joint", "revolute", "trunk", "left", "<origin xyz=\"0.2 0.3 0\"/><axis xyz=\"1 0.5 0\"/>");
  joint("left_end", "fixed", "left", "left_tip", "<origin xyz=\"0 0 0.4\" rpy=\"0 1 0\"/>");
  joint("right_joint", "revolute", "trunk", "right",
        "<origin xyz=\"0.2 -0.3 0\"/><axis xyz=\"1 -0.5 0\"/><mimic joint=\"left_joint\" multiplier=\"-0.7\" "
        "offset=\"0.2\"/>");
  joint("right_slide_joint", "prismatic", "right", "right_slide", "<origin xyz=\"0 0 0.2\"/><axis xyz=\"0 0.6 0.8\"/>");
  joint("right_end", "fixed", "right_slide", "right_tip", "<origin xyz=\"0.1 0 0\" rpy=\"0.3 0 0\"/>");
  RobotOptions options;
  options.base = base;
  return Robot::from_strings(
      urdf + "</robot>",
      "<robot name=\"hands\"><group name=\"all\"><joint name=\"turn\"/><joint name=\"left_joint\"/>"
      "<joint name=\"right_slide_joint\"/></group></robot>",
      options);
}

/// Runs a test body on every code path that this machine has, then puts the fastest back.
template <class Body>
void on_every_instruction_set(const Body& body) {
  const std::vector<std::string> sets = detail::instruction_sets();
  for (const std::string& set : sets) {
    detail::use_instruction_set(set);
    SCOPED_TRACE(set);
    body();
  }
  detail::use_instruction_set(sets.front());
}

/// By central differences of a point that moves with a link, through the slow general Robot::link_poses.
inline Matrix6Xd numeric_jacobian(const JointGroup& group, const Eigen::VectorXd& q, int link,
                                  const Eigen::Vector3d& p_link_point) {
  const double h = 1e-6;
  const auto pose = [&](const Eigen::VectorXd& at) -> Pose {
    return group.robot().link_poses(group.full_values(at), group.root_pose(at))[link] *
           Eigen::Translation3d(p_link_point);
  };
  Matrix6Xd J(6, group.size());
  for (int i = 0; i < group.size(); ++i) {
    Eigen::VectorXd a = q, b = q;
    a[i] -= h;
    b[i] += h;
    J.col(i) = pose_difference(pose(a), pose(b)) / (2 * h);
  }
  return J;
}

inline Matrix6Xd numeric_jacobian(const JointGroup& group, const Eigen::VectorXd& q) {
  return numeric_jacobian(group, q, group.tip_link(), Eigen::Vector3d::Zero());
}

/// Group and Robot::link_poses must agree on every link; the latter is the plain, slow way.
inline void expect_link_poses_agree(const JointGroup& group, const Eigen::VectorXd& q) {
  const Poses expected = group.robot().link_poses(group.full_values(q), group.root_pose(q));
  Poses actual;
  group.link_poses(q, actual);
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i)
    EXPECT_LT((actual[i].matrix() - expected[i].matrix()).norm(), 1e-12) << group.robot().links()[i].name;
  EXPECT_LT((group.fk(q).matrix() - expected[group.tip_link()].matrix()).norm(), 1e-12);
}

/// Pose and Jacobian of a point on the tip by KDL, for groups that hold every joint between the root and their tip.
inline void kdl_kinematics(const JointGroup& group, const Eigen::VectorXd& q, const Eigen::Vector3d& p_tip_point,
                           Pose& T, Matrix6Xd& J) {
  KDL::Chain chain = kdl_chain(group.robot(), group.tip_link());
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::Fixed),
                                KDL::Frame(KDL::Vector(p_tip_point[0], p_tip_point[1], p_tip_point[2]))));
  ASSERT_EQ(static_cast<int>(chain.getNrOfJoints()), group.size());
  KDL::JntArray angles(chain.getNrOfJoints());
  angles.data = q;
  KDL::Frame frame;
  KDL::Jacobian jacobian(chain.getNrOfJoints());
  ASSERT_GE(KDL::ChainFkSolverPos_recursive(chain).JntToCart(angles, frame), 0);
  ASSERT_GE(KDL::ChainJntToJacSolver(chain).JntToJac(angles, jacobian), 0);
  T.setIdentity();
  for (int r = 0; r < 3; ++r) {
    T(r, 3) = frame.p[r];
    for (int c = 0; c < 3; ++c) T(r, c) = frame.M(r, c);
  }
  J = jacobian.data;
}

inline void expect_kdl_agrees(const JointGroup& group, const Eigen::VectorXd& q) {
  Pose expected_T, T;
  Matrix6Xd expected_J, J(6, group.size());
  ASSERT_NO_FATAL_FAILURE(kdl_kinematics(group, q, Eigen::Vector3d::Zero(), expected_T, expected_J));
  group.fk_jacobian(q, T, J);
  EXPECT_LT((T.matrix() - expected_T.matrix()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((J - expected_J).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace mmgrasp::testing_support
