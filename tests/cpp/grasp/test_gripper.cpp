#include "mmgrasp/grasp/gripper.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

Gripper two_fingers() {
  Gripper gripper;
  gripper.max_opening = 0.08;
  gripper.clearance = 0.01;
  gripper.joints = {{"left", 0.0, 0.04}, {"knuckle", 0.8, 0.0}};
  return gripper;
}

/// The message names the field.
void expect_refused(const Gripper& gripper, const std::string& field) {
  try {
    gripper.check();
    ADD_FAILURE() << field << " was accepted";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
  }
}

TEST(Gripper, FingerJointsAreLinearInTheOpening) {
  const Gripper gripper = two_fingers();
  const auto closed = gripper.joint_values(0), half = gripper.joint_values(0.04), open = gripper.joint_values(0.08);
  EXPECT_DOUBLE_EQ(closed.at("left"), 0.0);
  EXPECT_DOUBLE_EQ(closed.at("knuckle"), 0.8);
  EXPECT_DOUBLE_EQ(half.at("left"), 0.02);
  EXPECT_DOUBLE_EQ(half.at("knuckle"), 0.4);
  EXPECT_DOUBLE_EQ(open.at("left"), 0.04);
  EXPECT_DOUBLE_EQ(open.at("knuckle"), 0.0);
  EXPECT_EQ(open.size(), 2u);
}

TEST(Gripper, RefusesOpeningsOutsideItsRange) {
  const Gripper gripper = two_fingers();
  EXPECT_THROW(gripper.joint_values(-0.001), InvalidInput);
  EXPECT_THROW(gripper.joint_values(0.081), InvalidInput);
  EXPECT_THROW(gripper.joint_values(std::numeric_limits<double>::quiet_NaN()), InvalidInput);
  EXPECT_THROW(gripper.pregrasp_opening(0.09), InvalidInput);
}

TEST(Gripper, PregraspOpeningAddsClearanceUpToTheWidest) {
  const Gripper gripper = two_fingers();
  EXPECT_DOUBLE_EQ(gripper.pregrasp_opening(0.03), 0.05);
  EXPECT_DOUBLE_EQ(gripper.pregrasp_opening(0.07), 0.08);
  EXPECT_DOUBLE_EQ(gripper.pregrasp_opening(0.08), 0.08);
}

TEST(Gripper, CheckNamesTheField) {
  EXPECT_NO_THROW(two_fingers().check());
  Gripper gripper = two_fingers();
  gripper.approach = {1, 0.1, 0};
  expect_refused(gripper, "gripper.approach");
  gripper = two_fingers();
  gripper.closing = Eigen::Vector3d(1, 1, 0).normalized();
  expect_refused(gripper, "gripper.closing");
  gripper = two_fingers();
  gripper.max_opening = 0;
  expect_refused(gripper, "gripper.max_opening");
  gripper = two_fingers();
  gripper.finger_depth = -0.01;
  expect_refused(gripper, "gripper.finger_depth");
  gripper = two_fingers();
  gripper.finger_width = std::numeric_limits<double>::infinity();
  expect_refused(gripper, "gripper.finger_width");
  gripper = two_fingers();
  gripper.clearance = std::numeric_limits<double>::quiet_NaN();
  expect_refused(gripper, "gripper.clearance");
  gripper = two_fingers();
  gripper.joints.push_back({"left", 0, 1});
  expect_refused(gripper, "left");
}

}  // namespace
}  // namespace mmgrasp
