#include "mmgrasp/robot/manipulability.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "support/kinematics_support.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

constexpr double kLengths[] = {0.5, 0.3, 0.2};

/// Links in the x-y plane that turn about z.
JointGroup planar_arm(int joints) {
  std::string urdf = "<robot name=\"planar\"><link name=\"l0\"/>";
  double before = 0;
  for (int i = 0; i <= joints; ++i) {
    const std::string a = std::to_string(i), b = std::to_string(i + 1);
    urdf += "<link name=\"l" + b + "\"/><joint name=\"j" + b + "\" type=\"" + (i < joints ? "continuous" : "fixed") +
            "\"><parent link=\"l" + a + "\"/><child link=\"l" + b + "\"/><origin xyz=\"" + std::to_string(before) +
            " 0 0\"/><axis xyz=\"0 0 1\"/></joint>";
    before = kLengths[i % 3];
  }
  return Robot::from_strings(urdf + "</robot>").chain("l0", "l" + std::to_string(joints + 1));
}

/// The tip's velocity per joint velocity, by hand.
Eigen::MatrixXd planar_jacobian(const Eigen::VectorXd& q) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2, q.size());
  double angle = 0;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    angle += q[i];
    for (Eigen::Index k = 0; k <= i; ++k) J.col(k) += kLengths[i] * Eigen::Vector2d(-std::sin(angle), std::cos(angle));
  }
  return J;
}

Eigen::Vector3d direction(double angle) {
  return {std::cos(angle), std::sin(angle), 0};
}

}  // namespace

TEST(Manipulability, PlanarTwoJointArmInClosedForm) {
  const JointGroup arm = planar_arm(2);
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::VectorXd q = random_configuration(arm, rng);
    const Eigen::Matrix2d J = planar_jacobian(q);
    const Eigen::Vector3d z = direction(rng.uniform(-3.0, 3.0));
    // By hand: J^-1 from the adjugate, det J = l1 l2 sin q2.
    const double det = kLengths[0] * kLengths[1] * std::sin(q[1]);
    const Eigen::Vector2d rates(J(1, 1) * z[0] - J(0, 1) * z[1], -J(1, 0) * z[0] + J(0, 0) * z[1]);
    const double alpha = std::abs(det) / rates.norm();
    const double beta = 1 / Eigen::Vector2d(J.transpose() * z.head<2>()).norm();
    EXPECT_NEAR(velocity_manipulability(arm, q, 7.5 * z), alpha,
                1e-10 * std::max(1.0, alpha));  // lengths do not matter
    EXPECT_NEAR(force_manipulability(arm, q, 7.5 * z), beta, 1e-10 * beta);
  }
}

TEST(Manipulability, DirectionsInWhichAPlanarArmCannotMove) {
  const JointGroup arm = planar_arm(3);
  Eigen::VectorXd q(3);
  q << 0.3, 0.8, -0.4;
  const Eigen::Vector3d up(0, 0, 1);
  EXPECT_EQ(velocity_manipulability(arm, q, up), 0.0);
  EXPECT_TRUE(std::isinf(force_manipulability(arm, q, up)));
  EXPECT_EQ(velocity_manipulability(arm, q, Eigen::Vector3d(1, 0, 1e-3)), 0.0);
  EXPECT_GT(velocity_manipulability(arm, q, Eigen::Vector3d(1, 0, 0)), 0.1);
  // Stretched out: not along itself, but across with the lengths from each joint to the tip.
  q << 0.7, 0, 0;
  EXPECT_EQ(velocity_manipulability(arm, q, direction(0.7)), 0.0);
  EXPECT_TRUE(std::isinf(force_manipulability(arm, q, direction(0.7))));
  const double stretch = std::sqrt(1.0 * 1.0 + 0.5 * 0.5 + 0.2 * 0.2);
  EXPECT_NEAR(velocity_manipulability(arm, q, direction(0.7 + M_PI_2)), stretch, 1e-12);
  EXPECT_NEAR(force_manipulability(arm, q, direction(0.7 + M_PI_2)), 1 / stretch, 1e-12);
  EXPECT_EQ(arm.manipulability(q), 0.0);  // fewer than six joints span no volume of twists
}

TEST(Manipulability, StaysRightNextToASingularity) {
  const JointGroup arm = planar_arm(2);
  for (const double bend : {1e-3, 1e-6, 1e-9}) {
    const Eigen::VectorXd q = Eigen::Vector2d(0, bend);
    // Along the arm: rates (l2 cos q2, -(l1 + l2 cos q2)) / (l1 l2 sin q2) to first order.
    const double c = kLengths[1] * std::cos(bend), det = kLengths[0] * kLengths[1] * std::sin(bend);
    const double alpha = det / std::hypot(c, kLengths[0] + c);
    EXPECT_NEAR(velocity_manipulability(arm, q, Eigen::Vector3d(1, 0, 0)) / alpha, 1, 1e-6) << bend;
  }
  MMGRASP_NEEDS_SHARED_DATA();
  // A UR's volume is sin(wrist 2) times what does not depend on it.
  const JointGroup ur = load_kinematics("robots/ur/expanded/ur5e.urdf").chain("base_link", "tool0");
  Eigen::VectorXd q(6);
  q << 0.4, -1.1, 1.3, -0.6, M_PI_2, 0.8;
  const double whole = ur.manipulability(q);
  EXPECT_GT(whole, 0.01);
  for (const double wrist : {1e-2, 1e-5, 1e-8, 1e-10}) {
    q[4] = wrist;
    EXPECT_NEAR(ur.manipulability(q) / (whole * std::sin(wrist)), 1, 1e-4) << wrist;
  }
}

TEST(Manipulability, VolumeIsTheProductOfSingularValues) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  Rng rng(9);
  for (int i = 0; i < 50; ++i) {
    const Eigen::VectorXd q = random_configuration(group, rng);
    const double expected = Eigen::JacobiSVD<Eigen::MatrixXd>(group.jacobian(q)).singularValues().prod();
    EXPECT_NEAR(group.manipulability(q), expected, 1e-13);
  }
}

TEST(Manipulability, EllipsoidsMatchSingularValuesAndTheirProductIsAtMostOne) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  Rng rng(10);
  int below = 0;
  for (int i = 0; i < 100; ++i) {
    const Eigen::VectorXd q = random_configuration(group, rng);
    for (const int rows : {3, 6}) {
      const Eigen::MatrixXd J = group.jacobian(q).topRows(rows);
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeThinU | Eigen::ComputeThinV);
      Eigen::VectorXd z = rng.uniform(Eigen::VectorXd::Constant(rows, -1), Eigen::VectorXd::Constant(rows, 1));
      z.normalize();
      const Eigen::VectorXd along = svd.matrixU().transpose() * z;
      const double alpha = 1 / along.cwiseQuotient(svd.singularValues()).norm();
      const double beta = 1 / along.cwiseProduct(svd.singularValues()).norm();
      EXPECT_NEAR(velocity_manipulability(group, q, z) / alpha, 1, 1e-9);
      EXPECT_NEAR(force_manipulability(group, q, z) / beta, 1, 1e-9);
      // P2 takes the smallest of one for the largest of the other: true along the axes only (docs/errata.md).
      EXPECT_LE(alpha * beta, 1 + 1e-12);
      below += velocity_manipulability(group, q, z) * force_manipulability(group, q, z) < 0.9;
      for (int k = 0; k < rows; ++k) {
        const Eigen::VectorXd axis = svd.matrixU().col(k);
        EXPECT_NEAR(velocity_manipulability(group, q, axis) / svd.singularValues()[k], 1, 1e-8);
        EXPECT_NEAR(velocity_manipulability(group, q, axis) * force_manipulability(group, q, axis), 1, 1e-8);
      }
    }
  }
  EXPECT_GT(below, 100);
}

TEST(Manipulability, ADirectionMustBeOne) {
  const JointGroup arm = planar_arm(3);
  const Eigen::VectorXd q = Eigen::Vector3d(0.1, 0.2, 0.3);
  for (const Eigen::VectorXd& bad : {Eigen::VectorXd(Eigen::Vector3d(0, 0, 0)), Eigen::VectorXd(Eigen::Vector2d(1, 0)),
                                     Eigen::VectorXd(Eigen::Vector3d(1, std::nan(""), 0))}) {
    EXPECT_THROW(velocity_manipulability(arm, q, bad), InvalidInput);
    EXPECT_THROW(force_manipulability(arm, q, bad), InvalidInput);
  }
  EXPECT_THROW(velocity_manipulability(arm, Eigen::Vector2d(0, 0), Eigen::Vector3d(1, 0, 0)), InvalidInput);
}
