#include "mmgrasp/robot/detail/whole_turns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "support/kinematics_support.hpp"
#include "support/limited_arm.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

constexpr double kTurn = 2 * M_PI;

/// All turns within limits by enumeration of every combination from -3 to 3.
std::vector<VectorXd> enumerated(const JointGroup& group, const VectorXd& q) {
  std::vector<VectorXd> out{q};
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    std::vector<VectorXd> more;
    for (const VectorXd& at : out)
      for (int k = -3; k <= 3; ++k) {
        VectorXd turned = at;
        turned[i] += k * kTurn;
        if (turned[i] >= group.lower()[i] && turned[i] <= group.upper()[i]) more.push_back(turned);
      }
    out = std::move(more);
  }
  return out;
}

bool holds(const std::vector<VectorXd>& all, const VectorXd& q) {
  return std::any_of(all.begin(), all.end(), [&](const VectorXd& other) { return (other - q).norm() < 1e-9; });
}

TEST(WholeTurns, AreAllThatLimitsAllowNearestFirst) {
  Rng rng(4);
  std::size_t most = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<std::pair<double, double>> limits;
    for (int i = 0; i < 3; ++i) limits.emplace_back(rng.uniform(-8.0, -1.0), rng.uniform(1.0, 8.0));
    const JointGroup group = test::limited_arm(limits);
    const WholeTurns turns(group);
    const VectorXd q = rng.uniform(group.lower(), group.upper()), near = rng.uniform(group.lower(), group.upper());
    const std::vector<VectorXd> expected = enumerated(group, q), found = turns.of(q, near);
    ASSERT_EQ(found.size(), expected.size());
    most = std::max(most, found.size());
    EXPECT_TRUE(holds(found, q));
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_TRUE(holds(expected, found[i]));
      EXPECT_TRUE(group.within_limits(found[i]));
      EXPECT_LT((group.fk(found[i]).matrix() - group.fk(q).matrix()).norm(), 1e-12);
      EXPECT_TRUE(i == 0 || (found[i] - near).norm() >= (found[i - 1] - near).norm() - 1e-12);
    }
    const std::vector<VectorXd> first = turns.of(q, near, 2);
    ASSERT_EQ(first.size(), std::min<std::size_t>(2, found.size()));
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i], found[i]);
  }
  EXPECT_GE(most, 8u);
}

TEST(WholeTurns, TakesOnTheLimitCount) {
  const JointGroup group = test::limited_arm({{-3.5, 3.5}, {-3, 3}});
  const WholeTurns turns(group);
  EXPECT_TRUE(turns.any());
  EXPECT_EQ(turns.of(0, 0.1).size(), 1u);
  EXPECT_EQ(turns.of(0, 3.0).size(), 2u);
  EXPECT_NEAR(turns.of(0, 3.0).front(), 3.0 - kTurn, 1e-12);
  // By rounding beyond its limit: on it.
  EXPECT_EQ(turns.of(0, 3.5 + 1e-12).back(), group.upper()[0]);
  EXPECT_EQ(turns.of(0, 3.6).size(), 1u);  // Only a turn back.
  EXPECT_EQ(turns.of(1, 3.1).size(), 0u);
  EXPECT_FALSE(WholeTurns(test::limited_arm({{-3, 3}, {-2, 2}})).any());
}

/// A finger that follows at half the speed stands elsewhere after a turn; one at twice the speed does not.
TEST(WholeTurns, JointsThatOthersMimicInPartsDoNotTurn) {
  const auto arm = [](const std::string& multiplier) {
    return test::limited_arm({{-7, 7}},
                             "<link name=\"finger\"/><joint name=\"f\" type=\"revolute\"><parent link=\"l0\"/><child "
                             "link=\"finger\"/><axis xyz=\"0 0 1\"/><limit effort=\"1\" velocity=\"1\" lower=\"-20\" "
                             "upper=\"20\"/><mimic joint=\"j1\" multiplier=\"" +
                                 multiplier + "\"/></joint>");
  };
  EXPECT_FALSE(WholeTurns(arm("0.5")).any());
  EXPECT_TRUE(WholeTurns(arm("2")).any());
}

/// The ends of a UR5e: limits of two turns on every joint but the elbow.
TEST(WholeTurns, EveryBranchOfAUr5eComesInAllItsTurns) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = testing_support::load_kinematics("robots/ur/expanded/ur5e.urdf").chain("base_link", "tool0");
  Rng rng(8);
  for (int i = 0; i < 20; ++i) {
    const Pose target = group.fk(rng.uniform(group.lower(), group.upper()));
    const IkBranches one = solve_ik_branches(group, target);
    const IkBranches all = solve_ik_branches(group, target, {}, {}, 0, {}, true);
    std::size_t expected = 0;
    for (const VectorXd& q : one.solutions) {
      const std::vector<VectorXd> turned = enumerated(group, q);
      EXPECT_GE(turned.size(), 32u);
      expected += turned.size();
      for (const VectorXd& each : turned) EXPECT_TRUE(holds(all.solutions, each));
    }
    EXPECT_EQ(all.solutions.size(), expected);
    EXPECT_EQ(solve_ik_all(group, target, 1, {}, {}, true).size(), enumerated(group, one.solutions.front()).size());
  }
}

/// Without a closed form descents end in any turn; each posture is listed once all the same.
TEST(WholeTurns, SearchedPosturesComeOnce) {
  const JointGroup group = test::limited_arm({{-7, 7}, {-7, 7}});
  const VectorXd q = Eigen::Vector2d(0.4, 1.1);
  const std::vector<VectorXd> one = solve_ik_all(group, group.fk(q), 16);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_LT((one.front() - q).norm(), 1e-3);
  const std::vector<VectorXd> all = solve_ik_all(group, group.fk(q), 16, {}, {}, true);
  EXPECT_EQ(all.size(), enumerated(group, q).size());
  EXPECT_EQ(all.size(), 6u);
}

}  // namespace
}  // namespace mmgrasp::detail
