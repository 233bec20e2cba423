// Checks the drives between the stops.
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "verify/context.hpp"
#include "verify/motion/drive_profile.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr double kSamePose = 1e-6;     // Poses that differ by no more are the same [m, rad].
constexpr double kLimitSlack = 1e-5;   // [rad or m]; what limits and values printed to five digits lose
constexpr double kLargest = 1e6;       // No larger pose can be computed with [m, rad].
constexpr double kNearEnds = 1.0;      // Nearer to an end of a drive no clearance is asked for [m].
constexpr double kRounding = 1e-5;     // [m]; what distances of FCL lose
constexpr double kMaxSteps = 1000000;  // Base poses of one leg.

bool same_pose(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a - b).head<2>().norm() <= kSamePose && std::abs(wrap_angle(a.z() - b.z())) <= kSamePose;
}

/// Whether the base can get straight from one pose to the next; headings are taken as they stand, not modulo a turn.
bool driveable(BaseKind base, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d step = to - from;
  const double driven = step.head<2>().norm(), turned = std::abs(step.z());
  if (base == BaseKind::omni) return true;
  if (base == BaseKind::fixed) return driven <= kSamePose && turned <= kSamePose;
  if (driven <= kSamePose) return true;
  const double aside = std::abs(-std::sin(from.z()) * step.x() + std::cos(from.z()) * step.y());
  return turned <= kSamePose && aside <= kSamePose;
}

/// Length and turning must be the poses', the duration that of a base which rests at each of them.
bool values_hold(const CheckedLegValues& said, const std::vector<Eigen::Vector3d>& poses, BaseKind base,
                 const BaseLimits& limits) {
  double length = 0, turning = 0, duration = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length += (poses[i] - poses[i - 1]).head<2>().norm();
    turning += std::abs(poses[i].z() - poses[i - 1].z());
    duration += DriveProfile(poses[i - 1], poses[i], base, limits).duration();
  }
  const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-6 * (1 + b); };  // false for NaN
  return same(said.length, length) && same(said.turning, turning) && same(said.duration, duration);
}

/// Checks every leg of the route: its ends, whether the base can drive it, collisions, and what is said about it.
class RouteCheck {
 public:
  RouteCheck(const Context& context, Judge& judge, Faults& faults)
      : context_(context), plan_(context.plan), judge_(judge), faults_(faults) {}

  void run() {
    const std::size_t legs = plan_.stops.size() + 1;
    if (plan_.route.size() != legs) {
      faults_.push_back({"route-legs", "route",
                         "has " + std::to_string(plan_.route.size()) + " legs, " + std::to_string(plan_.stops.size()) +
                             " stops need " + std::to_string(legs)});
    }
    if (!plan_.leg_values.empty() && plan_.leg_values.size() != plan_.route.size()) {
      faults_.push_back({"route-values", "route", "length, turning and duration must be given for each leg"});
    }
    check_capacity();
    for (const CheckedUnloading& unloading : plan_.unloadings) check_unloading(unloading);
    for (std::size_t leg = 0; leg < plan_.route.size(); ++leg) {
      context_.monitor.report("route", static_cast<double>(leg) / static_cast<double>(plan_.route.size()));
      if (context_.monitor.stopped()) return;
      check_leg(leg);
    }
  }

 private:
  static std::string name(std::size_t leg) { return "route leg " + std::to_string(leg); }

  /// "capacity": never more parts in the bin than it takes, one in a hand that carries them to the goal; "unloading":
  /// at picks in order, not after the last one.
  void check_capacity() {
    int emptied = -1;  // the pick after which it was emptied last
    const int last = static_cast<int>(plan_.picks.size()) - 1;
    const int capacity = plan_.unload_region ? 1 : plan_.capacity;
    const auto count = [&](int up_to, const std::string& where) {
      if (capacity <= 0 || up_to - emptied <= capacity) return;
      faults_.push_back({"capacity", where,
                         std::to_string(up_to - emptied) + " parts are in the " +
                             (plan_.unload_region ? "hand" : "bin") + ", which takes " + std::to_string(capacity)});
    };
    for (const CheckedUnloading& unloading : plan_.unloadings) {
      if (unloading.after_pick <= emptied || unloading.after_pick >= last) {
        faults_.push_back({"unloading", "unloading after pick " + std::to_string(unloading.after_pick),
                           "must come after a pick later than the one before, and before the last"});
        return;
      }
      count(unloading.after_pick, "unloading after pick " + std::to_string(unloading.after_pick));
      emptied = unloading.after_pick;
    }
    count(last, "goal");
  }

  /// To the goal, and back where the next pick is at the same stop.
  void check_unloading(const CheckedUnloading& unloading) {
    const int pick = unloading.after_pick;
    if (pick < 0 || pick + 1 >= static_cast<int>(plan_.picks.size())) return;  // said already
    const int stop = plan_.picks[pick].stop;
    if (stop < 0 || stop >= static_cast<int>(plan_.stops.size())) return;
    const std::string where = "unloading after pick " + std::to_string(pick);
    for (std::size_t part = 0; part < plan_.parts.size(); ++part) {
      const int by = context_.picked_by[part];
      judge_.set_present(context_.body_of_part(static_cast<int>(part)), by < 0 || by > pick);
    }
    hold_part_of(pick);
    check_drive(unloading.to_goal, plan_.stops[stop].pose, plan_.goal, &unloading.to_goal_values,
                where + ", to the goal");
    let_go();
    const bool returns = plan_.picks[pick + 1].stop == stop;
    if (returns) {
      check_drive(unloading.back, plan_.goal, plan_.stops[stop].pose, &unloading.back_values, where + ", back");
    } else if (!unloading.back.empty()) {
      faults_.push_back({"unloading", where, "drives back to a stop at which nothing is left to pick"});
    }
  }

  /// Where the base leaves a stop for the next: from the stop, or from the goal where the bin was emptied last.
  Eigen::Vector3d left_from(std::size_t stop) const {
    for (const CheckedUnloading& unloading : plan_.unloadings) {
      const int pick = unloading.after_pick;
      if (pick < 0 || pick + 1 >= static_cast<int>(plan_.picks.size())) continue;
      const bool last_here = plan_.picks[pick + 1].stop != plan_.picks[pick].stop;
      if (last_here && plan_.picks[pick].stop == static_cast<int>(stop)) return plan_.goal;
    }
    return stop_pose(stop);
  }

  void check_leg(std::size_t leg) {
    const Eigen::Vector3d from = leg == 0 ? plan_.start : left_from(leg - 1);
    const Eigen::Vector3d to = leg + 1 >= plan_.route.size() ? plan_.goal : stop_pose(leg);
    set_parts_on_leg(leg);
    hold_part_of(held_on_leg(leg));
    check_drive(plan_.route[leg], from, to, leg < plan_.leg_values.size() ? &plan_.leg_values[leg] : nullptr,
                name(leg));
    let_go();
  }

  /// The last pick at the stops before this leg, where its part was not brought to the goal on a drive of its own; -1:
  /// none.
  int held_on_leg(std::size_t leg) const {
    int last = -1;
    for (int pick = 0; pick < static_cast<int>(plan_.picks.size()); ++pick) {
      if (plan_.picks[pick].stop < static_cast<int>(leg)) last = pick;
    }
    const bool unloaded = std::any_of(plan_.unloadings.begin(), plan_.unloadings.end(),
                                      [&](const CheckedUnloading& unloading) { return unloading.after_pick >= last; });
    return unloaded ? -1 : last;
  }

  /// The part of a pick rides in the hand as its grasp says, where the robot has no bin for it.
  void hold_part_of(int pick) {
    if (!plan_.unload_region || pick < 0) return;
    const int part = context_.pick_part[pick], grasp = plan_.picks[pick].grasp;
    if (part < 0 || grasp < 0 || grasp >= static_cast<int>(plan_.parts[part].grasps.size())) return;  // said already
    const CheckedGrasp& held = plan_.parts[part].grasps[grasp];
    judge_.hold(context_.body_of_part(part), held.T_object_hand.inverse());
    opening_ = held.opening;
  }

  void let_go() {
    judge_.drop();
    opening_ = 0;
  }

  /// One drive, with the parts in the scene that are there; `values`: what is said about it, or nothing.
  void check_drive(const std::vector<Eigen::Vector3d>& poses, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                   const CheckedLegValues* values, const std::string& where) {
    const bool finite = std::all_of(poses.begin(), poses.end(), [](const Eigen::Vector3d& p) {
      return p.allFinite() && p.cwiseAbs().maxCoeff() <= kLargest;
    });
    if (poses.empty() || !finite) {
      faults_.push_back({"route-ends", where, "must hold at least one pose, all finite and at most 1e6"});
      return;
    }
    check_end(poses.front(), from, where, "starts");
    check_end(poses.back(), to, where, "ends");
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
      if (driveable(plan_.robot.base, poses[i], poses[i + 1])) continue;
      faults_.push_back({"route-not-driveable", where + ", step " + std::to_string(i),
                         std::string("a ") + to_string(plan_.robot.base) + " base cannot go straight from " +
                             text(poses[i]) + " to " + text(poses[i + 1])});
      break;
    }
    if (values != nullptr && !values_hold(*values, poses, plan_.robot.base, plan_.robot.base_limits)) {
      faults_.push_back(
          {"route-values", where, "length, turning or duration are not those of its poses at the limits of the base"});
    }
    for (const Eigen::Vector3d& pose : poses) {
      if (!check_workspace(plan_, pose, 0, where, faults_)) break;
    }
    check_free(poses, where);
  }

  Eigen::Vector3d stop_pose(std::size_t stop) const {
    return stop < plan_.stops.size() ? plan_.stops[stop].pose : plan_.goal;
  }

  void check_end(const Eigen::Vector3d& pose, const Eigen::Vector3d& wanted, const std::string& where,
                 const char* verb) {
    if (same_pose(pose, wanted)) return;
    faults_.push_back({"route-ends", where, std::string(verb) + " at " + text(pose) + ", must be " + text(wanted)});
  }

  /// Parts picked at the stops before this leg are gone.
  void set_parts_on_leg(std::size_t leg) {
    for (std::size_t part = 0; part < plan_.parts.size(); ++part) {
      const int by = context_.picked_by[part];
      const bool removed = by >= 0 && plan_.picks[by].stop < static_cast<int>(leg);
      judge_.set_present(context_.body_of_part(static_cast<int>(part)), !removed);
    }
  }

  void check_free(const std::vector<Eigen::Vector3d>& poses, const std::string& where) {
    double taken = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Eigen::Vector3d step = i ? Eigen::Vector3d(poses[i] - poses[i - 1]) : Eigen::Vector3d::Zero();
      const double travel = std::max(step.head<2>().norm(), 0.5 * std::abs(step.z()));
      const double steps = std::max(1.0, std::ceil(travel / context_.options.base_step));
      taken += steps;
      if (!(taken <= kMaxSteps)) {
        faults_.push_back({"too-long", where, "is longer than can be checked"});
        return;
      }
      for (int k = 1; k <= static_cast<int>(steps); ++k) {
        const Eigen::Vector3d pose = poses[i] - step * (1 - k / steps);
        judge_.set_base(pose);
        const std::string at = where + ", base at " + text(pose);
        if (const Touch touch = judge_.touch(plan_.home, opening_)) {
          faults_.push_back({"route-collision", at, "'" + touch.a + "' touches '" + touch.b + "'"});
          return;
        }
        const bool passes =
            (pose - poses.front()).head<2>().norm() > kNearEnds && (pose - poses.back()).head<2>().norm() > kNearEnds;
        if (passes && !keeps_clearance(at)) return;
      }
    }
  }

  bool keeps_clearance(const std::string& where) {
    if (plan_.drive_clearance <= kRounding) return true;
    const Touch near = judge_.comes_near(plan_.home, opening_, plan_.drive_clearance - kRounding);
    if (!near) return true;
    faults_.push_back({"route-clearance", where,
                       "'" + near.a + "' comes closer to '" + near.b + "' than the " + text(plan_.drive_clearance) +
                           " m of drive_clearance"});
    return false;
  }

  const Context& context_;
  const PlanToCheck& plan_;
  Judge& judge_;
  Faults& faults_;
  double opening_ = 0;  ///< The fingers' on the drive [m]: the grasp's while they hold a part.
};

/// The configuration in which the robot drives, where it stands first.
void check_home(const Context& context, Judge& judge, Faults& faults) {
  const Kinematics& kinematics = judge.kinematics();
  for (int j = 0; j < kinematics.arm_size(); ++j) {
    const double q = context.plan.home[j];
    if (q >= kinematics.lower()[j] - kLimitSlack && q <= kinematics.upper()[j] + kLimitSlack) continue;
    faults.push_back({"home-limit", "home",
                      "'" + context.plan.arm_joints[j] + "' at " + text(q) + " is outside [" +
                          text(kinematics.lower()[j]) + ", " + text(kinematics.upper()[j]) + "]"});
  }
  check_workspace(context.plan, context.plan.start, 0, "start", faults);
  check_workspace(context.plan, context.plan.goal, 0, "goal", faults);
  for (std::size_t i = 0; i < context.plan.stops.size(); ++i) {
    check_workspace(context.plan, context.plan.stops[i].pose, context.plan.positioning_uncertainty,
                    "stop " + std::to_string(i), faults);
  }
  judge.set_base(context.plan.start);
  const Touch touch = judge.touch(context.plan.home, 0);
  if (!touch) return;
  const bool self = touch.kind == TouchKind::self;
  faults.push_back({self ? "home-collision" : "start-collision", self ? "home" : "start " + text(context.plan.start),
                    "'" + touch.a + "' touches '" + touch.b + "'"});
}

}  // namespace

bool check_workspace(const PlanToCheck& plan, const Eigen::Vector3d& pose, double radius, const std::string& where,
                     Faults& faults) {
  const double farthest = pose.head<2>().cwiseAbs().maxCoeff() + radius, most = plan.robot.base_limits.workspace;
  if (farthest <= most + kSamePose) return true;
  faults.push_back({"base-workspace", where,
                    "the base at " + text(pose) + (radius > 0 ? ", off by up to " + text(radius) + " m," : "") +
                        " leaves its workspace of " + text(most) + " m"});
  return false;
}

void check_route(const Context& context, Faults& faults, std::size_t& configurations) {
  Judge judge(context.stage);
  check_home(context, judge, faults);
  RouteCheck(context, judge, faults).run();
  configurations += judge.queries();
}

}  // namespace mmgrasp::verify::detail
