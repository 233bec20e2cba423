// Sampling.

#include "plan/manipulation/rrt_star_mg/rrt_star_mg.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "plan/manipulation/common/first_transfer.hpp"
#include "plan/manipulation/common/transfer_shortening.hpp"

namespace mmgrasp {

void RrtStarMgOptions::check() const {
  require(max_samples >= 1 && max_samples <= 10000000, "max_samples", max_samples, "must be in [1, 10 million]");
  require(std::isfinite(step) && step > 0, "step", step, "must be finite and > 0 [rad or m]");
  require(std::isfinite(gamma) && gamma >= 0, "gamma", gamma, "must be finite and >= 0");
  require(exploration >= 0 && exploration <= 1, "exploration", exploration, "must be in [0, 1]");
  require(goal_cost >= 0, "goal_cost", goal_cost, "must be >= 0");
}

namespace detail {
namespace {

constexpr int kStraight = 32;       // Straight lines tried before the first sample.
constexpr int kRounds = 8;          // Trees of single grasps that grow with one sample, until there is a path.
constexpr double kAround = 0.8;     // Samples drawn near a straight line, until there is a path.
constexpr double kNarrowest = 1.1;  // Paths they may lie on, by the straight line's length: at least ...
constexpr double kWidest = 2.5;     // ... and this much more.
constexpr double kCorners = 0.3;    // Corners of the best path cut, by samples drawn.
constexpr int kGuesses = 32;        // Random grasps asked before all of them are.

}  // namespace

RrtStarMg::RrtStarMg(ManipulationInput& input, const RrtStarMgOptions& options, ManipulationResult& result)
    : input_(input),
      result_(result),
      options_(options),
      ends_(input.candidates.found()),
      informed_(ends_, input.problem.group.sample_lower(), input.problem.group.sample_upper()),
      trees_(ends_),
      rng_(input.options.seed, 0x727274),
      best_(result.path ? result.cost : kInfinity),
      own_(static_cast<std::size_t>(ends_.size())),
      bridge_of_(own_.size(), -1),
      to_go_(bridge_of_.size()),
      to_go_stamp_(bridge_of_.size(), -1),
      blocked_stamp_(bridge_of_.size(), -1),
      q_(input.problem.group.size()),
      q_a_(q_.size()),
      q_b_(q_.size()) {
  if (result.path) prune();
}

void RrtStarMg::run() {
  input_.monitor.report("search", 0);
  if (input_.options.straight) try_straight_lines();
  const double goal = std::min(options_.goal_cost, std::numeric_limits<double>::max());
  int i = 0;
  for (; i < options_.max_samples && informed_.grasps() > 0 && best_ > goal; ++i) {
    if (input_.out_of_time()) break;
    // Not before another grasp has one: the path may be a poor one, and trees that have one grow less evenly.
    if (!solved() && result_.path && !contenders_.empty()) plant();
    if (i % 64 == 0) input_.monitor.report("search", static_cast<double>(i) / options_.max_samples);
    sample(options_.bidirectional ? i % 2 : GraspEnds::kStart);
  }
  result_.stats.samples += static_cast<std::size_t>(i);
  result_.stats.vertices += static_cast<std::size_t>(trees_.vertex_count());
  result_.lower_bound = std::min({best_, ends_.straight_cost(0), input_.candidates.least_cost_left()});
  if (options_.keep_trees) keep_trees();
}

void RrtStarMg::plant() {
  int grasp = 0;
  while (ends_.grasp(grasp) != result_.grasp_index) ++grasp;
  best_grasp_ = grasp;
  if (grasp >= informed_.grasps()) return;  // It is the straight line.
  const std::vector<Eigen::VectorXd>& path = result_.path->waypoints;
  int at = trees_.nearest_in_tree(GraspTrees::tree(grasp, GraspEnds::kStart), path.front().data());
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
    at = trees_.add(at, trees_.add_configuration(path[i].data()), (path[i] - path[i - 1]).norm());
  add_bridge(at, trees_.nearest_in_tree(GraspTrees::tree(grasp, GraspEnds::kGoal), path.back().data()));
  contenders_.push_back(grasp);
  refresh(grasp);
  straighten(grasp);
  refresh(grasp);
}

void RrtStarMg::keep_trees() {
  for (int grasp = 0; grasp < ends_.size(); ++grasp)
    for (const int side : {GraspEnds::kStart, GraspEnds::kGoal}) {
      std::vector<int> place(static_cast<std::size_t>(trees_.vertex_count()), -1), members;
      trees_.each_in_tree(GraspTrees::tree(grasp, side), [&](int v) {
        place[v] = static_cast<int>(members.size());
        members.push_back(v);
      });
      if (members.empty()) continue;
      SearchTree tree;
      tree.grasp = ends_.grasp(grasp);
      tree.from_goal = side == GraspEnds::kGoal;
      tree.vertices.resize(ends_.dimension(), static_cast<Eigen::Index>(members.size()));
      tree.costs.resize(tree.vertices.cols());
      for (std::size_t i = 0; i < members.size(); ++i) {
        const GraspTrees::Vertex& vertex = trees_.vertex(members[i]);
        tree.vertices.col(static_cast<Eigen::Index>(i)) =
            Eigen::Map<const Eigen::VectorXd>(trees_.at(members[i]), ends_.dimension());
        tree.costs[static_cast<Eigen::Index>(i)] = vertex.cost;
        tree.parents.push_back(vertex.parent < 0 ? -1 : place[vertex.parent]);
      }
      result_.trees.push_back(std::move(tree));
    }
}

// Beyond the paper: nothing is cheaper than a straight line, and many carries have a free one.
void RrtStarMg::try_straight_lines() {
  const int tried = std::min(kStraight, ends_.size());
  std::vector<int> roots;
  for (int grasp = 0; grasp < tried && ends_.straight_cost(grasp) < best_ && !input_.out_of_time(); ++grasp) {
    roots.clear();
    trees_.each_in_tree(GraspTrees::tree(grasp, GraspEnds::kStart), [&](int v) { roots.push_back(v); });
    for (const int v : roots) connect(v);
  }
}

// One round of Algorithm 5.13.
void RrtStarMg::sample(int side) {
  int tree = -1;
  int made = -1;
  const int again = take_reassigned(side, tree);
  if (again >= 0) {
    made = extend_tree(tree, again);
  } else {
    if (!solved()) return sample_early(side);
    made = sample_informed(side);
    if (rng_.uniform() < kCorners) cut_corner();
  }
  if (made >= 0) connect(made);
}

int RrtStarMg::sample_informed(int side) {
  const int grasp = options_.informed ? informed_.draw(rng_, q_.data()) : informed_.draw_box(rng_, q_.data());
  if (grasp < 0) return -1;
  const int configuration = trees_.add_configuration(q_.data());
  if (rng_.uniform() < options_.exploration) return extend_tree(GraspTrees::tree(grasp, side), configuration);
  return extend_forest(side, configuration);
}

// Beyond the paper, until there is a path. One configuration is offered to the trees, as in the paper, and to the
// trees of some grasps: what is found out about the robot there serves them all. Most configurations are drawn near the
// straight line of one of these, for few joint boxes are much larger than the ways through them.
void RrtStarMg::sample_early(int side) {
  int grasp = pick_early();
  if (options_.informed && rng_.uniform() < kAround) {
    const double width = rng_.uniform();
    informed_.draw_around(rng_, grasp, kNarrowest + kWidest * width * width, q_.data());
  } else {
    informed_.draw_box(rng_, q_.data());
  }
  const int configuration = trees_.add_configuration(q_.data());
  const int made = extend_forest(side, configuration);
  if (made >= 0) connect(made);
  for (int i = 0; i < kRounds && !solved(); ++i, grasp = pick_early()) {
    const int grown = extend_tree(GraspTrees::tree(grasp, side), configuration);
    if (grown >= 0) connect(grown);
  }
}

// The k-th cheapest-looking grasp with a chance that falls as 1 / k: whoever must be tried to get through, no grasp
// waits much longer than its place in the list.
int RrtStarMg::pick_early() {
  const int count = informed_.grasps();
  return std::min(count - 1, static_cast<int>(std::pow(count + 1.0, rng_.uniform())) - 1);
}

int RrtStarMg::take_reassigned(int side, int& tree) {
  while (!reassign_.empty()) {
    const std::size_t at = rng_.index(reassign_.size());
    const int configuration = reassign_[at];
    reassign_[at] = reassign_.back();
    reassign_.pop_back();
    const double* q = trees_.configuration(configuration);
    const auto serves = [&](int grasp) {
      return informed_.contains(grasp, q) && trees_.find(GraspTrees::tree(grasp, side), configuration) < 0;
    };
    const auto count = static_cast<std::size_t>(informed_.grasps());
    int grasp = -1;
    for (int i = 0; i < kGuesses && grasp < 0; ++i) {
      const int guess = static_cast<int>(rng_.index(count));
      if (serves(guess)) grasp = guess;
    }
    std::size_t found = 0;
    for (int g = 0; g < informed_.grasps() && (grasp < 0 || found > 0); ++g)
      if (serves(g) && rng_.index(++found) == 0) grasp = g;
    if (grasp < 0) continue;
    tree = GraspTrees::tree(grasp, side);
    return configuration;
  }
  return -1;
}

bool run_rrt_star_mg(ManipulationInput& input, ManipulationResult& result) {
  GraspCandidates& candidates = input.candidates;
  const TransferPath first = find_first_transfer(input, result);
  const auto good_enough = [&] { return result.path && result.cost <= input.options.rrt.goal_cost; };
  if (first.grasp >= 0 && !good_enough()) shorten_transfer(input, first, result);
  if (good_enough()) {
    result.lower_bound = std::min(result.cost, candidates.least_cost());
    return false;
  }
  candidates.find_rest();
  if (!candidates.found().empty()) RrtStarMg(input, input.options.rrt, result).run();
  return false;  // Trees can always grow on.
}

}  // namespace detail
}  // namespace mmgrasp
