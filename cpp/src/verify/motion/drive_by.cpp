// Checks the motions in passing: base and arm together, grasp and closing.
#include <algorithm>
#include <cmath>
#include <set>

#include "mmgrasp/core/parallel.hpp"
#include "verify/context.hpp"
#include "verify/motion/base_course.hpp"
#include "verify/motion/hand_check.hpp"
#include "verify/motion/hermite.hpp"
#include "verify/motion/motion_checks.hpp"
#include "verify/motion/motion_limits.hpp"
#include "verify/motion/tool_path.hpp"

namespace mmgrasp::verify::detail {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kStill = 2e-3;      // The tool may move so far while the fingers close [m],
constexpr double kStillTurn = 0.02;  // and turn so far [rad].

/// The columns of the arm alone.
CheckedMotion arm_of(const CheckedMotion& motion) {
  CheckedMotion arm = motion;
  for (auto* rows : {&arm.positions, &arm.velocities, &arm.accelerations})
    for (VectorXd& row : *rows) row = VectorXd(row.tail(row.size() - 3));
  return arm;
}

/// One motion through a grasp.
class DriveByCheck {
 public:
  DriveByCheck(const Context& context, std::size_t index, Judge& judge, Faults& faults)
      : context_(context),
        plan_(context.plan),
        drive_by_(plan_.drive_by[index]),
        motion_(drive_by_.motion),
        judge_(judge),
        hand_(context, judge, faults),
        faults_(faults) {}

  void run() {
    const CheckedPick& pick = plan_.picks[drive_by_.pick];
    where_ = context_.pick_name(drive_by_.pick) + ", drive-by";
    if (!check_motion_shape(motion_, 3 + judge_.kinematics().arm_size(), where_, faults_)) return;
    for (const VectorXd& row : motion_.accelerations)
      if (row.size() != motion_.positions.front().size()) return fault("motion-shape", "accelerations are too few");
    part_ = &plan_.parts[context_.pick_part[drive_by_.pick]];
    width_ = part_->grasps[pick.grasp].opening;
    T_world_grasp_ = part_->body.T_world_body * part_->grasps[pick.grasp].T_object_hand;
    check_motion_limits(context_, judge_.kinematics(), arm_of(motion_), where_, faults_);
    check_base_course(plan_, motion_, where_, faults_);
    check_ends(pick);
    if (check_closing()) walk();
  }

 private:
  void fault(const char* code, const std::string& message) { faults_.push_back({code, where_, message}); }
  static Vector3d base(const VectorXd& q) { return q.head<3>(); }
  static VectorXd arm(const VectorXd& q) { return q.tail(q.size() - 3); }

  /// Where the base stands before the motion: where the pick before was, or where the leg to the stop begins.
  Vector3d base_before(const CheckedPick& pick) const {
    if (drive_by_.from_release) return plan_.stops[plan_.picks[drive_by_.pick - 1].stop].pose;
    return pick.stop == 0 ? plan_.start : plan_.stops[pick.stop - 1].pose;
  }

  void check_ends(const CheckedPick& pick) {
    const VectorXd &first = motion_.positions.front(), &last = motion_.positions.back();
    const std::size_t stop = pick.stop;
    const auto stands = [this](const VectorXd& q, const Vector3d& wanted, const char* verb) {
      const bool there =
          (base(q) - wanted).head<2>().norm() <= kMaxStep && std::abs(wrap_angle(q[2] - wanted.z())) <= kMaxStep;
      if (!there) fault("route-ends", std::string(verb) + " at " + text(base(q)) + ", must be " + text(wanted));
    };
    stands(first, base_before(pick), "starts");
    stands(last, plan_.stops[stop].pose, "ends");
    const CheckedPick& before = drive_by_.from_release ? plan_.picks[drive_by_.pick - 1] : pick;
    if (pick.motions.size() < 4 || before.motions.size() < 4) return;  // said at the pick
    const auto joins = [this](const VectorXd& q, const CheckedMotion& other, const VectorXd& wanted) {
      if (wanted.size() == q.size() - 3)  // else said at the pick
        check_join(arm(q), wanted, where_, "does not meet '" + other.kind + "'", faults_);
    };
    const CheckedMotion &begin = before.motions[drive_by_.from_release ? 3 : 0], &transfer = pick.motions[3];
    if (!begin.positions.empty())
      joins(first, begin, drive_by_.from_release ? begin.positions.back() : begin.positions.front());
    if (!transfer.positions.empty())
      joins(last, transfer, drive_by_.to_release ? transfer.positions.back() : transfer.positions.front());
    check_rest(motion_.velocities.front(), where_, "start", faults_);
    check_rest(motion_.velocities.back(), where_, "end", faults_);
  }

  bool check_closing() {
    const double opening = motion_.opening;
    if (!(opening >= width_ && opening <= plan_.max_opening + 1e-6)) {
      fault("opening", text(opening) + " m is outside [" + text(width_) + ", " + text(plan_.max_opening) + "]");
      return false;
    }
    if (opening < context_.pregrasp_opening(width_) - 1e-6)
      fault("opening", text(opening) + " m leaves less than the clearance of " + text(plan_.clearance) +
                           " m on each side of a part of width " + text(width_) + " m");
    const double needed = (opening - width_) / plan_.closing_speed, taken = drive_by_.closed_at - drive_by_.close_at;
    const bool inside = drive_by_.close_at >= motion_.times.front() && drive_by_.closed_at < motion_.times.back();
    if (inside && taken >= needed - 1e-6) return true;
    fault("closing-time", "the fingers close from " + text(drive_by_.close_at) + " to " + text(drive_by_.closed_at) +
                              " s: must lie inside the motion and take at least " + text(needed) + " s");
    return false;
  }

  /// Opening of the fingers at a time.
  double opening(double t) const {
    const double share = (t - drive_by_.close_at) / (drive_by_.closed_at - drive_by_.close_at);
    return motion_.opening + std::clamp(share, 0.0, 1.0) * (width_ - motion_.opening);
  }

  void walk() {
    const std::size_t pick = drive_by_.pick;
    judge_.drop();
    context_.set_parts_before(judge_, pick);
    judge_.set_base(base(motion_.positions.front()));
    hand_.check_fingers(arm(motion_.positions.front()), 0, motion_.opening, where_ + ", fingers opening");
    StepBudget budget;
    for (std::size_t i = 0; i + 1 < motion_.times.size(); ++i) {
      const HermiteSegment segment(motion_, i);
      // The moments of closing are checked as they stand.
      std::vector<double> shares{0, 1};
      for (const double t : {drive_by_.close_at, drive_by_.closed_at}) {
        const double s = (t - motion_.times[i]) / segment.duration();
        if (s > 0 && s < 1) shares.insert(shares.end() - 1, s);
      }
      const double steps = std::max(1.0, std::ceil(steps_of(segment)));
      if (!budget.spend(steps, where_, faults_)) return;
      for (int k = 1; k < static_cast<int>(steps); ++k) shares.push_back(k / steps);
      std::sort(shares.begin(), shares.end());
      for (const double s : shares)
        if ((i == 0 || s > 0) && !good_at(segment.at(s), motion_.times[i] + s * segment.duration())) return;
    }
    if (drive_by_.to_release) {
      const Pose T_world_released = judge_.tip(arm(motion_.positions.back())) * T_tip_part_;
      check_release(context_, *part_, judge_.T_world_root(), T_world_released, where_, faults_);
    }
  }

  double steps_of(const HermiteSegment& segment) const {
    double steps =
        std::max({segment.travel(0), segment.travel(1), 0.5 * segment.travel(2)}) / context_.options.base_step;
    for (int j = 3; j < motion_.positions.front().size(); ++j)
      steps = std::max(steps, segment.travel(j) / context_.options.joint_step);
    return steps;
  }

  bool good_at(const VectorXd& q, double t) {
    const std::string where = where_ + ", t = " + text(t) + " s";
    judge_.set_base(base(q));
    if (t >= drive_by_.close_at && !held_) {
      const Pose T_world_tip = judge_.tip(arm(q));
      // While they close the part stands where it stood; fingers may touch it from now on.
      const std::size_t body = context_.body_of_part(static_cast<int>(part_ - plan_.parts.data()));
      T_tip_part_ = T_world_tip.inverse() * part_->body.T_world_body;
      judge_.hold(body, T_tip_part_);
      if (!closing_) check_grasp_reached(context_, T_world_grasp_, T_world_tip, where, faults_);
      closing_ = true;
      if (!still_at(T_world_tip, where)) return false;
      if (t >= drive_by_.closed_at) {
        held_ = true;
        hand_.check_grip(arm(q), width_, where);
        if (!part_->scanned) hand_.check_room(arm(q), width_, kStill, where);
      }
    }
    return !hand_.collides(arm(q), opening(t), where);
  }

  bool still_at(const Pose& T_world_tip, const std::string& where) {
    const double moved = (T_world_tip.translation() - T_world_grasp_.translation()).norm();
    const double turned = rotation_distance(T_world_tip, T_world_grasp_);
    if (moved <= kStill && turned <= kStillTurn) return true;
    faults_.push_back({"grasp-missed", where,
                       "the tool is " + text(moved) + " m and " + text(turned) +
                           " rad from the grasp while the fingers close, allowed are " + text(kStill) + " m and " +
                           text(kStillTurn) + " rad"});
    return false;
  }

  const Context& context_;
  const PlanToCheck& plan_;
  const CheckedDriveBy& drive_by_;
  const CheckedMotion& motion_;
  Judge& judge_;
  HandCheck hand_;
  Faults& faults_;
  std::string where_;
  const CheckedPart* part_ = nullptr;
  double width_ = 0;
  Pose T_world_grasp_ = Pose::Identity(), T_tip_part_ = Pose::Identity();
  bool closing_ = false, held_ = false;
};

/// Those that name a pick that can be done so, once; faults for the others.
std::vector<std::size_t> known_picks(const Context& context, Faults& faults) {
  const PlanToCheck& plan = context.plan;
  std::vector<std::size_t> known;
  std::set<int> seen;
  for (std::size_t i = 0; i < plan.drive_by.size(); ++i) {
    const int pick = plan.drive_by[i].pick;
    std::string wrong;
    if (pick < 0 || pick >= static_cast<int>(plan.picks.size())) {
      wrong = "there is no pick " + std::to_string(pick);
    } else {
      const CheckedPick& p = plan.picks[pick];
      const int part = context.pick_part[pick];
      const bool resolved = part >= 0 && p.stop >= 0 && p.stop < static_cast<int>(plan.stops.size()) && p.grasp >= 0 &&
                            p.grasp < static_cast<int>(plan.parts[part].grasps.size());
      if (!resolved) continue;  // said at the pick
      if (!seen.insert(pick).second) wrong = "pick " + std::to_string(pick) + " is done in passing twice";
      const int stop_before = pick > 0 ? plan.picks[pick - 1].stop : -1;
      if (!plan.drive_by[i].from_release && stop_before == p.stop)
        wrong = "pick " + std::to_string(pick) + " is not the first of its stop, and the motion begins at home";
      if (plan.drive_by[i].from_release && (stop_before < 0 || stop_before >= static_cast<int>(plan.stops.size())))
        wrong = "no pick is before pick " + std::to_string(pick);
    }
    if (wrong.empty())
      known.push_back(i);
    else
      faults.push_back({"drive-by-pick", "drive-by " + std::to_string(i), wrong});
  }
  return known;
}

}  // namespace

void check_drive_by(const Context& context, Faults& faults, std::size_t& configurations) {
  const std::vector<std::size_t> known = known_picks(context, faults);
  if (!known.empty() && context.plan.drive_clearance > 0)
    faults.push_back({"route-clearance", "drive-by", "motions in passing do not keep drive_clearance"});
  std::vector<Judge> judges(resolve_threads(context.options.threads), Judge(context.stage));
  std::vector<Faults> found(known.size());
  parallel_for(
      known.size(), context.options.threads,
      [&](std::size_t i, int worker) { DriveByCheck(context, known[i], judges[worker], found[i]).run(); },
      context.monitor, "drive-by");
  for (const Faults& some : found) faults.insert(faults.end(), some.begin(), some.end());
  for (const Judge& judge : judges) configurations += judge.queries();
}

}  // namespace mmgrasp::verify::detail
