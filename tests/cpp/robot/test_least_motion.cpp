#include "mmgrasp/robot/detail/least_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/detail/joint_metric.hpp"
#include "support/small_robots.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

struct Case {
  const char* name;
  JointGroup group;
};

IkOptions exact() {
  IkOptions ik;
  ik.position_tolerance = ik.rotation_tolerance = 0;
  return ik;
}

Pose at(double x, double y, double z) {
  return Pose(Eigen::Translation3d(x, y, z));
}

Pose turned(double angle) {
  return Pose(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

std::string one_joint(const std::string& type) {
  return "<robot name='one'>" + test::urdf_link("base") + test::urdf_link("link") + test::urdf_link("tip") +
         test::urdf_joint("joint", type, "base", "link", "0.3 0 0.2", "0 0 1") +
         test::urdf_joint("flange", "fixed", "link", "tip", "0.4 0 0.3", "0 0 1") + "</robot>";
}

TEST(LeastMotion, ClosedForms) {
  const Robot hinge = Robot::from_strings(one_joint("revolute")), slide = Robot::from_strings(one_joint("prismatic"));
  const JointGroup turns = hinge.chain("base", "tip"), slides = slide.chain("base", "tip");
  EXPECT_NEAR(least_motion(turns, at(0, 0, 0), turned(0.7), exact()), 0.7, 1e-12);
  EXPECT_NEAR(least_motion(turns, at(0, 0, 0), at(0.1, 0, 0), exact()), 0.1 / 0.5, 1e-12);  // The lever is 0.5 m.
  EXPECT_NEAR(least_motion(slides, at(0, 0, 0), at(0, 0, 0.25), exact()), 0.25, 1e-12);
  EXPECT_EQ(least_motion(slides, at(0, 0, 0), turned(0.7), exact()), std::numeric_limits<double>::infinity());
  EXPECT_EQ(least_motion(turns, turned(0.3), turned(0.3), exact()), 0);
  // Three slides and three turns at right angles: as far as along one of them, by sqrt(3) at most.
  const Robot gantry = Robot::from_strings(test::gantry_urdf());
  EXPECT_NEAR(least_motion(gantry.chain("base", "c"), at(0, 0, 0), at(0.3, 0, 0), exact()), 0.3 / std::sqrt(3), 1e-12);
  // A lever of 0.5 m at weight 4 is one of 0.125 m; of x and y of a base the cheaper one counts for both.
  const auto weighed = [](const JointGroup& group, std::vector<double> weights) {
    return JointMetric(group.wraps(), Eigen::Map<const VectorXd>(weights.data(), group.size()));
  };
  EXPECT_NEAR(least_motion(turns, at(0, 0, 0), at(0.1, 0, 0), exact(), weighed(turns, {4})), 0.8, 1e-12);
  EXPECT_NEAR(least_motion(slides, at(0, 0, 0), at(0, 0, 0.25), exact(), weighed(slides, {3})), 0.75, 1e-12);
  RobotOptions omni;
  omni.base = BaseKind::omni;
  const Robot driving = Robot::from_strings(one_joint("prismatic"), "", omni);
  const JointGroup drives = driving.chain("base", "tip", true);
  const double lever = std::hypot(0.3, 0.2) + 3 + std::hypot(0.4, 0.3);
  EXPECT_NEAR(least_motion(drives, at(0, 0, 0), at(2, 0, 0), exact(), weighed(drives, {5, 2, 10, 0.5})),
              2 / std::sqrt(1 / 4.0 + lever * lever / 100 + 4), 1e-12);
  // Within the tolerances of IK two poses are one.
  IkOptions ik;
  ik.position_tolerance = 0.01;
  EXPECT_NEAR(least_motion(slides, at(0, 0, 0), at(0, 0, 0.25), ik), 0.23, 1e-12);
}

/// Straight lines between random configurations are never shorter, and neither is the way round of what wraps.
TEST(LeastMotion, NoPathIsShorter) {
  RobotOptions omni;
  omni.base = BaseKind::omni;
  const Robot seven = Robot::from_strings(test::seven_joint_urdf());
  const Robot driving = Robot::from_strings(test::seven_joint_urdf(), "", omni);
  const std::vector<Case> cases{{"seven joints", seven.chain("column", "tool")},
                                {"omni base", driving.chain("column", "tool", true)},
                                {"gantry", Robot::from_strings(test::gantry_urdf()).chain("base", "c")},
                                {"two balls", Robot::from_strings(test::two_balls_urdf()).chain("base", "tip")}};
  for (const Case& each : cases) {
    const JointGroup& group = each.group;
    Rng rng(5);
    double tightest = 0;
    for (int i = 0; i < 8000; ++i) {
      VectorXd weights;
      if (i >= 4000)
        weights = rng.uniform(VectorXd::Constant(group.size(), -2), VectorXd::Constant(group.size(), 2)).array().exp();
      const JointMetric metric(group.wraps(), weights);
      const VectorXd a = rng.uniform(group.sample_lower(), group.sample_upper());
      const VectorXd far = rng.uniform(group.sample_lower(), group.sample_upper());
      const VectorXd b = a + (i % 2 ? 1.0 : 1e-3) * (metric.nearest(a, far) - a);
      const double bound = least_motion(group, group.fk(a), group.fk(b), exact(), metric), way = metric.distance(a, b);
      EXPECT_LE(bound, way + 1e-9) << each.name;
      tightest = std::max(tightest, bound / way);
    }
    EXPECT_GT(tightest, 0.4) << each.name;
  }
}

}  // namespace
}  // namespace mmgrasp::detail
