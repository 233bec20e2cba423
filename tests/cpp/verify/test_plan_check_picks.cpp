#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/verify/plan_check.hpp"
#include "verify/tiny_world.hpp"

// Which part is picked where, and from how many of the base poses that may come about.
namespace tiny {
namespace {

TEST(PlanCheckPicks, ForgottenPart) {
  PlanToCheck plan = good_plan();
  plan.picks.erase(plan.picks.begin() + 1);
  EXPECT_EQ(codes_of(plan), Codes{"part-forgotten"});
}

TEST(PlanCheckPicks, RepeatedPart) {
  PlanToCheck plan = good_plan();
  plan.picks.insert(plan.picks.begin() + 1, plan.picks[0]);
  EXPECT_TRUE(codes_of(plan).count("part-repeated"));
}

TEST(PlanCheckPicks, PartThatIsToStay) {
  PlanToCheck plan = good_plan();
  plan.parts[1].target = false;
  EXPECT_EQ(codes_of(plan), Codes{"part-not-target"});
}

TEST(PlanCheckPicks, UnknownPart) {
  PlanToCheck plan = good_plan();
  plan.picks[0].part = "A/cube_9";
  EXPECT_EQ(codes_of(plan), (Codes{"part-unknown", "part-forgotten"}));
}

TEST(PlanCheckPicks, WrongTray) {
  PlanToCheck plan = good_plan();
  plan.picks[0].tray = "B";
  EXPECT_EQ(codes_of(plan), Codes{"wrong-tray"});
}

TEST(PlanCheckPicks, WrongStop) {
  PlanToCheck plan = good_plan();
  plan.picks[1].stop = 1;
  EXPECT_TRUE(codes_of(plan).count("wrong-stop"));
  plan = good_plan();
  plan.picks[2].stop = 7;
  EXPECT_TRUE(codes_of(plan).count("wrong-stop"));
  plan.picks[2].stop = -1;
  EXPECT_TRUE(codes_of(plan).count("wrong-stop"));
}

TEST(PlanCheckPicks, StopsOutOfOrder) {
  PlanToCheck plan = good_plan();
  std::swap(plan.picks[1], plan.picks[2]);
  EXPECT_TRUE(codes_of(plan).count("stop-order"));
}

TEST(PlanCheckPicks, GraspIndexOutside) {
  for (const int index : {-1, 2, 1000000}) {
    PlanToCheck plan = good_plan();
    plan.picks[0].grasp = index;
    EXPECT_EQ(codes_of(plan), Codes{"grasp-invalid"});
  }
}

TEST(PlanCheckPicks, OtherGraspNamed) {
  PlanToCheck plan = good_plan();
  plan.picks[0].grasp = 1;  // turned by 90 degrees
  EXPECT_EQ(codes_of(plan), Codes{"grasp-missed"});
}

TEST(PlanCheckRobustness, ReachEndsInsideTheDisc) {
  // At the stop joint x stands at 0.4; the disc asks for up to 0.5.
  const PlanCheckResult result = check_plan(good_plan({0.45, 0, 0.12, 0, 0, 0, 0}), quick());
  EXPECT_EQ(codes(result), Codes{"not-robust"});
  ASSERT_EQ(result.rates.size(), 2u);
  EXPECT_LT(result.rates[1].good, result.rates[1].samples);
  EXPECT_EQ(result.rates[1].worst_part, "B/cube_0");
}

TEST(PlanCheckRobustness, ShareOfTheDiscIsRight) {
  // Reachable base poses are those less than 0.05 m behind the stop: by area of the disc's segment, 0.8045 of it. With
  // a required share of almost nothing no chunk ends early, so the share can be compared (3 sigma of 400 samples:
  // 0.06).
  PlanCheckOptions options;
  options.samples = 400;
  options.required_rate = 1e-6;
  PlanToCheck plan = good_plan({0.45, 0, 0.12, 0, 0, 0, 0});
  plan.parts[1].target = false;
  plan.picks.erase(plan.picks.begin() + 1);
  const PlanCheckResult result = check_plan(plan, options);
  const double c = 0.5;  // distance of the cut from the middle over the radius
  const double share = 1 - (std::acos(c) - c * std::sqrt(1 - c * c)) / M_PI;
  for (const StopRate& rate : result.rates) {
    EXPECT_EQ(rate.samples, 400);
    EXPECT_NEAR(static_cast<double>(rate.good) / rate.samples, share, 0.06);
  }
}

TEST(PlanCheckRobustness, OtherGraspsCount) {
  // The grasp that the plan takes is blocked by a neighbour while all parts are in place; the turned one is not.
  PlanToCheck plan = good_plan();
  plan.parts[2].body.T_world_body = at(0.9, 0.1 + kCube + 0.005, kPartZ);
  Codes found = codes_of(plan);
  EXPECT_TRUE(found.count("scene-collision"));
  EXPECT_FALSE(found.count("not-robust"));
  plan.parts[0].grasps.pop_back();
  found = codes_of(plan);
  EXPECT_TRUE(found.count("not-robust"));
}

TEST(PlanCheckRobustness, HomeBlockedNearTheStop) {
  // A beam that the hand at home meets only when the base stands more than 0.06 m ahead of the stop.
  PlanToCheck plan = good_plan();
  plan.obstacles.push_back(box("beam", {0.04, 0.2, 0.03}, at(0.62, 0, 1.295)));
  EXPECT_EQ(codes_of(plan), Codes{"not-robust"});
}

TEST(PlanCheckRobustness, PartWithoutGrasps) {
  PlanToCheck plan = good_plan();
  plan.parts[1].grasps.clear();
  EXPECT_EQ(codes_of(plan), (Codes{"grasp-invalid", "not-robust"}));
}

}  // namespace
}  // namespace tiny
