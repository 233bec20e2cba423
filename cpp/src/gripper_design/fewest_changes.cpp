// Which grippers to choose so that few changes are needed along the order of assembly.
#include "gripper_design/fewest_changes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gripper_design/change_prices.hpp"
#include "gripper_design/cover_prices.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kSameCost = 1e-12;  // Share by which sums of the same costs in another order may differ.

/// Steps by which prices are raised.
struct PriceSteps {
  int of_parts = 30, of_uses = 30;
};
constexpr PriceSteps kFirstSteps{600, 6000};  // Before anything is chosen.
constexpr double kFirstWork = 6e7;            // Uses that these may look at.
constexpr double kNodeWork = 5e3;             // Uses that count as a node.
constexpr int kManyLess = 10;                 // Where a tenth is left out, bounds are raised again,
constexpr double kMoreChanges = 0.1;          // and where the bound was raised by this.

/// Branch and bound over sets of grippers. In a set a gripper is kept for as long as one takes the next part, which
/// needs fewest changes.
class Search {
 public:
  Search(const std::vector<GripperCandidate>& candidates, int part_count, double least_gripper_cost,
         const MinimalGrippersOptions& options, const Monitor& monitor)
      : candidates_(candidates),
        takers_(part_count, Bits(static_cast<int>(candidates.size()))),
        least_gripper_cost_(least_gripper_cost),
        options_(options),
        monitor_(monitor),
        time_limit_(options.time_limit),
        cover_prices_(candidates),
        change_prices_(candidates, part_count) {
    for (int g = 0; g < count(); ++g) {
      for (int p = candidates[g].parts.next(0); p >= 0; p = candidates[g].parts.next(p + 1)) takers_[p].set(g);
    }
  }

  FewestChanges run(const std::vector<int>& known) {
    Bits chosen(count());
    for (const int g : known) chosen.set(g);
    take_if_better(chosen);
    improve_by_exchange();
    FewestChanges out;
    SearchPrices prices;
    out.changes_bound = search(prices);
    out.best = best_;
    out.proven = complete_;
    return out;
  }

  /// The first choice found that is as good as `limit`; sets nodes() and complete().
  std::optional<GripperChoice> as_good_as(const GripperChoice& limit, SearchPrices& prices) {
    // Only what beats this is taken: as much in all, with one change more.
    best_.gripper_cost = limit.gripper_cost - options_.change_cost;
    best_.changes = limit.changes + 1;
    bounded_ = first_suffices_ = true;
    search(prices);
    if (best_.of_part.empty()) return std::nullopt;
    return best_;
  }

  int nodes() const { return nodes_ + static_cast<int>(change_prices_.work() / kNodeWork); }
  bool complete() const { return complete_; }

 private:
  /// Some of the sets that are searched, and what is known about those of them that are better than the best.
  struct Node {
    Bits chosen, allowed, uncovered;  // `allowed`: what may be chosen, and `chosen`.
    double cost = 0;                  // That of `chosen`.
    int changes = 0;                  // None needs fewer.
    std::vector<double> part_prices;
    ChangePrices::Prices use_prices;
  };

  int count() const { return static_cast<int>(candidates_.size()); }
  int parts() const { return static_cast<int>(takers_.size()); }
  double total(double gripper_cost, int changes) const { return gripper_cost + options_.change_cost * changes; }

  /// Whether nothing with these bounds can beat the best so far.
  bool no_better(double gripper_cost, int changes) const {
    const double cost = total(std::max(gripper_cost, least_gripper_cost_), changes);
    const double best = total(best_.gripper_cost, best_.changes);
    return cost > best * (1 + kSameCost) || (cost > best * (1 - kSameCost) && changes >= best_.changes);
  }

  /// Fewest changes with these grippers at hand: every gripper is kept for as long as one that took all since the last
  /// change takes the next part. Every part must have a taker among them.
  int changes_with(const Bits& grippers) const {
    int changes = -1;
    Bits holding(count());
    for (int p = 0; p < parts(); ++p) {
      holding &= takers_[p];
      if (holding.first() >= 0) continue;
      holding = takers_[p];
      holding &= grippers;
      ++changes;
    }
    return std::max(changes, 0);
  }

  /// The same, with the gripper of each part; only those used are paid for.
  GripperChoice choice_with(const Bits& grippers) const {
    GripperChoice choice;
    Bits used(count()), holding(count());
    int begin = 0;
    const auto end_run = [&](int end) {
      if (end == begin) return;
      Bits again = holding;
      again &= used;
      const int gripper = again.first() >= 0 ? again.first() : holding.first();
      if (!used.test(gripper)) choice.gripper_cost += candidates_[gripper].cost;
      used.set(gripper);
      choice.of_part.insert(choice.of_part.end(), end - begin, gripper);
      choice.changes += begin > 0;
      begin = end;
    };
    for (int p = 0; p < parts(); ++p) {
      Bits next = holding;
      next &= takers_[p];
      if (next.first() < 0) {
        end_run(p);
        next = takers_[p];
        next &= grippers;
      }
      holding = next;
    }
    end_run(parts());
    return choice;
  }

  bool take_if_better(const Bits& grippers) {
    const GripperChoice choice = choice_with(grippers);
    if (bounded_ && no_better(choice.gripper_cost, choice.changes)) return false;
    best_ = choice;
    bounded_ = true;
    return true;
  }

  Bits best_set() const {
    Bits out(count());
    for (const int g : best_.of_part) out.set(g);
    return out;
  }

  /// Exchanges one gripper at a time while that helps, so that the search begins with a good choice.
  void improve_by_exchange() {
    bool better = true;
    while (better && !ended()) {
      better = false;
      const Bits current = best_set();
      for (int out = current.first(); out >= 0 && !better && !ended(); out = current.next(out + 1)) {
        Bits rest(parts());
        for (int g = current.first(); g >= 0; g = current.next(g + 1)) {
          if (g != out) rest |= candidates_[g].parts;
        }
        for (int in = 0; in < count() && !better; ++in) {
          Bits all = rest;
          all |= candidates_[in].parts;
          if (all.count() < parts()) continue;
          Bits exchanged = current;
          exchanged.reset(out);
          exchanged.set(in);
          better = take_if_better(exchanged);
        }
      }
    }
  }

  double cheapest(const Bits& grippers) const {
    double cost = kInfinity;
    for (int g = grippers.first(); g >= 0; g = grippers.next(g + 1)) cost = std::min(cost, candidates_[g].cost);
    return cost;
  }

  bool out_of_time() const { return monitor_.stopped() || time_limit_.expired(); }

  bool ended() {
    if (out_of_time() || nodes() >= options_.max_nodes) complete_ = false;
    return !complete_ || (first_suffices_ && !best_.of_part.empty());
  }

  /// Searches all sets; no set that costs as little as the best one needs fewer changes than the answer.
  int search(SearchPrices& prices) {
    Node all{Bits(count()),
             Bits(count()),
             Bits(parts()),
             0,
             0,
             std::vector<double>(parts(), 0.0),
             change_prices_.first_prices()};
    for (int g = 0; g < count(); ++g) all.allowed.set(g);
    for (int p = 0; p < parts(); ++p) all.uncovered.set(p);
    PriceSteps steps = kFirstSteps;
    if (!prices.empty()) {
      all.part_prices = prices.of_part;
      all.use_prices = change_prices_.compact(prices.of_use, prices.of_cost);
    }
    const double most = kFirstWork / static_cast<double>(change_prices_.use_count());
    if (most < steps.of_uses) steps.of_uses = 1 + static_cast<int>(most);
    const bool is_open = tighten(all, steps);
    prices = {all.part_prices, change_prices_.spread(all.use_prices), all.use_prices.of_cost};
    const int bound = all.changes;
    if (is_open) split(std::move(all));
    return complete_ ? best_.changes : std::min(bound, best_.changes);
  }

  void choose(int g, Node& node) const {
    node.chosen.set(g);
    node.uncovered -= candidates_[g].parts;
    node.cost += candidates_[g].cost;
  }

  /// Chooses what alone takes a part; false when nothing does.
  bool choose_forced(Node& node) const {
    for (int p = node.uncovered.first(); p >= 0; p = node.uncovered.next(p + 1)) {
      Bits takers = takers_[p];
      takers &= node.allowed;
      const int only = takers.first();
      if (only < 0) return false;
      if (takers.next(only + 1) < 0) choose(only, node);
    }
    return true;
  }

  /// Leaves out what is in no better set; false when there is no such set.
  bool tighten(Node& node, const PriceSteps& steps) {
    for (double before = 0;;) {
      if (!choose_forced(node)) return false;
      node.changes = std::max(node.changes, changes_with(node.allowed));
      if (no_better(node.cost, node.changes)) return false;
      if (node.uncovered.first() < 0) return true;
      const double least_cost =
          node.cost + cover_prices_.raise(open(node), node.uncovered, steps.of_parts, room(node), node.part_prices);
      if (no_better(least_cost, node.changes)) return false;
      if (leave_out(node, [&](int g) {
            return no_better(least_cost + std::max(0.0, cover_prices_.reduced_cost(g)), node.changes);
          }) > 0)
        continue;
      const double changes = change_prices_.raise({node.allowed, node.chosen},
                                                  {room(node), static_cast<double>(best_.changes - 1), steps.of_uses},
                                                  node.use_prices, [&] { return out_of_time(); });
      node.changes = std::max(node.changes, whole(changes));
      if (no_better(least_cost, node.changes)) return false;
      const int less = leave_out(node, [&](int g) {
        return no_better(least_cost, whole(changes + std::max(0.0, change_prices_.reduced_cost(g))));
      });
      if (ended() || (kManyLess * less < open(node).count() && changes < before + kMoreChanges)) return complete_;
      before = std::max(before, changes);
    }
  }

  static int whole(double bound) { return static_cast<int>(std::ceil(std::max(0.0, bound))); }

  Bits open(const Node& node) const {
    Bits out = node.allowed;
    out -= node.chosen;
    return out;
  }

  /// What grippers beside the chosen ones may cost in a better set.
  double room(const Node& node) const {
    return total(best_.gripper_cost, best_.changes) * (1 + kSameCost) - total(node.cost, node.changes);
  }

  /// How many were left out, of those that may be chosen.
  template <class IsNoBetter>
  int leave_out(Node& node, const IsNoBetter& is_no_better) const {
    int out = 0;
    const Bits candidates = open(node);
    for (int g = candidates.first(); g >= 0; g = candidates.next(g + 1)) {
      if (!is_no_better(g)) continue;
      node.allowed.reset(g);
      ++out;
    }
    return out;
  }

  void branch(Node node) {
    ++nodes_;
    if (!ended() && tighten(node, {})) split(std::move(node));
  }

  void split(Node node) {
    Bits next = node.allowed;
    if (node.uncovered.first() < 0) {
      take_if_better(node.chosen);
      if (options_.change_cost == 0) return;  // Nothing more is paid for by fewer changes.
      next -= node.chosen;
      if (next.first() < 0 || no_better(node.cost + cheapest(next), changes_with(node.allowed))) return;
    } else {
      next &= takers_[part_of_fewest(node.allowed, node.uncovered)];
    }
    for (const int g : by_reduced_cost(next)) {
      Node with = node;
      choose(g, with);
      branch(std::move(with));
      if (ended()) return;
      node.allowed.reset(g);  // What follows is without it.
    }
  }

  int part_of_fewest(const Bits& allowed, const Bits& uncovered) const {
    int best = -1, fewest = 0;
    for (int p = uncovered.first(); p >= 0; p = uncovered.next(p + 1)) {
      Bits takers = takers_[p];
      takers &= allowed;
      const int size = takers.count();
      if (best < 0 || size < fewest) {
        best = p;
        fewest = size;
      }
    }
    return best;
  }

  std::vector<int> by_reduced_cost(const Bits& grippers) const {
    std::vector<std::pair<double, int>> order;
    for (int g = grippers.first(); g >= 0; g = grippers.next(g + 1))
      order.emplace_back(change_prices_.reduced_cost(g), g);
    std::sort(order.begin(), order.end());
    std::vector<int> out;
    for (const auto& [cost, g] : order) out.push_back(g);
    return out;
  }

  const std::vector<GripperCandidate>& candidates_;
  std::vector<Bits> takers_;  // The candidates that take each part.
  double least_gripper_cost_;
  const MinimalGrippersOptions& options_;
  const Monitor& monitor_;
  TimeLimit time_limit_;
  CoverPrices cover_prices_;
  ChangePrices change_prices_;
  GripperChoice best_;
  bool bounded_ = false;         // best_ says what there is to beat.
  bool first_suffices_ = false;  // Whatever beats it ends the search.
  int nodes_ = 0;
  bool complete_ = true;
};

}  // namespace

FewestChanges fewest_changes(const std::vector<GripperCandidate>& candidates, int part_count,
                             const std::vector<int>& known, double least_gripper_cost,
                             const MinimalGrippersOptions& options, const Monitor& monitor) {
  return Search(candidates, part_count, least_gripper_cost, options, monitor).run(known);
}

ChoiceAsGood choice_as_good(const std::vector<GripperCandidate>& candidates, int part_count, const GripperChoice& limit,
                            double least_gripper_cost, const MinimalGrippersOptions& options, const Monitor& monitor,
                            SearchPrices& prices) {
  Search search(candidates, part_count, least_gripper_cost, options, monitor);
  ChoiceAsGood out;
  out.found = search.as_good_as(limit, prices);
  out.nodes = search.nodes();
  out.decided = out.found || search.complete();
  return out;
}

}  // namespace mmgrasp::detail
