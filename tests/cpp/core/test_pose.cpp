#include "mmgrasp/core/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <kdl/frames.hpp>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

using namespace mmgrasp;

namespace {

Eigen::Matrix3d from_kdl(const KDL::Rotation& R) {
  Eigen::Matrix3d M;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) M(i, j) = R(i, j);
  return M;
}

}  // namespace

TEST(Pose, RpyMatchesKdl) {
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d rpy(rng.uniform(-4, 4), rng.uniform(-4, 4), rng.uniform(-4, 4));
    const Eigen::Matrix3d expected = from_kdl(KDL::Rotation::RPY(rpy[0], rpy[1], rpy[2]));
    EXPECT_LT((pose_from_xyz_rpy({1, 2, 3}, rpy).linear() - expected).norm(), 1e-14);
  }
}

TEST(Pose, RpyRoundTripAlsoAtAndNearGimbalLock) {
  for (const double pitch : {M_PI / 2, -M_PI / 2}) {
    for (const double offset : {0.0, 1e-13, 1e-9, 1e-6, 1e-3, 0.7}) {
      const double p = pitch > 0 ? pitch - offset : pitch + offset;
      const Pose T = pose_from_xyz_rpy({0, 0, 0}, {0.4, p, -1.1});
      const Eigen::Vector3d rpy = rpy_from_rotation(T.linear());
      EXPECT_LT((pose_from_xyz_rpy({0, 0, 0}, rpy).linear() - T.linear()).norm(), 1e-11) << "offset " << offset;
      if (offset == 0) {
        EXPECT_EQ(rpy[0], 0.0);
      }
      if (offset >= 1e-3) {
        EXPECT_LT((rpy - Eigen::Vector3d(0.4, p, -1.1)).norm(), 1e-11);
      }
    }
  }
}

TEST(Pose, QuaternionRoundTripAndNormRule) {
  Rng rng(2);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Quaterniond q = rng.rotation();
    const Pose T = pose_from_xyz_quat({1, 2, 3}, q.coeffs());
    const Eigen::Vector4d back = quat_xyzw_from_rotation(T.linear());
    EXPECT_NEAR(std::abs(back.dot(q.coeffs())), 1.0, 1e-12);
    EXPECT_GE(back[3], 0);
  }
  EXPECT_THROW(pose_from_xyz_quat({0, 0, 0}, {0, 0, 0, 1.1}), InvalidInput);
  EXPECT_THROW(pose_from_xyz_quat({0, 0, 0}, {0, 0, 0, 0}), InvalidInput);
}

TEST(Pose, RotationVectorIsExactAtBothEnds) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
  for (const double angle : {0.0, 1e-14, 1e-9, 1e-5, 0.3, 2.0, M_PI - 1e-5, M_PI - 1e-9, M_PI}) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const Eigen::Vector3d v = rotation_vector(R);
    EXPECT_NEAR(v.norm(), angle, 1e-14 + 1e-15 * angle) << angle;
    // At exactly pi both signs of the axis are right.
    EXPECT_LT(std::min((v - angle * axis).norm(), angle == M_PI ? (v + angle * axis).norm() : 1e9), 1e-9) << angle;
  }
  EXPECT_EQ(rotation_vector(Eigen::Matrix3d::Identity()).norm(), 0.0);
}

TEST(Pose, DifferenceIsWorldAligned) {
  const Pose from = pose_from_xyz_rpy({1, 2, 3}, {0.3, 0.2, 0.1});
  const Eigen::Vector3d turn(0.1, -0.4, 0.2);
  Pose to = from;
  to.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * from.linear();
  to.translation() += Eigen::Vector3d(0.5, 0, -1);
  const Vector6d d = pose_difference(from, to);
  EXPECT_LT((d.head<3>() - Eigen::Vector3d(0.5, 0, -1)).norm(), 1e-15);
  EXPECT_LT((d.tail<3>() - turn).norm(), 1e-14);
  EXPECT_NEAR(rotation_distance(from, to), turn.norm(), 1e-14);
}

TEST(Pose, CheckedPoseNamesFieldAndRule) {
  Eigen::Matrix4d T = pose_from_xyz_rpy({1, 2, 3}, {0.3, 0.2, 0.1}).matrix();
  EXPECT_EQ(checked_pose(T, "pose").matrix(), T);
  const auto message = [](const Eigen::Matrix4d& bad) {
    try {
      checked_pose(bad, "tray pose");
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  Eigen::Matrix4d bad = T;
  bad(0, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message(bad).find("tray pose(0, 3) = nan"), std::string::npos) << message(bad);
  bad = T;
  bad(0, 0) += 1e-3;
  EXPECT_NE(message(bad).find("tray pose rotation"), std::string::npos);
  bad = T;
  bad.col(2).head<3>() *= -1;
  EXPECT_NE(message(bad).find("mirror"), std::string::npos);
  bad = T;
  bad(3, 0) = 1;
  EXPECT_NE(message(bad).find("last row"), std::string::npos);
}

TEST(Pose, WrapAngle) {
  EXPECT_EQ(wrap_angle(M_PI), M_PI);
  EXPECT_EQ(wrap_angle(-M_PI), M_PI);
  EXPECT_NEAR(wrap_angle(5 * M_PI / 2), M_PI / 2, 1e-15);
  EXPECT_NEAR(wrap_angle(-7.0), -7.0 + 2 * M_PI, 1e-15);
  EXPECT_NEAR(wrap_angle(7), 7 - 2 * M_PI, 1e-15);
  EXPECT_EQ(wrap_angle(0.25), 0.25);
  EXPECT_EQ(wrap_angle(-0.5), -0.5);
}

TEST(Pose, PlanarIsAPoseOnTheFloor) {
  const Pose T = pose_from_planar({1, 2, 0.5});
  EXPECT_LT((T.matrix() - pose_from_xyz_rpy({1, 2, 0}, {0, 0, 0.5}).matrix()).norm(), 1e-15);
}
