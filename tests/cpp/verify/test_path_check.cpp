#include "mmgrasp/verify/path_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "support/planar_arm.hpp"

namespace mmgrasp::verify {
namespace {

using Eigen::Vector2d;

PathToCheck two_links(const test::PlanarArm& arm, const Vector2d& from, const Vector2d& to) {
  PathToCheck path{source_of(arm.robot())};
  path.joints = {"j1", "j2"};
  path.waypoints = {from, to};
  return path;
}

CheckedBody box(const Eigen::Vector3d& centre, double size) {
  LinkShape shape;
  shape.shape = Box{{size, size, size}};
  return {"box", {shape}, Pose(Eigen::Translation3d(centre))};
}

TEST(PathCheck, FindsWhereTheArmMeetsABox) {
  const test::PlanarArm arm(2, 0.5, 0.02);
  PathToCheck path = two_links(arm, {-1, 0}, {1, 0});
  EXPECT_TRUE(check_path(path).free);
  EXPECT_EQ(check_path(path).configurations_checked, 401u);  // 2 rad in steps of 0.005, both ends
  // The stretched arm sweeps over the x axis.
  path.bodies = {box({0.8, 0, 0}, 0.1)};
  const PathCheckResult hit = check_path(path);
  EXPECT_FALSE(hit.free);
  EXPECT_NE(hit.where.find("'l2' touches 'box'"), std::string::npos) << hit.where;
  // It comes from below: the corner (0.75, -0.05) and half the arm's width meet at this angle.
  const double angle = -std::atan2(0.05, 0.75) - std::asin(0.01 / std::hypot(0.75, 0.05));
  const double found = std::stod(hit.where.substr(hit.where.find("at ") + 3)) * 2 - 1;
  EXPECT_NEAR(found, angle, 0.006);
  path.bodies = {box({1.2, 0, 0}, 0.1)};
  EXPECT_TRUE(check_path(path).free);
}

TEST(PathCheck, LeavesOutWhatMayTouch) {
  const test::PlanarArm arm(2, 0.5, 0.02);
  PathToCheck path = two_links(arm, {-1, 0}, {1, 0});
  path.bodies = {box({0.8, 0, 0}, 0.1)};
  path.allowed_collisions = {{"box", "l2"}};
  EXPECT_TRUE(check_path(path).free) << check_path(path).where;
  path.bodies.push_back(box({0.3, 0, 0}, 0.1));
  path.bodies.back().name = "near";  // in the way of the first link
  EXPECT_NE(check_path(path).where.find("'l1' touches 'near'"), std::string::npos);
  path.allowed_collisions.emplace_back("l1", "near");
  EXPECT_TRUE(check_path(path).free) << check_path(path).where;
  path.allowed_collisions.emplace_back("l1", "far");
  EXPECT_THROW(check_path(path), InvalidInput);
}

TEST(PathCheck, FindsLimits) {
  const test::PlanarArm arm(2, 0.5, 0.02);
  const PathCheckResult result = check_path(two_links(arm, {2.5, 0}, {2.9, 0}));
  EXPECT_FALSE(result.free);
  EXPECT_NE(result.where.find("joint 'j1'"), std::string::npos);
}

TEST(PathCheck, RefusesBadInput) {
  const test::PlanarArm arm(2, 0.5, 0.02);
  PathToCheck path = two_links(arm, {0, 0}, {1, 0});
  EXPECT_THROW(check_path(path, 0), InvalidInput);
  path.joints = {"j1", "nothing"};
  EXPECT_THROW(check_path(path), InvalidInput);
  path.joints = {"j1"};
  EXPECT_THROW(check_path(path), InvalidInput);
  path = two_links(arm, {0, 0}, {1, std::nan("")});
  EXPECT_THROW(check_path(path), InvalidInput);
  path.waypoints.clear();
  EXPECT_THROW(check_path(path), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp::verify
