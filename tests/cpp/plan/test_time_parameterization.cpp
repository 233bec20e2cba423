#include "mmgrasp/plan/time_parameterization.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/planar_arm.hpp"
#include "support/vec.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;
using test::vec;

/// Rest to rest over `distance` under both limits: triangle or trapezoid of velocity.
double bang_bang_time(double distance, double velocity, double acceleration) {
  if (distance <= velocity * velocity / acceleration) return 2 * std::sqrt(distance / acceleration);
  return distance / velocity + velocity / acceleration;
}

struct Worst {
  double velocity = 0, acceleration = 0;  // Over the limits.
};

/// Derivatives of the cubic between samples, from its polynomial: p = p0 + v0 t + c t^2 + d t^3.
Worst worst_load(const JointTrajectory& trajectory, const VectorXd& v_max, const VectorXd& a_max) {
  Worst worst;
  for (std::size_t i = 0; i + 1 < trajectory.times.size(); ++i) {
    const double h = trajectory.times[i + 1] - trajectory.times[i];
    const VectorXd dp = trajectory.positions[i + 1] - trajectory.positions[i];
    const VectorXd &v0 = trajectory.velocities[i], &v1 = trajectory.velocities[i + 1];
    const VectorXd c = (3 * dp / h - 2 * v0 - v1) / h, d = (v0 + v1 - 2 * dp / h) / (h * h);
    for (int k = 0; k <= 10; ++k) {
      const double t = h * k / 10;
      const VectorXd v = v0 + 2 * c * t + 3 * d * t * t, a = 2 * c + 6 * d * t;
      worst.velocity = std::max(worst.velocity, v.cwiseAbs().cwiseQuotient(v_max).maxCoeff());
      worst.acceleration = std::max(worst.acceleration, a.cwiseAbs().cwiseQuotient(a_max).maxCoeff());
    }
  }
  return worst;
}

double distance_to_path(const VectorXd& q, const JointPath& path) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
    const VectorXd edge = path.waypoints[i + 1] - path.waypoints[i];
    const double t = std::clamp((q - path.waypoints[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (q - path.waypoints[i] - t * edge).norm());
  }
  return nearest;
}

void expect_sound(const JointTrajectory& trajectory, const JointPath& path, const VectorXd& v_max,
                  const VectorXd& a_max, double deviation) {
  ASSERT_GE(trajectory.times.size(), 2u);
  EXPECT_EQ(trajectory.times.front(), 0);
  EXPECT_EQ(trajectory.positions.front(), path.waypoints.front());
  EXPECT_EQ(trajectory.positions.back(), path.waypoints.back());
  EXPECT_EQ(trajectory.velocities.front().norm(), 0);
  EXPECT_EQ(trajectory.velocities.back().norm(), 0);
  for (std::size_t i = 0; i < trajectory.times.size(); ++i) {
    EXPECT_TRUE(i == 0 || trajectory.times[i] > trajectory.times[i - 1]);
    EXPECT_LE((trajectory.velocities[i].cwiseAbs() - v_max * (1 + 1e-6)).maxCoeff(), 0);
    EXPECT_LE((trajectory.accelerations[i].cwiseAbs() - a_max * (1 + 1e-6)).maxCoeff(), 0);
  }
  const Worst worst = worst_load(trajectory, v_max, a_max);
  EXPECT_LE(worst.velocity, 1.0 + 1e-4);
  EXPECT_LE(worst.acceleration, 1.0 + 1e-4);
  for (double t = 0; t < trajectory.duration(); t += 0.003) {
    EXPECT_LE(distance_to_path(trajectory.at(t), path), deviation + 1e-4) << "at " << t;
  }
}

TEST(TimeParameterization, OneJointTriangleAndTrapezoid) {
  for (const double distance : {0.01, 0.2, 0.5, 1.0, 3.0}) {
    for (const double period : {0.004, 0.02, 0.1}) {
      const JointPath path{{vec({0.3}), vec({0.3 - distance})}};
      const VectorXd v = vec({0.8}), a = vec({2.5});
      TimingOptions options;
      options.sample_period = period;
      const JointTrajectory trajectory = time_parameterize(path, v, a, options);
      expect_sound(trajectory, path, v, a, 0);
      const double expected = bang_bang_time(distance, 0.8, 2.5);
      EXPECT_GE(trajectory.duration(), expected * (1 - 1e-9));
      EXPECT_LE(trajectory.duration(), expected * 1.005) << distance << " " << period;
    }
  }
}

TEST(TimeParameterization, StraightLineIsRuledByTheTightestJoint) {
  const VectorXd from = vec({0.1, -0.5, 1.0}), motion = vec({1.2, -0.7, 0.3});
  const JointPath path{{from, from + motion}};
  const VectorXd v = vec({1.0, 0.4, 2.0}), a = vec({3.0, 2.0, 0.5});
  double speed = std::numeric_limits<double>::infinity(), acceleration = speed;  // Of the fraction driven.
  for (int i = 0; i < 3; ++i) {
    speed = std::min(speed, v[i] / std::abs(motion[i]));
    acceleration = std::min(acceleration, a[i] / std::abs(motion[i]));
  }
  const JointTrajectory trajectory = time_parameterize(path, v, a);
  expect_sound(trajectory, path, v, a, 0);
  EXPECT_NEAR(trajectory.duration(), bang_bang_time(1.0, speed, acceleration),
              0.005 * bang_bang_time(1.0, speed, acceleration));
}

TEST(TimeParameterization, NoDeviationStopsAtTheCorner) {
  const JointPath path{{vec({0, 0}), vec({1, 0}), vec({1, 0.6})}};
  const VectorXd v = vec({1, 1}), a = vec({2, 2});
  TimingOptions options;
  options.max_deviation = 0;
  const JointTrajectory trajectory = time_parameterize(path, v, a, options);
  expect_sound(trajectory, path, v, a, 0);
  const double expected = bang_bang_time(1.0, 1, 2) + bang_bang_time(0.6, 1, 2);
  EXPECT_NEAR(trajectory.duration(), expected, 0.005 * expected);
  // It passes the corner itself.
  double nearest = 1;
  for (const auto& q : trajectory.positions) nearest = std::min(nearest, (q - path.waypoints[1]).norm());
  EXPECT_LT(nearest, 1e-9);
}

TEST(TimeParameterization, BlendingIsFasterAndKeepsItsDistance) {
  const JointPath path{{vec({0, 0}), vec({1, 0}), vec({1, 0.6})}};
  const VectorXd v = vec({1, 1}), a = vec({2, 2});
  double previous = std::numeric_limits<double>::infinity();
  for (const double deviation : {0.0, 0.001, 0.01, 0.1}) {
    TimingOptions options;
    options.max_deviation = deviation;
    const JointTrajectory trajectory = time_parameterize(path, v, a, options);
    expect_sound(trajectory, path, v, a, deviation);
    EXPECT_LT(trajectory.duration(), previous);
    previous = trajectory.duration();
  }
}

TEST(TimeParameterization, CollinearWaypointsDoNotSlowDown) {
  const JointPath path{{vec({0, 0}), vec({0.1, 0.2}), vec({0.1, 0.2}), vec({0.4, 0.8}), vec({1, 2})}};
  const VectorXd v = vec({1, 1}), a = vec({2, 2});
  TimingOptions options;
  options.max_deviation = 0;
  const JointTrajectory trajectory = time_parameterize(path, v, a, options);
  expect_sound(trajectory, path, v, a, 0);
  const double expected = bang_bang_time(2.0, 1, 2);
  EXPECT_NEAR(trajectory.duration(), expected, 0.005 * expected);
}

TEST(TimeParameterization, TurningBackStops) {
  const JointPath path{{vec({0, 0}), vec({0.5, 0.5}), vec({0.1, 0.1})}};
  const VectorXd v = vec({1, 1}), a = vec({2, 2});
  const JointTrajectory trajectory = time_parameterize(path, v, a);
  expect_sound(trajectory, path, v, a, 0);
  const double expected = bang_bang_time(0.5, 1, 2) + bang_bang_time(0.4, 1, 2);
  EXPECT_NEAR(trajectory.duration(), expected, 0.005 * expected);
}

TEST(TimeParameterization, RandomPathsKeepLimitsAndDeviation) {
  Rng rng(4);
  for (int repeat = 0; repeat < 40; ++repeat) {
    const auto joints = static_cast<Eigen::Index>(1 + rng.index(7));
    JointPath path;
    const double scale = repeat % 4 == 3 ? 0.02 : 1.0;
    path.waypoints.push_back(rng.uniform(VectorXd::Constant(joints, -2), VectorXd::Constant(joints, 2)));
    for (int i = 0, count = 1 + static_cast<int>(rng.index(10)); i < count; ++i) {
      const VectorXd step = rng.uniform(VectorXd::Constant(joints, -1), VectorXd::Constant(joints, 1));
      path.waypoints.push_back(path.waypoints.back() + scale * step);
    }
    const VectorXd v = rng.uniform(VectorXd::Constant(joints, 0.3), VectorXd::Constant(joints, 2.5));
    const VectorXd a = rng.uniform(VectorXd::Constant(joints, 0.5), VectorXd::Constant(joints, 12));
    TimingOptions options;
    options.max_deviation = 0.03 * rng.uniform();
    options.sample_period = rng.uniform(0.004, 0.05);
    SCOPED_TRACE(repeat);
    const JointTrajectory trajectory = time_parameterize(path, v, a, options);
    expect_sound(trajectory, path, v, a, options.max_deviation);
    // Nothing can be faster than each joint alone with the whole travel in one go.
    double travel_bound = 0;
    for (Eigen::Index j = 0; j < joints; ++j) {
      const double net = std::abs(path.waypoints.back()[j] - path.waypoints.front()[j]);
      travel_bound = std::max(travel_bound, net > 0 ? bang_bang_time(net, v[j], a[j]) : 0.0);
    }
    EXPECT_GE(trajectory.duration(), travel_bound * (1 - 1e-9));
  }
}

TEST(TimeParameterization, AQuarterCircleIsDrivenAtItsCentripetalLimit) {
  // Many short chords of a circle of radius r. With joint limits a, the speed v on the circle can nowhere be more than
  // sqrt(a r sqrt(2)), and a v of sqrt(a r) is possible all along: the duration lies between what these two allow.
  JointPath path;
  const double r = 1.0, acceleration = 0.5;
  for (int i = 0; i <= 200; ++i)
    path.waypoints.push_back(r * vec({std::cos(M_PI * i / 200), std::sin(M_PI * i / 200)}));
  const VectorXd v = vec({10, 10}), a = vec({acceleration, acceleration});
  const JointTrajectory trajectory = time_parameterize(path, v, a);
  expect_sound(trajectory, path, v, a, 0.01);
  const double arc = M_PI * r;
  EXPECT_GT(trajectory.duration(), arc / std::sqrt(acceleration * r * std::sqrt(2.0)));
  // At constant tangential acceleration up to the speed sqrt(a r / 2) both parts together stay within a.
  const double slow = std::sqrt(acceleration * r / std::sqrt(2.0));
  EXPECT_LT(trajectory.duration(), arc / slow + slow / (acceleration / std::sqrt(2.0)));
}

TEST(TimeParameterization, AccelerationsAreThoseOfTheVelocities) {
  // Chords of a helix that differ by a hundred-thousandth leave straights of a micrometre between their arcs, which
  // take less time than two samples may lie apart. The third joint rules the speed: accelerations are those of the
  // arcs, and zero on the straights. Where one that is zero stood for an arc, 51 intervals turned with none at either
  // end.
  JointPath path;
  for (int i = 0; i <= 200; ++i) {
    const double angle = M_PI * (i + (i % 3 == 1 ? 1e-5 : 0.0)) / 200;
    path.waypoints.push_back(vec({std::cos(angle), std::sin(angle), angle}));
  }
  TimingOptions options;
  options.max_deviation = 2e-4;
  const VectorXd a = vec({1, 1, 1});
  const JointTrajectory trajectory = time_parameterize(path, vec({10, 10, 0.9}), a, options);
  int off = 0;
  for (std::size_t i = 0; i + 1 < trajectory.times.size(); ++i) {
    const double h = trajectory.times[i + 1] - trajectory.times[i];
    const VectorXd mean = (trajectory.velocities[i + 1] - trajectory.velocities[i]) / h;
    const VectorXd &before = trajectory.accelerations[i], &after = trajectory.accelerations[i + 1];
    const VectorXd beyond = (before.cwiseMin(after) - mean).cwiseMax(mean - before.cwiseMax(after));
    if (h > 1e-4 && (beyond.array() > 0.1 * a.array()).any()) ++off;
  }
  EXPECT_EQ(off, 0) << "of " << trajectory.times.size();
}

TEST(TimeParameterization, AStandstillIsOneSample) {
  const JointPath path{{vec({0.2, 0.3}), vec({0.2, 0.3})}};
  const JointTrajectory trajectory = time_parameterize(path, vec({1, 1}), vec({1, 1}));
  ASSERT_EQ(trajectory.times.size(), 1u);
  EXPECT_EQ(trajectory.duration(), 0);
  EXPECT_EQ(trajectory.positions.front(), path.waypoints.front());
}

TEST(TimeParameterization, NamesComeAlong) {
  const JointPath path{{vec({0, 0}), vec({1, 0})}};
  EXPECT_EQ(time_parameterize(path, vec({1, 1}), vec({1, 1}), {}, {"a", "b"}).names,
            (std::vector<std::string>{"a", "b"}));
}

TEST(TimeParameterization, RefusesBadInput) {
  const JointPath path{{vec({0, 0}), vec({1, 0})}};
  EXPECT_THROW(time_parameterize({}, vec({1}), vec({1})), InvalidInput);
  EXPECT_THROW(time_parameterize(path, vec({1}), vec({1, 1})), InvalidInput);
  EXPECT_THROW(time_parameterize(path, vec({1, 1}), vec({1, 0})), InvalidInput);
  EXPECT_THROW(time_parameterize(path, vec({1, std::nan("")}), vec({1, 1})), InvalidInput);
  EXPECT_THROW(time_parameterize(path, vec({1, 1}), vec({1, 1}), {}, {"only one"}), InvalidInput);
  EXPECT_THROW(time_parameterize({{vec({0, 0}), vec({1})}}, vec({1, 1}), vec({1, 1})), InvalidInput);
  TimingOptions options;
  options.max_deviation = -1;
  EXPECT_THROW(time_parameterize(path, vec({1, 1}), vec({1, 1}), options), InvalidInput);
  options = {};
  options.sample_period = 0;
  EXPECT_THROW(time_parameterize(path, vec({1, 1}), vec({1, 1}), options), InvalidInput);
}

/// Without jerk limits quick, with them minutes of work.
JointPath long_path() {
  Rng rng(1);
  JointPath path{{VectorXd::Zero(6)}};
  for (int i = 0; i < 3000; ++i)
    path.waypoints.push_back(path.waypoints.back() +
                             rng.uniform(VectorXd::Constant(6, -0.2), VectorXd::Constant(6, 0.2)));
  return path;
}

TEST(TimeParameterization, StopsBetweenItsTries) {
  TimingOptions options;
  options.jerk_limits = vec({20, 20});
  const JointPath path{{vec({0, 0}), vec({0.5, 0.5}), vec({0.1, 0.4})}};
  std::vector<std::string> stages;
  Monitor monitor;
  monitor.progress = [&](const std::string& stage, double fraction) {
    EXPECT_TRUE(fraction >= 0 && fraction <= 1) << fraction;
    stages.push_back(stage);
  };
  EXPECT_FALSE(time_parameterize(path, vec({1, 1}), vec({2, 2}), options, {}, monitor).times.empty());
  ASSERT_GT(std::count(stages.begin(), stages.end(), "limit jerk"), 3);
  stages.clear();
  monitor.progress = [&](const std::string& stage, double) {
    stages.push_back(stage);
    if (stage == "limit jerk") monitor.stop.stop();
  };
  EXPECT_TRUE(time_parameterize(path, vec({1, 1}), vec({2, 2}), options, {}, monitor).times.empty());
  EXPECT_EQ(stages, (std::vector<std::string>{"time path", "limit jerk"}));
}

TEST(TimeParameterization, StopsWithinATry) {
  TimingOptions options;
  options.jerk_limits = VectorXd::Constant(6, 20);
  Monitor monitor;
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    monitor.stop.stop();
  });
  const VectorXd limits = VectorXd::Ones(6);
  EXPECT_TRUE(time_parameterize(long_path(), limits, limits, options, {}, monitor).times.empty());
  stopper.join();
}

TEST(TimeParameterization, RefusesMoreSamplesThanMemoryHolds) {
  TimingOptions options;
  options.sample_period = 1e-12;
  const JointPath path{{vec({0, 0}), vec({1, 2})}};
  try {
    time_parameterize(path, vec({1, 1}), vec({2, 2}), options);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("sample_period = 1e-12"), std::string::npos) << error.what();
  }
  // The joint that is to blame is named.
  try {
    time_parameterize(path, vec({1, 1e-9}), vec({2, 2}));
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("at most 1e7 samples"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("for joint 1, which moves by 2 with velocity_limits[1] = 1e-09"),
              std::string::npos)
        << error.what();
  }
}

/// A bent path of a planar arm past a small ball that only a wide blend of its corner touches.
struct CornerScene {
  JointPath path;
  World world;
};

bool is_free_throughout(CollisionChecker& checker, const JointTrajectory& trajectory) {
  for (double t = 0; t <= trajectory.duration(); t += 5e-4) {
    if (!checker.is_free(trajectory.at(t))) return false;
  }
  return true;
}

/// Draws scenes until one is as wanted; there are plenty.
std::optional<CornerScene> corner_scene(const test::PlanarArm& arm, const TimingOptions& options, Rng& rng) {
  const VectorXd low = VectorXd::Constant(2, -1.5), high = VectorXd::Constant(2, 1.5);
  for (int attempt = 0; attempt < 2000; ++attempt) {
    CornerScene scene;
    for (int i = 0; i < 3; ++i) scene.path.waypoints.push_back(rng.uniform(low, high));
    const JointTrajectory wide =
        time_parameterize(scene.path, arm.group().velocity_limits(), arm.group().acceleration_limits(), options);
    Pose ball = Pose::Identity();
    ball.translation() = arm.tip(wide.at(rng.uniform(0.2, 0.8) * wide.duration()));
    scene.world.add("ball", Sphere{0.01}, ball);
    CollisionChecker checker(arm.group(), scene.world);
    const auto& w = scene.path.waypoints;
    if (checker.edge_is_free(w[0], w[1], 0.001) && checker.edge_is_free(w[1], w[2], 0.001) &&
        !is_free_throughout(checker, wide)) {
      return scene;
    }
  }
  return std::nullopt;
}

TEST(TimeParameterizeFree, ComesCloserToACornerThatIsInTheWay) {
  const test::PlanarArm arm(2);
  TimingOptions options;
  options.max_deviation = 0.3;
  Rng rng(8);
  for (int repeat = 0; repeat < 5; ++repeat) {
    const auto scene = corner_scene(arm, options, rng);
    ASSERT_TRUE(scene);
    CollisionChecker checker(arm.group(), scene->world);
    const JointTrajectory trajectory = time_parameterize_free(checker, scene->path, options, 0.001);
    ASSERT_FALSE(trajectory.times.empty());
    EXPECT_TRUE(is_free_throughout(checker, trajectory));
    EXPECT_EQ(trajectory.names, arm.group().names());
    expect_sound(trajectory, scene->path, arm.group().velocity_limits(), arm.group().acceleration_limits(), 0.3);
  }
}

TEST(TimeParameterizeFree, ChecksNothingMoreOnceStopped) {
  const test::PlanarArm arm(2);
  const JointPath path{{vec({0.4, -0.8}), vec({0.4, 0.3}), vec({1.2, 0.3})}};
  CollisionChecker checker(arm.group(), World{});
  std::size_t queries = 0, reports = 0;
  Monitor monitor;
  monitor.progress = [&](const std::string& stage, double) {
    if (stage != "check timed path" || ++reports != 3) return;
    queries = checker.queries();
    monitor.stop.stop();
  };
  EXPECT_TRUE(time_parameterize_free(checker, path, {}, 0.01, monitor).times.empty());
  EXPECT_EQ(reports, 3u);
  EXPECT_GT(queries, 0u);
  EXPECT_EQ(checker.queries(), queries);
}

TEST(TimeParameterizeFree, ChecksTooFineToWaitForCanBeStopped) {
  const test::PlanarArm arm(2);
  CollisionChecker checker(arm.group(), World{});
  Monitor monitor;
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    monitor.stop.stop();
  });
  EXPECT_TRUE(time_parameterize_free(checker, {{vec({0.4, -0.8}), vec({0.4, 0.3})}}, {}, 1e-9, monitor).times.empty());
  stopper.join();
}

TEST(TimeParameterizeFree, APathThroughAnObstacleGivesNothing) {
  const test::PlanarArm arm(2);
  const JointPath path{{vec({0.4, -0.8}), vec({0.4, 0.3}), vec({1.2, 0.3})}};
  World world;
  Pose ball = Pose::Identity();
  ball.translation() = arm.tip(vec({0.4, 0.0}));
  world.add("ball", Sphere{0.02}, ball);
  CollisionChecker checker(arm.group(), world);
  EXPECT_TRUE(time_parameterize_free(checker, path).times.empty());
}

}  // namespace
}  // namespace mmgrasp
