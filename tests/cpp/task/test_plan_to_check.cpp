#include "mmgrasp/task/plan_to_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/collision/floor.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/verify/plan_check.hpp"
#include "support/small_storeroom.hpp"

namespace mmgrasp {
namespace {

struct Planned {
  PartSupplyProblem problem = test::small_storeroom();
  PartSupplyPlan plan = plan_part_supply(problem, test::small_database(problem));
};

const Planned& planned() {
  static const Planned shared;
  return shared;
}

std::vector<std::string> fault_codes(const verify::PlanToCheck& check) {
  verify::PlanCheckOptions options;
  options.samples = 100;
  std::vector<std::string> codes;
  for (const verify::Fault& fault : verify::check_plan(check, options).faults) codes.push_back(fault.code);
  return codes;
}

bool has(const std::vector<std::string>& codes, const std::string& code) {
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

/// What is claimed goes along: each claim that is changed is a fault of its own.
TEST(PlanToCheck, EveryClaimIsJudged) {
  const verify::PlanToCheck held = plan_to_check(planned().problem, planned().plan);
  EXPECT_TRUE(fault_codes(held).empty());

  const auto changed = [](const auto& change) {
    PartSupplyPlan plan = planned().plan;
    change(plan);
    return fault_codes(plan_to_check(planned().problem, plan));
  };
  EXPECT_TRUE(has(changed([](PartSupplyPlan& p) { p.stops[0].radius += 0.05; }), "stop-outside-region"));
  EXPECT_TRUE(has(changed([](PartSupplyPlan& p) { p.lower_bound = 2; }), "lower-bound"));
  EXPECT_TRUE(has(changed([](PartSupplyPlan& p) { p.robustness_rate = 0.5; }), "wrong-values"));
  EXPECT_TRUE(has(changed([](PartSupplyPlan& p) { p.route[0].length += 0.1; }), "route-values"));
  EXPECT_TRUE(has(changed([](PartSupplyPlan& p) { p.picks.pop_back(); }), "part-forgotten"));
  EXPECT_TRUE(has(changed([](PartSupplyPlan& p) { p.intersections.robust[0].centre.x() += 5; }), "wrong-values"));
  EXPECT_TRUE(has(changed([](PartSupplyPlan& p) {
                    for (Eigen::VectorXd& a : p.picks[0].motions[0].trajectory.accelerations) a.array() += 100;
                  }),
                  "acceleration"));
}

/// The ground is a height of its own, the links that may touch it are the checker's rule; groups are taken apart.
TEST(PlanToCheck, GroundAndAllowedPairs) {
  Planned own = planned();
  EXPECT_FALSE(std::isfinite(plan_to_check(own.problem, own.plan).floor));
  add_floor(own.problem.world, own.problem.arm, -0.2);
  own.problem.world.allow("hand", own.problem.trays[0].parts[0].name);
  const verify::PlanToCheck check = plan_to_check(own.problem, own.plan);
  EXPECT_EQ(check.floor, -0.2);
  ASSERT_EQ(check.allowed_collisions.size(), 1u);
  for (const verify::CheckedBody& body : check.obstacles) EXPECT_NE(body.name, kFloor);
  EXPECT_EQ(check.obstacles.size(), planned().problem.world.objects().size());
}

TEST(PlanToCheck, WhatItCannotJudgeIsRefused) {
  Planned other = planned();
  other.plan.picks[0].part.part = 99;
  EXPECT_THROW(plan_to_check(other.problem, other.plan), InvalidInput);
  other = planned();
  other.plan.stops[0].trays[0] = TrayId(7);
  EXPECT_THROW(plan_to_check(other.problem, other.plan), InvalidInput);
  other = planned();
  other.problem.world.add("held", test::box_shape(0.1, 0.1, 0.1), test::at(0, 0, 5));
  other.problem.world.attach("held", "hand", Pose::Identity());
  EXPECT_THROW(plan_to_check(other.problem, other.plan), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
