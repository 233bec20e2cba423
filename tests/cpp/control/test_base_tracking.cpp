#include "mmgrasp/control/base_tracking.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "mmgrasp/control/unicycle.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod = 0.02;

BaseLimits fast() {
  BaseLimits limits;
  limits.linear_velocity = limits.angular_velocity = 5;
  limits.wheel_separation = 0.375;
  return limits;
}

/// A base plan sampled at every period from a pose as a function of time.
JointTrajectory sampled(double duration, const std::function<Vector3d(double)>& pose) {
  JointTrajectory plan;
  plan.names = {"x", "y", "theta"};
  for (int k = 0; k * kPeriod < duration + kPeriod / 2; ++k) {
    plan.times.push_back(k * kPeriod);
    plan.positions.push_back(pose(k * kPeriod));
  }
  return plan;
}

JointTrajectory straight(double v, double duration) {
  return sampled(duration, [v](double t) { return Vector3d(v * t, 0, 0); });
}

/// On a circle with a speed that swells and fades: what an exact integrator follows exactly at any step.
JointTrajectory swelling_arc(double radius, double duration, double direction = 1) {
  return sampled(duration, [=](double t) {
    const double turn = 0.8 * (t - std::sin(2 * M_PI * t / duration) * duration / (2 * M_PI));
    return drive_arc({0.3, -0.2, 0.5}, {direction * radius, 0, direction}, turn);
  });
}

BaseTrackingOptions open_loop() {
  BaseTrackingOptions options;
  options.feedback = false;
  return options;
}

TEST(BaseTracking, WithoutDisturbanceArcsAreFollowedToRounding) {
  for (const double direction : {1.0, -1.0}) {
    const JointTrajectory plan = swelling_arc(1.3, 6, direction);
    for (const BaseTrackingOptions& options : {open_loop(), BaseTrackingOptions()}) {
      const BaseTrackingResult run = track_base(plan, BaseKind::diff_drive, fast(), options);
      EXPECT_EQ(run.times.size(), plan.times.size());
      EXPECT_EQ(run.commands.size() + 1, run.actual.size());
      EXPECT_GT((run.actual.back() - run.actual.front()).norm(), 1.0);
      EXPECT_LT(run.max_error(), 1e-11);
    }
  }
}

TEST(BaseTracking, CurvesOfChangingCurvatureAreFollowedToTheSquareOfThePeriod) {
  // Speed and turning rate linear in time (a clothoid); the reference comes from 2000 exact arcs a period.
  const auto error_at = [](double period) {
    JointTrajectory plan;
    plan.names = {"x", "y", "theta"};
    Vector3d pose = Vector3d::Zero();
    const int steps = static_cast<int>(std::lround(4 / period)), fine = 2000;
    for (int k = 0; k <= steps; ++k) {
      plan.times.push_back(k * period);
      plan.positions.push_back(pose);
      for (int i = 0; i < fine; ++i) {
        const double t = k * period + (i + 0.5) * period / fine;
        pose = drive_arc(pose, {0.2 + 0.1 * t, 0, 0.5 - 0.3 * t}, period / fine);
      }
    }
    BaseTrackingOptions options = open_loop();
    options.period = period;
    return track_base(plan, BaseKind::diff_drive, fast(), options).max_error();
  };
  const double coarse = error_at(0.1), finer = error_at(0.05);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_NEAR(coarse / finer, 4, 0.2);
}

TEST(BaseTracking, EqualSlipOpenLoopFallsBehindByItsShare) {
  BaseDisturbance slip;
  slip.slip_left = slip.slip_right = 0.07;
  const BaseTrackingResult run = track_base(straight(0.5, 8), BaseKind::diff_drive, fast(), open_loop(), slip);
  for (std::size_t k = 0; k < run.times.size(); ++k)
    ASSERT_NEAR(run.position_errors[k], 0.07 * 0.5 * run.times[k], 1e-12);
}

TEST(BaseTracking, UnequalSlipOpenLoopDrivesTheCircleOfItsWheels) {
  BaseDisturbance slip;
  slip.slip_left = 0.04;
  const double v = 0.5, w = v * 0.04 / 0.375, mean = v * (1 - 0.02);
  const BaseTrackingResult run = track_base(straight(v, 8), BaseKind::diff_drive, fast(), open_loop(), slip);
  for (std::size_t k = 0; k < run.times.size(); ++k) {
    const double t = run.times[k];
    ASSERT_NEAR(run.actual[k].x(), mean / w * std::sin(w * t), 1e-11);
    ASSERT_NEAR(run.actual[k].y(), mean / w * (1 - std::cos(w * t)), 1e-11);
    ASSERT_NEAR(run.heading_errors[k], -w * t, 1e-12);
  }
}

TEST(BaseTracking, ProportionalFeedbackLeavesTheLagOfItsGain) {
  // At rest (1 - s)(v + kp e) = v, hence e = s v / ((1 - s) kp); without feed-forward (1 - s) kp e = v.
  BaseDisturbance slip;
  slip.slip_left = slip.slip_right = 0.1;
  BaseTrackingOptions options;
  options.ki = options.kd = 0;
  const BaseTrackingResult run = track_base(straight(0.5, 20), BaseKind::diff_drive, fast(), options, slip);
  EXPECT_NEAR(run.final_error(), 0.1 * 0.5 / (0.9 * 2.0), 1e-10);
  options.feed_forward = false;
  const BaseTrackingResult printed = track_base(straight(0.5, 20), BaseKind::diff_drive, fast(), options, slip);
  EXPECT_NEAR(printed.final_error(), 0.5 / (0.9 * 2.0), 1e-10);
}

TEST(BaseTracking, AStartErrorAlongTheWayFollowsThePidRecursion) {
  // On a straight line P, base and error move along one axis: e' = -(kp e + ki I + kd slope), held for a period.
  BaseDisturbance late;
  late.start_error = {-0.2, 0, 0};
  const BaseTrackingOptions options;
  const BaseTrackingResult run = track_base(straight(0.5, 6), BaseKind::diff_drive, fast(), options, late);
  double e = 0.2, integral = 0, last = 0.2;
  for (std::size_t k = 0; k + 1 < run.times.size(); ++k) {
    ASSERT_NEAR(run.desired[k].x() - run.actual[k].x(), e, 1e-12);
    ASSERT_EQ(run.actual[k].y(), 0);
    integral += kPeriod * e;
    const double rate = 2.0 * e + 0.1 * integral + 0.3 * (e - last) / kPeriod;
    last = e;
    e -= kPeriod * rate;
  }
  EXPECT_LT(run.final_error(), 0.02);
}

TEST(BaseTracking, FeedbackKeepsTheErrorSmallWhereOpenLoopRunsAway) {
  BaseDisturbance disturbance;
  disturbance.slip_left = 0.05;
  disturbance.drift = {0, 0.01, 0.01};
  disturbance.travel_noise = 0.01;
  disturbance.position_noise = 0.002;
  disturbance.heading_noise = 0.002;
  const JointTrajectory plan = swelling_arc(2, 20);
  const auto open = track_base(plan, BaseKind::diff_drive, fast(), open_loop(), disturbance);
  const auto closed = track_base(plan, BaseKind::diff_drive, fast(), {}, disturbance);
  EXPECT_GT(open.max_error(), 1.0);
  EXPECT_LT(closed.max_error(), 0.1);
  EXPECT_LT(closed.mean_error(), open.mean_error() / 20);
}

TEST(BaseTracking, ReversingKeepsItsHeading) {
  // A point ahead of a base that drives backwards would turn it round.
  BaseDisturbance beside;
  beside.start_error = {0, 0.05, 0.2};
  const auto run = track_base(straight(-0.4, 12), BaseKind::diff_drive, fast(), {}, beside);
  EXPECT_LT(run.final_error(), 0.01);
  EXPECT_LT(std::abs(run.heading_errors.back()), 0.02);
}

TEST(BaseTracking, AnOmniBaseFollowsAllThree) {
  const JointTrajectory plan = sampled(8, [](double t) { return Vector3d(0.3 * t, 0.2 * std::sin(t), 3.0 + 0.4 * t); });
  BaseDisturbance late;
  late.start_error = {0.1, -0.1, 0.3};
  const auto run = track_base(plan, BaseKind::omni, fast(), {}, late);
  EXPECT_LT(run.final_error(), 0.01);
  EXPECT_LT(std::abs(run.heading_errors.back()), 0.02);
  late.slip_left = 0.1;
  EXPECT_THROW(track_base(plan, BaseKind::omni, fast(), {}, late), InvalidInput);
}

TEST(BaseTracking, CommandsKeepTheLimitsAndTheirCurvature) {
  BaseLimits limits = fast();
  limits.wheel_velocity = 0.6;
  BaseDisturbance far;
  far.start_error = {-0.8, 0.5, 0.4};
  const auto run = track_base(straight(0.4, 10), BaseKind::diff_drive, limits, {}, far);
  EXPECT_GT(run.limited, 10u);
  for (const Vector3d& command : run.commands) {
    EXPECT_LE(std::abs(command.x()) + std::abs(command.z()) * limits.wheel_separation / 2, 0.6 + 1e-12);
    EXPECT_EQ(command.y(), 0);
  }
  EXPECT_LT(run.final_error(), 0.05);
}

TEST(BaseTracking, TravelNoiseSpreadsAsItsClosedForm) {
  // Each wheel's travel after d metres deviates by n sqrt(d): the mean of both by n sqrt(d / 2), the heading by
  // n sqrt(2 d) / W. Over 2000 runs the deviation estimated lies within 6 % (4 of its own deviations).
  const double n = 0.004, v = 0.5, duration = 2;
  BaseDisturbance noise;
  noise.travel_noise = n;
  double along = 0, heading = 0;
  const int runs = 2000;
  for (int i = 0; i < runs; ++i) {
    noise.seed = static_cast<unsigned>(i);
    const auto run = track_base(straight(v, duration), BaseKind::diff_drive, fast(), open_loop(), noise);
    along += std::pow(run.actual.back().x() - v * duration, 2) / runs;
    heading += std::pow(run.heading_errors.back(), 2) / runs;
  }
  EXPECT_NEAR(std::sqrt(along) / (n * std::sqrt(v * duration / 2)), 1, 0.07);
  EXPECT_NEAR(std::sqrt(heading) / (n * std::sqrt(2 * v * duration) / 0.375), 1, 0.07);
}

TEST(BaseTracking, SameSeedSameRun) {
  BaseDisturbance noise;
  noise.travel_noise = 0.01;
  noise.position_noise = 0.005;
  const auto a = track_base(swelling_arc(1, 5), BaseKind::diff_drive, fast(), {}, noise);
  const auto b = track_base(swelling_arc(1, 5), BaseKind::diff_drive, fast(), {}, noise);
  EXPECT_EQ(a.position_errors, b.position_errors);
  noise.seed = 2;
  EXPECT_NE(a.position_errors, track_base(swelling_arc(1, 5), BaseKind::diff_drive, fast(), {}, noise).position_errors);
}

TEST(BaseTracking, BadInputIsRefusedByName) {
  const JointTrajectory plan = straight(0.5, 1);
  const auto refused = [&](const BaseTrackingOptions& options, const BaseDisturbance& disturbance,
                           const std::string& field) {
    try {
      track_base(plan, BaseKind::diff_drive, fast(), options, disturbance);
      ADD_FAILURE() << field << " accepted";
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-0.1, nan, double(INFINITY)}) {
    for (const auto& [member, field] :
         {std::pair(&BaseTrackingOptions::kp, "kp"), std::pair(&BaseTrackingOptions::ki, "ki"),
          std::pair(&BaseTrackingOptions::kd, "kd"), std::pair(&BaseTrackingOptions::offset, "offset"),
          std::pair(&BaseTrackingOptions::period, "period"), std::pair(&BaseTrackingOptions::settle, "settle")}) {
      BaseTrackingOptions options;
      options.*member = bad;
      refused(options, {}, field);
    }
    for (const auto& [member, field] :
         {std::pair(&BaseDisturbance::slip_left, "slip_left"), std::pair(&BaseDisturbance::slip_right, "slip_right"),
          std::pair(&BaseDisturbance::travel_noise, "travel_noise"),
          std::pair(&BaseDisturbance::position_noise, "position_noise"),
          std::pair(&BaseDisturbance::heading_noise, "heading_noise")}) {
      BaseDisturbance disturbance;
      disturbance.*member = bad;
      refused({}, disturbance, field);
    }
  }
  BaseDisturbance drift;
  drift.drift.y() = nan;
  refused({}, drift, "drift[1]");
  EXPECT_THROW(track_base(plan, BaseKind::fixed, fast()), InvalidInput);
  EXPECT_THROW(track_base({}, BaseKind::diff_drive, fast()), InvalidInput);
  JointTrajectory arm = plan;
  arm.names = {"x", "y", "elbow"};
  EXPECT_THROW(track_base(arm, BaseKind::diff_drive, fast()), InvalidInput);
  BaseTracker tracker(BaseKind::diff_drive, fast());
  EXPECT_THROW(tracker.command(Vector3d::Zero(), Vector3d::Zero(), {0, nan, 0}), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
