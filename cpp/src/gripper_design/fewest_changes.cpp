// Which grippers to choose so that few changes are needed along the order of assembly.
#include "gripper_design/fewest_changes.hpp"

#include <algorithm>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kSameCost = 1e-12;  // Share by which sums of the same costs in another order may differ.

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
        time_limit_(options.time_limit) {
    for (int g = 0; g < count(); ++g) {
      for (int p = candidates[g].parts.next(0); p >= 0; p = candidates[g].parts.next(p + 1)) takers_[p].set(g);
    }
  }

  FewestChanges run(const std::vector<int>& known) {
    Bits all(count()), chosen(count()), uncovered(parts());
    for (int g = 0; g < count(); ++g) all.set(g);
    for (int p = 0; p < parts(); ++p) uncovered.set(p);
    for (const int g : known) chosen.set(g);
    FewestChanges out;
    out.changes_bound = changes_with(all);
    take_if_better(chosen);
    improve_by_exchange();
    branch(Bits(count()), all, uncovered, 0);
    out.best = best_;
    out.proven = complete_;
    return out;
  }

  /// The first choice found that is as good as `limit`; sets nodes() and complete().
  std::optional<GripperChoice> as_good_as(const GripperChoice& limit) {
    // Only what beats this is taken: as much in all, with one change more.
    best_.gripper_cost = limit.gripper_cost - options_.change_cost;
    best_.changes = limit.changes + 1;
    bounded_ = first_suffices_ = true;
    Bits all(count()), uncovered(parts());
    for (int g = 0; g < count(); ++g) all.set(g);
    for (int p = 0; p < parts(); ++p) uncovered.set(p);
    branch(Bits(count()), all, uncovered, 0);
    if (best_.of_part.empty()) return std::nullopt;
    return best_;
  }

  int nodes() const { return nodes_; }
  bool complete() const { return complete_; }

 private:
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

  /// What the uncovered parts cost at least: parts that share no taker are paid for one by one. Infinite when a part
  /// has no taker left.
  double cost_of_rest(const Bits& allowed, const Bits& uncovered) const {
    std::vector<std::pair<int, int>> order;
    for (int p = uncovered.first(); p >= 0; p = uncovered.next(p + 1)) {
      Bits takers = takers_[p];
      takers &= allowed;
      const int size = takers.count();
      if (size == 0) return kInfinity;
      order.emplace_back(size, p);
    }
    std::sort(order.begin(), order.end());
    Bits paid(count());
    double cost = 0;
    for (const auto& [size, p] : order) {
      Bits takers = takers_[p];
      takers &= allowed;
      if (takers.meets(paid)) continue;
      paid |= takers;
      cost += cheapest(takers);
    }
    return cost;
  }

  double cheapest(const Bits& grippers) const {
    double cost = kInfinity;
    for (int g = grippers.first(); g >= 0; g = grippers.next(g + 1)) cost = std::min(cost, candidates_[g].cost);
    return cost;
  }

  bool ended() {
    if (nodes_ % 256 == 0 && (monitor_.stopped() || time_limit_.expired())) complete_ = false;
    if (nodes_ >= options_.max_nodes) complete_ = false;
    return !complete_ || (first_suffices_ && !best_.of_part.empty());
  }

  /// `allowed` holds `chosen` and what may be chosen beside.
  void branch(const Bits& chosen, Bits allowed, const Bits& uncovered, double chosen_cost) {
    ++nodes_;
    if (ended()) return;
    const double rest = cost_of_rest(allowed, uncovered);
    if (rest == kInfinity || no_better(chosen_cost + rest, changes_with(allowed))) return;
    Bits open = allowed;
    if (uncovered.first() < 0) {
      take_if_better(chosen);
      if (options_.change_cost == 0) return;  // Nothing more is paid for by fewer changes.
      open -= chosen;
      if (open.first() < 0 || no_better(chosen_cost + cheapest(open), changes_with(allowed))) return;
    } else {
      open &= takers_[part_of_fewest(allowed, uncovered)];
    }
    for (const int g : by_new_parts(open, uncovered)) {
      Bits with = chosen, still = uncovered;
      with.set(g);
      still -= candidates_[g].parts;
      branch(with, allowed, still, chosen_cost + candidates_[g].cost);
      if (!complete_ || (first_suffices_ && !best_.of_part.empty())) return;
      allowed.reset(g);  // What follows is without it.
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

  std::vector<int> by_new_parts(const Bits& grippers, const Bits& uncovered) const {
    std::vector<std::pair<int, int>> order;
    for (int g = grippers.first(); g >= 0; g = grippers.next(g + 1)) {
      Bits parts = candidates_[g].parts;
      parts &= uncovered;
      order.emplace_back(-parts.count(), g);
    }
    std::sort(order.begin(), order.end());
    std::vector<int> out;
    for (const auto& [less, g] : order) out.push_back(g);
    return out;
  }

  const std::vector<GripperCandidate>& candidates_;
  std::vector<Bits> takers_;  // The candidates that take each part.
  double least_gripper_cost_;
  const MinimalGrippersOptions& options_;
  const Monitor& monitor_;
  TimeLimit time_limit_;
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
                            double least_gripper_cost, const MinimalGrippersOptions& options, const Monitor& monitor) {
  Search search(candidates, part_count, least_gripper_cost, options, monitor);
  ChoiceAsGood out;
  out.found = search.as_good_as(limit);
  out.nodes = search.nodes();
  out.decided = out.found || search.complete();
  return out;
}

}  // namespace mmgrasp::detail
