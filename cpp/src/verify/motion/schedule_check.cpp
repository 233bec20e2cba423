#include "mmgrasp/verify/schedule_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "verify/context.hpp"
#include "verify/motion/course.hpp"

namespace mmgrasp::verify {
namespace {

using namespace detail;

constexpr double kTolerance = 1e-3;  // How much closer than the clearance robots may come [m].
constexpr double kStretch = 1.0;     // Longest stretch of time that is looked at in one [s].
constexpr double kTimeSlack = 1e-6;  // [s]; what numbers printed with fewer digits lose

/// What a plan says of the robot, without the room; null, with faults, where it cannot be used.
std::shared_ptr<const Stage> stage_of(const PlanToCheck& plan, Faults& faults) {
  try {
    const auto robot = std::make_shared<RobotModel>(read_robot(plan.robot));
    ArmSetup setup;
    std::vector<int> finger_links;
    Faults of_the_plan;  // those that a robot can be placed in spite of are check_plan()'s business
    if (!check_structure(plan, *robot, of_the_plan, setup, finger_links)) {
      for (const Fault& fault : of_the_plan)
        if (fault.code == "malformed") faults.push_back(fault);
      return nullptr;
    }
    return std::make_shared<Stage>(make_stage(robot, setup, finger_links, {}));
  } catch (const Error& error) {
    faults.push_back({"robot-unreadable", "robot", error.what()});
    return nullptr;
  }
}

/// Motions must have what a robot can be placed by.
bool check_motions(const PlanToCheck& plan, Faults& faults) {
  for (const CheckedPick& pick : plan.picks) {
    for (const CheckedMotion& motion : pick.motions) {
      const std::size_t count = motion.times.size();
      bool good = count > 0 && motion.positions.size() == count && motion.velocities.size() == count;
      for (std::size_t i = 0; good && i < count; ++i) {
        good = motion.positions[i].size() == static_cast<Eigen::Index>(plan.arm_joints.size()) &&
               motion.velocities[i].size() == motion.positions[i].size() && motion.positions[i].allFinite() &&
               motion.velocities[i].allFinite() &&
               (i == 0 ? motion.times[0] == 0 : motion.times[i] > motion.times[i - 1]);
      }
      if (good) continue;
      faults.push_back({"malformed", motion.kind + " " + pick.part, "needs samples in order, one value a joint"});
      return false;
    }
  }
  return true;
}

/// One start a piece, none before the piece before has ended, and durations as they are.
bool check_starts(const std::vector<CoursePiece>& pieces, const ScheduledPlan& scheduled, const std::string& robot,
                  Faults& faults) {
  const std::vector<double>&starts = scheduled.starts, &durations = scheduled.durations;
  const bool fits = pieces.size() == starts.size() && (durations.empty() || durations.size() == pieces.size());
  if (pieces.empty() || !fits) {
    faults.push_back({"schedule-pieces", robot,
                      "has " + std::to_string(starts.size()) + " starts, its plan has " +
                          std::to_string(pieces.size()) + " pieces"});
    return false;
  }
  double ready = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!durations.empty() && !(std::abs(durations[i] - pieces[i].duration) <= kTimeSlack)) {
      faults.push_back({"piece-duration", robot + ", '" + pieces[i].name + "'",
                        "is said to take " + text(durations[i]) + " s, it takes " + text(pieces[i].duration) + " s"});
    }
    if (!(starts[i] >= ready - kTimeSlack) || !(starts[i] < 1e9)) {
      faults.push_back({"too-early", robot + ", '" + pieces[i].name + "'",
                        "begins at " + text(starts[i]) + " s, the robot is ready at " + text(ready) + " s"});
      return false;
    }
    ready = starts[i] + pieces[i].duration;
  }
  return true;
}

/// Halves stretches of time until each is proven, or the two are found too close in the middle of one.
class MeetingSearch {
 public:
  MeetingSearch(MovingRobot& a, MovingRobot& b, double clearance) : a_(a), b_(b), clearance_(clearance) {}

  /// The first time at which they are too close.
  std::optional<double> first(double begin, double end) {
    mmgrasp::detail::throw_if_interrupted();
    const double middle = 0.5 * (begin + end);
    const double moved = std::max(travel(begin, middle), travel(middle, end));
    a_.place(middle);
    b_.place(middle);
    bodies_ = a_.closer_than(clearance_ - kTolerance + moved, b_);
    if (bodies_.empty()) return std::nullopt;
    if (moved <= 0.5 * kTolerance || end - begin < 1e-9) return middle;
    if (const auto found = first(begin, middle)) return found;
    return first(middle, end);
  }
  const std::string& bodies() const { return bodies_; }

 private:
  double travel(double from, double to) const { return a_.travel(from, to) + b_.travel(from, to); }

  MovingRobot &a_, &b_;
  double clearance_;
  std::string bodies_;
};

/// Times at which a robot begins or ends a piece, between which what it holds does not change; few far apart.
std::vector<double> times_to_part_at(const MovingRobot& a, const MovingRobot& b) {
  std::vector<double> times = a.changes();
  const std::vector<double> others = b.changes();
  times.insert(times.end(), others.begin(), others.end());
  times.push_back(0);
  times.push_back(std::max(a.end(), b.end()) + kStretch);  // both stand at their goals from then on
  std::sort(times.begin(), times.end());
  std::vector<double> out{times.front()};
  for (const double time : times) {
    const double from = out.back();
    const int pieces = static_cast<int>(std::ceil((time - from) / kStretch));
    for (int k = 1; k <= pieces; ++k) out.push_back(k == pieces ? time : from + (time - from) * k / pieces);
  }
  return out;
}

void check_pair(MovingRobot& a, MovingRobot& b, const std::string& names, double clearance, const Monitor& monitor,
                Faults& faults) {
  MeetingSearch search(a, b, clearance);
  const std::vector<double> times = times_to_part_at(a, b);
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    monitor.report(names, static_cast<double>(i) / static_cast<double>(times.size()));
    const auto met = search.first(times[i], times[i + 1]);
    if (!met) continue;
    faults.push_back({"robots-meet", names + ", t = " + text(*met) + " s",
                      search.bodies() + " is closer than " + text(clearance) + " m: the first is at " + a.doing(*met) +
                          ", the second at " + b.doing(*met)});
    return;
  }
}

void check_all(const std::vector<ScheduledPlan>& robots, double clearance, const Monitor& monitor, Faults& faults) {
  std::vector<MovingRobot> moving;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const std::string name = "robot " + std::to_string(i + 1);
    monitor.report("reading the robots", static_cast<double>(i) / static_cast<double>(robots.size()));
    const std::shared_ptr<const Stage> stage = stage_of(robots[i].plan, faults);
    if (!stage || !check_motions(robots[i].plan, faults)) return;
    std::vector<CoursePiece> pieces = course_of(robots[i].plan, *stage);
    if (!check_starts(pieces, robots[i], name, faults)) return;
    moving.emplace_back(stage, robots[i].plan, std::move(pieces), robots[i].starts);
  }
  for (std::size_t i = 0; i < moving.size(); ++i) {
    for (std::size_t k = i + 1; k < moving.size(); ++k)
      check_pair(moving[i], moving[k], "robots " + std::to_string(i + 1) + " and " + std::to_string(k + 1), clearance,
                 monitor, faults);
  }
}

}  // namespace

std::vector<Fault> check_schedule(const std::vector<ScheduledPlan>& robots, double clearance, const Monitor& monitor) {
  require(clearance >= 0.01 && clearance <= 10, "clearance", clearance, "must be in [0.01, 10] [m]");
  for (std::size_t i = 0; i < robots.size(); ++i) {
    require(!robots[i].plan.unload_region.has_value(), "plans[" + std::to_string(i) + "].unload_region", "given",
            "must be none: robots that carry parts in the hand are not judged");
  }
  Faults faults;
  const mmgrasp::detail::InterruptionScope scope(monitor.stop);
  try {
    check_all(robots, clearance, monitor, faults);
  } catch (const mmgrasp::detail::Interrupted&) {  // said below
  }
  if (monitor.stopped()) faults.push_back({"stopped", "check", "was ended before everything was checked"});
  return faults;
}

}  // namespace mmgrasp::verify
