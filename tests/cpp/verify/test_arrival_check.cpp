#include <gtest/gtest.h>

#include "mmgrasp/verify/plan_check.hpp"
#include "verify/tiny_world.hpp"

// How often arrivals drawn by a covariance serve all parts, as a plan says.
namespace tiny {
namespace {

/// The robot of good_plan() that arrives as the plan says, with a millimetre of error: everything can be grasped.
PlanToCheck plan_with_arrivals(double deviation) {
  PlanToCheck plan = good_plan();
  plan.arrival_covariance = Eigen::Vector3d(deviation * deviation, deviation * deviation, 1e-6).asDiagonal();
  for (auto& stop : plan.stops) stop.arrivals = stop.arrivals_served = 1000;
  return plan;
}

TEST(PlanCheckArrivals, ShareMustBeWhatItIs) {
  EXPECT_EQ(codes_of(plan_with_arrivals(1e-3)), Codes{});
  PlanToCheck plan = plan_with_arrivals(1e-3);
  plan.stops[0].arrivals_served = 300;
  EXPECT_EQ(codes_of(plan), Codes{"arrival-rate"});
  EXPECT_EQ(codes_of(plan_with_arrivals(0.4)), Codes{"arrival-rate"}) << "most arrivals are out of reach";
}

TEST(PlanCheckArrivals, CountsAndCovarianceBelongTogether) {
  PlanToCheck plan = plan_with_arrivals(1e-3);
  plan.stops[0].arrivals_served = 1001;
  EXPECT_EQ(codes_of(plan), Codes{"malformed"});
  plan = plan_with_arrivals(1e-3);
  plan.stops[0].arrivals = plan.stops[0].arrivals_served = 0;
  EXPECT_EQ(codes_of(plan), Codes{"malformed"});
  plan = plan_with_arrivals(1e-3);
  plan.arrival_covariance.setZero();
  EXPECT_EQ(codes_of(plan), Codes{"malformed"});
  plan = plan_with_arrivals(1e-3);
  plan.arrival_covariance(0, 1) = 1e-4;
  EXPECT_EQ(codes_of(plan), Codes{"malformed"});
}

}  // namespace
}  // namespace tiny
