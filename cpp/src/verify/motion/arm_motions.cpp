// Checks the motions of one pick: joints, collisions, grasp, lift, release.
#include <algorithm>
#include <array>
#include <cmath>

#include "mmgrasp/core/parallel.hpp"
#include "verify/context.hpp"
#include "verify/motion/hand_check.hpp"
#include "verify/motion/hermite.hpp"
#include "verify/motion/motion_checks.hpp"
#include "verify/motion/motion_limits.hpp"
#include "verify/motion/payload.hpp"
#include "verify/motion/tool_path.hpp"

namespace mmgrasp::verify::detail {
namespace {

enum Kind { kTransit, kApproach, kLift, kStow, kTransfer, kRetreat, kKinds };
constexpr std::array<const char*, kKinds> kKindNames = {"transit", "approach", "lift", "stow", "transfer", "retreat"};
constexpr double kOpening = 1e-6;  // [m]

bool has_part_attached(int kind) {
  return kind == kLift || kind == kStow || kind == kTransfer;
}

void check_follows(const CheckedMotion& before, const CheckedMotion& after, const std::string& where, Faults& faults) {
  check_join(before.positions.back(), after.positions.front(), where, "does not start where the last ended", faults);
}

/// Everything about one pick. Broken motions end the checks that need them, not the others.
class PickCheck {
 public:
  PickCheck(const Context& context, std::size_t index, Judge& judge, Faults& faults)
      : context_(context),
        plan_(context.plan),
        pick_(plan_.picks[index]),
        index_(index),
        judge_(judge),
        hand_(context, judge, faults),
        faults_(faults) {
    for (int kind = 0; kind < kKinds; ++kind) {
      if (kind != kStow || carries()) kinds_.push_back(kind);
    }
  }

  /// False when its motions hold no usable numbers.
  bool run() {
    bool usable = true;
    for (const CheckedMotion& motion : pick_.motions) {
      const std::string where = name(motion.kind);
      if (check_motion_shape(motion, judge_.kinematics().arm_size(), where, faults_)) {
        check_motion_limits(context_, judge_.kinematics(), motion, where, faults_);
      } else {
        usable = false;
      }
    }
    usable = check_order() && usable;
    if (!usable || !resolve()) return usable;
    check_openings();
    check_joins();
    check_poses();
    check_collisions();
    return true;
  }

 private:
  std::string name(const std::string& kind) const { return context_.pick_name(index_) + ", " + kind; }
  std::string name(int kind) const { return name(kKindNames[kind]); }
  /// Whether the part is brought to the goal in the hand, and let go there.
  bool carries() const { return plan_.unload_region.has_value(); }
  const CheckedMotion& motion(int kind) const { return pick_.motions[carries() || kind < kStow ? kind : kind - 1]; }
  void fault(const char* code, const std::string& where, const std::string& message) {
    faults_.push_back({code, where, message});
  }

  bool check_order() {
    std::string found, wanted;
    for (const CheckedMotion& m : pick_.motions) found += (found.empty() ? "" : ", ") + m.kind;
    for (const int kind : kinds_) wanted += (wanted.empty() ? "" : ", ") + std::string(kKindNames[kind]);
    bool good = pick_.motions.size() == kinds_.size();
    for (std::size_t i = 0; good && i < kinds_.size(); ++i) good = pick_.motions[i].kind == kKindNames[kinds_[i]];
    if (!good) {
      fault("motion-order", context_.pick_name(index_), "motions are [" + found + "], must be [" + wanted + "]");
    }
    return good;
  }

  /// The part, the grasp and the stop; false when one of them does not exist (said in picks.cpp).
  bool resolve() {
    const int part = context_.pick_part[index_];
    if (part < 0 || pick_.stop < 0 || pick_.stop >= static_cast<int>(plan_.stops.size())) return false;
    part_ = &plan_.parts[part];
    if (pick_.grasp < 0 || pick_.grasp >= static_cast<int>(part_->grasps.size())) return false;
    grasp_ = &part_->grasps[pick_.grasp];
    body_ = context_.body_of_part(part);
    judge_.drop();
    judge_.set_base(plan_.stops[pick_.stop].pose);
    context_.set_parts_before(judge_, index_);
    return true;
  }

  /// Once the part was brought there, the base stands where it is let go.
  void stand_where_released() {
    if (carries()) judge_.set_base(plan_.goal);
  }

  void check_openings() {
    for (const int kind : kinds_) {
      const CheckedMotion& m = motion(kind);
      const double width = grasp_->opening;
      if (!(m.opening >= -kOpening && m.opening <= plan_.max_opening + kOpening)) {
        fault("opening", name(kind), text(m.opening) + " m is outside [0, " + text(plan_.max_opening) + "]");
      } else if (has_part_attached(kind) && std::abs(m.opening - width) > kOpening) {
        fault("opening", name(kind), text(m.opening) + " m while holding a part of width " + text(width) + " m");
      } else if (!has_part_attached(kind) && m.opening < width - kOpening) {
        fault("opening", name(kind), text(m.opening) + " m does not pass a part of width " + text(width) + " m");
      } else if (!has_part_attached(kind) && m.opening < context_.pregrasp_opening(width) - kOpening) {
        fault("opening", name(kind),
              text(m.opening) + " m leaves less than the clearance of " + text(plan_.clearance) +
                  " m on each side of a part of width " + text(width) + " m");
      }
      if (m.attached != has_part_attached(kind)) {
        fault("attachment", name(kind),
              m.attached ? "says that the part is attached, it is not" : "says that nothing is attached, the part is");
      }
    }
    if (std::abs(motion(kTransit).opening - motion(kApproach).opening) > kOpening) {
      fault("opening", name(kApproach), "the opening jumps between transit and approach");
    }
  }

  /// Largest difference from home. Home is a pose of the arm: whole turns of a continuous joint lead to it as well.
  double gap_to_home(const Eigen::VectorXd& q) const {
    double largest = 0;
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const double difference = q[j] - plan_.home[j];
      largest = std::max(largest, std::abs(judge_.kinematics().continuous()[j] ? wrap_angle(difference) : difference));
    }
    return largest;
  }

  void check_joins() {
    const auto at_home = [this](const Eigen::VectorXd& q, int kind, const char* what) {
      const double by = gap_to_home(q);
      if (by > kMaxStep) fault("discontinuous", name(kind), std::string(what) + ": a joint is off by " + text(by));
    };
    at_home(motion(kTransit).positions.front(), kTransit, "does not start at home");
    at_home(motion(kRetreat).positions.back(), kRetreat, "does not end at home");
    for (std::size_t i = 1; i < kinds_.size(); ++i) {
      const CheckedMotion &before = motion(kinds_[i - 1]), &after = motion(kinds_[i]);
      check_follows(before, after, name(kinds_[i]), faults_);
      const double jump = largest_of(before.velocities.back() - after.velocities.front());
      if (jump > kRest) fault("discontinuous", name(kinds_[i]), "a velocity jumps by " + text(jump) + " at its start");
    }
    const auto rest = [this](const Eigen::VectorXd& v, int kind, const char* end) {
      check_rest(v, name(kind), end, faults_);
    };
    rest(motion(kTransit).velocities.front(), kTransit, "start");
    rest(motion(kApproach).velocities.back(), kApproach, "end");
    rest(motion(kTransfer).velocities.back(), kTransfer, "end");
    rest(motion(kRetreat).velocities.back(), kRetreat, "end");
    if (!carries()) return;
    at_home(motion(kStow).positions.back(), kStow, "does not end at home, where the base drives");
    rest(motion(kStow).velocities.back(), kStow, "end");
  }

  void check_poses() {
    const Pose& T_world_part = part_->body.T_world_body;
    const Pose T_world_grasp = judge_.tip(motion(kApproach).positions.back());
    T_tip_part_ = T_world_grasp.inverse() * T_world_part;
    check_grasp_reached(context_, T_world_part * grasp_->T_object_hand, T_world_grasp, name(kApproach), faults_);
    check_approach(context_, judge_.tip(motion(kApproach).positions.front()), T_world_grasp, name(kApproach), faults_);
    check_lift(context_, judge_.tip(motion(kLift).positions.front()), judge_.tip(motion(kLift).positions.back()),
               name(kLift), faults_);
    stand_where_released();
    const Pose T_world_released = judge_.tip(motion(kTransfer).positions.back()) * T_tip_part_;
    check_release(context_, *part_, judge_.T_world_root(), T_world_released, name(kTransfer), faults_);
  }

  void check_collisions() {
    judge_.set_base(plan_.stops[pick_.stop].pose);
    hand_.check_fingers(plan_.home, 0, motion(kTransit).opening,
                        context_.pick_name(index_) + ", fingers opening at home");
    walk(kTransit);
    walk(kApproach);
    const Eigen::VectorXd& at_grasp = motion(kApproach).positions.back();
    judge_.hold(body_, T_tip_part_);
    if (plan_.suction.cups.empty()) {
      hand_.check_grip(at_grasp, grasp_->opening, context_.pick_name(index_));
      if (!part_->scanned) hand_.check_room(at_grasp, grasp_->opening, 0, context_.pick_name(index_));
    } else {
      const Eigen::Vector3d centre = T_tip_part_ * centre_of_mass(part_->body.shapes);
      for (const int kind : {kLift, kTransfer})
        check_cups_hold(context_, judge_, motion(kind), part_->mass, centre, name(kind), faults_);
    }
    hand_.check_fingers(at_grasp, motion(kApproach).opening, grasp_->opening,
                        context_.pick_name(index_) + ", fingers closing");
    walk(kLift);
    if (carries()) walk(kStow);
    stand_where_released();
    walk(kTransfer);
    judge_.drop();
    hand_.check_fingers(
        motion(kTransfer).positions.back(), grasp_->opening, motion(kRetreat).opening,
        context_.pick_name(index_) + ", fingers opening over the " + (carries() ? "unload region" : "bin"));
    walk(kRetreat);
    hand_.check_fingers(plan_.home, motion(kRetreat).opening, 0,
                        context_.pick_name(index_) + ", fingers closing at home");
  }

  void walk(int kind) {
    const CheckedMotion& m = motion(kind);
    const double opening = std::min(std::max(m.opening, 0.0), plan_.max_opening);
    const Pose T_world_end = judge_.tip(m.positions.back());
    const Eigen::Vector3d axis = kind == kLift ? Eigen::Vector3d(Eigen::Vector3d::UnitZ())
                                               : Eigen::Vector3d(T_world_end.linear() * plan_.approach);
    StraightnessCheck straight(axis, T_world_end);
    StepBudget budget;
    bool free = true, is_straight = true;
    for (std::size_t i = 0; i + 1 < m.times.size() && free; ++i) {
      const HermiteSegment segment(m, i);
      double travel = 0;  // no joint moves farther than this in the segment
      for (int j = 0; j < judge_.kinematics().arm_size(); ++j) travel = std::max(travel, segment.travel(j));
      const double steps = std::max(1.0, std::ceil(travel / context_.options.joint_step));
      if (!budget.spend(steps, name(kind), faults_)) return;
      for (int step = i == 0 ? 0 : 1; step <= static_cast<int>(steps) && free; ++step) {
        const double s = step / steps;
        const Eigen::VectorXd q = segment.at(s);
        const std::string where = name(kind) + ", t = " + text(m.times[i] + s * segment.duration()) + " s";
        free = !hand_.collides(q, opening, where);
        if ((kind == kApproach || kind == kLift) && is_straight)
          is_straight = straight.check(judge_.tip(q), where, faults_);
      }
    }
  }

  const Context& context_;
  const PlanToCheck& plan_;
  const CheckedPick& pick_;
  std::size_t index_;
  std::vector<int> kinds_;  ///< Those of its motions, in order.
  Judge& judge_;
  HandCheck hand_;
  Faults& faults_;
  const CheckedPart* part_ = nullptr;
  const CheckedGrasp* grasp_ = nullptr;
  std::size_t body_ = 0;
  Pose T_tip_part_ = Pose::Identity();
};

/// The arm keeps its numbers while the base drives: each pick starts where the last one ended.
void check_picks_join(const Context& context, const std::vector<char>& usable, Faults& faults) {
  for (std::size_t pick = 1; pick < usable.size(); ++pick) {
    if (!usable[pick - 1] || !usable[pick]) continue;
    const std::vector<CheckedPick>& picks = context.plan.picks;
    check_follows(picks[pick - 1].motions.back(), picks[pick].motions.front(), context.pick_name(pick) + ", reach",
                  faults);
  }
}

}  // namespace

void check_arm_motions(const Context& context, Faults& faults, std::size_t& configurations) {
  const std::size_t picks = context.plan.picks.size();
  std::vector<Judge> judges(resolve_threads(context.options.threads), Judge(context.stage));
  std::vector<Faults> found(picks);
  std::vector<char> usable(picks, 0);
  parallel_for(
      picks, context.options.threads,
      [&](std::size_t pick, int worker) { usable[pick] = PickCheck(context, pick, judges[worker], found[pick]).run(); },
      context.monitor, "arm motions");
  for (const Faults& some : found) faults.insert(faults.end(), some.begin(), some.end());
  check_picks_join(context, usable, faults);
  for (const Judge& judge : judges) configurations += judge.queries();
}

}  // namespace mmgrasp::verify::detail
