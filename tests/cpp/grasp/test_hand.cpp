#include "mmgrasp/grasp/hand.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/robot_support.hpp"
#include "support/tray_scene.hpp"

namespace mmgrasp {
namespace {

Hand two_fingers() {
  Hand hand;
  hand.max_opening = 0.08;
  hand.clearance = 0.01;
  hand.joints = {{"left", 0.0, 0.04}, {"knuckle", 0.8, 0.0}};
  return hand;
}

/// The message names the field.
void expect_refused(const Hand& hand, const std::string& field) {
  try {
    hand.check();
    ADD_FAILURE() << field << " was accepted";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
  }
}

TEST(Hand, JointsAreLinearInTheOpening) {
  const Hand hand = two_fingers();
  const auto closed = hand.joint_values(0), half = hand.joint_values(0.04), open = hand.joint_values(0.08);
  EXPECT_DOUBLE_EQ(closed.at("left"), 0.0);
  EXPECT_DOUBLE_EQ(closed.at("knuckle"), 0.8);
  EXPECT_DOUBLE_EQ(half.at("left"), 0.02);
  EXPECT_DOUBLE_EQ(half.at("knuckle"), 0.4);
  EXPECT_DOUBLE_EQ(open.at("left"), 0.04);
  EXPECT_DOUBLE_EQ(open.at("knuckle"), 0.0);
  EXPECT_EQ(open.size(), 2u);
}

TEST(Hand, RefusesOpeningsOutsideItsRange) {
  const Hand hand = two_fingers();
  EXPECT_THROW(hand.joint_values(-0.001), InvalidInput);
  EXPECT_THROW(hand.joint_values(0.081), InvalidInput);
  EXPECT_THROW(hand.joint_values(std::numeric_limits<double>::quiet_NaN()), InvalidInput);
  EXPECT_THROW(hand.pregrasp_opening(0.09), InvalidInput);
}

TEST(Hand, PregraspOpeningAddsClearanceUpToTheWidest) {
  const Hand hand = two_fingers();
  EXPECT_DOUBLE_EQ(hand.pregrasp_opening(0.03), 0.05);
  EXPECT_DOUBLE_EQ(hand.pregrasp_opening(0.07), 0.08);
  EXPECT_DOUBLE_EQ(hand.pregrasp_opening(0.08), 0.08);
}

TEST(Hand, CheckNamesTheField) {
  EXPECT_NO_THROW(two_fingers().check());
  Hand hand = two_fingers();
  hand.approach = {1, 0.1, 0};
  expect_refused(hand, "hand.approach");
  hand = two_fingers();
  hand.closing = Eigen::Vector3d(1, 1, 0).normalized();
  expect_refused(hand, "hand.closing");
  hand = two_fingers();
  hand.max_opening = 0;
  expect_refused(hand, "hand.max_opening");
  hand = two_fingers();
  hand.finger_depth = -0.01;
  expect_refused(hand, "hand.finger_depth");
  hand = two_fingers();
  hand.finger_width = std::numeric_limits<double>::infinity();
  expect_refused(hand, "hand.finger_width");
  hand = two_fingers();
  hand.clearance = std::numeric_limits<double>::quiet_NaN();
  expect_refused(hand, "hand.clearance");
  hand = two_fingers();
  hand.joints.push_back({"left", 0, 1});
  expect_refused(hand, "left");
  hand = two_fingers();
  hand.min_opening = 0.09;
  expect_refused(hand, "hand.min_opening");
  hand = two_fingers();
  hand.openings = {0, 0.05, 0.04, 0.08};
  expect_refused(hand, "hand.openings");
  hand.openings = {0, 0.05, 0.09};
  expect_refused(hand, "hand.openings");
  hand = two_fingers();
  hand.preshape = {{"thumb", 0.5}};
  expect_refused(hand, "thumb");
  hand.preshape = {{"fingers", 1.5}};
  expect_refused(hand, "hand.preshape.fingers");
  hand = two_fingers();
  hand.body.palm_width = 0;
  expect_refused(hand, "hand.body.palm_width");
}

/// Three fingers with two joints each and a joint that spreads two of them.
Hand three_fingers() {
  Hand hand;
  hand.kind = ClosingKind::adaptive;
  hand.min_opening = 0.01;
  hand.max_opening = 0.15;
  hand.openings = {0.01, 0.02, 0.06, 0.15};
  hand.joints = {{"a1", 1.2, 0.0, "a"}, {"a2", 0.9, 0.3, "a"},      {"b1", 1.2, 0.0, "b"},
                 {"c1", 1.2, 0.0, "c"}, {"spread", -0.2, 0.2, "s"}, {"b2", 0.9, 0.3, "b"}};
  hand.preshape = {{"s", 0.25}};
  return hand;
}

TEST(Hand, ATableOfOpeningsIsInvertedBetweenItsEntries) {
  const Hand hand = three_fingers();
  hand.check();
  EXPECT_DOUBLE_EQ(hand.share_open(0.01), 0);
  EXPECT_DOUBLE_EQ(hand.share_open(0.0), 0) << "below the least opening the fingers are closed";
  EXPECT_DOUBLE_EQ(hand.share_open(0.04), 0.5);
  EXPECT_DOUBLE_EQ(hand.share_open(0.15), 1);
  EXPECT_DOUBLE_EQ(hand.opening_at(5.0 / 6), 0.105);
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const double opening = rng.uniform(0.01, 0.15);
    EXPECT_NEAR(hand.opening_at(hand.share_open(opening)), opening, 1e-15);
  }
  for (const Hand& any : {hand, two_fingers()})
    for (const double share : {0.0, 0.2, 0.7, 1.0}) EXPECT_NEAR(any.share_open(any.opening_at(share)), share, 1e-15);
}

TEST(Hand, PosturesOpenGroupsAndTheOpeningLeavesThePreshape) {
  const Hand hand = three_fingers();
  EXPECT_EQ(hand.groups(), (std::vector<std::string>{"a", "b", "c", "s"}));
  const auto held = hand.joint_values(0.04);
  EXPECT_DOUBLE_EQ(held.at("a1"), 0.6);
  EXPECT_DOUBLE_EQ(held.at("b2"), 0.6);
  EXPECT_DOUBLE_EQ(held.at("spread"), -0.1);
  const auto posed = hand.joint_values(std::vector<double>{0, 1, 0.5, 1});
  EXPECT_DOUBLE_EQ(posed.at("a1"), 1.2);
  EXPECT_DOUBLE_EQ(posed.at("a2"), 0.9);
  EXPECT_DOUBLE_EQ(posed.at("b1"), 0.0);
  EXPECT_DOUBLE_EQ(posed.at("c1"), 0.6);
  EXPECT_DOUBLE_EQ(posed.at("spread"), 0.2);
  Grasp grasp;
  grasp.opening = 0.04;
  EXPECT_EQ(hand.joint_values(grasp), held);
  grasp.posture = {0, 1, 0.5, 1};
  EXPECT_EQ(hand.joint_values(grasp), posed);
  EXPECT_THROW(hand.joint_values(std::vector<double>{0, 1}), InvalidInput);
  EXPECT_THROW(hand.joint_values(std::vector<double>{0, 1, 2, 1}), InvalidInput);
}

TEST(Hand, ShapesAreTheBoxesOfItsBody) {
  Hand hand = tray_scene::gripper();
  for (const double opening : {0.0, 0.037, 0.1}) {
    const auto expected = tray_scene::hand_body(hand, opening), shapes = hand.shapes(opening);
    ASSERT_EQ(shapes.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(shapes[i].T_link_shape.isApprox(expected[i].T_link_shape, 1e-14)) << i;
      EXPECT_LT((std::get<Box>(shapes[i].shape).size - std::get<Box>(expected[i].shape).size).norm(), 1e-14) << i;
    }
  }
  hand.approach = Eigen::Vector3d::UnitZ();
  hand.closing = -Eigen::Vector3d::UnitX();
  const auto bounds = shape_bounds(hand.shapes(0.06)[1].shape, hand.shapes(0.06)[1].T_link_shape);
  EXPECT_NEAR(bounds.min().x(), -0.042, 1e-14) << "the second finger stands along the closing axis";
  EXPECT_NEAR(bounds.max().x(), -0.03, 1e-14);
  EXPECT_NEAR(bounds.max().z(), 0.02, 1e-14) << "and ends half a pad beyond the tool frame";
}

/// Position of a link's origin in the frame of another link, computed by KDL.
Eigen::Vector3d kdl_position(const Robot& robot, const std::map<std::string, double>& values, const std::string& link,
                             const std::string& in) {
  const auto frame = [&](const std::string& name) {
    const KDL::Chain chain = testing_support::kdl_chain(robot, robot.link_index(name));
    KDL::JntArray q(chain.getNrOfJoints());
    for (unsigned i = 0, k = 0; i < chain.getNrOfSegments(); ++i) {
      const KDL::Joint& joint = chain.getSegment(i).getJoint();
      if (joint.getType() == KDL::Joint::None) continue;
      const Joint& own = robot.joints()[robot.joint_index(joint.getName())];
      const bool follows = own.mimic_joint >= 0;
      const auto value = values.find(follows ? robot.joints()[own.mimic_joint].name : own.name);
      const double led = value == values.end() ? 0.0 : value->second;
      q(k++) = follows ? own.mimic_multiplier * led + own.mimic_offset : led;
    }
    KDL::Frame out;
    KDL::ChainFkSolverPos_recursive(chain).JntToCart(q, out);
    return out;
  };
  const KDL::Vector p = (frame(in).Inverse() * frame(link)).p;
  return {p.x(), p.y(), p.z()};
}

Robot hand_robot(const std::string& urdf, const std::string& package, const std::string& base,
                 const Pose& T_base_tool) {
  RobotOptions options;
  options.package_dirs[std::filesystem::path(package).filename()] = testing_support::shared(package);
  return Robot::load(testing_support::shared(urdf), "", options).with_link("tool", base, T_base_tool);
}

Pose along_z(double z) {
  return Pose(Eigen::Translation3d(0, 0, z));
}

/// Opening against the distance of two tip links along the closing axis by KDL: they differ by the pads' thickness
/// only.
void expect_opening_follows_tips(const Robot& robot, const Hand& hand, const std::string& left,
                                 const std::string& right, double tolerance) {
  const auto distance = [&](double share) {
    const auto values = hand.joint_values(hand.opening_at(share));
    return std::abs(
        hand.closing.dot(kdl_position(robot, values, left, "tool") - kdl_position(robot, values, right, "tool")));
  };
  for (const double share : {0.0, 0.25, 0.4, 0.6, 0.85}) {
    EXPECT_NEAR(hand.opening_at(1) - hand.opening_at(share), distance(1) - distance(share), tolerance) << share;
  }
}

TEST(HandFromRobot, Wsg50IsParallelAndLinear) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot robot = hand_robot("robots/wsg50/wsg_50_simulation/urdf/wsg_50.urdf", "robots/wsg50/wsg_50_simulation",
                                 "base_link", along_z(0.143));
  const Hand hand = Hand::from_robot(robot, "tool");
  EXPECT_EQ(hand.kind, ClosingKind::parallel);
  EXPECT_TRUE(hand.approach.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(hand.closing.isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(hand.openings.empty()) << "prismatic joints";
  EXPECT_NEAR(hand.max_opening, 0.103, 0.002) << "as tests/scenarios/tiago_wsg50.yaml has it, read off the meshes";
  EXPECT_EQ(hand.groups(), std::vector<std::string>{"fingers"});
  ASSERT_EQ(hand.joints.size(), 2u);
  EXPECT_DOUBLE_EQ(hand.joints[0].open, -0.055);
  EXPECT_DOUBLE_EQ(hand.joints[1].open, 0.055);
  EXPECT_NEAR(hand.max_opening - hand.min_opening,
              hand.joints[1].open - hand.joints[1].closed + hand.joints[0].closed - hand.joints[0].open, 1e-9);
  expect_opening_follows_tips(robot, hand, "finger_left", "finger_right", 1e-6);  // the file's pi has six digits
}

TEST(HandFromRobot, PandaHandFollowsItsMimicJoint) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot robot = hand_robot("robots/panda/expanded/panda.urdf", "robots/panda/moveit_resources_panda_description",
                                 "panda_hand", along_z(0.1034));
  const Hand hand = Hand::from_robot(robot, "tool");
  EXPECT_EQ(hand.kind, ClosingKind::parallel);
  EXPECT_TRUE(hand.approach.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(hand.closing.isApprox(Eigen::Vector3d::UnitY()));
  ASSERT_EQ(hand.joints.size(), 1u) << "the other finger follows";
  EXPECT_EQ(hand.joints[0].name, "panda_finger_joint1");
  EXPECT_DOUBLE_EQ(hand.joints[0].open, 0.04);
  EXPECT_NEAR(hand.max_opening, 0.08, 0.001) << "data sheet";
  EXPECT_NEAR(hand.min_opening, 0, 0.001);
  EXPECT_EQ(hand.finger_links, (std::vector<std::string>{"panda_leftfinger", "panda_rightfinger"}));
  expect_opening_follows_tips(robot, hand, "panda_leftfinger", "panda_rightfinger", 1e-9);
}

/// The flange's frame is turned by 45 degrees against the fingers.
TEST(HandFromRobot, FramesTurnedAgainstTheFingers) {
  MMGRASP_NEEDS_SHARED_DATA();
  const std::string urdf = "robots/panda/expanded/panda.urdf",
                    folder = "robots/panda/moveit_resources_panda_description";
  const Hand straight = Hand::from_robot(hand_robot(urdf, folder, "panda_hand", along_z(0.1034)), "tool");
  const Robot robot = hand_robot(urdf, folder, "panda_link8", along_z(0.1034));
  const Hand hand = Hand::from_robot(robot, "tool");
  EXPECT_TRUE(hand.approach.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(hand.closing.isApprox(Eigen::Vector3d(1, 1, 0).normalized(), 1e-6)) << hand.closing.transpose();
  EXPECT_NEAR(hand.max_opening, straight.max_opening, 1e-6);
  EXPECT_NEAR(hand.min_opening, straight.min_opening, 1e-6);
  EXPECT_DOUBLE_EQ(hand.joints[0].open, 0.04);
  EXPECT_EQ(hand.finger_links, straight.finger_links);
  const Pose tilted = Pose(Eigen::Translation3d(0, 0, 0.1034)) * pose_from_xyz_rpy({0, 0, 0}, {0.6, 0, 0});
  EXPECT_THROW(Hand::from_robot(hand_robot(urdf, folder, "panda_hand", tilted), "tool"), InvalidInput)
      << "no axis of the frame lies along the fingers";
}

/// The maker's own file lets every joint turn by 180 degrees: the fingers curl past the palm.
TEST(HandFromRobot, LimitsThatAreNoneAreNamed) {
  MMGRASP_NEEDS_SHARED_DATA();
  const std::string folder = "robots/robotiq/robotiq_3f_gripper_visualization";
  const std::string urdf = folder + "/cfg/robotiq-3f-gripper_articulated.urdf";
  const Robot robot = hand_robot(urdf, folder, "palm", Pose(Eigen::Translation3d(0, 0.11, 0)));
  try {
    Hand::from_robot(robot, "tool");
    ADD_FAILURE() << "read";
  } catch (const InvalidInput& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("_joint_"), std::string::npos) << message;
    EXPECT_NE(message.find("3.141"), std::string::npos) << message;
    EXPECT_NE(message.find("SRDF"), std::string::npos) << message;
  }
}

TEST(HandFromRobot, Robotiq2F85IsParallelButNotLinear) {
  MMGRASP_NEEDS_SHARED_DATA();
  const std::string folder = "robots/robotiq_2f85/robotiq_arg85_description";
  const Robot robot =
      hand_robot(folder + "/robots/robotiq_arg85_description.URDF", folder, "robotiq_85_base_link", along_z(0.146));
  const Hand hand = Hand::from_robot(robot, "tool");
  EXPECT_EQ(hand.kind, ClosingKind::parallel);
  ASSERT_EQ(hand.joints.size(), 1u) << "five joints follow the one that is driven";
  EXPECT_NEAR(hand.max_opening, 0.078, 0.001) << "as tests/scenarios/tiago_2f85.yaml has it, read off the meshes";
  EXPECT_NEAR(hand.finger_depth, 0.05, 0.002) << "the same";
  EXPECT_FALSE(hand.openings.empty());
  expect_opening_follows_tips(robot, hand, "left_inner_finger", "right_inner_finger", 1e-5);
}

TEST(HandFromRobot, Robotiq3FHasAGroupAFingerAndASpread) {
  MMGRASP_NEEDS_SHARED_DATA();
  const std::string folder = "robots/robotiq/robotiq_3f_gripper_visualization";
  const Robot robot = hand_robot("robots/robotiq/expanded/robotiq_3f_articulated.urdf", folder, "palm",
                                 Pose(Eigen::Translation3d(0, 0.11, 0)));
  const Hand hand = Hand::from_robot(robot, "tool");
  EXPECT_EQ(hand.kind, ClosingKind::adaptive);
  EXPECT_TRUE(hand.approach.isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(hand.closing.isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_EQ(hand.joints.size(), 11u);
  EXPECT_EQ(hand.preshape.size(), 2u) << "the two joints that spread the fingers";
  EXPECT_EQ(hand.groups().size(), 5u) << "three fingers";
  EXPECT_NEAR(hand.max_opening, 0.155, 0.02) << "data sheet";
  // The tips come nearer from posture to posture, until they meet.
  double last = std::numeric_limits<double>::infinity();
  for (const double share : {1.0, 0.75, 0.5, 0.25, 0.0}) {
    const auto values = hand.joint_values(hand.opening_at(share));
    const double apart = kdl_position(robot, values, "finger_middle_link_3", "tool").x() -
                         kdl_position(robot, values, "finger_1_link_3", "tool").x();
    EXPECT_LT(apart, last) << share;
    last = apart;
  }
}

TEST(HandFromRobot, WhatIsNoHandIsRefused) {
  MMGRASP_NEEDS_SHARED_DATA();
  const std::string urdf = "robots/wsg50/wsg_50_simulation/urdf/wsg_50.urdf", folder = "robots/wsg50/wsg_50_simulation";
  const Robot robot = hand_robot(urdf, folder, "base_link", along_z(0.143));
  EXPECT_THROW(Hand::from_robot(robot, "nowhere"), InvalidInput);
  EXPECT_THROW(Hand::from_robot(robot, "finger_left"), InvalidInput) << "nothing moves beside a finger";
  HandReading reading;
  reading.group = "hand";
  EXPECT_THROW(Hand::from_robot(robot, "tool", reading), InvalidInput) << "no SRDF, no such group";
  reading.group = "";
  reading.closing = Eigen::Vector3d(2, 0, 0);
  EXPECT_THROW(Hand::from_robot(robot, "tool", reading), InvalidInput) << "no unit vector";
  reading.closing = Eigen::Vector3d::UnitY();
  EXPECT_THROW(Hand::from_robot(robot, "tool", reading), InvalidInput) << "its fingers close along x";
  EXPECT_THROW(Hand::from_robot(hand_robot(urdf, folder, "base_link", along_z(0.5)), "tool"), InvalidInput)
      << "the tool frame lies beyond the tips";
  RobotOptions bare;
  bare.load_meshes = false;
  const Robot shapeless =
      Robot::load(testing_support::shared(urdf), "", bare).with_link("tool", "base_link", along_z(0.1));
  EXPECT_THROW(Hand::from_robot(shapeless, "tool"), InvalidInput) << "no collision shapes";
}

}  // namespace
}  // namespace mmgrasp
