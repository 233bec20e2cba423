#include "mmgrasp/robot/joint_weights.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "support/small_robots.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

std::string refusal(const JointWeights& weights, const JointGroup& group) {
  try {
    weights.of(group);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(JointWeights, ByNumberOrByName) {
  const JointGroup group = Robot::from_strings(test::gantry_urdf()).chain("base", "c");
  ASSERT_EQ(group.size(), 6);
  EXPECT_EQ(JointWeights().of(group).size(), 0);
  EXPECT_EQ(JointWeights(VectorXd::Ones(6)).of(group).size(), 0);  // As if not given.
  const VectorXd all = VectorXd::LinSpaced(6, 1, 6);
  EXPECT_EQ(JointWeights(all).of(group), all);
  VectorXd expected = VectorXd::Ones(6);
  expected[1] = 10;
  expected[4] = 0.25;
  EXPECT_EQ(JointWeights({{group.names()[1], 10}, {group.names()[4], 0.25}}).of(group), expected);
}

TEST(JointWeights, RefusalsNameTheJoint) {
  const JointGroup group = Robot::from_strings(test::gantry_urdf()).chain("base", "c");
  EXPECT_EQ(refusal(VectorXd(VectorXd::Ones(5)), group),
            "joint_weights: number of them = 5: must be 6, one per joint of group '" + group.name() + "'");
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    VectorXd weights = VectorXd::Ones(6);
    weights[3] = bad;
    const std::string said = refusal(weights, group), name = group.names()[3];
    EXPECT_NE(said.find("joint_weights of '" + name + "' = "), std::string::npos) << said;
    EXPECT_NE(said.find("must be positive and finite"), std::string::npos) << said;
    EXPECT_EQ(refusal({{name, bad}}, group), said);
  }
  const std::string said = refusal({{group.names()[0] + "_", 2}}, group);
  EXPECT_NE(said.find("has no joint '" + group.names()[0] + "_'"), std::string::npos) << said;
  JointWeights both({{group.names()[0], 2}});
  both.values = VectorXd::Ones(6);
  EXPECT_NE(refusal(both, group).find("not both"), std::string::npos);
}

}  // namespace
}  // namespace mmgrasp
