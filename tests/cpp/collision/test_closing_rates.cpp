#include <gtest/gtest.h>

#include "collision/checker/pair_plan.hpp"
#include "collision/narrow/narrow.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/mesh_robots.hpp"

// How fast a pair can close its clearance, against clearances measured before and after a small motion.

namespace mmgrasp::detail {
namespace {

// A trunk that rises, with two arms whose bodies stand off their axes; one hand's value mimics its elbow's.
Robot two_arms() {
  std::string urdf = R"(<robot name="r"><link name="root"><collision><geometry><box size="0.3 0.2 0.1"/></geometry>
</collision></link><link name="trunk"><collision><origin xyz="0 0 0.2"/><geometry><box size="0.1 0.2 0.4"/></geometry>
</collision></link><joint name="rise" type="prismatic"><parent link="root"/><child link="trunk"/><origin xyz="0 0 0.1"/>
<axis xyz="0 0 1"/><limit lower="0" upper="0.4" velocity="1" effort="1"/></joint>)";
  for (const std::string side : {"left", "right"}) {
    const std::string y = side == "left" ? "0.2" : "-0.2";
    urdf += "<link name='" + side + "_arm'><collision><origin xyz='0.15 0 0.05'/><geometry>" +
            "<box size='0.3 0.05 0.06'/></geometry></collision></link><link name='" + side +
            "_hand'><collision><origin xyz='0.05 0.02 0.03'/><geometry><sphere radius='0.06'/></geometry></collision>" +
            "</link><joint name='" + side + "_shoulder' type='revolute'><parent link='trunk'/><child link='" + side +
            "_arm'/><origin xyz='0 " + y + " 0.35' rpy='0.2 0.3 0'/><axis xyz='0 0.6 0.8'/>" +
            "<limit lower='-2' upper='2' velocity='1' effort='1'/></joint><joint name='" + side +
            "_elbow' type='revolute'><parent link='" + side + "_arm'/><child link='" + side +
            "_hand'/><origin xyz='0.35 0 0.02'/><axis xyz='0 1 0'/>" +
            (side == "left" ? "" : "<mimic joint='right_shoulder' multiplier='-1.5' offset='0.2'/>") +
            "<limit lower='-2' upper='2' velocity='1' effort='1'/></joint>";
  }
  std::string srdf = "<robot name='r'><group name='all'>";
  for (const std::string joint : {"rise", "left_shoulder", "left_elbow", "right_shoulder"})
    srdf += "<joint name='" + joint + "'/>";
  return Robot::from_strings(urdf + "</robot>", srdf + "</group></robot>");
}

// Returns how many clearances changed by more than half of what the bound allows.
int expect_bounded(const JointGroup& group, int draws) {
  const Snapshot snapshot(group.robot(), World(), CheckerOptions());
  const PairPlan plan(snapshot, group);
  EXPECT_TRUE(plan.rates.finite);
  std::vector<double> frames(16 * static_cast<std::size_t>(plan.frames.count()));
  MovingFrames::set(Rigid(), frames.data());
  const auto clearance = [&](const ShapePair& pair, const Eigen::VectorXd& q) {
    plan.frames.place(q.data(), frames.data());
    const auto pose = [&](int s) {
      return MovingFrames::get(frames.data() + 16 * plan.placed[s].frame) * plan.placed[s].in_frame;
    };
    return solids_distance(*snapshot.shapes[pair.a].solid, pose(pair.a), *snapshot.shapes[pair.b].solid, pose(pair.b))
        .distance;
  };
  Rng rng(5);
  int close = 0;
  for (int i = 0; i < draws; ++i) {
    const Eigen::VectorXd q = rng.uniform(group.sample_lower(), group.sample_upper());
    Eigen::VectorXd step = Eigen::VectorXd::Zero(q.size());
    if (i % 2 == 0) step[static_cast<Eigen::Index>(rng.index(static_cast<std::size_t>(q.size())))] = 0.02;
    if (i % 2 == 1) step = 0.02 * rng.uniform(-Eigen::VectorXd::Ones(q.size()), Eigen::VectorXd::Ones(q.size()));
    const Eigen::VectorXd next = (q + step).cwiseMax(group.lower()).cwiseMin(group.upper());
    for (std::size_t p = 0; p < plan.varying.size(); ++p) {
      const double before = clearance(plan.varying[p], q), after = clearance(plan.varying[p], next);
      if (before <= 0 || after <= 0) continue;
      const double bound = plan.rates.pairs.col(static_cast<Eigen::Index>(p)).dot((next - q).cwiseAbs());
      EXPECT_LE(std::abs(after - before), bound + 1e-9) << "pair " << p << " at " << q.transpose();
      close += std::abs(after - before) > 0.5 * bound && bound > 0;
    }
  }
  return close;
}

TEST(ClosingRates, BoundHowClearancesOfRealArmsChange) {
  for (const auto& arm : {testing_support::ur5_arm(), testing_support::tiago_arm()}) {
    SCOPED_TRACE(arm.name);
    EXPECT_GT(expect_bounded(arm.group, 30), 50);
  }
}

TEST(ClosingRates, BoundHowClearancesAcrossBranchesChange) {
  EXPECT_GT(expect_bounded(two_arms().group("all", "left_hand"), 2000), 1000);
}

}  // namespace
}  // namespace mmgrasp::detail
