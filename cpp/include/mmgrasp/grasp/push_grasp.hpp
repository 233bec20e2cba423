#pragma once

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/hand.hpp"

namespace mmgrasp {

/// A parallel hand that takes an object while it moves on along the approach (P1 4.3, figure 4.7). Lengths
/// along the approach are engagements: how far the finger tips are beyond the object's near face, negative before they
/// reach it. The palm touches at `finger_length`; from there the object slides with it.
struct MMGRASP_EXPORT PushGraspProblem {
  double opening = 0.1;         ///< Between the fingers before they close [m]; > object_width.
  double closing_speed = 0.1;   ///< How fast the opening shrinks [m/s]; > 0 (P1 4.4.1).
  double tool_speed = 0.3;      ///< Along the approach [m/s]; > 0.
  double finger_length = 0.12;  ///< From the palm to the tips [m]; > 0.
  double object_width = 0.05;   ///< Along the closing direction [m]; > 0.
  double grip_depth = 0.02;     ///< Least engagement that holds [m]; in (0, finger_length].
  double planned_depth = 0.06;  ///< Engagement at the planned grasp pose [m]; in [grip_depth, finger_length].
  double clearance = 0.0;       ///< Kept between finger and object on either side while they pass [m]; >= 0.
  double max_push = 0.1;        ///< How far the object may slide before the palm [m]; >= 0.
  double along_error = 0.0;     ///< The object may stand this much nearer or farther [m]; >= 0.
  double lateral_error = 0.0;   ///< And this much to either side along the closing direction [m]; >= 0.
  /// What perception knows of the object's position: standard deviations along the approach and the closing direction
  /// [m]; >= 0. Errors of `sigmas` of them are covered as along_error and lateral_error are, whichever is larger.
  double along_deviation = 0.0;
  double lateral_deviation = 0.0;
  double sigmas = 3.0;  ///< >= 0.
  void check() const;   ///< Throws InvalidInput naming field, value and rule.
};

/// The push-grasp of an object this wide [m] by a hand that is wide open: opening, finger length and clearance are the
/// hand's, half a pad must engage, and planned is the middle of the fingers; speeds and errors keep their defaults.
/// Throws InvalidInput when the object is no narrower than the hand opens.
MMGRASP_EXPORT PushGraspProblem push_grasp_problem(const Hand& hand, double object_width);

/// What beginning to close at one moment leads to.
struct MMGRASP_EXPORT ClosingOutcome {
  double start = 0;              ///< Engagement at which closing begins [m].
  double both_touch = 0;         ///< The same when both fingers touch, were the object not pushed [m].
  double pushed = 0;             ///< How far the object slides before the palm until then [m].
  double swept = 0;              ///< How far the tool goes beyond the planned grasp pose until then [m].
  double side_clearance = 0;     ///< Free space on either side of a centred object as the tips pass it [m].
  bool holds = false;            ///< An object standing where planned is held, and pushed no farther than allowed.
  double lateral_tolerance = 0;  ///< An object standing where planned may lie this far off to a side [m]; < 0: none.
  double nearer_tolerance = 0;   ///< It may stand this much nearer, at the problem's lateral error [m]; < 0: none.
  double farther_tolerance = 0;  ///< And this much farther [m]; < 0: none.
  /// Errors of so many of the problem's standard deviations along and aside together are survived; infinite where these
  /// are 0, negative where nothing is held.
  double covered_sigmas = 0;
  /// How probable it is that the object is held as planned, its two errors normally distributed with these deviations
  /// and independent.
  double probability = 0;
};

/// The closing windows of a problem and both strategies of figure 4.7.
struct MMGRASP_EXPORT PushGrasp {
  double closing_time = 0;    ///< From `opening` to the object's width [s].
  double earliest = 0;        ///< Engagements between which closing may begin so that the object is held for every
  double latest = 0;          ///< error of the problem, its limits kept [m].
  bool feasible = false;      ///< earliest <= latest.
  double window = 0;          ///< The same as a time [s]; 0 when not feasible.
  double max_tool_speed = 0;  ///< Fastest tool for which the window is not empty [m/s]; 0: none, infinite: any.
  ClosingOutcome push;        ///< Closing begins in the middle of the window, or later once the object is surely
                              ///< inside; where there is no window, as the tips reach it.
  ClosingOutcome plain;       ///< Closing while moving so that both fingers touch at the planned pose.
};

/// Closed form. Throws InvalidInput for a problem out of range.
MMGRASP_EXPORT PushGrasp push_grasp(const PushGraspProblem& problem);

/// What beginning to close at an engagement [m] comes to.
MMGRASP_EXPORT ClosingOutcome closing_outcome(const PushGraspProblem& problem, double start);

/// Fastest tool [m/s] before whose palm an object does not leap more than `length` [m]: hit with restitution r it
/// leaves at (1 + r) v, slowed by friction mu g, and gets (r v)^2 / (2 mu g) ahead before the palm has it again
/// (P1 4.3: it must not detach). Infinite for r = 0. Throws InvalidInput unless length > 0, friction > 0, restitution
/// in [0, 1].
MMGRASP_EXPORT double push_speed_limit(double length, double friction, double restitution);

}  // namespace mmgrasp
