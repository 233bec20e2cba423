#include "mmgrasp/plan/cartesian.hpp"

#include <algorithm>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/detail/whole_turns.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "plan/motion/beyond_limits.hpp"
#include "plan/motion/steered_base.hpp"

namespace mmgrasp {
namespace {

/// Tries the branches of the first pose, the nearest to `near` first, or in the order of inverse kinematics.
class BranchSearch {
 public:
  BranchSearch(CollisionChecker& checker, const Poses& poses, const std::optional<Eigen::VectorXd>& near,
               const CartesianOptions& options, const Monitor& monitor)
      : checker_(checker), poses_(poses), near_(near), options_(options), monitor_(monitor) {}

  CartesianResult run() {
    find_branches();
    for (const Start& start : starts_) {
      if (result_.tried == options_.max_branches || distance_to(start.q) >= best_cost_ || monitor_.stopped()) break;
      // Another turn of a branch draws the same lines: it only helps against joint limits.
      if (start.branch >= 0 && ended_[start.branch]) continue;
      const Rejection cause = try_branch(start.q);
      if (start.branch >= 0) ended_[start.branch] = cause != Rejection::limits;
      monitor_.report("cartesian path", static_cast<double>(++result_.tried) / result_.branches);
    }
    result_.outcome = result_.path ? Outcome::solved : Outcome::not_found;
    if (starts_.empty()) refuse_start();
    if (monitor_.stopped()) {
      result_.outcome = Outcome::stopped;
      result_.path.reset();
      result_.corners.clear();
    }
    return std::move(result_);
  }

 private:
  void find_branches() {
    const IkOptions& ik = options_.line.ik;
    const auto allowed = [&](const Eigen::VectorXd& q) {
      const Rejection cause = checker_.rejection(q);
      if (cause == Rejection::scene && !scene_contact_) scene_contact_ = checker_.first_contact(q);
      if (cause == Rejection::self_collision && !self_contact_) self_contact_ = checker_.first_contact(q);
      return cause;
    };
    IkBranches found = solve_ik_branches(checker_.group(), poses_.front(), ik, allowed, 0, monitor_);
    result_.rejections = found.rejections;
    result_.branches = static_cast<int>(found.solutions.size());
    ended_.assign(found.solutions.size(), 0);
    const detail::WholeTurns turns(checker_.group());
    for (std::size_t b = 0; b < found.solutions.size(); ++b) {
      int turn = 0;
      for (Eigen::VectorXd& q : turns.of(found.solutions[b], near_ ? *near_ : found.solutions[b]))
        starts_.push_back({std::move(q), static_cast<int>(b), turn++});
    }
    std::stable_sort(starts_.begin(), starts_.end(), [&](const Start& a, const Start& b) {
      return near_ ? distance_to(a.q) < distance_to(b.q) : a.turn < b.turn;
    });
    if (near_ && near_reaches_first_pose() && checker_.is_free(*near_)) {
      starts_.insert(starts_.begin(), {*near_, -1, 0});
      ++result_.branches;
    }
  }

  bool near_reaches_first_pose() const {
    const IkOptions& ik = options_.line.ik;
    const Pose at = checker_.group().fk(*near_);
    return (at.translation() - poses_.front().translation()).norm() <= ik.position_tolerance &&
           rotation_distance(at, poses_.front()) <= ik.rotation_tolerance;
  }

  /// Reports what keeps the arm from the first pose.
  void refuse_start() {
    if (near_ && near_reaches_first_pose()) return refuse_near();
    result_.cause = most(result_.rejections);
    if (result_.cause != Rejection::unreachable) result_.outcome = Outcome::invalid_start;
    if (result_.cause == Rejection::scene) result_.contact = scene_contact_;
    if (result_.cause == Rejection::self_collision) result_.contact = self_contact_;
  }

  /// Says why a `near` that reaches the first pose is not allowed.
  void refuse_near() {
    result_.outcome = Outcome::invalid_start;
    result_.cause = checker_.rejection(*near_);
    if (result_.cause == Rejection::scene || result_.cause == Rejection::self_collision)
      result_.contact = checker_.first_contact(*near_);
    result_.beyond_limits = detail::beyond_limits(checker_.group(), *near_);
  }

  double distance_to(const Eigen::VectorXd& q) const { return near_ ? (q - *near_).norm() : 0; }

  /// What ended the lines; none when they are complete.
  Rejection try_branch(const Eigen::VectorXd& first) {
    JointPath path{{first}};
    std::vector<int> corners{0};
    const double lines = static_cast<double>(poses_.size() - 1);
    Monitor stop;  // No progress from within a branch: whole branches are reported.
    stop.stop = monitor_.stop;
    for (std::size_t i = 1; i < poses_.size(); ++i) {
      StraightLineResult line = plan_straight_line(checker_, path.waypoints.back(), poses_[i], options_.line, stop);
      if (line.outcome != Outcome::solved) {
        const double fraction = (static_cast<double>(i - 1) + line.fraction) / lines;
        if (result_.path || fraction < result_.fraction) return line.cause;
        result_.fraction = fraction;
        result_.cause = line.cause;
        result_.contact = std::move(line.contact);
        return line.cause;
      }
      path.waypoints.insert(path.waypoints.end(), line.path->waypoints.begin() + 1, line.path->waypoints.end());
      corners.push_back(static_cast<int>(path.waypoints.size()) - 1);
    }
    const double cost = distance_to(first) + path.length();
    if (cost >= best_cost_) return Rejection::none;
    best_cost_ = cost;
    result_.path = std::move(path);
    result_.corners = std::move(corners);
    result_.fraction = 1;
    result_.cause = Rejection::none;
    result_.contact.reset();
    return Rejection::none;
  }

  static Rejection most(const Rejections& r) {
    if (r.scene > 0) return Rejection::scene;
    if (r.self_collision > 0) return Rejection::self_collision;
    return r.limits > 0 ? Rejection::limits : Rejection::unreachable;
  }

  CollisionChecker& checker_;
  const Poses& poses_;
  const std::optional<Eigen::VectorXd>& near_;
  const CartesianOptions& options_;
  const Monitor& monitor_;
  std::optional<Contact> scene_contact_, self_contact_;  ///< Contacts of the first pose's configurations.
  /// A configuration at the first pose.
  struct Start {
    Eigen::VectorXd q;
    int branch;  ///< Branch of inverse kinematics; -1: `near` itself.
    int turn;    ///< Which of the branch's turns, the nearest first.
  };
  std::vector<Start> starts_;
  std::vector<char> ended_;  ///< Per branch: its other turns need not be tried.
  double best_cost_ = detail::kInfinity;
  CartesianResult result_;
};

}  // namespace

void CartesianOptions::check() const {
  line.check();
  require_count(max_branches, "max_branches", 1, 1'000'000);
}

CartesianResult plan_cartesian(CollisionChecker& checker, const Poses& T_world_tip,
                               const std::optional<Eigen::VectorXd>& near, const CartesianOptions& options,
                               const Monitor& monitor) {
  options.check();
  detail::refuse_steered_base(checker.group(), "plan_cartesian");
  require(T_world_tip.size() >= 2, "tool_poses", static_cast<double>(T_world_tip.size()),
          "must hold two poses or more");
  for (std::size_t i = 0; i < T_world_tip.size(); ++i) {
    checked_pose(T_world_tip[i].matrix(), "tool_poses[" + std::to_string(i) + "]");
  }
  if (near) checker.group().check_configuration(*near, "near");
  return BranchSearch(checker, T_world_tip, near, options, monitor).run();
}

}  // namespace mmgrasp
