#include "plan/manipulation/common/grasp_candidates.hpp"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/detail/least_motion.hpp"
#include "plan/manipulation/common/turned_ends.hpp"
#include "plan/motion/arm_configurations.hpp"

namespace mmgrasp::detail {

namespace {

constexpr std::size_t kMinParallelGrasps = 16;  // Fewer are checked in one thread.

constexpr double kPoseGrid = 1.0 / (1LL << 36);  // 1.5e-11 of a metre, or of a rotation matrix.

/// The tool's pose, rounded to a grid far finer than any tolerance: poses that are equal but for rounding, as when the
/// heading they come from is turned once, give the same arm configurations and so the same path.
Pose pose_of_tool(const ManipulationProblem& problem, int grasp, bool at_goal) {
  const Pose& T_world_object = at_goal ? problem.T_world_goal : problem.T_world_start;
  Pose T_world_tool = T_world_object * problem.grasps[grasp].T_object_hand;
  T_world_tool.matrix() = (T_world_tool.matrix() / kPoseGrid).array().round() * kPoseGrid;
  return T_world_tool;
}

IkOptions ik_of(const ManipulationOptions& options, int grasp) {
  IkOptions ik = options.ik;
  ik.seed = options.ik.seed + static_cast<unsigned>(grasp);
  return ik;
}

// Neighbours in the caller's list tend to fail together.
std::vector<int> shuffled(std::size_t count, unsigned seed) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  Rng rng(seed, 0x6d67);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng.index(i)]);
  return order;
}

}  // namespace

double GraspCandidate::straight_cost() const {
  double least = kInfinity;
  for (const Eigen::VectorXd& s : starts)
    for (const Eigen::VectorXd& g : goals) least = std::min(least, metric.distance(g, s));
  return least + cost;
}

GraspCandidates::GraspCandidates(const ManipulationProblem& problem, const ManipulationOptions& options,
                                 const JointMetric& metric, TransferChecks& checks, const Stopwatch& clock,
                                 const Monitor& monitor, ManipulationResult& result)
    : problem_(problem),
      options_(options),
      metric_(metric),
      checks_(checks),
      clock_(clock),
      monitor_(monitor),
      result_(result),
      order_(shuffled(problem.grasps.size(), options.seed)),
      least_cost_elsewhere_(kInfinity),
      turns_(problem.group) {
  result_.grasps.assign(order_.size(), {});
}

bool GraspCandidates::find_more(std::size_t count) {
  if (complete()) return false;
  const double begin = clock_.seconds();
  count = std::min(count, order_.size() - checked_);
  // As long as no path bounds their turns, ends are searched in one turn alone, and turned again later.
  const bool unbounded = !result_.path && turns_.any();
  std::vector<GraspCandidate> checked(count), in_one_turn(unbounded ? count : 0);
  std::atomic<bool> late{false};
  const auto work = [&](std::size_t i, int worker) {
    if (clock_.seconds() > options_.time_limit) {
      late = true;
      return;
    }
    const int grasp = order_[checked_ + i];
    checked[i] = check(grasp, worker, result_.grasps[grasp]);
    if (unbounded) in_one_turn[i] = checked[i];
    add_turned_ends(turns_, problem_.group, bound(), checked[i]);
  };
  const bool whole =
      parallel_for(count, count >= kMinParallelGrasps ? options_.threads : 1, work, monitor_, "grasps") && !late;
  for (std::size_t i = 0; i < count; ++i) {
    if (checked[i].grasp >= 0 && !checked[i].all_postures)
      least_cost_elsewhere_ = std::min(least_cost_elsewhere_, least_cost_from_anywhere(checked[i].grasp));
    if (checked[i].goals.empty()) continue;
    if (unbounded) unbounded_.push_back(std::move(in_one_turn[i]));
    found_.push_back(std::move(checked[i]));
  }
  if (whole) checked_ += count;
  result_.stats.ik_seconds += clock_.seconds() - begin;
  return whole;
}

bool GraspCandidates::find_rest() {
  const bool whole = find_more(order_.size());
  add_left_out_turns();
  return whole;
}

double GraspCandidates::bound() const {
  return result_.path ? result_.cost : kInfinity;
}

void GraspCandidates::add_left_out_turns() {
  if (!result_.path) return;
  for (std::size_t i = 0; i < unbounded_.size(); ++i) {
    // Those there are stay: the path known may end there.
    add_turned_ends(turns_, problem_.group, bound(), unbounded_[i]);
    add_ends(unbounded_[i], found_[i]);
  }
  unbounded_.clear();
}

GraspCandidate GraspCandidates::check(int grasp, int worker, GraspReport& report) {
  GraspCandidate out;
  out.grasp = grasp;
  out.opening = checks_.opening_of(grasp);
  out.cost = problem_.grasps[grasp].cost;
  out.metric = metric_;
  const auto valid = [&](const Eigen::VectorXd& q) {
    // The object first: it has fewer shapes, and hits the scene in every configuration with this tool pose or in none.
    ReachVerdict verdict{checks_.attached_rejection(worker, grasp, q), false};
    if (verdict.cause == Rejection::scene) {
      verdict.final = true;
    } else if (verdict.cause == Rejection::none) {
      verdict.cause = checks_.robot_rejection(worker, out.opening, q);
      verdict.final = verdict.cause == Rejection::scene && checks_.tool_hits_scene(worker, out.opening, q);
    }
    return verdict;
  };
  const auto one_end = [&](bool at_goal, Rejections& rejections, int& left) {
    ArmConfigurations found = arm_configurations(checks_.group(out.opening), pose_of_tool(problem_, grasp, at_goal),
                                                 options_.ik_solutions, ik_of(options_, grasp), valid, rejections);
    left = static_cast<int>(found.q.size());
    return found;
  };
  ArmConfigurations starts = one_end(false, report.start, report.start_solutions);
  out.starts = std::move(starts.q);
  out.all_postures = starts.all;
  if (out.starts.empty()) return out;
  ArmConfigurations goals = one_end(true, report.goal, report.goal_solutions);
  out.goals = std::move(goals.q);
  out.all_postures = goals.all && (starts.all || out.goals.empty());
  return out;
}

double GraspCandidates::least_cost_from_anywhere(int grasp) const {
  return problem_.grasps[grasp].cost + least_motion(problem_.group, pose_of_tool(problem_, grasp, false),
                                                    pose_of_tool(problem_, grasp, true), options_.ik, metric_);
}

double GraspCandidates::least_cost_left() const {
  double least = kInfinity;
  for (std::size_t i = checked_; i < order_.size(); ++i) least = std::min(least, problem_.grasps[order_[i]].cost);
  return least;
}

double GraspCandidates::least_cost() const {
  double least = least_cost_left();
  for (const GraspCandidate& candidate : found_) least = std::min(least, candidate.straight_cost());
  return least;
}

std::vector<Contact> GraspCandidates::first_contacts(bool at_goal) {
  for (std::size_t i = 0; i < result_.grasps.size(); ++i) {
    const Rejections& seen = at_goal ? result_.grasps[i].goal : result_.grasps[i].start;
    if (seen.scene + seen.self_collision == 0) continue;
    const int grasp = static_cast<int>(i);
    std::vector<Contact> contacts;
    CollisionChecker checker = checks_.whole(grasp);
    Rejections unused;
    const auto keep_contacts = [&](const Eigen::VectorXd& q) {
      if (contacts.empty()) contacts = checker.contacts(q);
      return ReachVerdict{Rejection::none, true};
    };
    arm_configurations(checks_.group(checks_.opening_of(grasp)), pose_of_tool(problem_, grasp, at_goal),
                       options_.ik_solutions, ik_of(options_, grasp), keep_contacts, unused);
    if (!contacts.empty()) return contacts;
  }
  return {};
}

}  // namespace mmgrasp::detail
