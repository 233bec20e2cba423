#include "plan/manipulation/rrt_star_mg/rrt_star_mg_planner.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "plan/manipulation/common/finish_path.hpp"
#include "plan/manipulation/common/first_transfer.hpp"
#include "plan/manipulation/common/informed_union.hpp"
#include "plan/manipulation/common/transfer_shortening.hpp"
#include "plan/manipulation/rrt_star_mg/connect_trees.hpp"
#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"
#include "plan/manipulation/rrt_star_mg/incumbent.hpp"
#include "plan/manipulation/rrt_star_mg/near_vertices.hpp"
#include "plan/manipulation/rrt_star_mg/path_shortcutting.hpp"
#include "plan/manipulation/rrt_star_mg/search_trees.hpp"
#include "plan/manipulation/rrt_star_mg/tree_checks.hpp"
#include "plan/manipulation/rrt_star_mg/tree_connections.hpp"
#include "plan/manipulation/rrt_star_mg/tree_growth.hpp"
#include "plan/manipulation/rrt_star_mg/tree_pruning.hpp"
#include "plan/manipulation/rrt_star_mg/tree_repair.hpp"
#include "plan/manipulation/rrt_star_mg/tree_sampler.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kReportInterval = 64;  // Samples.
constexpr int kMaxUnseeded = 500;    // Samples after which the trees get the first path if they have none themselves.

/// The options with their lengths as the metric measures them.
RrtStarMgOptions in_units_of(const JointMetric& metric, RrtStarMgOptions options) {
  options.range *= metric.unit();
  options.gamma *= metric.unit();
  return options;
}

/// Algorithm 5.13. Trees, informed sets and the incumbent are shared by those who sample, grow, connect and improve;
/// everything else is theirs.
class RrtStarMg {
 public:
  /// Plans over the grasps known now; the result may have a path already.
  RrtStarMg(ManipulationInput& input, ManipulationResult& result, const RrtStarMgTuning& tuning)
      : input_(input),
        result_(result),
        options_(in_units_of(input.metric, input.options.rrt)),
        tuning_(tuning),
        ends_(input.candidates.found()),
        informed_(ends_, input.problem.group.sample_lower(), input.problem.group.sample_upper()),
        trees_(ends_),  // Lines 1-5.
        checks_(trees_, input.checks, result.stats),
        near_vertices_(trees_, informed_, options_, tuning),
        connections_(trees_),
        sampler_(trees_, informed_, options_, tuning),
        repair_(trees_, checks_, near_vertices_, sampler_),
        growth_(trees_, checks_, near_vertices_, incumbent_, options_, tuning),
        connect_trees_(trees_, checks_, near_vertices_, incumbent_, connections_, options_, tuning),
        shortcutting_(trees_, checks_, connections_, incumbent_, tuning),
        rng_(input.options.seed, 0x727274) {
    growth_.on_rewired = [this](int grasp) {
      if (connections_.any(grasp)) update_incumbent(grasp);
    };
    if (result.path) first_ = {result.grasp_index, result.cost, *result.path};
  }

  void run() {
    input_.monitor.report("search", 0);
    if (input_.options.straight) try_straight_lines();
    const double goal_cost = std::min(options_.goal_cost, std::numeric_limits<double>::max());
    int i = 0;
    for (; i < options_.max_iterations && informed_.grasps() > 0 && incumbent_.cost > goal_cost; ++i) {  // Line 6.
      if (input_.out_of_time()) break;
      // Trees that begin with a path grow where it runs; those that find their own have been everywhere.
      if (first_.grasp >= 0 && (incumbent_.in_trees() || i == kMaxUnseeded)) seed_tree(std::exchange(first_, {}));
      if (i % kReportInterval == 0) input_.monitor.report("search", static_cast<double>(i) / options_.max_iterations);
      sample(options_.bidirectional ? i % 2 : GraspEnds::kStart);  // Line 26: SwapTrees.
    }
    result_.stats.samples += i;
    result_.stats.vertices += trees_.vertex_count();
    finish_path(input_, result_);
    if (options_.keep_trees) append_search_trees(trees_, result_.trees);
  }

 private:
  /// Lines 11-26 for one sample.
  void sample(int side) {
    if (incumbent_.in_trees()) restore_incumbent();
    const TreeSampler::Sample again = sampler_.draw_reassigned(rng_, side);
    if (again.configuration >= 0) {  // Lines 19, 20.
      connect(growth_.extend_tree(GraspTrees::tree(again.grasp, side), again.configuration));
    } else if (incumbent_.in_trees()) {
      const int made = grow_informed(side);
      if (rng_.uniform() < tuning_.shortcut_probability) shortcut();
      connect(made);
    } else {
      grow_before_first_path(side);
    }
  }

  /// Lines 12-17: exploration with probability p_blt, exploitation otherwise. Returns the new vertex, or -1.
  int grow_informed(int side) {
    const TreeSampler::Sample drawn = sampler_.draw(rng_);
    if (drawn.grasp < 0) return -1;
    if (rng_.uniform() < options_.exploration)
      return growth_.extend_tree(GraspTrees::tree(drawn.grasp, side), drawn.configuration);
    return extend_cheapest_tree(side, drawn.configuration);
  }

  /// Lines 16, 17 (errata: go on with the next sample).
  int extend_cheapest_tree(int side, int configuration) {
    const TreeGrowth::Extension extension = growth_.extend_cheapest_tree(side, configuration);
    if (extension.pruned) sampler_.reassign(configuration);  // Another grasp's tree may be improved (P2 5.3.4).
    return extension.vertex;
  }

  /// One sample before there is a path: offered to the trees as in the paper and then, beyond it, to the trees of some
  /// single grasps. What is found out about the robot there serves them all.
  void grow_before_first_path(int side) {
    int grasp = sampler_.pick_grasp(rng_);
    const int configuration = sampler_.draw_near_straight_line(rng_, grasp);
    connect(extend_cheapest_tree(side, configuration));
    for (int i = 0; i < tuning_.trees_per_sample && !incumbent_.in_trees(); ++i, grasp = sampler_.pick_grasp(rng_))
      connect(growth_.extend_tree(GraspTrees::tree(grasp, side), configuration));
  }

  /// Tries straight lines first, beyond the paper: nothing is cheaper, and many problems have a free one.
  void try_straight_lines() {
    const int tried = std::min(tuning_.straight_line_grasps, ends_.size());
    std::vector<int> roots;
    for (int grasp = 0; grasp < tried && ends_.straight_cost(grasp) < incumbent_.cost && !input_.out_of_time();
         ++grasp) {
      roots.clear();
      trees_.each_in_tree(GraspTrees::tree(grasp, GraspEnds::kStart), [&](int v) { roots.push_back(v); });
      for (const int v : roots) connect(v);
    }
  }

  /// Lines 22-25.
  void connect(int vertex) {
    if (vertex < 0) return;
    const ConnectTrees::Attempt attempt = connect_trees_.connect(vertex);
    if (attempt.connected) {
      update_incumbent(GraspTrees::grasp_of(trees_.vertex(vertex).tree));
    } else if (attempt.blocked_vertex >= 0 && !incumbent_.in_trees() && options_.bidirectional) {
      growth_.extend_half(attempt.blocked_vertex, trees_.vertex(vertex).configuration);
    }
  }

  void shortcut() {
    const int grasp = shortcutting_.improve_randomly(rng_, informed_.grasps());
    if (grasp >= 0) update_incumbent(grasp);
  }

  /// Puts the path that was known beforehand into the trees of its grasp.
  void seed_tree(const TransferPath& first) {
    int grasp = 0;
    while (ends_.grasp(grasp) != first.grasp) ++grasp;
    if (first.cost < incumbent_.cost) {
      incumbent_ = {first.cost, grasp};
      prune_and_reassign(incumbent_, trees_, informed_, sampler_);
    }
    if (grasp >= informed_.grasps()) return;  // The path is a straight line, or cannot become the best one.
    add_path(grasp, first.path.waypoints);
    update_incumbent(grasp);
    shortcutting_.skip_vertices(grasp);
    update_incumbent(grasp);
  }

  /// Puts a path into the trees of its grasp. TreeConnections::update() must follow.
  void add_path(int grasp, std::vector<Eigen::VectorXd> path) {
    ends_.metric().split_long_edges(path);
    int at = trees_.nearest_in_tree(GraspTrees::tree(grasp, GraspEnds::kStart), path.front().data());
    for (std::size_t i = 1; i + 1 < path.size(); ++i)
      at = trees_.add(at, trees_.add_configuration(ends_.metric().wrapped(path[i]).data()),
                      ends_.metric().norm(path[i] - path[i - 1]));
    if (connections_.best(grasp).connection < 0) connections_.list_grasp(grasp);
    connections_.add(at, trees_.nearest_in_tree(GraspTrees::tree(grasp, GraspEnds::kGoal), path.back().data()));
  }

  /// Rewiring along an edge that the final check refuses breaks the path that passed it, and repair may find none that
  /// is as good: that path is put back, for shortcuts need one, and only its neighbourhood is sampled. Between samples
  /// alone: whoever grows a tree holds references into it.
  void restore_incumbent() {
    const int grasp = incumbent_.grasp;
    if (grasp >= informed_.grasps()) return;  // A straight line: nothing is shorter.
    if (connections_.best(grasp).cost <= incumbent_.cost * (1 + kLeastImprovement)) return;
    add_path(grasp, result_.path->waypoints);
    connections_.update(grasp);
  }

  /// Lines 7-10 after the connections or costs of a grasp's trees changed: while its cheapest path beats the incumbent,
  /// checks it, takes it, prunes by it and shortcuts it.
  void update_incumbent(int grasp) {
    for (;;) {
      const TreeConnections::BestPath path = connections_.update(grasp);
      if (!(path.cost < incumbent_.cost_to_beat())) return;
      if (!accept(grasp, path.connection)) continue;
      incumbent_.grasp = grasp;
      prune_and_reassign(incumbent_, trees_, informed_, sampler_);
      if (incumbent_.cost <= options_.goal_cost) return;
      shortcutting_.skip_vertices(grasp);
    }
  }

  /// The final check of a path, which becomes the incumbent when it passes. Otherwise the search stepped over a thin
  /// obstacle: the blocked edge is taken out, and what was behind it connected anew.
  bool accept(int grasp, int connection) {
    std::size_t crossing = 0;
    const std::vector<int> vertices = connections_.vertices(connection, crossing);
    const int blocked = checks_.blocked_edge(grasp, vertices);
    if (blocked < 0) {
      incumbent_.cost = connections_.cost(connection);
      JointPath path;
      for (const int v : vertices)
        path.waypoints.push_back(Eigen::Map<const Eigen::VectorXd>(trees_.at(v), ends_.dimension()));
      ends_.metric().unroll(path.waypoints);
      const PlanStage stage = vertices.size() == 2 ? PlanStage::straight_lines : PlanStage::trees;
      take_path(input_, {ends_.grasp(grasp), incumbent_.cost, std::move(path), stage}, result_);
      return true;
    }
    const std::size_t edge = blocked;
    if (edge + 1 == crossing) {
      connections_.remove(grasp, connection);
    } else {
      repair_.reconnect(edge + 1 < crossing ? vertices[edge + 1] : vertices[edge]);
    }
    return false;
  }

  ManipulationInput& input_;
  ManipulationResult& result_;
  const RrtStarMgOptions options_;
  const RrtStarMgTuning& tuning_;
  TransferPath first_;  ///< Known beforehand and not in the trees yet; no grasp: none.
  GraspEnds ends_;
  InformedUnion informed_;
  GraspTrees trees_;
  Incumbent incumbent_;
  TreeChecks checks_;
  NearVertices near_vertices_;
  TreeConnections connections_;
  TreeSampler sampler_;
  TreeRepair repair_;
  TreeGrowth growth_;
  ConnectTrees connect_trees_;
  PathShortcutting shortcutting_;
  Rng rng_;
};

}  // namespace

bool run_rrt_star_mg(ManipulationInput& input, ManipulationResult& result, const RrtStarMgTuning& tuning) {
  GraspCandidates& candidates = input.candidates;
  const TransferPath first = find_first_transfer(input, result);
  const auto good_enough = [&] { return result.path && result.cost <= input.options.rrt.goal_cost; };
  if (first.grasp >= 0 && !good_enough()) shorten_transfer(input, first, result);
  if (good_enough()) {
    finish_path(input, result);
    return false;
  }
  candidates.find_rest();
  if (!candidates.found().empty()) RrtStarMg(input, result, tuning).run();
  return false;
}

}  // namespace mmgrasp::detail
