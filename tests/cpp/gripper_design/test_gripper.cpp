#include "mmgrasp/gripper_design/gripper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp {
namespace {

std::string folder(const std::string& name) {
  return (std::filesystem::path(testing::TempDir()) / ("mmgrasp_gripper_" + name)).string();
}

Gripper centric(double low, double high) {
  Gripper g;
  g.name = "centric";
  g.fingers = 3;
  g.min_opening = low;
  g.max_opening = high;
  return g;
}

TEST(Gripper, FingersOfJawsAreBoxes) {
  Gripper g;
  g.finger_length = 0.04;
  const auto mesh = g.finger_mesh();
  EXPECT_TRUE(mesh->closed);
  EXPECT_NEAR(mesh_volume(*mesh), 0.04 * g.finger_width * g.finger_thickness, 1e-15);
}

TEST(Gripper, CentricFingersStayInTheirSectors) {
  for (const double low : {0.0, 0.002, 0.008, 0.014, 0.1}) {
    const Gripper g = centric(low, low + 0.008);
    const auto mesh = g.finger_mesh();
    EXPECT_TRUE(mesh->closed);
    double widest = 0;
    for (const Eigen::Vector3d& v : mesh->vertices) {
      EXPECT_LE(std::abs(v.y()), (low / 2 + v.x()) * std::tan(M_PI / 3) + 1e-12) << low;
      EXPECT_GE(v.x(), 0);
      EXPECT_LE(v.x(), g.finger_thickness + 1e-12);
      widest = std::max(widest, std::abs(v.y()));
    }
    if (low > 0.0141) {
      EXPECT_DOUBLE_EQ(widest, g.finger_width / 2);
    }
  }
}

/// Radius of the largest ball about a point on the tool's axis that the fingers leave free.
double free_radius(const Robot& robot, const Gripper& g, double joint) {
  const JointGroup group = robot.group("fingers");
  double low = 0, high = 0.2;
  for (int step = 0; step < 40; ++step) {
    const double radius = (low + high) / 2;
    World world;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().z() = g.palm_height + g.finger_length - g.pad_length() / 2;
    world.add("ball", Sphere{radius}, pose);
    CollisionChecker checker(group, world);
    (checker.is_free(Eigen::VectorXd::Constant(group.size(), joint)) ? low : high) = radius;
  }
  return low;
}

TEST(Gripper, LoadedGripperOpensAsPromised) {
  for (Gripper g : {centric(0.014, 0.022), centric(0.1, 0.16), Gripper{}}) {
    g.finger_length = 0.12;  // So long that the ball meets the fingers before the palm.
    g.to_urdf(folder(g.name));
    const Robot robot = Robot::load(folder(g.name) + "/gripper.urdf", folder(g.name) + "/gripper.srdf");
    const double stroke = (g.max_opening - g.min_opening) / 2;
    EXPECT_NEAR(2 * free_radius(robot, g, stroke), g.max_opening, 2e-6) << g.fingers;
    if (g.min_opening > 0) {
      EXPECT_NEAR(2 * free_radius(robot, g, 0), g.min_opening, 2e-6) << g.fingers;
    }
  }
}

double number_after(const std::string& text, const std::string& what) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return std::stod(text.substr(at + what.size()));
}

TEST(Gripper, InertialsAreThoseOfTheFingersMesh) {
  constexpr double kDensity = 1240;
  for (const Gripper& g : {Gripper{}, centric(0, 0.008), centric(0.004, 0.012), centric(0.1, 0.16)}) {
    const auto mesh = g.finger_mesh();
    // Tetrahedra from the origin: volume, first and second moments.
    double volume = 0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    for (const auto& t : mesh->triangles) {
      const Eigen::Vector3d &a = mesh->vertices[t[0]], &b = mesh->vertices[t[1]], &c = mesh->vertices[t[2]];
      const double v = a.dot(b.cross(c)) / 6;
      const Eigen::Vector3d sum = a + b + c;
      volume += v;
      first += v / 4 * sum;
      second += v / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
    const Eigen::Vector3d centre = first / volume;
    const Eigen::Matrix3d about = kDensity * (second - volume * centre * centre.transpose());
    const std::string urdf = g.files().at("gripper.urdf");
    const std::string finger = urdf.substr(urdf.find("<link name=\"finger_1\">"));
    EXPECT_NEAR(number_after(finger, "mass value=\""), kDensity * volume, 1e-9);
    EXPECT_NEAR(number_after(finger, "origin xyz=\""), centre.x(), 1e-9);
    EXPECT_NEAR(centre.y(), 0, 1e-12);
    EXPECT_NEAR(centre.z(), g.finger_length / 2, 1e-12);
    EXPECT_NEAR(number_after(finger, "ixx=\""), about(1, 1) + about(2, 2), 1e-12);
    EXPECT_NEAR(number_after(finger, "iyy=\""), about(0, 0) + about(2, 2), 1e-12);
    EXPECT_NEAR(number_after(finger, "izz=\""), about(0, 0) + about(1, 1), 1e-12);
  }
}

TEST(Gripper, PadsAreAsWideAsTheMeshHasThem) {
  for (const double low : {0.0, 0.001, 0.004, 0.008, 0.02}) {
    const Gripper g = centric(low, low + 0.008);
    const auto mesh = g.finger_mesh();
    double widest = 0;
    for (const Eigen::Vector3d& v : mesh->vertices)
      if (v.x() < 1e-9) widest = std::max(widest, 2 * v.y());
    EXPECT_NEAR(g.pad_width(), widest, 1e-12) << low;
  }
  EXPECT_EQ(Gripper{}.pad_width(), Gripper{}.finger_width);
}

TEST(Gripper, JawsAreReadAsAHand) {
  Gripper g;
  g.name = "jaws";
  g.min_opening = 0.01;
  g.to_urdf(folder("hand"));
  const Hand hand =
      Hand::from_robot(Robot::load(folder("hand") + "/gripper.urdf", folder("hand") + "/gripper.srdf"), "tool");
  EXPECT_EQ(hand.kind, ClosingKind::parallel);
  EXPECT_NEAR(hand.max_opening, g.max_opening, 1e-6);
  EXPECT_NEAR(hand.min_opening, g.min_opening, 1e-6);
  EXPECT_LT((hand.approach - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  EXPECT_NEAR(std::abs(hand.closing.x()), 1, 1e-9);
}

TEST(Gripper, ItsHandIsTheOneThatIsReadFromItsFiles) {
  for (const double min_opening : {0.0, 0.01}) {
    Gripper g;
    g.name = "jaws";
    g.min_opening = min_opening;
    g.finger_length = 0.045;
    g.to_urdf(folder("same_hand"));
    const Robot robot = Robot::load(folder("same_hand") + "/gripper.urdf", folder("same_hand") + "/gripper.srdf");
    const Hand read = Hand::from_robot(robot, "tool"), hand = g.hand();
    EXPECT_NO_THROW(hand.check());
    EXPECT_EQ(hand.tool_link, read.tool_link);
    EXPECT_EQ(hand.kind, read.kind);
    EXPECT_EQ(hand.groups(), read.groups());
    EXPECT_EQ(std::set<std::string>(hand.finger_links.begin(), hand.finger_links.end()),
              std::set<std::string>(read.finger_links.begin(), read.finger_links.end()));
    EXPECT_LT((hand.approach - read.approach).norm(), 1e-9);
    EXPECT_LT(hand.closing.cross(read.closing).norm(), 1e-9);
    EXPECT_NEAR(hand.min_opening, read.min_opening, 1e-6);
    EXPECT_NEAR(hand.max_opening, read.max_opening, 1e-6);
    EXPECT_NEAR(hand.finger_depth, read.finger_depth, 1e-6);
    EXPECT_NEAR(hand.finger_width, read.finger_width, 1e-6);
    EXPECT_NEAR(hand.clearance, read.clearance, 1e-12);
    EXPECT_NEAR(hand.body.finger_thickness, read.body.finger_thickness, 1e-6);
    EXPECT_NEAR(hand.body.finger_length, read.body.finger_length, 1e-6);
    EXPECT_NEAR(hand.body.palm_length, read.body.palm_length, 1e-6);
    EXPECT_NEAR(hand.body.palm_width, read.body.palm_width, 1e-6);
    for (const double opening : {g.min_opening, 0.02, g.max_opening}) {
      const auto values = hand.joint_values(opening), expected = read.joint_values(std::min(opening, read.max_opening));
      ASSERT_EQ(values.size(), expected.size());
      for (const auto& [joint, value] : values) EXPECT_NEAR(value, expected.at(joint), 1e-6) << joint;
    }
  }
  Gripper centric;
  centric.fingers = 3;
  EXPECT_THROW(centric.hand(), InvalidInput);
}

TEST(Gripper, Refusals) {
  const auto refused = [](auto change) {
    Gripper g;
    change(g);
    EXPECT_THROW(g.check(), InvalidInput);
  };
  refused([](Gripper& g) { g.name = "<b>"; });
  refused([](Gripper& g) { g.fingers = 5; });
  refused([](Gripper& g) { g.min_opening = g.max_opening; });
  refused([](Gripper& g) { g.min_opening = -0.01; });
  refused([](Gripper& g) { g.finger_length = 0; });
  refused([](Gripper& g) { g.finger_thickness = std::nan(""); });
  EXPECT_THROW(Gripper{}.to_urdf("/proc/no/such"), IoError);
}

}  // namespace
}  // namespace mmgrasp
