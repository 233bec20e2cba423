#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/verify/plan_check.hpp"

namespace mmgrasp::verify {

/// One robot of a schedule: its plan, and when it begins each piece of it. The pieces, in order: straight sections of
/// its drives, motions of its picks, and closings and openings of the hand by `closing_speed`, which take no time
/// before the first motion. Motions in passing are left out: a plan holds without them.
struct MMGRASP_EXPORT ScheduledPlan {
  PlanToCheck plan;
  std::vector<double> starts;          ///< One a piece [s], on the clock that all robots share.
  std::vector<double> durations = {};  ///< What is said about each piece [s]; empty: nothing is.
};

/// Checks that robots which carry out their plans on one clock, each piece when `starts` says and standing still in
/// between, before and after, never come closer to each other than `clearance` [m], less 1 mm. Robots are read, placed
/// and measured as check_plan() does it; stretches of time are halved until what moves in them cannot make up for the
/// distance in their middle. So the answer holds for every moment. The plans themselves are check_plan()'s business.
///
/// Fault codes: `robot-unreadable` and `malformed` as check_plan() has them, `schedule-pieces` (not one start a piece),
/// `piece-duration` (a piece takes another time than is said), `too-early` (a piece begins before time 0 or the end of
/// the one before), `robots-meet` (the first time of each two robots, with the two pieces and links), `stopped`. Throws
/// InvalidInput unless clearance is in [0.01, 10].
MMGRASP_EXPORT std::vector<Fault> check_schedule(const std::vector<ScheduledPlan>& robots, double clearance,
                                                 const Monitor& monitor = {});

}  // namespace mmgrasp::verify
