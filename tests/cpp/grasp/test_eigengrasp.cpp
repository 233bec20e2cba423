#include "mmgrasp/grasp/eigengrasp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/grasp/synthesize_grasps.hpp"
#include "mmgrasp/robot/robot.hpp"
#include "scanned_object.hpp"

namespace mmgrasp {
namespace {

using namespace test;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kDegree = 3.14159265358979323846 / 180;

const Robot& sdh() {
  static const Robot robot = Robot::load(std::string(MMGRASP_ASSETS) + "/grippers/sdhlike/sdhlike.urdf");
  return robot;
}

/// P3 figure 4.9: a finger a group, and the coupled roots.
const std::vector<EigengraspGroup> kGroups{{"thumb", {"thumb_proximal", "thumb_distal"}},
                                           {"finger_1", {"finger_1_proximal", "finger_1_distal"}},
                                           {"finger_2", {"finger_2_proximal", "finger_2_distal"}},
                                           {"spread", {"spread"}}};

GraspType type_of(const std::string& name, std::vector<double> open, std::vector<double> closed) {
  const auto vector = [](const std::vector<double>& degrees) {
    return VectorXd(Eigen::Map<const VectorXd>(degrees.data(), static_cast<Eigen::Index>(degrees.size())) * kDegree);
  };
  return {name, vector(open), vector(closed)};
}

/// Fingers 1 and 2 face each other, the thumb is turned away.
const GraspType kPinch = type_of("pinch", {-90, 0, -25, 25, -25, 25, 90}, {-90, 0, 12, -12, 12, -12, 90});
const GraspType kCylindrical = type_of("cylindrical", {-25, 25, -25, 25, -25, 25, 0}, {12, -12, 12, -12, 12, -12, 0});
const GraspType kSpherical = type_of("spherical", {-25, 25, -25, 25, -25, 25, 60}, {12, -12, 12, -12, 12, -12, 60});

}  // namespace

TEST(Eigengrasp, MatrixOfAlgorithm3) {
  const std::vector<int> sizes{2, 2, 2, 1};
  const Eigen::MatrixXd M = eigengrasp_matrix(sizes, kPinch.open, kPinch.closed);
  ASSERT_EQ(M.rows(), 7);
  ASSERT_EQ(M.cols(), 4);
  // Joint by joint which group it belongs to. With the printed counter (r += n_g) the second group would fill the rows
  // 4 and 5, and the third lie outside of the matrix.
  const int group[7] = {0, 0, 1, 1, 2, 2, 3};
  for (int row = 0; row < 7; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_EQ(M(row, column), column == group[row] ? kPinch.closed[row] - kPinch.open[row] : 0);
  EXPECT_NE(M(2, 1), 0);
  EXPECT_LT((M * VectorXd::Zero(4) + kPinch.open - kPinch.open).norm(), 1e-12);
  EXPECT_LT((M * VectorXd::Ones(4) + kPinch.open - kPinch.closed).norm(), 1e-12);
  EXPECT_THROW(eigengrasp_matrix({2, 2}, kPinch.open, kPinch.closed), InvalidInput);
  EXPECT_THROW(eigengrasp_matrix({7, 0}, kPinch.open, kPinch.closed), InvalidInput);
}

TEST(Eigengrasp, PosturesAreThoseOfTheMatrix) {
  const Hand hand = eigengrasp_hand(sdh(), "tcp", kGroups, kCylindrical);
  const Eigen::MatrixXd M = eigengrasp_matrix({2, 2, 2, 1}, kCylindrical.open, kCylindrical.closed);
  const Eigen::Vector4d alpha(0.2, 0.7, 1.0, 0.4);
  const VectorXd j = M * alpha + kCylindrical.open;
  std::vector<double> posture;
  for (int g = 0; g < 4; ++g) posture.push_back(1 - alpha[g]);
  const auto values = hand.joint_values(posture);
  int row = 0;
  for (const EigengraspGroup& group : kGroups)
    for (const std::string& joint : group.joints) EXPECT_NEAR(values.at(joint), j[row++], 1e-12);
}

TEST(Eigengrasp, PadsStandWhereTheirLinksAre) {
  // Tips stay upright, 33 mm from the middle at the roots, moved by 86.5 mm sin(angle), 12 mm thick on each side.
  const Hand pinch = eigengrasp_hand(sdh(), "tcp", kGroups, kPinch);
  EXPECT_NEAR(pinch.max_opening, 2 * (0.033 + 0.0865 * std::sin(25 * kDegree) - 0.012), 1e-9);
  EXPECT_NEAR(pinch.min_opening, 2 * (0.033 - 0.0865 * std::sin(12 * kDegree) - 0.012), 1e-9);
  EXPECT_NEAR(std::abs(pinch.closing.y()), 1, 1e-9);
  const auto model = make_hand_model(pinch, sdh());
  EXPECT_EQ(model->groups(), 2);  // thumb and spread keep their values
  EXPECT_EQ(model->pads({1, 1}).size(), 2u);
  const auto three = make_hand_model(eigengrasp_hand(sdh(), "tcp", kGroups, kCylindrical), sdh());
  EXPECT_EQ(three->groups(), 3);
  const auto pads = three->pads({1, 1, 1});
  ASSERT_EQ(pads.size(), 3u);
  // From the thumb's root to those of the others it is 66 mm sin(60 degrees).
  const double opening = 0.066 * std::sin(60 * kDegree) + 2 * 0.0865 * std::sin(25 * kDegree) - 0.024;
  EXPECT_NEAR(closing_line(pads).opening, opening, 1e-5);
  // Round about the vertical axis, pads of the spherical type face the middle.
  const auto round = make_hand_model(eigengrasp_hand(sdh(), "tcp", kGroups, kSpherical), sdh());
  double turn[3];
  for (int k = 0; k < 3; ++k) {
    const Vector3d push = round->pads({1, 1, 1})[k].T_hand_pad.linear().col(2);
    EXPECT_NEAR(push.z(), 0, 1e-6);
    turn[k] = std::atan2(push.y(), push.x()) / kDegree;
  }
  EXPECT_NEAR(turn[0], 0, 1e-4);
  EXPECT_NEAR(std::abs(turn[1]), 120, 1e-4);
  EXPECT_NEAR(turn[1] + turn[2], 0, 1e-4);
  // The pads are as far from the middle, where their pushes meet, as the ball between them has a radius: the roots lie
  // on a circle of 66 mm / sqrt(3).
  const ClosingLine line = closing_line(round->pads({1, 1, 1}));
  EXPECT_NEAR(line.opening / 2, 0.066 / std::sqrt(3.0) + 0.0865 * std::sin(25 * kDegree) - 0.012, 1e-5);
  for (const FingerPad& pad : round->pads({1, 1, 1})) {
    const Vector3d way = line.middle - pad.T_hand_pad.translation(), push = pad.T_hand_pad.linear().col(2);
    EXPECT_NEAR(way.dot(push), line.opening / 2, 1e-5);
    EXPECT_LT(way.cross(push).norm(), 1e-5);
  }
}

TEST(Eigengrasp, ClosingLineOfFingersThatDoNotPushStraight) {
  // Pads on a circle of radius 3 around (5, 1, 2), pushing to its middle; the third closes at 90 degrees to the second.
  const auto pad_at = [](double angle) {
    const Vector3d in(-std::cos(angle), -std::sin(angle), 0);
    FingerPad pad;
    pad.T_hand_pad.linear() << Vector3d::UnitZ(), in.cross(Vector3d::UnitZ()), in;
    pad.T_hand_pad.translation() = Vector3d(5, 1, 2) - 3 * in;
    return pad;
  };
  const ClosingLine line = closing_line({pad_at(0), pad_at(135 * kDegree), pad_at(225 * kDegree)});
  EXPECT_NEAR(line.opening, 6, 1e-12);
  EXPECT_LT((line.middle - Vector3d(5, 1, 2)).norm(), 1e-12);
  EXPECT_LT((line.axis + Vector3d::UnitX()).norm(), 1e-12);
}

TEST(Eigengrasp, PinchOfABoxFingerByFinger) {
  const Vector3d size(0.04, 0.07, 0.09);
  const Pose T_box = at(0.01, -0.005, 0.045, 0.3);
  const ProbabilisticSdf map = scan({table_plane(), {Box{size}, T_box}});
  SynthesisOptions options;
  options.table = 0.0;
  options.threads = 1;
  const auto model = make_hand_model(eigengrasp_hand(sdh(), "tcp", kGroups, kPinch), sdh());
  const GraspSynthesis found = synthesize_grasps(map, *model, options);
  ASSERT_EQ(found.outcome, Outcome::solved) << found.summary();
  for (std::size_t i = 0; i < found.grasps.size(); ++i) {
    const GraspRating& rating = found.ratings[i];
    const auto pads = model->pads(model->shares_of(0, rating.pretouch_posture));
    for (std::size_t k = 0; k < 2; ++k) {
      const ContactPatch& patch = rating.patches[k];
      EXPECT_NEAR(patch.distance, model->hand().clearance, 0.0015);
      // The patch is before the pad, on a true face.
      const Vector3d pad = found.grasps[i].T_object_hand * pads[k].T_hand_pad.translation();
      EXPECT_NEAR((patch.point - pad).dot(patch.pad_normal), patch.distance, 0.004);
      const Vector3d p = T_box.inverse() * patch.point;
      EXPECT_NEAR((p.cwiseAbs() - size / 2).maxCoeff(), 0, 0.0015);
    }
    // Closed on the part the pads' distance is its width, by the hand's own kinematics.
    const double apart = closing_line(model->pads(model->shares_of(0, found.grasps[i].posture))).opening;
    EXPECT_NEAR(apart, found.grasps[i].opening, 1e-9);
    const double across = (rating.patches[1].point - rating.patches[0].point).norm();
    EXPECT_NEAR(apart, across, 0.01);
  }
}

/// Long enough for two fingers 66 mm apart.
const Vector3d kBar(0.05, 0.16, 0.09);
const Pose kBarPose = at(0, 0, 0.045, 0.4);
const ProbabilisticSdf& bar_map() {
  static const ProbabilisticSdf map = scan({table_plane(), {Box{kBar}, kBarPose}});
  return map;
}

SynthesisOptions bar_options() {
  SynthesisOptions options;
  options.table = 0.0;
  options.threads = 1;
  options.samples = 400;
  return options;
}

/// Whether two grasps stand near each other, come the same way and close along opposite axes.
bool are_half_a_turn_apart(const HandModel& model, const Grasp& a, const Grasp& b) {
  const auto axis = [&](const Grasp& grasp) -> Vector3d {
    return grasp.T_object_hand.linear() * closing_line(model.pads(std::vector<double>(model.groups(), 1.0))).axis;
  };
  const auto approach = [&](const Grasp& grasp) -> Vector3d {
    return grasp.T_object_hand.linear() * model.hand().approach;
  };
  return (a.T_object_hand.translation() - b.T_object_hand.translation()).norm() < 0.03 &&
         approach(a).dot(approach(b)) > 0.95 && axis(a).dot(axis(b)) < -0.95;
}

TEST(Eigengrasp, ThumbOnEitherSideIsAnotherGraspAndParallelFingersAreNot) {
  SynthesisOptions options = bar_options();
  options.samples = 800;
  options.max_grasps = 400;
  options.min_distance = 0.03;
  const auto pairs = [&](const HandModel& model) {
    const GraspSynthesis found = synthesize_grasps(bar_map(), model, options);
    EXPECT_EQ(found.outcome, Outcome::solved) << found.summary();
    int count = 0;
    for (std::size_t i = 0; i < found.grasps.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) count += are_half_a_turn_apart(model, found.grasps[i], found.grasps[j]);
    return count;
  };
  EXPECT_GT(pairs(*make_hand_model(eigengrasp_hand(sdh(), "tcp", kGroups, kCylindrical), sdh())), 0);
  EXPECT_EQ(pairs(*make_hand_model(test_hand())), 0);
}

TEST(Eigengrasp, ThreeFingersHoldABar) {
  const auto model = make_hand_model(eigengrasp_hand(sdh(), "tcp", kGroups, kCylindrical), sdh());
  const GraspSynthesis found = synthesize_grasps(bar_map(), *model, bar_options());
  ASSERT_EQ(found.outcome, Outcome::solved) << found.summary();
  for (const GraspRating& rating : found.ratings) {
    ASSERT_EQ(rating.patches.size(), 3u);
    EXPECT_TRUE(rating.success.force_closure);
    int sides[2] = {0, 0};
    for (const ContactPatch& patch : rating.patches) {
      const Vector3d p = kBarPose.inverse() * patch.point;
      EXPECT_NEAR(std::abs(p.x()), kBar.x() / 2, 0.0015);
      ++sides[p.x() > 0 ? 1 : 0];
    }
    EXPECT_EQ(sides[0] * sides[1], 2);  // the thumb on one side, both fingers on the other
  }
}

TEST(Eigengrasp, ThreeFingersHoldABall) {
  const double radius = 0.05;
  const Vector3d centre(0.01, 0, radius);
  const ProbabilisticSdf map = scan({table_plane(), {Sphere{radius}, at(centre.x(), centre.y(), centre.z())}});
  SynthesisOptions options;
  options.table = 0.0;
  options.threads = 1;
  const auto model = make_hand_model(eigengrasp_hand(sdh(), "tcp", kGroups, kSpherical), sdh());
  const GraspSynthesis found = synthesize_grasps(map, *model, options);
  ASSERT_EQ(found.outcome, Outcome::solved) << found.summary();
  for (std::size_t i = 0; i < found.grasps.size(); ++i) {
    const GraspRating& rating = found.ratings[i];
    ASSERT_EQ(rating.patches.size(), 3u);
    EXPECT_TRUE(rating.success.force_closure);
    const auto pads = model->pads(model->shares_of(0, found.grasps[i].posture));
    for (std::size_t k = 0; k < 3; ++k) {
      const ContactPatch& patch = rating.patches[k];
      // A patch is a plane through a cap of the ball, which pads of 41 x 24 mm see: its middle is inside, by less than
      // 5 mm.
      EXPECT_NEAR((patch.point - centre).norm(), radius - 0.002, 0.003);
      EXPECT_GT(patch.normal.dot((patch.point - centre).normalized()), 0.95);
      // Closed, the pad's plane is where the ball begins: it is tangent to it.
      const Pose T = found.grasps[i].T_object_hand * pads[k].T_hand_pad;
      EXPECT_NEAR((centre - T.translation()).dot(T.linear().col(2)), radius, 0.003);
    }
    // Round about the hand's axis no half is without a finger.
    std::vector<double> angles;
    for (const ContactPatch& patch : rating.patches) {
      const Vector3d normal = found.grasps[i].T_object_hand.linear().transpose() * patch.normal;
      angles.push_back(std::atan2(normal.y(), normal.x()) / kDegree);
    }
    std::sort(angles.begin(), angles.end());
    for (int k = 0; k < 3; ++k) EXPECT_LT(k < 2 ? angles[k + 1] - angles[k] : angles[0] + 360 - angles[2], 160);
  }
}

TEST(Eigengrasp, BallsTooRoundForFlatPadsAreSaidToBeUneven) {
  // 41 mm of pad on a ball of 40 mm radius: its cap is 5 mm high, a patch is a plane within 2 mm.
  const ProbabilisticSdf map = scan({table_plane(), {Sphere{0.04}, at(0, 0, 0.04)}});
  SynthesisOptions options;
  options.table = 0.0;
  options.threads = 1;
  const auto model = make_hand_model(eigengrasp_hand(sdh(), "tcp", kGroups, kSpherical), sdh());
  const GraspSynthesis none = synthesize_grasps(map, *model, options);
  EXPECT_EQ(none.outcome, Outcome::not_found);
  EXPECT_GT(none.counts.uneven, none.counts.evaluated / 3);
  options.patch.plane_tolerance = 0.003;
  EXPECT_EQ(synthesize_grasps(map, *model, options).outcome, Outcome::solved);
}

/// A finger a group, of the three-finger gripper of the shared data.
std::vector<EigengraspGroup> three_fingers() {
  std::vector<EigengraspGroup> groups;
  for (const char* finger : {"finger_1", "finger_2", "finger_middle"}) {
    groups.push_back({finger, {}});
    for (const char* joint : {"_joint_1", "_joint_2", "_joint_3"})
      groups.back().joints.push_back(std::string(finger) + joint);
  }
  return groups;
}

TEST(Eigengrasp, ThreeFingerGripperOfDataHoldsABar) {
  const std::string folder = std::string(MMGRASP_SHARED_DATA) + "/robots/robotiq/";
  const std::string urdf = folder + "expanded/robotiq_3f_articulated.urdf";
  if (!std::filesystem::exists(urdf)) GTEST_SKIP() << "no shared data";
  RobotOptions read;
  read.package_dirs["robotiq_3f_gripper_visualization"] = folder + "robotiq_3f_gripper_visualization";
  const Robot robot = Robot::load(urdf, "", read);
  // Its parallel motion: the last joint takes back what the first turns.
  GraspType type{"parallel", VectorXd(9), VectorXd(9)};
  for (int finger = 0; finger < 3; ++finger) {
    type.open.segment(3 * finger, 3) = Vector3d(0.053, 0, -0.053);
    type.closed.segment(3 * finger, 3) = Vector3d(0.9, 0, -0.9);
  }
  const auto model = make_hand_model(eigengrasp_hand(robot, "palm", three_fingers(), type, Vector3d::UnitY()), robot);
  const GraspSynthesis found = synthesize_grasps(bar_map(), *model, bar_options());
  ASSERT_EQ(found.outcome, Outcome::solved) << found.summary();
  for (std::size_t i = 0; i < found.grasps.size(); ++i) {
    EXPECT_NEAR(found.grasps[i].opening, kBar.x(), 0.01);
    ASSERT_EQ(found.ratings[i].patches.size(), 3u);
    for (const ContactPatch& patch : found.ratings[i].patches) {
      const Vector3d p = kBarPose.inverse() * patch.point;
      EXPECT_NEAR(std::abs(p.x()), kBar.x() / 2, 0.0015);
      EXPECT_LT(std::abs(p.y()), kBar.y() / 2);
    }
  }
}

TEST(Eigengrasp, ThreeFingerGripperOfData) {
  const std::string urdf = std::string(MMGRASP_SHARED_DATA) +
                           "/robots/robotiq/robotiq_3f_gripper_visualization/cfg/robotiq-3f-gripper_articulated.urdf";
  if (!std::filesystem::exists(urdf)) GTEST_SKIP() << "no shared data";
  RobotOptions read;
  read.package_dirs["robotiq_3f_gripper_visualization"] =
      std::string(MMGRASP_SHARED_DATA) + "/robots/robotiq/robotiq_3f_gripper_visualization";
  const Robot robot = Robot::load(urdf, "", read);
  const std::vector<EigengraspGroup> groups = three_fingers();
  GraspType type{"power", VectorXd::Zero(9), VectorXd::Zero(9)};
  for (int finger = 0; finger < 3; ++finger) type.closed.segment(3 * finger, 3) = Vector3d(0.9, 0.3, 0.1);
  // Its palm opens along y of "palm"; without a tool frame the palm's own is taken.
  const Hand hand = eigengrasp_hand(robot, "palm", groups, type, Vector3d::UnitY());
  const auto model = make_hand_model(hand, robot);
  EXPECT_EQ(model->pads({1, 1, 1}).size(), 3u);
  // The data sheet's stroke is 155 mm; the middle finger faces the two others.
  EXPECT_GT(hand.max_opening, 0.1);
  EXPECT_LT(hand.max_opening, 0.2);
  EXPECT_LT(hand.min_opening, hand.max_opening / 2);
  EXPECT_NEAR(std::abs(hand.closing.x()), 1, 0.05);
  type.closed[0] = -0.7;
  EXPECT_THROW(eigengrasp_hand(robot, "palm", groups, type, Vector3d::UnitY()), InvalidInput);
}

TEST(Eigengrasp, HandsOfSeveralGroupsNeedTheirRobot) {
  const Hand pinch = eigengrasp_hand(sdh(), "tcp", kGroups, kPinch);
  try {
    make_hand_model(pinch);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("4 groups of joints: needs its robot"), std::string::npos) << error.what();
  }
  EXPECT_NE(make_hand_model(pinch, sdh()), nullptr);
}

TEST(Eigengrasp, HandsWithoutFingertipsAreRefused) {
  const auto message = [](const GraspType& type, const Vector3d& approach) {
    try {
      eigengrasp_hand(sdh(), "tcp", kGroups, type, approach);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const GraspType one = type_of("one finger", {-90, 0, -25, 25, 0, 0, 90}, {-90, 0, 12, -12, 0, 0, 90});
  EXPECT_NE(message(one, Vector3d::UnitZ()).find("hand = 1 fingertips"), std::string::npos) << message(one, {0, 0, 1});
  const GraspType spreading = type_of("spreading", {-90, 0, -25, 25, -25, 25, 90}, {-90, 0, 12, -12, 12, -12, 0});
  EXPECT_NE(message(spreading, Vector3d::UnitZ()).find("hand = spread: a group of joints that closes no fingertip"),
            std::string::npos)
      << message(spreading, Vector3d::UnitZ());
  const GraspType still{"still", kPinch.open, kPinch.open};
  EXPECT_NE(message(still, Vector3d::UnitZ()).find("no group of joints closes"), std::string::npos);
  EXPECT_NE(message(kPinch, Vector3d::UnitY()).find("close along it"), std::string::npos);
  EXPECT_NE(message(kPinch, Vector3d::Zero()).find("approach"), std::string::npos);
}

}  // namespace mmgrasp
