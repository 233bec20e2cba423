// Grasps whose approach is given: for parts that lie in one pose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <variant>

#include "grasp/placed_shape.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/grasp/sample_grasps.hpp"

namespace mmgrasp {
namespace {

constexpr double kPi = 3.14159265358979323846;

using test::shape_at;
using test::wide_gripper;

Eigen::Vector3d approach_of(const Grasp& grasp) {
  return grasp.T_object_hand.linear() * wide_gripper().approach;
}

Eigen::Vector3d closing_of(const Grasp& grasp) {
  return grasp.T_object_hand.linear() * wide_gripper().closing;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

std::vector<Grasp> grasps_along(const LinkShape& part, const Eigen::Vector3d& direction) {
  GraspSamplerOptions options;
  options.max_grasps = 1000000;
  options.approach_direction = direction;
  return sample_grasps({part}, wide_gripper(), options).grasps;
}

std::vector<Grasp> at_contacts(std::vector<Grasp> grasps) {
  const auto flush = [](const Grasp& grasp) { return std::get<ContactPairProvenance>(grasp.provenance).tips_flush; };
  grasps.erase(std::remove_if(grasps.begin(), grasps.end(), flush), grasps.end());
  return grasps;
}

std::multiset<double> openings_of(const std::vector<Grasp>& grasps) {
  std::multiset<double> openings;
  for (const Grasp& grasp : grasps) openings.insert(grasp.opening);
  return openings;
}

bool is_among(const std::vector<Grasp>& grasps, const Grasp& wanted) {
  return std::any_of(grasps.begin(), grasps.end(), [&](const Grasp& grasp) {
    return (grasp.T_object_hand.matrix() - wanted.T_object_hand.matrix()).norm() < 1e-9;
  });
}

/// A rod about z of flat sides, with its ends.
LinkShape rod_mesh(double radius, double length, int sides) {
  std::vector<Eigen::Vector3d> corners;
  for (const double z : {-length / 2, length / 2})
    for (int i = 0; i < sides; ++i)
      corners.emplace_back(radius * std::cos(2 * kPi * i / sides), radius * std::sin(2 * kPi * i / sides), z);
  return shape_at(MeshShape{convex_hull(corners)});
}

TEST(ApproachDirection, OfABoxKeepsThoseOfAllThatApproachSo) {
  const Pose T = pose_from_xyz_rpy({0.1, -0.2, 0.3}, {0.4, -0.7, 1.1});
  const LinkShape box = shape_at(Box{{0.03, 0.05, 0.08}}, T);
  const Eigen::Vector3d down = -T.linear().col(2);
  const std::vector<Grasp> along = grasps_along(box, down);
  GraspSamplerOptions options;
  options.max_grasps = 1000000;
  std::size_t expected = 0;
  for (const Grasp& grasp : sample_grasps({box}, wide_gripper(), options).grasps) {
    if (angle_between(approach_of(grasp), down) > 1e-6) continue;
    ++expected;
    EXPECT_TRUE(is_among(along, grasp));
  }
  EXPECT_EQ(along.size(), expected);
  EXPECT_EQ(at_contacts(along).size(), 2u * 9 * 2);  // two closing axes, nine places, the hand either way
}

TEST(ApproachDirection, AnglesOfFourDecimalsAreStraight) {
  // 1.5708 for a quarter of a turn leaves the direction 3.7e-6 rad beside the box's axis.
  const Eigen::Vector3d down =
      pose_from_xyz_rpy({0, 0, 0}, {1.5708, 0, 0}).linear().transpose() * Eigen::Vector3d(0, 0, -1);
  for (const Shape& shape : {Shape{Box{{0.03, 0.05, 0.04}}}, Shape{Cylinder{0.02, 0.06}}, Shape{Capsule{0.02, 0.04}}}) {
    const std::vector<Grasp> near = at_contacts(grasps_along(shape_at(shape), down));
    const std::vector<Grasp> exact = at_contacts(grasps_along(shape_at(shape), {0, -1, 0}));
    ASSERT_FALSE(exact.empty());
    EXPECT_EQ(openings_of(near), openings_of(exact));
    for (const Grasp& grasp : near) {
      const Eigen::Matrix3d R = grasp.T_object_hand.linear();
      EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-12);
      EXPECT_LT(angle_between(approach_of(grasp), down), 4e-6);
    }
  }
}

TEST(ApproachDirection, ACylinderIsHeldAcrossItselfHoweverItIsRolled) {
  const double radius = 0.02, length = 0.07;
  const Eigen::Vector3d down(std::cos(0.3), std::sin(0.3), 0);
  const std::vector<Grasp> grasps = at_contacts(grasps_along(shape_at(Cylinder{radius, length}), down));
  int across = 0, along = 0;
  for (const Grasp& grasp : grasps) {
    EXPECT_LT(angle_between(approach_of(grasp), down), 1e-9);
    const bool is_along = std::abs(closing_of(grasp).z()) > 0.5;
    ++(is_along ? along : across);
    EXPECT_NEAR(grasp.opening, is_along ? length : 2 * radius, 1e-12);
  }
  EXPECT_EQ(across, 3 * 2);
  EXPECT_EQ(along, 9 * 2);
}

TEST(ApproachDirection, ABallIsHeldFromAnywhere) {
  const Eigen::Vector3d down = Eigen::Vector3d(0.3, -0.5, 0.7).normalized();
  const std::vector<Grasp> grasps = at_contacts(grasps_along(shape_at(Sphere{0.02}), down));
  ASSERT_EQ(grasps.size(), 8u * 2);
  for (const Grasp& grasp : grasps) {
    EXPECT_LT(angle_between(approach_of(grasp), down), 1e-9);
    EXPECT_NEAR(grasp.opening, 0.04, 1e-12);
  }
}

TEST(ApproachDirection, FindsManyGraspsOfARodMeshWhereFewOfAllAreStraight) {
  const double radius = 0.012;
  const int sides = 32;
  const LinkShape rod = rod_mesh(radius, 0.12, sides);
  const Eigen::Vector3d down(std::cos(0.05), std::sin(0.05), 0);  // 2.9 degrees from a facet's edge
  GraspSamplerOptions options;
  const auto is_straight = [&](const Grasp& grasp) { return angle_between(approach_of(grasp), down) < 1e-3; };
  const std::vector<Grasp> all = sample_grasps({rod}, wide_gripper(), options).grasps;
  EXPECT_LT(std::count_if(all.begin(), all.end(), is_straight), 8);
  options.approach_direction = down;
  const std::vector<Grasp> along = sample_grasps({rod}, wide_gripper(), options).grasps;
  EXPECT_GE(along.size(), 100u);
  EXPECT_LE(along.size(), 200u);  // max_grasps
  for (const Grasp& grasp : along) {
    EXPECT_LT(angle_between(approach_of(grasp), down), 1e-9);
    if (std::abs(closing_of(grasp).z()) > 1e-6) continue;  // not straight across the rod
    EXPECT_LE(grasp.opening, 2 * radius + 1e-9);
    EXPECT_GE(grasp.opening, 2 * radius * std::cos(kPi / sides) - 1e-9);
  }
  const std::vector<Grasp> again = sample_grasps({rod}, wide_gripper(), options).grasps;
  ASSERT_EQ(again.size(), along.size());
  for (std::size_t i = 0; i < along.size(); ++i)
    EXPECT_EQ(again[i].T_object_hand.matrix(), along[i].T_object_hand.matrix());
}

TEST(ApproachDirection, ABoxThatLeansIsHeldAsItsMesh) {
  const Eigen::Vector3d size(0.06, 0.04, 0.02);
  const double tilt = 15 * kPi / 180;  // about the box's x axis
  const Eigen::Vector3d down(0, -std::sin(tilt), -std::cos(tilt));
  // The pads are longer than the box is high as it leans, so that they meet its outermost edges.
  const double across = size.y() * std::cos(tilt) + size.z() * std::sin(tilt);
  ASSERT_LT(size.z() * std::cos(tilt) + size.y() * std::sin(tilt), wide_gripper().finger_depth);
  double widest = 0;
  int along_x = 0;
  for (const Grasp& grasp : grasps_along(shape_at(Box{size}), down)) {
    EXPECT_LT(angle_between(approach_of(grasp), down), 1e-9);
    const bool is_along_x = std::abs(closing_of(grasp).x()) > std::cos(1e-3);
    along_x += is_along_x;
    if (is_along_x) {
      EXPECT_NEAR(grasp.opening, size.x(), 1e-4);
    }
    if (std::abs(closing_of(grasp).x()) < std::sin(1e-3)) widest = std::max(widest, grasp.opening);
  }
  EXPECT_GE(along_x, 8);
  EXPECT_NEAR(widest, across, 1e-4);
}

TEST(ApproachDirection, RefusesWhatIsNoDirection) {
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, -2), Eigen::Vector3d(std::nan(""), 0, 1)})
    EXPECT_THROW(grasps_along(shape_at(Sphere{0.02}), direction), InvalidInput) << direction.transpose();
  EXPECT_FALSE(grasps_along(shape_at(Sphere{0.02}), {0.7071, 0, -0.7071}).empty());
}

}  // namespace
}  // namespace mmgrasp
