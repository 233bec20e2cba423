#include <gtest/gtest.h>

#include "collision/checker/edge_motion.hpp"
#include "collision/narrow/narrow.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/mesh_robots.hpp"

// How fast a pair can close its clearance, against clearances measured before and after a small motion; how far points
// come along a stretch of an edge, against where they are.

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
  const auto snapshot = std::make_shared<const Snapshot>(group.robot(), World(), CheckerOptions());
  const auto shared_plan = std::make_shared<const PairPlan>(*snapshot, group);
  const PairPlan& plan = *shared_plan;
  EXPECT_TRUE(plan.rates.finite);
  Placement placement(snapshot, shared_plan, group);
  const auto clearance = [&](const ShapePair& pair, const Eigen::VectorXd& q) {
    placement.place(q.data());
    const Solid &a = *snapshot->shapes[pair.a].solid, &b = *snapshot->shapes[pair.b].solid;
    return solids_distance(a, placement.pose(pair.a), b, placement.pose(pair.b)).distance;
  };
  Rng rng(5);
  int close = 0;
  for (int i = 0; i < draws; ++i) {
    const Eigen::VectorXd q = rng.uniform(group.sample_lower(), group.sample_upper());
    Eigen::VectorXd step = Eigen::VectorXd::Zero(q.size());
    if (i % 2 == 0) step[static_cast<Eigen::Index>(rng.index(q.size()))] = 0.02;
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

/// How many of the bounds of EdgeMotion were nearly reached, and how many are below those of the rates.
struct Tightness {
  int reached = 0, below_rates = 0;
};

Tightness expect_motion_bounded(const JointGroup& group, int draws) {
  const auto snapshot = std::make_shared<const Snapshot>(group.robot(), World(), CheckerOptions());
  const auto plan = std::make_shared<const PairPlan>(*snapshot, group);
  Placement here(snapshot, plan, group), there(snapshot, plan, group);
  Tightness out;
  Rng rng(8);
  for (int i = 0; i < draws; ++i) {
    const Eigen::VectorXd q = rng.uniform(group.sample_lower(), group.sample_upper());
    const Eigen::VectorXd step =
        rng.uniform(0.001, 0.03) * rng.uniform(-Eigen::VectorXd::Ones(q.size()), Eigen::VectorXd::Ones(q.size()));
    const double reach = rng.uniform(0, 10);
    here.place(q.data());
    EdgeMotion motion;
    motion.start(here, q, q + step, step);
    const Eigen::Vector3d n = rng.rotation() * Eigen::Vector3d::UnitX();
    // Points of a body, seen from the world or from another body, before and after.
    const auto check = [&](int shape, int other, const Closing& closing) {
      const Solid& solid = *snapshot->shapes[shape].solid;
      const Rigid T = other < 0 ? Rigid() : here.pose(other);
      for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const Eigen::Vector3d point = solid.sphere_centre + sign * solid.sphere_radius / std::sqrt(3.0);
        const Eigen::Vector3d before = here.pose(shape) * point;
        const Rigid back = other < 0 ? Rigid() : T * there.pose(other).to(Rigid());
        const Eigen::Vector3d way = back * (there.pose(shape) * point) - before;
        ASSERT_LE(way.norm(), closing.most + 1e-9) << "shape " << shape << " from " << other;
        ASSERT_LE(std::abs(n.dot(way)), closing.along(n) + 1e-9) << "shape " << shape << " from " << other;
        if (closing.directed) {
          ASSERT_LE(std::abs(n.dot(way)), closing.along_at(n, before) + 1e-6);
        }
        out.reached += way.norm() > 0.5 * closing.most;
      }
    };
    for (const double share : {-1.0, -0.4, 0.7, 1.0}) {
      const Eigen::VectorXd moved = q + share * reach * step;
      there.place(moved.data());
      for (std::size_t b = 0; b < plan->moving.size(); ++b) {
        const Closing closing = motion.of_body(static_cast<int>(b), reach);
        check(plan->moving[b], -1, closing);
      }
      for (std::size_t p = 0; p < plan->varying.size(); ++p) {
        const Closing closing = motion.of_pair(static_cast<int>(p), reach);
        out.below_rates += closing.most < 0.8 * motion.of_pair_anywhere(static_cast<int>(p), reach);
        const ShapePair& pair = plan->varying[p];
        // Without a velocity the rates bound clearances only, not points.
        if (closing.directed && closing.most < motion.of_pair_anywhere(static_cast<int>(p), reach))
          check(closing.first_moves ? pair.a : pair.b, closing.first_moves ? pair.b : pair.a, closing);
      }
    }
  }
  return out;
}

TEST(EdgeMotion, BoundsHowFarPointsComeAlongAnEdge) {
  for (const auto& arm : {testing_support::ur5_arm(), testing_support::tiago_arm()}) {
    SCOPED_TRACE(arm.name);
    const Tightness tightness = expect_motion_bounded(arm.group, 30);
    EXPECT_GT(tightness.reached, 1000);
    EXPECT_GT(tightness.below_rates, 1000);
  }
}

TEST(EdgeMotion, BoundsPointsOfBranchesSlidesAndMimics) {
  EXPECT_GT(expect_motion_bounded(two_arms().group("all", "left_hand"), 1000).reached, 1000);
}

}  // namespace
}  // namespace mmgrasp::detail
