#include "mmgrasp/grasp/push_grasp.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2]

void check_positive(double value, const char* field) {
  require_positive(value, field);
}

void check_not_negative(double value, const char* field) {
  require_not_negative(value, field);
}

double closing_time(const PushGraspProblem& p) {
  return (p.opening - p.object_width) / p.closing_speed;
}

double along_error(const PushGraspProblem& p) {
  return std::max(p.along_error, p.sigmas * p.along_deviation);
}

double lateral_error(const PushGraspProblem& p) {
  return std::max(p.lateral_error, p.sigmas * p.lateral_deviation);
}

/// Engagement from which on closing may begin so that an object `aside` passes between the tips.
double passing_start(const PushGraspProblem& p, double aside) {
  const double spare = p.opening - p.object_width - 2 * (aside + p.clearance);
  return spare < 0 ? detail::kInfinity : -p.tool_speed * spare / p.closing_speed;
}

/// Engagement from which on closing may begin so that an object `aside` is held.
double holding_start(const PushGraspProblem& p, double aside) {
  return std::max(p.grip_depth - p.tool_speed * closing_time(p), passing_start(p, aside));
}

/// And up to which it may begin.
double latest_start(const PushGraspProblem& p) {
  return p.finger_length + p.max_push - p.tool_speed * closing_time(p);
}

/// Largest k for which errors of k standard deviations along and aside together are survived: each limit is linear in
/// k.
double covered_sigmas(const PushGraspProblem& p, double start) {
  const double along = p.along_deviation, aside = p.lateral_deviation;
  const double spare = p.opening - p.object_width - 2 * p.clearance, rate = p.tool_speed / p.closing_speed;
  double k = detail::kInfinity;
  const auto limit = [&](double room, double per_sigma) {
    if (room < 0) k = std::min(k, -1.0);
    if (per_sigma > 0) k = std::min(k, room / per_sigma);
  };
  limit(latest_start(p) - start, along);
  limit(start - (p.grip_depth - p.tool_speed * closing_time(p)), along);
  limit(start + rate * spare, along + 2 * rate * aside);
  limit(spare, 2 * aside);
  return k;
}

double normal_share(double lower, double upper, double deviation) {
  if (upper < lower) return 0;
  if (deviation == 0) return lower <= 0 && upper >= 0 ? 1 : 0;
  const double scale = 1 / (deviation * std::sqrt(2.0));
  return 0.5 * (std::erf(upper * scale) - std::erf(lower * scale));
}

double probability(const PushGraspProblem& p, double start) {
  const auto held = [&](double aside) {
    return normal_share(start - latest_start(p), start - holding_start(p, aside), p.along_deviation);
  };
  if (p.lateral_deviation == 0) return held(0);
  // Over one side by the midpoint rule, up to where nothing passes the tips any more.
  constexpr int kPieces = 2000;
  constexpr double kFar = 8;
  const double spare = (p.opening - p.object_width) / 2 - p.clearance;
  const double far = std::min(kFar * p.lateral_deviation, spare);
  if (far <= 0) return 0;
  double sum = 0;
  for (int i = 0; i < kPieces; ++i)
    sum +=
        held((i + 0.5) * far / kPieces) * normal_share(i * far / kPieces, (i + 1) * far / kPieces, p.lateral_deviation);
  return 2 * sum;
}

}  // namespace

void PushGraspProblem::check() const {
  check_positive(object_width, "object_width");
  require_number(opening, "opening");
  require(opening > object_width, "opening", opening, "must be finite and wider than object_width");
  check_positive(closing_speed, "closing_speed");
  check_positive(tool_speed, "tool_speed");
  check_positive(finger_length, "finger_length");
  require(grip_depth > 0 && grip_depth <= finger_length, "grip_depth", grip_depth, "must lie in (0, finger_length]");
  require(planned_depth >= grip_depth && planned_depth <= finger_length, "planned_depth", planned_depth,
          "must lie in [grip_depth, finger_length]");
  check_not_negative(clearance, "clearance");
  check_not_negative(max_push, "max_push");
  check_not_negative(along_error, "along_error");
  check_not_negative(lateral_error, "lateral_error");
  check_not_negative(along_deviation, "along_deviation");
  check_not_negative(lateral_deviation, "lateral_deviation");
  check_not_negative(sigmas, "sigmas");
}

PushGraspProblem push_grasp_problem(const Hand& hand, double object_width) {
  hand.check_fingers();
  PushGraspProblem problem;
  problem.opening = hand.max_opening;
  problem.object_width = object_width;
  problem.finger_length = hand.body.finger_length;
  problem.grip_depth = std::min(hand.finger_depth, hand.body.finger_length) / 2;
  problem.planned_depth = std::max(problem.grip_depth, hand.body.finger_length / 2);
  problem.clearance = hand.clearance;
  problem.check();
  return problem;
}

ClosingOutcome closing_outcome(const PushGraspProblem& problem, double start) {
  problem.check();
  require_number(start, "start");
  const PushGraspProblem& p = problem;
  ClosingOutcome out;
  out.start = start;
  out.both_touch = start + p.tool_speed * closing_time(p);
  out.pushed = std::max(0.0, out.both_touch - p.finger_length);
  out.swept = std::max(0.0, out.both_touch - p.planned_depth);
  // Closed already when the tips arrive: they meet the object's face.
  const double passing = std::min(p.opening, p.opening + p.closing_speed * start / p.tool_speed);
  out.side_clearance = (std::max(passing, 0.0) - p.object_width) / 2;
  out.lateral_tolerance = out.side_clearance - p.clearance;
  out.holds = out.lateral_tolerance >= 0 && out.both_touch >= p.grip_depth && out.pushed <= p.max_push;
  out.nearer_tolerance = p.finger_length + p.max_push - out.both_touch;
  out.farther_tolerance = std::min(out.both_touch - p.grip_depth, start - passing_start(p, lateral_error(p)));
  out.covered_sigmas = covered_sigmas(p, start);
  out.probability = probability(p, start);
  return out;
}

PushGrasp push_grasp(const PushGraspProblem& problem) {
  problem.check();
  const PushGraspProblem& p = problem;
  const double along = along_error(p), lateral = lateral_error(p);
  PushGrasp out;
  out.closing_time = closing_time(p);
  const double travel = p.tool_speed * out.closing_time;
  out.earliest = along + holding_start(p, lateral);
  out.latest = latest_start(p) - along;
  out.feasible = out.earliest <= out.latest;
  out.window = out.feasible ? (out.latest - out.earliest) / p.tool_speed : 0;

  const double room = p.finger_length + p.max_push - 2 * along;
  const double aside = lateral + p.clearance;
  if (room < p.grip_depth || 2 * aside > p.opening - p.object_width) {
    out.max_tool_speed = 0;
  } else {
    out.max_tool_speed = aside > 0 ? p.closing_speed * room / (2 * aside) : detail::kInfinity;
  }

  const double middle = (out.earliest + out.latest) / 2;
  // A later begin than the middle of the window where only then the object is inside whatever its error.
  const double inside = along <= out.latest ? std::max(middle, along) : middle;
  const double start = out.feasible ? inside : 0.0;
  out.push = closing_outcome(p, start);
  out.plain = closing_outcome(p, p.planned_depth - travel);
  return out;
}

double push_speed_limit(double length, double friction, double restitution) {
  check_positive(length, "length");
  check_positive(friction, "friction");
  require(restitution >= 0 && restitution <= 1, "restitution", restitution, "must lie in [0, 1]");
  return restitution == 0 ? detail::kInfinity : std::sqrt(2 * friction * kGravity * length) / restitution;
}

}  // namespace mmgrasp
