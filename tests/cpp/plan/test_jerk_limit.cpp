#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/plan/time_parameterization.hpp"
#include "support/vec.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;
using test::vec;

TimingOptions with_jerk(const VectorXd& limits, double deviation = 0.01) {
  TimingOptions options;
  options.jerk_limits = limits;
  options.max_deviation = deviation;
  options.sample_period = 0.005;
  return options;
}

/// The executed cubics keep all limits, by finite differences of `at()` where it is smooth.
void expect_kept(const JointTrajectory& motion, const VectorXd& velocity, const VectorXd& acceleration,
                 const VectorXd& jerk) {
  for (std::size_t i = 0; i + 1 < motion.times.size(); ++i) {
    const double h = motion.times[i + 1] - motion.times[i];
    VectorXd p[4];
    for (int k = 0; k < 4; ++k) p[k] = motion.at(motion.times[i] + h * (1e-9 + k * (1 - 2e-9) / 3));
    const double d = h / 3;
    for (Eigen::Index j = 0; j < velocity.size(); ++j) {
      EXPECT_LE(std::abs(p[3][j] - p[0][j]) / h, velocity[j] * (1 + 1e-5));
      EXPECT_LE(std::abs(p[2][j] - 2 * p[1][j] + p[0][j]) / (d * d), acceleration[j] * (1 + 1e-3));
      EXPECT_LE(std::abs(p[3][j] - 3 * p[2][j] + 3 * p[1][j] - p[0][j]) / (d * d * d), jerk[j] * (1 + 1e-2));
    }
    // From sample to sample, too, the acceleration changes by no more than the jerk allows.
    const VectorXd change = (motion.accelerations[i + 1] - motion.accelerations[i]).cwiseAbs();
    for (Eigen::Index j = 0; j < jerk.size(); ++j) EXPECT_LE(change[j], jerk[j] * h * (1 + 1e-6) + 1e-9);
  }
}

TEST(JerkLimits, ALongStraightMoveTakesTheShortestTime) {
  // v and a are both reached: distance / v + v / a + a / j is the least there is.
  const double v = 1.0, a = 2.0, j = 20.0, distance = 3.0;
  const JointPath path{{vec({0}), vec({distance})}};
  const JointTrajectory motion = time_parameterize(path, vec({v}), vec({a}), with_jerk(vec({j})));
  EXPECT_NEAR(motion.duration(), distance / v + v / a + a / j, 0.005 * motion.duration());
  EXPECT_GE(motion.duration(), distance / v + v / a + a / j - 1e-9);
  EXPECT_EQ(motion.positions.front(), vec({0}));
  EXPECT_EQ(motion.positions.back(), vec({distance}));
  EXPECT_EQ(motion.velocities.back(), vec({0}));
  expect_kept(motion, vec({v}), vec({a}), vec({j}));
}

TEST(JerkLimits, AShortMoveComesNearTheShortestTime) {
  // Neither v nor a is reached: 4 (d / 2j)^(1/3) is the least there is.
  const double j = 10.0, distance = 0.01, least = 4 * std::cbrt(distance / (2 * j));
  const JointTrajectory motion =
      time_parameterize(JointPath{{vec({0}), vec({distance})}}, vec({1}), vec({5}), with_jerk(vec({j})));
  EXPECT_GE(motion.duration(), least - 1e-9);
  EXPECT_LE(motion.duration(), 1.25 * least);
  expect_kept(motion, vec({1}), vec({5}), vec({j}));
}

TEST(JerkLimits, CornersAreBlendedAndLimitsKept) {
  const JointPath path{{vec({0, 0}), vec({1, 0.2}), vec({1.2, 1}), vec({0, 1.5})}};
  const VectorXd v = vec({1, 1.5}), a = vec({3, 2}), j = vec({30, 40});
  const JointTrajectory motion = time_parameterize(path, v, a, with_jerk(j));
  const JointTrajectory fast = time_parameterize(path, v, a, with_jerk(VectorXd()));
  EXPECT_GT(motion.duration(), fast.duration());
  EXPECT_LT(motion.duration(), fast.duration() + 2.5 * (a.cwiseQuotient(j)).maxCoeff());
  EXPECT_EQ(motion.positions.front(), path.waypoints.front());
  EXPECT_EQ(motion.positions.back(), path.waypoints.back());
  expect_kept(motion, v, a, j);
  // Never far from the path: no farther than blending and averaging over the window may take it.
  for (double t = 0; t < motion.duration(); t += 0.003) {
    double off = 1e9;
    for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
      const VectorXd from = path.waypoints[i], edge = path.waypoints[i + 1] - from, q = motion.at(t) - from;
      const double s = std::clamp(q.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
      off = std::min(off, (q - s * edge).norm());
    }
    EXPECT_LE(off, 0.03);
  }
}

TEST(JerkLimits, StopsKeepThePathExactly) {
  const JointPath path{{vec({0, 0}), vec({1, 0}), vec({1, 1})}};
  const VectorXd v = vec({1, 1}), a = vec({3, 3}), j = vec({20, 20});
  const JointTrajectory motion = time_parameterize(path, v, a, with_jerk(j, 0));
  // Two moves of one unit, each as long as it takes by itself.
  EXPECT_NEAR(motion.duration(), 2 * (1 / 1.0 + 1 / 3.0 + 3 / 20.0), 0.01 * motion.duration());
  for (double t = 0; t < motion.duration(); t += 0.002) {
    const VectorXd q = motion.at(t);
    EXPECT_LE(std::min(std::abs(q[1]), std::abs(q[0] - 1)), 1e-4);
  }
  expect_kept(motion, v, a, j);
}

/// The distance of the executed motion from the polyline.
double farthest(const JointTrajectory& motion, const JointPath& path) {
  double worst = 0;
  for (int k = 0; k <= 4000; ++k) {
    const VectorXd at = motion.at(motion.duration() * k / 4000);
    double off = 1e9;
    for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
      const VectorXd edge = path.waypoints[i + 1] - path.waypoints[i], q = at - path.waypoints[i];
      off = std::min(off, (q - std::clamp(q.dot(edge) / edge.squaredNorm(), 0.0, 1.0) * edge).norm());
    }
    worst = std::max(worst, off);
  }
  return worst;
}

TEST(JerkLimits, RandomPathsAreKeptWithinTheDeviation) {
  Rng rng(21);
  for (int trial = 0; trial < 40; ++trial) {
    const int joints = 2 + trial % 5, corners = 1 + trial % 4;
    JointPath path{{VectorXd::Zero(joints)}};
    for (int i = 0; i <= corners; ++i)
      path.waypoints.push_back(path.waypoints.back() +
                               rng.uniform(VectorXd::Constant(joints, -1), VectorXd::Constant(joints, 1)));
    const VectorXd v = rng.uniform(VectorXd::Constant(joints, 0.5), VectorXd::Constant(joints, 2));
    const VectorXd j = v * std::pow(10.0, rng.uniform(-0.5, 2));
    TimingOptions options = with_jerk(j, trial % 7 == 0 ? 0 : rng.uniform(0.001, 0.05));
    options.sample_period = trial % 3 == 0 ? 0.3 : 0.02;
    const JointTrajectory motion = time_parameterize(path, v, 2 * v, options);
    EXPECT_LE(farthest(motion, path), options.max_deviation + 1e-6) << trial;
    EXPECT_EQ(motion.positions.back(), path.waypoints.back());
  }
}

TEST(JerkLimits, ASquareIsNotLeft) {
  const JointPath path{{vec({0, 0}), vec({1, 0}), vec({1, 1}), vec({0, 1})}};
  const JointTrajectory motion = time_parameterize(path, vec({1, 1}), vec({2, 2}), with_jerk(vec({1, 1})));
  EXPECT_LE(farthest(motion, path), 0.01 + 1e-6);
  // Three moves of 1, each from rest to rest in the least time under the jerk limit alone, are what stops may take.
  EXPECT_LE(motion.duration(), 3 * 4 * std::cbrt(1 / 2.0) * 1.25);
}

/// Round a square, with corners blended or stopped at.
class SquareJerk : public ::testing::TestWithParam<double> {
 protected:
  JointTrajectory timed(const VectorXd& jerk, double period = 0.02) const {
    TimingOptions options = with_jerk(jerk, GetParam());
    options.sample_period = period;
    return time_parameterize(path_, ones_, ones_, options);
  }
  const JointPath path_{{vec({0, 0}), vec({1, 0}), vec({1, 1}), vec({0, 1})}};
  const VectorXd ones_ = vec({1, 1});
};

TEST_P(SquareJerk, LimitsThatNeverBindChangeNothing) {
  const JointTrajectory fast = timed({});
  EXPECT_GT(fast.times.size(), 100u);
  for (const double j : {1e6, 1e12, 1e300}) {
    const JointTrajectory motion = timed(vec({j, j}));
    EXPECT_EQ(motion.times, fast.times) << j;
    EXPECT_EQ(motion.positions, fast.positions) << j;
    EXPECT_EQ(motion.velocities, fast.velocities) << j;
    EXPECT_EQ(motion.accelerations, fast.accelerations) << j;
  }
}

TEST_P(SquareJerk, HighLimitsAreKeptByFewSamples) {
  const JointTrajectory fast = timed({});
  for (const double j : {250.0, 1e3, 3e3, 8e3}) {
    const JointTrajectory motion = timed(vec({j, j}));
    expect_kept(motion, ones_, ones_, vec({j, j}));
    // A window of 2 a / j at most, waited for at two corners, and the end's.
    EXPECT_GT(motion.duration(), fast.duration() - 1e-9) << j;
    EXPECT_LT(motion.duration(), fast.duration() * 1.003 + 3 * 2.0 / j) << j;
    EXPECT_LT(motion.times.size(), 25 * fast.times.size()) << j;
    for (double t = 0; t < fast.duration(); t += 0.01)
      EXPECT_LT((motion.at(t * motion.duration() / fast.duration()) - fast.at(t)).norm(), 0.02 + 6 / j) << j;
  }
}

TEST_P(SquareJerk, LimitsThatWouldFillTheMemoryAreRefused) {
  for (const double j : {1e-20, 1e-100}) {
    try {
      timed(vec({1, j}));
      FAIL() << j;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("jerk_limits = "), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("1e7 samples"), std::string::npos) << error.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Corners, SquareJerk, ::testing::Values(0.0, 0.01));

TEST(JerkLimits, RefusesBadInput) {
  const JointPath path{{vec({0, 0}), vec({1, 0})}};
  EXPECT_THROW(time_parameterize(path, vec({1, 1}), vec({1, 1}), with_jerk(vec({1}))), InvalidInput);
  EXPECT_THROW(time_parameterize(path, vec({1, 1}), vec({1, 1}), with_jerk(vec({1, 0}))), InvalidInput);
  EXPECT_THROW(time_parameterize(path, vec({1, 1}), vec({1, 1}), with_jerk(vec({1, std::nan("")}))), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
