#include "mmgrasp/trajopt/optimize_whole_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "support/fetchlike.hpp"
#include "support/small_robots.hpp"
#include "support/vec.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;
using test::vec;

/// Straight lines start - task - goal.
WholeBodyGuess straight(const WholeBodyProblem& problem, const std::vector<VectorXd>& knots, double step) {
  WholeBodyGuess guess;
  for (std::size_t s = 0; s < problem.segments.size(); ++s) {
    const int n = problem.segments[s].intervals;
    for (int i = 0; i < n; ++i) guess.positions.push_back(knots[s] + (knots[s + 1] - knots[s]) * i / n);
    guess.steps.push_back(step);
  }
  guess.positions.push_back(knots.back());
  return guess;
}

/// P1 4.2: figure 4.3.
WholeBodyProblem example(const JointGroup& group) {
  WholeBodyProblem problem(group);
  problem.start = VectorXd::Zero(10);
  problem.goal_lower = problem.goal_upper = vec({10, 0, -1, 1.13, 0.3, 1.9, 1.1, 2.1, 0.5, 2.5});
  problem.segments = {{17}, {17}};
  ToolConstraint tool;
  tool.waypoint = 17;
  tool.T_world_tip = pose_from_xyz_rpy({5.5, -2, 0.5}, {1, 1, 0});
  problem.tool = {tool};
  return problem;
}

/// Sliding joints of 1 m/s and 2 m/s^2 along x and y.
JointGroup sliders(int count) {
  std::string urdf = "<robot name='sliders'>" + test::urdf_link("base");
  for (int i = 0; i < count; ++i) {
    const std::string name = std::string(1, static_cast<char>('a' + i)), parent = i == 0 ? "base" : "a";
    urdf += test::urdf_link(name) +
            test::urdf_joint("joint_" + name, "prismatic", parent, name, "0 0 0", i == 0 ? "1 0 0" : "0 1 0");
  }
  const Robot robot = Robot::from_strings(urdf + "</robot>");
  return robot.chain("base", count == 1 ? "a" : "b").with_acceleration_limits(VectorXd::Constant(count, 2.0));
}

/// Rest to rest over d at no more than v, speeding up by a.
double bang_bang(double d, double v, double a) {
  return d >= v * v / a ? d / v + v / a : 2 * std::sqrt(d / a);
}

WholeBodyProblem between(const JointGroup& group, const VectorXd& from, const VectorXd& to, std::vector<int> segments) {
  WholeBodyProblem problem(group);
  problem.start = from;
  problem.goal_lower = problem.goal_upper = to;
  for (int n : segments) problem.segments.push_back({n});
  return problem;
}

const Violation& violation(const WholeBodyResult& r, const std::string& kind) {
  for (const Violation& v : r.violations)
    if (v.kind == kind) return v;
  throw InvalidInput(kind);
}

TEST(OptimizeWholeBody, SeesWhatItPassesBetweenTheSamplesOfAnInterval) {
  // A pin of 4 mm in the way of a ball of 4 mm: a tenth of an interval is longer than both.
  const JointGroup group = sliders(2);
  const Robot ball =
      group.robot().with_link("ball", "b", Pose::Identity(), {LinkShape{Sphere{0.002}, Pose::Identity()}});
  const JointGroup carrier = ball.chain("base", "b").with_acceleration_limits(vec({2.0, 0.7}));
  const WholeBodyProblem problem = between(carrier, vec({-0.4, 0.0}), vec({0.4, 0.0}), {4});
  for (const double x : {-0.123, 0.0171, 0.139}) {
    World world;
    world.add("pin", Sphere{0.002}, pose_from_xyz_rpy({x, -0.0035, 0}, {0, 0, 0}));
    CollisionChecker checker(carrier, world);
    const WholeBodyGuess guess = straight(problem, {problem.start, problem.goal_lower}, 0.1);
    const WholeBodyResult alone = optimize_whole_body(problem, guess);
    bool seen = false, touches = false;
    for (const VectorXd& q : alone.trajectory->sampled(9).positions) seen = seen || !checker.is_free(q);
    for (const VectorXd& q : alone.trajectory->sampled(999).positions) touches = touches || !checker.is_free(q);
    ASSERT_TRUE(touches && !seen) << "the straight motion has to pass it unseen";
    const WholeBodyResult r = optimize_whole_body(problem, guess, {}, std::vector<CollisionChecker*>(4, &checker));
    ASSERT_EQ(r.outcome, Outcome::solved) << r.message << " " << violation(r, "collision").value;
    for (const VectorXd& q : r.trajectory->sampled(999).positions) EXPECT_TRUE(checker.is_free(q));
  }
}

}  // namespace

TEST(OptimizeWholeBody, SolvesTheExampleOfP1) {
  const JointGroup group = test::fetchlike_whole_body();
  const WholeBodyProblem problem = example(group);
  const VectorXd middle = 0.5 * (problem.start + problem.goal_lower);
  const WholeBodyResult r =
      optimize_whole_body(problem, straight(problem, {problem.start, middle, problem.goal_lower}, 0.6));
  ASSERT_EQ(r.outcome, Outcome::solved) << r.message;
  for (const Violation& v : r.violations) EXPECT_TRUE(v.kept()) << v.kind;
  EXPECT_LE(violation(r, "dynamics").value, 1e-8);
  EXPECT_LE(violation(r, "nonholonomic").value, 1e-6);
  // (4.1) with all m + 1 segments.
  EXPECT_NEAR(r.trajectory->duration(),
              17 * r.trajectory->times()[1] + 17 * (r.trajectory->times()[34] - r.trajectory->times()[33]), 1e-9);
}

TEST(CheckWholeBody, TellsSlippingSidewaysFromFallingBehind) {
  const JointGroup group = test::fetchlike_whole_body();
  const WholeBodyProblem problem = example(group);
  const VectorXd middle = 0.5 * (problem.start + problem.goal_lower);
  const WholeBodyResult r =
      optimize_whole_body(problem, straight(problem, {problem.start, middle, problem.goal_lower}, 0.6));
  ASSERT_EQ(r.outcome, Outcome::solved) << r.message;
  const WholeBodyTrajectory& t = *r.trajectory;
  constexpr double kOff = 1e-3;
  for (const bool sideways : {false, true}) {
    std::vector<VectorXd> positions = t.positions();
    const double theta = positions.back()[2], h = t.times()[34] - t.times()[33];
    const double angle = theta + (sideways ? M_PI / 2 : 0);
    positions.back()[0] += kOff * std::cos(angle);
    positions.back()[1] += kOff * std::sin(angle);
    WholeBodyResult spoiled;
    spoiled.violations = check_whole_body(problem, {group, t.times(), positions, t.drive()});
    EXPECT_NEAR(violation(spoiled, "nonholonomic").value, sideways ? kOff / h : 0, 1e-6);
    EXPECT_NEAR(violation(spoiled, "dynamics").value,
                kOff * std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle))), 1e-6);
  }
}

TEST(OptimizeWholeBody, SolvesInTheSameWayWhateverWasSolvedBefore) {
  const JointGroup group = test::fetchlike_whole_body();
  WholeBodyProblem problem = example(group);
  const VectorXd middle = 0.5 * (problem.start + problem.goal_lower);
  const auto solve = [&](double y) {
    problem.tool[0].T_world_tip.translation().y() = y;
    const WholeBodyResult r =
        optimize_whole_body(problem, straight(problem, {problem.start, middle, problem.goal_lower}, 0.6));
    EXPECT_EQ(r.outcome, Outcome::solved) << r.message;
    return r.trajectory->to_csv();
  };
  const std::vector<double> places{-2, -1.8, -1.6};
  std::vector<std::string> forwards, backwards;
  for (std::size_t i = 0; i < places.size(); ++i) forwards.push_back(solve(places[i]));
  for (std::size_t i = places.size(); i-- > 0;) backwards.insert(backwards.begin(), solve(places[i]));
  EXPECT_EQ(forwards, backwards);
}

TEST(OptimizeWholeBody, MeetsBangBangOptimaInOneAndTwoDimensions) {
  for (const double d : {0.3, 0.9, 2.0}) {
    const JointGroup one = sliders(1);
    const WholeBodyProblem problem = between(one, vec({-0.5 * d}), vec({0.5 * d}), {34});
    const WholeBodyResult r = optimize_whole_body(problem, straight(problem, {problem.start, problem.goal_lower}, 0.2));
    ASSERT_EQ(r.outcome, Outcome::solved) << d;
    EXPECT_GE(r.trajectory->duration(), bang_bang(d, 1, 2) - 1e-6);
    EXPECT_LE(r.trajectory->duration(), 1.01 * bang_bang(d, 1, 2));
  }
  const WholeBodyProblem problem = between(sliders(2), vec({-1, 0.2}), vec({1, -0.1}), {34});
  const WholeBodyResult r = optimize_whole_body(problem, straight(problem, {problem.start, problem.goal_lower}, 0.2));
  ASSERT_EQ(r.outcome, Outcome::solved);
  EXPECT_GE(r.trajectory->duration(), bang_bang(2, 1, 2) - 1e-6);
  EXPECT_LE(r.trajectory->duration(), 1.01 * bang_bang(2, 1, 2));
}

TEST(OptimizeWholeBody, KeepsMecanumWheelsBetweenWaypoints) {
  BaseLimits limits;
  limits.linear_velocity = 0.9;
  limits.angular_velocity = 2;
  limits.wheel_velocity = 0.5;
  limits.wheel_separation = 0.4;
  limits.wheelbase = 0.5;
  const JointGroup group = test::fetchlike_whole_body(BaseKind::omni, limits);
  const auto drive = [&](double theta, double turn) {
    VectorXd goal = VectorXd::Zero(10), start = goal;
    start[2] = theta;
    goal.head<3>() << 3, 0, theta + turn;
    const WholeBodyProblem problem = between(group, start, goal, {34});
    return optimize_whole_body(problem, straight(problem, {start, goal}, 0.3));
  };
  // Straight: 3 m at 0.5 m/s ahead, at 0.5 / sqrt(2) m/s across, if it may not turn on its way.
  limits.angular_velocity = 1e-3;
  const JointGroup stiff = test::fetchlike_whole_body(BaseKind::omni, limits);
  VectorXd across = VectorXd::Zero(10), end = across;
  across[2] = end[2] = M_PI / 4;
  end[0] = 3;
  const WholeBodyProblem problem = between(stiff, across, end, {34});
  const WholeBodyResult slow = optimize_whole_body(problem, straight(problem, {across, end}, 0.3));
  ASSERT_EQ(slow.outcome, Outcome::solved) << slow.message;
  const double expected = bang_bang(3, 0.5 / std::sqrt(2.0), 0.5);
  EXPECT_GE(slow.trajectory->duration(), 0.99 * expected);  // turned by up to 4 mrad
  EXPECT_LE(slow.trajectory->duration(), 1.01 * expected);
  const WholeBodyResult ahead = drive(0, 0);
  ASSERT_EQ(ahead.outcome, Outcome::solved) << ahead.message;
  EXPECT_GE(ahead.trajectory->duration(), bang_bang(3, 0.5, 0.5) - 1e-6);
  EXPECT_LE(ahead.trajectory->duration(), 1.02 * bang_bang(3, 0.5, 0.5));
  // Turning by two right angles: rims from positions alone, a hundred times finer than waypoints.
  const WholeBodyResult turning = drive(0.3, M_PI);
  ASSERT_EQ(turning.outcome, Outcome::solved) << turning.message;
  EXPECT_TRUE(violation(turning, "wheel speed").kept());
  const JointTrajectory fine = turning.trajectory->sampled(99);
  double most = 0;
  for (std::size_t i = 1; i < fine.times.size(); ++i) {
    const VectorXd rate = (fine.positions[i] - fine.positions[i - 1]) / (fine.times[i] - fine.times[i - 1]);
    const double theta = 0.5 * (fine.positions[i][2] + fine.positions[i - 1][2]);
    const double c = std::cos(theta), s = std::sin(theta);
    most = std::max(
        most, std::abs(c * rate[0] + s * rate[1]) + std::abs(c * rate[1] - s * rate[0]) + 0.45 * std::abs(rate[2]));
  }
  EXPECT_LE(most, 0.5 + 1e-5);
  EXPECT_GE(most, 0.49);
}

TEST(OptimizeWholeBody, PassesAPointWithoutStopping) {
  // Out to 1 and back to 0: the joint turns round at the task, where its speed is 0 anyway; over 0 -> 1 -> 2 it is not.
  const WholeBodyProblem plain = between(sliders(1), vec({0}), vec({2}), {17, 17});
  WholeBodyProblem problem = plain;
  ToolConstraint tool;
  tool.waypoint = 17;
  tool.T_world_tip.translation().x() = 0.7;
  problem.tool = {tool};
  const WholeBodyResult r =
      optimize_whole_body(problem, straight(problem, {problem.start, vec({0.7}), problem.goal_lower}, 0.1));
  ASSERT_EQ(r.outcome, Outcome::solved) << r.message;
  EXPECT_NEAR(r.trajectory->positions()[17][0], 0.7, 1e-6);
  EXPECT_LE(r.trajectory->duration(), 1.01 * bang_bang(2, 1, 2));
  problem.tool[0].max_speed = 0.25;
  const WholeBodyResult slow =
      optimize_whole_body(problem, straight(problem, {problem.start, vec({0.7}), problem.goal_lower}, 0.1));
  ASSERT_EQ(slow.outcome, Outcome::solved) << slow.message;
  // Slowing from 1 to 0.25 and speeding up again costs (1 - 0.25)^2 / 2 / 1 s.
  EXPECT_NEAR(slow.trajectory->duration(), bang_bang(2, 1, 2) + 0.75 * 0.75 / 2, 0.02);
  EXPECT_LE(std::abs(slow.trajectory->drive()[17][0]), 0.25 + 1e-6);
}

TEST(OptimizeWholeBody, BothSolversAgree) {
  const WholeBodyProblem problem = between(sliders(2), vec({-1, 0.2}), vec({1, -0.1}), {8});
  const WholeBodyGuess guess = straight(problem, {problem.start, problem.goal_lower}, 0.4);
  WholeBodyOptions options;
  options.smoothing = 0.1;
  options.tolerance = 1e-7;
  options.max_iterations = 1000;
  const WholeBodyResult sparse = optimize_whole_body(problem, guess, options);
  options.solver = "slsqp";
  const WholeBodyResult dense = optimize_whole_body(problem, guess, options);
  ASSERT_TRUE(sparse.usable()) << sparse.message;
  ASSERT_TRUE(dense.usable()) << dense.message;
  EXPECT_NEAR(sparse.trajectory->duration(), dense.trajectory->duration(), 1e-4 * sparse.trajectory->duration());
}

TEST(OptimizeWholeBody, KeepsJointLimitsBetweenWaypoints) {
  // Joints end at 3 m: starting towards the limit, the joint has 0.1 m in which to turn round.
  WholeBodyProblem problem = between(sliders(1), vec({2.9}), vec({1.0}), {20});
  problem.start_velocity = vec({0.6});
  const WholeBodyResult r = optimize_whole_body(problem, straight(problem, {problem.start, problem.goal_lower}, 0.5));
  ASSERT_EQ(r.outcome, Outcome::solved) << r.message;
  for (int i = 0; i <= 1000; ++i) EXPECT_LE(r.trajectory->at(r.trajectory->duration() * i / 1000)[0], 3 + 1e-7);
}

TEST(OptimizeWholeBody, KeepsJerk) {
  for (const double jerk_time : {0.15, 0.25, 0.4}) {
    WholeBodyProblem problem = between(sliders(1), vec({-1}), vec({1}), {80});
    problem.jerk_time = jerk_time;
    const WholeBodyResult r = optimize_whole_body(problem, straight(problem, {problem.start, problem.goal_lower}, 0.1));
    ASSERT_EQ(r.outcome, Outcome::solved) << r.message;
    EXPECT_LE(violation(r, "jerk").value, 1e-4);
    // The S-curve: its four ramps of acceleration make it last jerk_time longer than with jumps. Steps of acceleration
    // at waypoints stand for ramps between them, which is up to a step shorter.
    const double step = r.trajectory->duration() / problem.intervals();
    EXPECT_NEAR(r.trajectory->duration(), bang_bang(2, 1, 2) + jerk_time, 1.5 * step) << jerk_time;
    // At both ends, too.
    const auto& drive = r.trajectory->drive();
    const double allowed = 2 / jerk_time * step * step;
    EXPECT_LE(std::abs(drive[1][0]), allowed * (1 + 1e-3));
    EXPECT_LE(std::abs(drive[drive.size() - 2][0]), allowed * (1 + 1e-3));
  }
}

/// In the middle of a motion nothing is known about the acceleration before.
TEST(OptimizeWholeBody, JerkIsFreeWhereTheMotionBeganBefore) {
  WholeBodyProblem problem = between(sliders(1), vec({-1}), vec({1}), {40});
  problem.jerk_time = 0.4;
  problem.start_velocity = vec({0.5});
  const WholeBodyResult r = optimize_whole_body(problem, straight(problem, {problem.start, problem.goal_lower}, 0.1));
  ASSERT_EQ(r.outcome, Outcome::solved) << r.message;
  const double first = (r.trajectory->drive()[1][0] - 0.5) / r.trajectory->times()[1];
  EXPECT_NEAR(first, 2, 1e-3);
}

TEST(OptimizeWholeBody, SaysWhatCannotBeKept) {
  WholeBodyProblem problem = between(sliders(1), vec({-1}), vec({1}), {10});
  problem.segments[0].max_duration = 0.5;  // 2 m at 1 m/s
  const WholeBodyResult r = optimize_whole_body(problem, straight(problem, {problem.start, problem.goal_lower}, 0.05));
  EXPECT_FALSE(r.usable());
  ASSERT_TRUE(r.trajectory);
  EXPECT_TRUE(std::any_of(r.violations.begin(), r.violations.end(), [](const Violation& v) { return !v.kept(); }));
}

TEST(OptimizeWholeBody, RefusesWhatMakesNoSense) {
  const WholeBodyProblem good = between(sliders(1), vec({-1}), vec({1}), {10});
  const WholeBodyGuess guess = straight(good, {good.start, good.goal_lower}, 0.2);
  const auto refused = [&](const WholeBodyProblem& p, const WholeBodyGuess& g, const std::string& what) {
    try {
      optimize_whole_body(p, g);
      ADD_FAILURE() << what;
    } catch (const InvalidInput& e) {
      EXPECT_NE(std::string(e.what()).find(what), std::string::npos) << e.what();
    }
  };
  WholeBodyProblem p = good;
  p.segments[0].intervals = 0;
  refused(p, guess, "segments[0].intervals");
  p = good;
  p.segments[0].min_duration = 3;
  p.segments[0].max_duration = 2;
  refused(p, guess, "max_duration");
  p = good;
  p.goal_lower = vec({2});
  refused(p, guess, "goal");
  p = good;
  p.tool.push_back({});
  p.tool[0].waypoint = 11;
  refused(p, guess, "waypoint");
  WholeBodyGuess g = guess;
  g.positions[4][0] = std::nan("");
  refused(good, g, "guess.positions[4]");
  g = guess;
  g.steps[0] = 0;
  refused(good, g, "guess.steps");
  g = guess;
  g.positions.pop_back();
  refused(good, g, "guess.positions");
}

TEST(WholeBodyTrajectory, RollsOutAsAUnicycle) {
  const JointGroup group = test::fetchlike_whole_body();
  // Half a circle of 0.5 m at 0.5 m/s.
  std::vector<double> times;
  std::vector<VectorXd> positions, drive;
  for (int i = 0; i <= 10; ++i) {
    const double t = M_PI * i / 10;
    VectorXd q = VectorXd::Zero(10), u = VectorXd::Zero(9);
    q.head<3>() << 0.5 * std::sin(t), 0.5 - 0.5 * std::cos(t), t;
    u.head<2>() << 0.5, 1;
    times.push_back(t);
    positions.push_back(q);
    drive.push_back(u);
  }
  const WholeBodyTrajectory circle(group, times, positions, drive);
  const std::vector<VectorXd> rolled = circle.rolled_out();
  for (std::size_t i = 0; i < rolled.size(); ++i) EXPECT_LT((rolled[i] - positions[i]).norm(), 1e-9);
  const VectorXd q = circle.at(1.234);
  EXPECT_NEAR(q[0], 0.5 * std::sin(1.234), 1e-9);
  EXPECT_NEAR(q[2], 1.234, 1e-12);
  const JointTrajectory fine = circle.sampled(3);
  EXPECT_EQ(fine.times.size(), 41u);
  EXPECT_NEAR(fine.accelerations[7].head<2>().norm(), 0.5, 1e-9);  // towards the centre: v omega
  const WholeBodyProblem problem = between(group, positions.front(), positions.back(), {10});
  for (const Violation& v : check_whole_body(problem, circle))
    if (v.kind == "dynamics" || v.kind == "nonholonomic" || v.kind == "drift") {
      EXPECT_TRUE(v.kept()) << v.kind;
    }
  // The trapezoid of (4.6) on x and y would be off by far more than the check allows.
  std::vector<VectorXd> wrong = positions;
  for (std::size_t i = 0; i + 1 < wrong.size(); ++i) {
    const VectorXd a = configuration_velocity(group, positions[i], drive[i]),
                   b = configuration_velocity(group, positions[i + 1], drive[i + 1]);
    wrong[i + 1] = wrong[i] + 0.5 * (times[i + 1] - times[i]) * (a + b);
  }
  const std::vector<Violation> found = check_whole_body(problem, WholeBodyTrajectory(group, times, wrong, drive));
  EXPECT_FALSE(found[0].kept());
  EXPECT_EQ(found[0].kind, "dynamics");
  EXPECT_GT(found[0].value, 1e-3);
}

TEST(OptimizeWholeBody, KeepsThePaddingOfTheWorld) {
  // A slider pair carries a ball of 5 cm past a post and keeps what the padding asks.
  const JointGroup group = sliders(2);
  const Robot ball =
      group.robot().with_link("ball", "b", Pose::Identity(), {LinkShape{Sphere{0.05}, Pose::Identity()}});
  const JointGroup carrier = ball.chain("base", "b").with_acceleration_limits(vec({2.0, 0.7}));
  WholeBodyProblem problem = between(carrier, vec({-0.4, 0.02}), vec({0.4, 0.02}), {24});
  World world;
  world.add("post", Sphere{0.1}, Pose::Identity());
  WholeBodyOptions options;
  options.margin = 1e-3;
  for (const double links : {0.0, 0.1, 0.22}) {
    world.set_padding({links, 0, 0.02, {}});
    CollisionChecker checker(carrier, world);
    const std::vector<CollisionChecker*> checkers(24, &checker);
    WholeBodyGuess guess = straight(problem, {problem.start, problem.goal_lower}, 0.1);
    const WholeBodyResult r = optimize_whole_body(problem, guess, options, checkers);
    ASSERT_EQ(r.outcome, Outcome::solved) << r.message << " " << violation(r, "collision").what;
    double nearest = 1;
    for (const VectorXd& q : r.trajectory->sampled(49).positions) nearest = std::min(nearest, q.norm() - 0.15);
    EXPECT_GT(nearest, links + 0.02);
  }
}

}  // namespace mmgrasp
