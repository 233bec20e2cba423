#include "mmgrasp/verify/plan_check.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <thread>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "verify/spoiled_plan.hpp"

// The whole plan, its arm motions and its numbers; stops, route and regions are in test_plan_check_base.cpp.
namespace tiny {
namespace {

TEST(PlanCheck, GoodPlanHasNoFault) {
  PlanCheckOptions options;
  options.samples = 1000;
  const PlanCheckResult result = check_plan(good_plan(), options);
  EXPECT_TRUE(result.faults.empty()) << listed(result);
  ASSERT_EQ(result.rates.size(), 2u);
  for (const StopRate& rate : result.rates) {
    EXPECT_EQ(rate.samples, 1000);
    EXPECT_EQ(rate.good, 1000);
  }
  EXPECT_EQ(result.minimal_stops, 2);
}

TEST(PlanCheck, SameAnswerAtAnyThreadCount) {
  const PlanToCheck plan = good_plan({0.45, 0, 0.12, 0, 0, 0, 0});
  PlanCheckOptions options = quick();
  options.threads = 1;
  const PlanCheckResult one = check_plan(plan, options);
  options.threads = 3;
  const PlanCheckResult three = check_plan(plan, options);
  EXPECT_EQ(one.configurations_checked, three.configurations_checked);
  ASSERT_EQ(one.rates.size(), three.rates.size());
  for (std::size_t i = 0; i < one.rates.size(); ++i) {
    EXPECT_EQ(one.rates[i].samples, three.rates[i].samples);
    EXPECT_EQ(one.rates[i].good, three.rates[i].good);
  }
  EXPECT_EQ(listed(one), listed(three));
}

TEST(PlanCheck, ChecksAtLeastAsFinelyAsAsked) {
  // Pick 0 at stop 0 has to be looked at once in every hundredth of what its fastest joint travels.
  const PlanToCheck plan = good_plan();
  double travel = 0;
  for (const CheckedPick& pick : plan.picks) {
    for (const CheckedMotion& m : pick.motions)
      travel += (m.positions.back() - m.positions.front()).cwiseAbs().maxCoeff();
  }
  PlanCheckOptions options = quick();
  options.samples = 1;
  const std::size_t coarse = check_plan(plan, options).configurations_checked;
  options.joint_step = 0.001;
  const std::size_t fine = check_plan(plan, options).configurations_checked;
  EXPECT_GE(static_cast<double>(fine), travel / 0.001);
  EXPECT_GE(static_cast<double>(fine - coarse), travel / 0.001 - 2 * travel / 0.01 - 500);
}

TEST(PlanCheck, FingerLinksAreAtLeastTwo) {
  PlanToCheck plan = good_plan();
  for (const std::vector<std::string>& links :
       {std::vector<std::string>{}, std::vector<std::string>{"left"}, std::vector<std::string>{"left", "left"}}) {
    plan.finger_links = links;
    EXPECT_TRUE(codes_of(plan).count("finger-links"));
  }
}

TEST(PlanCheck, OneFingerHoldsNothing) {
  // The right finger's shape shrinks to a stub up at the hand: only the left one meets the part.
  const std::string stub = replaced(urdf(), "<origin xyz=\"0 -0.005 0\"/><geometry><box size=\"0.02 0.01 0.08\"/>",
                                    "<origin xyz=\"0 -0.005 0.035\"/><geometry><box size=\"0.02 0.01 0.01\"/>");
  EXPECT_EQ(codes_of(on_other_robot(good_plan(), stub, srdf())), Codes{"grasp-empty"});
  // Said to be the fingers, the hand does not help: it stays away from the part.
  PlanToCheck plan = on_other_robot(good_plan(), stub, srdf());
  plan.finger_links = {"left", "hand"};
  EXPECT_TRUE(codes_of(plan).count("grasp-empty"));
  // Fingers that meet the part only when nearly closed do not hold it at its width.
  plan = good_plan();
  plan.fingers[0].closed = -0.02;  // outside its limits as well, which is another fault
  plan.fingers[0].open = 0.05;
  EXPECT_FALSE(codes_of(plan).count("grasp-empty"));
  for (CheckedPart& part : plan.parts) {
    for (CheckedGrasp& grasp : part.grasps) grasp.opening = 0.08;
  }
  EXPECT_TRUE(codes_of(plan).count("grasp-empty"));
}

TEST(PlanCheck, PairsThatNeverTouchAreTested) {
  PlanToCheck plan = good_plan();
  plan.home = joints(-0.6, 0, 0);
  ASSERT_TRUE(codes_of(plan).count("home-collision"));
  const auto doctored = [&plan](const std::string& reason) {
    const std::string pair = " link2=\"hand\" reason=\"" + reason + "\"/>";
    std::string text = "<disable_collisions link1=\"left\" link2=\"right\" reason=\"Never\"/>";
    for (const char* link : {"left", "right"}) {
      text += std::string("<disable_collisions link1=\"base\" link2=\"") + link + "\" reason=\"User\"/>";
    }
    text += "<disable_collisions link1=\"base\"" + pair;
    return on_other_robot(plan, urdf(), "<robot name=\"gantry\">" + text + "</robot>");
  };
  EXPECT_TRUE(codes_of(doctored("Never")).count("home-collision"));
  // What a user disabled is believed; so the fingers, closed against each other, are the only fault left.
  const PlanCheckResult result = check_plan(doctored("User"), quick());
  ASSERT_TRUE(codes(result).count("home-collision")) << listed(result);
  for (const Fault& fault : result.faults) {
    if (fault.code != "home-collision") continue;
    EXPECT_EQ(fault.message, "'left' touches 'right'");
  }
}

TEST(PlanCheck, SwappedMotions) {
  PlanToCheck plan = good_plan();
  std::swap(plan.picks[0].motions[2], plan.picks[0].motions[3]);
  EXPECT_EQ(codes_of(plan), Codes{"motion-order"});
  plan = good_plan();
  plan.picks[0].motions.pop_back();
  EXPECT_EQ(codes_of(plan), Codes{"motion-order"});
}

TEST(PlanCheck, MotionOfAnotherPart) {
  PlanToCheck plan = good_plan();
  std::swap(plan.picks[0].motions, plan.picks[1].motions);
  EXPECT_TRUE(codes_of(plan).count("grasp-missed"));
}

TEST(PlanCheck, AddedObstacleIsHit) {
  PlanToCheck plan = good_plan();
  plan.obstacles.push_back(box("lamp", {0.05, 0.05, 0.05}, at(0.7, 0.05, 0.95)));
  EXPECT_TRUE(codes_of(plan).count("scene-collision"));
}

TEST(PlanCheck, ObstacleThatOnlyTheHeldPartHits) {
  // Under the carried cube, beside the fingers (20 mm wide), between table and bin: only the cube's edge (x +- 20 mm)
  // reaches over it, and only when the arm is back at the release.
  PlanToCheck plan = good_plan();
  const Eigen::Vector3d bin(0.5, 0, kBinTop + kDropHeight + 0.5 * kCube);
  plan.obstacles.push_back(box("pin", {0.002, 0.002, 0.02}, at(bin.x() - 0.017, bin.y(), bin.z())));
  const Codes found = codes_of(plan);
  EXPECT_TRUE(found.count("attached-collision"));
  EXPECT_FALSE(found.count("self-collision"));
}

TEST(PlanCheck, NeighbourPartIsInTheWay) {
  PlanToCheck plan = good_plan();
  plan.parts[2].body.T_world_body = at(0.9, 0.1 + kCube + 0.005, kPartZ);  // where the open finger comes down
  EXPECT_TRUE(codes_of(plan).count("scene-collision"));
}

TEST(PlanCheck, PartsThatOverlapAtRest) {
  // The part that stays sinks into the table, or moves into its neighbour; contact and 0.05 mm of rounding are no
  // fault.
  for (const double into : {-1e-4, 0.0, 5e-5, 2e-4, 0.005}) {
    const bool overlaps = into > 1e-4;
    PlanToCheck plan = good_plan();
    plan.parts[2].body.T_world_body.translation().z() = kTableTop + 0.5 * kCube - into;
    EXPECT_EQ(codes_of(plan).count("part-overlap"), overlaps) << into;
    plan = good_plan();
    plan.parts[2].body.T_world_body.translation().y() = 0.1 + kCube - into;
    EXPECT_EQ(codes_of(plan).count("part-overlap"), overlaps) << into;
  }
}

TEST(PlanCheck, PickedPartIsGone) {
  // The second cube is moved to where the first one lay, to a hair: free only because the first is in the bin.
  PlanToCheck plan = good_plan();
  plan.parts[1].body.T_world_body = at(0.9, 0.1 + kCube + 0.005, kPartZ);
  plan.picks[1] = make_pick(plan, 0, 1, {});
  const PlanCheckResult result = check_plan(plan, quick());
  for (const Fault& fault : result.faults) EXPECT_EQ(fault.where.find("pick 1"), std::string::npos) << fault.where;
  EXPECT_TRUE(codes(result).count("scene-collision")) << "pick 0 must hit the second cube";
}

TEST(PlanCheck, SelfCollision) {
  // Fingers end at 0.43 m above the floor at the release, the base's top is at 0.35 m.
  EXPECT_TRUE(codes_of(good_plan({0.8, 0, 0.12, 0, -0.085, 0, 0})).count("self-collision"));
  EXPECT_FALSE(codes_of(good_plan({0.8, 0, 0.12, 0, -0.075, 0, 0})).count("self-collision"));
}

TEST(PlanCheck, LinkInsideClosedMeshCollides) {
  // A hollow-looking box mesh around the hand at the start: no triangle is touched, the solid is.
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 0.2 : -0.2, i & 2 ? 0.2 : -0.2, i & 4 ? 0.2 : -0.2);
  mmgrasp::LinkShape shape;
  shape.shape = mmgrasp::MeshShape{mmgrasp::convex_hull(corners)};
  PlanToCheck plan = good_plan();
  plan.obstacles.push_back({"cage", {shape}, at(-0.9, 0, 1.25)});
  EXPECT_TRUE(codes_of(plan).count("start-collision"));
  plan.obstacles.back().T_world_body = at(-0.9, 0.4, 1.25);
  EXPECT_TRUE(codes_of(plan).empty());
}

TEST(PlanCheck, GraspPoseMoved) {
  PlanToCheck plan = good_plan();
  plan.parts[0].grasps[0].T_object_hand.translation().x() += 1.2e-4;  // the tolerance is 1e-4
  EXPECT_EQ(codes_of(plan), Codes{"grasp-missed"});
  plan = good_plan();
  plan.parts[0].grasps[0].T_object_hand.translation().x() += 0.8e-4;
  EXPECT_TRUE(codes_of(plan).empty());
  plan = good_plan();
  plan.parts[0].grasps[0].T_object_hand.rotate(Eigen::AngleAxisd(0.0012, Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(codes_of(plan), Codes{"grasp-missed"});
}

TEST(PlanCheck, FingersThatCloseOnNothing) {
  EXPECT_TRUE(codes_of(good_plan({0.8, 0.06, 0.12, 0, 0, 0, 0})).count("grasp-empty"));
}

TEST(PlanCheck, ApproachFromTheSide) {
  EXPECT_EQ(codes_of(good_plan({0.8, 0, 0.12, 0, 0, 0, 0.003})), Codes{"not-straight"});
  EXPECT_TRUE(codes_of(good_plan({0.8, 0, 0.12, 0, 0, 0, 0.0009})).empty());
}

TEST(PlanCheck, LiftTooSmall) {
  EXPECT_TRUE(codes_of(good_plan({0.8, 0, 0.008, 0, 0, 0, 0})).count("no-lift"));
}

TEST(PlanCheck, ApproachAndLiftAreAsLongAsAsked) {
  PlanToCheck plan = good_plan();  // 0.08 m down to the grasp, 0.12 m up
  plan.approach_distance = 0.08;
  plan.lift_height = 0.12;
  EXPECT_EQ(codes_of(plan), Codes{});
  plan.approach_distance = 0.085;
  EXPECT_EQ(codes_of(plan), Codes{"short-approach"});
  plan.approach_distance = 0.08;
  plan.lift_height = 0.125;
  EXPECT_EQ(codes_of(plan), Codes{"no-lift"});
}

TEST(PlanCheck, WidthsAreThoseOfTheParts) {
  PlanToCheck plan = good_plan();
  plan.finger_depth = plan.finger_width = 0.02;
  EXPECT_EQ(codes_of(plan), Codes{});
  for (const double factor : {0.5, 0.85, 1.2}) {
    plan = good_plan();
    plan.finger_depth = plan.finger_width = 0.02;
    plan.parts[0].grasps[0].opening *= factor;
    EXPECT_TRUE(codes_of(plan).count("grasp-opening")) << factor;
  }
}

TEST(PlanCheck, ListedGraspsHoldSomething) {
  // Pads 2 cm deep around the tcp: 2.9 cm above the middle of a cube of 4 cm they still meet it, 3.1 cm above not.
  for (const double above : {0.029, 0.031}) {
    PlanToCheck plan = good_plan();
    plan.finger_depth = plan.finger_width = 0.02;
    plan.parts[0].grasps[1].T_object_hand = at(0, 0, above);  // no pick uses it
    EXPECT_EQ(codes_of(plan), above > 0.03 ? Codes{"grasp-empty"} : Codes{}) << above;
    plan.parts[2].grasps[1].T_object_hand = at(0, 0, 1);  // this part is to stay
    EXPECT_EQ(codes_of(plan), above > 0.03 ? Codes{"grasp-empty"} : Codes{}) << above;
  }
}

TEST(PlanCheck, BodiesThatOverlap) {
  const std::vector<CheckedBody> bodies = {box("a", {1, 1, 1}, at(0, 0, 0)), box("b", {1, 1, 1}, at(1, 0, 0)),
                                           box("c", {1, 1, 1}, at(0.5, 0.2, 0))};
  EXPECT_EQ(overlapping_bodies(bodies), (std::vector<std::pair<std::size_t, std::size_t>>{{0, 2}, {1, 2}}));
}

TEST(PlanCheck, OverlapsAreNotSoughtAnyMoreOnceStopped) {
  mmgrasp::CancelToken stop;
  stop.stop();
  const mmgrasp::detail::InterruptionScope scope(stop);
  EXPECT_THROW(overlapping_bodies({box("a", {1, 1, 1}, at(0, 0, 0))}), mmgrasp::detail::Interrupted);
}

TEST(PlanCheck, ReleaseOutsideBin) {
  EXPECT_TRUE(codes_of(good_plan({0.8, 0, 0.12, 0.155, 0, 0, 0})).count("release-outside"));
  EXPECT_FALSE(codes_of(good_plan({0.8, 0, 0.12, 0.145, 0, 0, 0})).count("release-outside"));
  PlanToCheck plan = good_plan();
  plan.T_base_bin = at(0.3, 0, kBinTop);
  EXPECT_EQ(codes_of(plan), Codes{"release-outside"});
}

TEST(PlanCheck, ReleaseHeight) {
  for (const double off : {-0.032, -0.006, 0.006, 0.051})
    EXPECT_EQ(codes_of(good_plan({0.8, 0, 0.12, 0, off, 0, 0})), Codes{"release-height"}) << off;
  for (const double off : {-0.004, 0.004})
    EXPECT_TRUE(codes_of(good_plan({0.8, 0, 0.12, 0, off, 0, 0})).empty()) << off;
}

TEST(PlanCheck, ReleaseTilted) {
  EXPECT_EQ(codes_of(good_plan({0.8, 0, 0.12, 0, 0, 0.02, 0})), Codes{"release-tilted"});
  EXPECT_TRUE(codes_of(good_plan({0.8, 0, 0.12, 0, 0, 0.008, 0})).empty());
}

TEST(PlanCheck, Openings) {
  PlanToCheck plan = good_plan();
  motion(plan, 0, kApproach).opening = motion(plan, 0, kTransit).opening = 0.035;  // does not pass 0.04
  EXPECT_TRUE(codes_of(plan).count("opening"));
  plan = good_plan();
  motion(plan, 0, kTransfer).opening = 0.05;  // would let go
  EXPECT_TRUE(codes_of(plan).count("opening"));
  plan = good_plan();
  motion(plan, 0, kRetreat).opening = 0.11;  // the gripper ends at 0.10
  EXPECT_TRUE(codes_of(plan).count("opening"));
  plan = good_plan();
  plan.clearance = 0.01;  // the plan's hands are open by twice that
  EXPECT_EQ(codes_of(plan), Codes{});
  plan.clearance = 0.01001;
  EXPECT_EQ(codes_of(plan), Codes{"opening"});
  plan.clearance = 0.01;
  motion(plan, 0, kRetreat).opening = motion(plan, 0, kTransfer).opening;  // never lets go
  EXPECT_TRUE(codes_of(plan).count("opening"));
}

TEST(PlanCheck, HoldingFlag) {
  PlanToCheck plan = good_plan();
  motion(plan, 0, kLift).attached = false;
  EXPECT_EQ(codes_of(plan), Codes{"attachment"});
}

TEST(PlanCheck, FingerOutsideItsLimits) {
  PlanToCheck plan = good_plan();
  plan.fingers[0].open = 0.06;
  EXPECT_TRUE(codes_of(plan).count("finger-limit"));
}

TEST(PlanCheck, BrokenSamplesAreFaultsNotCrashes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<PlanToCheck> plans(6, good_plan());
  motion(plans[0], 0, kLift).positions[5][2] = nan;
  motion(plans[1], 0, kLift).positions[5].resize(3);
  motion(plans[2], 0, kLift).velocities.pop_back();
  motion(plans[3], 0, kLift) = {"lift", kCube, true, {}, {}, {}};
  motion(plans[4], 0, kLift).times[5] = nan;
  motion(plans[5], 0, kLift).positions.clear();
  for (const PlanToCheck& plan : plans) EXPECT_EQ(codes_of(plan), Codes{"motion-shape"});
}

TEST(PlanCheck, UnusableDataIsMalformed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<PlanToCheck> plans(14, good_plan());
  plans[0].arm_joints[2] = "nothing";
  plans[1].home[0] = nan;
  plans[2].tip_link = "";
  plans[3].velocity_limits.pop_back();
  plans[4].acceleration_limits[1] = 0;
  plans[5].parts[0].tray = "C";
  plans[6].parts[1].body.name = plans[6].parts[0].body.name;
  plans[7].obstacles[0].shapes[0].shape = mmgrasp::Box{Eigen::Vector3d(0, 1, 1)};
  plans[8].obstacles[0].shapes[0].shape = mmgrasp::MeshShape{};
  plans[9].parts[0].body.T_world_body.translation().x() = nan;
  plans[10].finger_links = {"thumb"};
  plans[11].stops[0].pose.z() = nan;
  plans[12].parts[0].grasps[0].opening = -1;
  plans[13].arm_joints[0] = "finger_mirror";
  for (std::size_t i = 0; i < plans.size(); ++i) EXPECT_EQ(codes_of(plans[i]), Codes{"malformed"}) << i;
}

TEST(PlanCheck, EmptyPlanForgetsEverything) {
  PlanToCheck plan{good_plan().robot};
  EXPECT_EQ(codes_of(plan), Codes{"malformed"});
  plan = good_plan();
  plan.picks.clear();
  plan.stops.clear();
  plan.regions.clear();
  plan.route.clear();
  EXPECT_EQ(codes_of(plan), (Codes{"part-forgotten", "region-missing", "route-legs", "tray-forgotten"}));
}

TEST(PlanCheck, EndlessMotionIsRefused) {
  PlanToCheck plan = good_plan();
  for (Eigen::VectorXd& v : motion(plan, 0, kTransit).velocities) v *= 1e5;
  EXPECT_TRUE(codes_of(plan).count("too-long"));
}

/// Every number and index of a plan that a file could get wrong.
std::vector<double*> numbers_of(PlanToCheck& plan) {
  std::vector<double*> numbers{&plan.max_opening,
                               &plan.clearance,
                               &plan.positioning_uncertainty,
                               &plan.drop_height,
                               &plan.bin_size.x(),
                               &plan.start.x(),
                               &plan.goal.z(),
                               &plan.home[1],
                               &plan.grid.resolution,
                               &plan.grid.origin.x(),
                               &plan.grid.headings[0],
                               &plan.fingers[0].open,
                               &plan.velocity_limits[0],
                               &plan.acceleration_limits[1],
                               &plan.approach.z(),
                               &plan.T_base_bin.matrix()(0, 3),
                               &plan.T_base_bin.matrix()(1, 1),
                               &plan.parts[0].body.T_world_body.matrix()(2, 3),
                               &plan.parts[0].grasps[0].opening,
                               &plan.parts[0].grasps[0].T_object_hand.matrix()(0, 0),
                               &plan.obstacles[1].T_world_body.matrix()(1, 3),
                               &plan.stops[0].pose.x(),
                               &plan.stops[1].radius,
                               &plan.route[1][1].y(),
                               &plan.route[2][0].z()};
  for (CheckedMotion& m : plan.picks[1].motions) {
    numbers.insert(numbers.end(),
                   {&m.opening, &m.times[4], &m.positions[7][1], &m.positions.back()[4], &m.velocities[9][0]});
  }
  return numbers;
}

TEST(PlanCheck, NoNumberMakesItThrow) {
  PlanToCheck model = good_plan();
  const std::size_t count = numbers_of(model).size();
  for (std::size_t i = 0; i < count; ++i) {
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), -1e9, 1e300}) {
      PlanToCheck plan = good_plan();
      *numbers_of(plan)[i] = value;
      PlanCheckOptions options = quick();
      options.samples = 1;
      PlanCheckResult result;
      EXPECT_NO_THROW(result = check_plan(plan, options)) << "number " << i << " = " << value;
      EXPECT_FALSE(result.faults.empty()) << "number " << i << " = " << value;
    }
  }
}

TEST(PlanCheck, StoppedCheckIsNoPass) {
  mmgrasp::Monitor monitor;
  monitor.stop.stop();
  EXPECT_TRUE(codes(check_plan(good_plan(), quick(), monitor)).count("stopped"));
}

TEST(PlanCheckVerdict, EndsSoonAfterItWasStoppedAtAnyMoment) {
  PlanCheckOptions options = quick();
  options.samples = 1'000'000;
  options.region_samples = 100'000;
  for (const int delay : {1, 5, 20, 100, 300}) {
    mmgrasp::Monitor monitor;
    std::thread watch([stop = monitor.stop, delay]() mutable {
      std::this_thread::sleep_for(std::chrono::milliseconds(delay));
      stop.stop();
    });
    EXPECT_TRUE(codes(check_plan(good_plan(), options, monitor)).count("stopped")) << delay;  // the whole takes hours
    watch.join();
  }
}

TEST(PlanCheckOptions, RefusesNonsense) {
  PlanCheckOptions options;
  options.joint_step = 0;
  EXPECT_THROW(check_plan(good_plan(), options), mmgrasp::InvalidInput);
  options = {};
  options.required_rate = 1.1;
  EXPECT_THROW(check_plan(good_plan(), options), mmgrasp::InvalidInput);
  options = {};
  options.samples = 2000000000;
  EXPECT_THROW(check_plan(good_plan(), options), mmgrasp::InvalidInput);
}

}  // namespace
}  // namespace tiny
