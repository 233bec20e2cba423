// Sampling and growing.

#include "plan/rrt_star_mg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"

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

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kSame = 1e-9;  // Configurations nearer than this are the same [rad or m].
constexpr int kHopeless = -2;
constexpr int kFirst = 4;            // Samples for each grasp found, as long as others are left to look at.
constexpr int kStraight = 32;        // Straight lines tried before the first sample.
constexpr int kDuplicates = 4;       // Vertices of other trees taken over by one new vertex.
constexpr int kHalvings = 3;         // To find how far along an edge the way is free.
constexpr int kRounds = 8;           // Trees of single grasps that grow with one sample, until there is a path.
constexpr double kAround = 0.8;      // Samples drawn near a straight line, until there is a path.
constexpr double kNarrowest = 1.1;   // Paths they may lie on, by the straight line's length: at least ...
constexpr double kWidest = 2.5;      // ... and this much more.
constexpr double kCorners = 0.3;     // Corners of the best path cut, by samples drawn.
constexpr double kCoarse = 8;        // Steps along the trees' edges, by those of finished paths.
constexpr int kGuesses = 32;         // Random grasps asked before all of them are.
constexpr double kGammaSlack = 1.1;  // Above the least that optimality asks for.

/// Cheapest first.
bool costlier(const Forest::Near& a, const Forest::Near& b) {
  return a.key != b.key ? a.key > b.key : a.vertex > b.vertex;
}

// RRT* joins a new vertex with all nearer than gamma (log n / n)^(1 / (d + 1)) (Karaman and Frazzoli, with the exponent
// that Solovey and others proved sufficient), gamma from the volume of the joint box.
double least_gamma(const JointGroup& group) {
  const int d = group.size();
  const double volume = (group.sample_upper() - group.sample_lower()).prod() / unit_ball_volume(d);
  return kGammaSlack * 2 * std::pow((1 + 1.0 / d) * volume, 1.0 / (d + 1));
}

}  // namespace

RrtStarMg::RrtStarMg(CarryInput& input, const RrtStarMgOptions& options, ManipulationResult& result)
    : input_(input),
      result_(result),
      options_(options),
      ends_(input.candidates.found()),
      informed_(ends_, input.problem.group.sample_lower(), input.problem.group.sample_upper()),
      forest_(ends_),
      rng_(input.options.seed, 0x727274),
      gamma_(options_.gamma > 0 ? options_.gamma : least_gamma(input.problem.group)),
      best_(result.path ? result.cost : kInfinite),
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
  try_straight_lines();
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
  result_.stats.vertices += static_cast<std::size_t>(forest_.vertex_count());
  result_.lower_bound = std::min({best_, ends_.straight_cost(0), input_.candidates.least_cost_left()});
  if (options_.keep_trees) keep_trees();
  if (result_.path) {
    result_.outcome = Outcome::solved;
  } else {
    result_.outcome = input_.monitor.stopped() ? Outcome::stopped : Outcome::timeout;
  }
}

void RrtStarMg::plant() {
  int grasp = 0;
  while (ends_.grasp(grasp) != result_.grasp_index) ++grasp;
  best_grasp_ = grasp;
  if (grasp >= informed_.grasps()) return;  // It is the straight line.
  const std::vector<Eigen::VectorXd>& path = result_.path->waypoints;
  int at = forest_.nearest_in_tree(Forest::tree(grasp, GraspEnds::kStart), path.front().data());
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
    at = forest_.add(at, forest_.add_configuration(path[i].data()), (path[i] - path[i - 1]).norm());
  add_bridge(at, forest_.nearest_in_tree(Forest::tree(grasp, GraspEnds::kGoal), path.back().data()));
  contenders_.push_back(grasp);
  refresh(grasp);
  straighten(grasp);
  refresh(grasp);
}

void RrtStarMg::keep_trees() {
  for (int grasp = 0; grasp < ends_.size(); ++grasp)
    for (const int side : {GraspEnds::kStart, GraspEnds::kGoal}) {
      std::vector<int> place(static_cast<std::size_t>(forest_.vertex_count()), -1), members;
      forest_.each_in_tree(Forest::tree(grasp, side), [&](int v) {
        place[static_cast<std::size_t>(v)] = static_cast<int>(members.size());
        members.push_back(v);
      });
      if (members.empty()) continue;
      SearchTree tree;
      tree.grasp = ends_.grasp(grasp);
      tree.from_goal = side == GraspEnds::kGoal;
      tree.vertices.resize(ends_.dimension(), static_cast<Eigen::Index>(members.size()));
      tree.costs.resize(tree.vertices.cols());
      for (std::size_t i = 0; i < members.size(); ++i) {
        const Forest::Vertex& vertex = forest_.vertex(members[i]);
        tree.vertices.col(static_cast<Eigen::Index>(i)) =
            Eigen::Map<const Eigen::VectorXd>(forest_.at(members[i]), ends_.dimension());
        tree.costs[static_cast<Eigen::Index>(i)] = vertex.cost;
        tree.parents.push_back(vertex.parent < 0 ? -1 : place[static_cast<std::size_t>(vertex.parent)]);
      }
      result_.trees.push_back(std::move(tree));
    }
}

double RrtStarMg::radius(int vertices) const {
  const double n = std::max(2, vertices);
  return std::min(gamma_ * std::pow(std::log(n) / n, 1.0 / (ends_.dimension() + 1)), options_.step);
}

// Beyond the paper: nothing is cheaper than a straight line, and many carries have a free one.
void RrtStarMg::try_straight_lines() {
  const int tried = std::min(kStraight, ends_.size());
  std::vector<int> roots;
  for (int grasp = 0; grasp < tried && ends_.straight_cost(grasp) < best_ && !input_.out_of_time(); ++grasp) {
    roots.clear();
    forest_.each_in_tree(Forest::tree(grasp, GraspEnds::kStart), [&](int v) { roots.push_back(v); });
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
  const int configuration = forest_.add_configuration(q_.data());
  if (rng_.uniform() < options_.exploration) return extend_tree(Forest::tree(grasp, side), configuration);
  return extend_forest(side, configuration);
}

// Beyond the paper, until there is a path. One configuration is offered to the forest, as in the paper, and to the
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
  const int configuration = forest_.add_configuration(q_.data());
  const int made = extend_forest(side, configuration);
  if (made >= 0) connect(made);
  for (int i = 0; i < kRounds && !solved(); ++i, grasp = pick_early()) {
    const int grown = extend_tree(Forest::tree(grasp, side), configuration);
    if (grown >= 0) connect(grown);
  }
}

int RrtStarMg::take_reassigned(int side, int& tree) {
  while (!reassign_.empty()) {
    const std::size_t at = rng_.index(reassign_.size());
    const int configuration = reassign_[at];
    reassign_[at] = reassign_.back();
    reassign_.pop_back();
    const double* q = forest_.configuration(configuration);
    const auto serves = [&](int grasp) {
      return informed_.contains(grasp, q) && forest_.find(Forest::tree(grasp, side), configuration) < 0;
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
    tree = Forest::tree(grasp, side);
    return configuration;
  }
  return -1;
}

int RrtStarMg::steer(int from, int target) {
  const int d = ends_.dimension();
  const double* a = forest_.at(from);
  const double* b = forest_.configuration(target);
  const double distance = std::sqrt(squared_distance(a, b, d));
  if (distance < kSame) return -1;
  if (distance <= options_.step) return target;
  for (int i = 0; i < d; ++i) q_[i] = a[i] + (b[i] - a[i]) * (options_.step / distance);
  return forest_.add_configuration(q_.data());
}

// ExtendAndRewire (Algorithm 5.2) on the tree of one grasp.
int RrtStarMg::extend_tree(int tree, int configuration) {
  const int nearest = forest_.nearest_in_tree(tree, forest_.configuration(configuration));
  const int target = steer(nearest, configuration);
  if (target < 0 || forest_.find(tree, target) >= 0) return -1;
  forest_.near_in_tree(tree, forest_.configuration(target), radius(forest_.tree_size(tree)), near_);
  include_nearest(nearest, target);
  const int made = add_best(target, kInfinite);
  if (made < 0) return solved() ? -1 : advance(nearest, target);
  rewire(made);
  return made;
}

// ExtendAndRewire-MG: the tree that looks cheapest by equation (5.1) among those near.
int RrtStarMg::extend_forest(int side, int configuration) {
  const int nearest = forest_.nearest_on_side(side, forest_.configuration(configuration));
  const int target = steer(nearest, configuration);
  if (target < 0) return -1;
  forest_.near_on_side(side, forest_.configuration(target), radius(forest_.side_size(side)), near_);
  include_nearest(nearest, target);
  const int made = add_best(target, best_);
  // No tree nearby can be improved from here; another grasp's may (P2 5.3.4).
  if (made == kHopeless) reassign_.push_back(configuration);
  if (made < 0) return solved() ? -1 : advance(nearest, target);
  rewire(made);
  if (solved()) duplicate_into(made);
  return made;
}

// Beyond the paper, until there is a path.
int RrtStarMg::advance(int from, int target) {
  const Forest::Vertex start = forest_.vertex(from);
  const int grasp = Forest::grasp_of(start.tree), d = ends_.dimension();
  int last = start.configuration;
  double done = 0, share = 0.5;
  for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
    const double* a = forest_.at(from);
    const double* b = forest_.configuration(target);
    for (int k = 0; k < d; ++k) q_[k] = a[k] + (b[k] - a[k]) * (done + share);
    const int next = forest_.add_configuration(q_.data());
    if (!configuration_is_free(grasp, next) || !edge_is_free(grasp, last, next)) continue;
    last = next;
    done += share;
  }
  if (last == start.configuration) return -1;
  return forest_.add(from, last, std::sqrt(squared_distance(forest_.at(from), forest_.configuration(last), d)));
}

// The k-th cheapest-looking grasp with a chance that falls as 1 / k: whoever must be tried to get through, no grasp
// waits much longer than its place in the list.
int RrtStarMg::pick_early() {
  const int count = informed_.grasps();
  return std::min(count - 1, static_cast<int>(std::pow(count + 1.0, rng_.uniform())) - 1);
}

void RrtStarMg::include_nearest(int nearest, int target) {
  for (const Near& entry : near_)
    if (entry.vertex == nearest) return;
  near_.push_back(
      {nearest, std::sqrt(squared_distance(forest_.at(nearest), forest_.configuration(target), ends_.dimension()))});
}

int RrtStarMg::add_best(int configuration, double bound) {
  const double* q = forest_.configuration(configuration);
  bool any = false;
  for (Near& entry : near_) {
    const Forest::Vertex& vertex = forest_.vertex(entry.vertex);
    const int grasp = Forest::grasp_of(vertex.tree);
    const auto own = static_cast<std::size_t>(grasp);
    if (to_go_stamp_[own] != configuration) {
      to_go_stamp_[own] = configuration;
      to_go_[own] = ends_.cost(grasp) + ends_.distance(grasp, 1 - Forest::side_of(vertex.tree), q);
    }
    entry.key = vertex.cost + entry.distance + to_go_[own];
    any |= entry.key < bound;
  }
  if (!any) return kHopeless;
  std::make_heap(near_.begin(), near_.end(), costlier);
  for (auto last = near_.end(); last != near_.begin(); --last) {
    std::pop_heap(near_.begin(), last, costlier);
    const Near& entry = *(last - 1);
    if (entry.key >= bound) return -1;
    const Forest::Vertex& vertex = forest_.vertex(entry.vertex);
    const int grasp = Forest::grasp_of(vertex.tree);
    int& blocked = blocked_stamp_[static_cast<std::size_t>(grasp)];
    if (blocked == configuration) continue;
    if (!configuration_is_free(grasp, configuration)) {
      blocked = configuration;
      if (input_.checks.opening_count() == 1 && !robot_is_free(grasp, configuration)) return -1;
      continue;
    }
    if (edge_is_free(grasp, vertex.configuration, configuration))
      return forest_.add(entry.vertex, configuration, entry.distance);
  }
  return -1;
}

// Only within the tree (P2 5.3.2), and only what could make the best path better.
void RrtStarMg::rewire(int made) {
  const Forest::Vertex own = forest_.vertex(made);
  const int grasp = Forest::grasp_of(own.tree);
  bool changed = false;
  for (const Near& entry : near_) {
    const Forest::Vertex& other = forest_.vertex(entry.vertex);
    if (other.tree != own.tree || entry.vertex == own.parent || other.parent < 0) continue;
    const double cost = own.cost + entry.distance;
    if (!(cost < other.cost - kSame)) continue;
    if (cost + ends_.cost(grasp) + ends_.distance(grasp, 1 - Forest::side_of(own.tree), forest_.at(entry.vertex)) >=
        best_)
      continue;
    if (!edge_is_free(grasp, own.configuration, other.configuration)) continue;
    forest_.reparent(entry.vertex, made, entry.distance);
    changed = true;
  }
  if (changed && bridge_of_[static_cast<std::size_t>(grasp)] >= 0) refresh(grasp);
}

// What stands in other trees nearby and could serve this one (P2 5.3.2).
void RrtStarMg::duplicate_into(int made) {
  const Forest::Vertex own = forest_.vertex(made);
  const int grasp = Forest::grasp_of(own.tree), side = Forest::side_of(own.tree);
  if (!own.alive) return;
  int taken = 0;
  for (std::size_t i = 0; i < near_.size() && taken < kDuplicates; ++i) {
    const Near entry = near_[i];
    const Forest::Vertex other = forest_.vertex(entry.vertex);
    if (!other.alive || other.tree == own.tree || other.parent < 0 || entry.distance < kSame) continue;
    const double cost = own.cost + entry.distance;
    const double whole = cost + ends_.cost(grasp) + ends_.distance(grasp, 1 - side, forest_.at(entry.vertex));
    if (whole >= best_ || forest_.find(own.tree, other.configuration) >= 0) continue;
    if (!configuration_is_free(grasp, other.configuration) ||
        !edge_is_free(grasp, own.configuration, other.configuration))
      continue;
    forest_.add(made, other.configuration, entry.distance);
    ++taken;
  }
}

void run_rrt_star_mg(CarryInput& input, ManipulationResult& result) {
  CarryCandidates& candidates = input.candidates;
  const RrtStarMgOptions& options = input.options.rrt;
  input.checks.coarsen(kCoarse);
  RrtStarMgOptions first = options;
  first.goal_cost = kInfinite;
  first.keep_trees = false;
  std::size_t tried = 0;
  while (candidates.find_more(result.path.has_value()) && !candidates.complete() && !result.path) {
    first.max_samples = kFirst * static_cast<int>(candidates.found().size() - tried);
    first.max_samples = std::min(first.max_samples, options.max_samples - static_cast<int>(result.stats.samples));
    tried = candidates.found().size();
    if (first.max_samples > 0) RrtStarMg(input, first, result).run();
    if (result.path && result.cost <= options.goal_cost) return;
  }
  RrtStarMgOptions left = options;
  left.max_samples -= static_cast<int>(result.stats.samples);
  if (!candidates.found().empty()) {
    RrtStarMg(input, left, result).run();
  } else {
    result.outcome = input.monitor.stopped() ? Outcome::stopped : Outcome::timeout;
  }
}

}  // namespace detail
}  // namespace mmgrasp
