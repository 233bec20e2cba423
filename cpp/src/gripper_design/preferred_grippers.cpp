// preferred_grippers: the least set, with each part held to its best segment as long as the set stays as good.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "gripper_design/fewest_changes.hpp"
#include "gripper_design/gripper_set.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/gripper_design/minimal_grippers.hpp"

namespace mmgrasp {
namespace {

using namespace detail;

constexpr double kSameCost = 1e-12;  // Share by which sums of the same costs in another order may differ.
constexpr double kSameValue = 1e-9;
constexpr int kSearches = 5;               // All tries together may take so many times the nodes of one search,
constexpr std::size_t kMostSought = 4000;  // Beyond it only the set at hand is asked.
constexpr int kOneTry = 2;                 // and one try this share of it.

/// Which requirements each part may be taken by, over candidates that are made once: parts are held to their best one
/// after the other, and a set that is as good as the least one is kept at hand.
class Preference {
 public:
  Preference(const GripperSetQuestion& question, const MinimalGrippersResult& least, const TimeLimit& clock,
             const Monitor& monitor)
      : question_(question),
        least_(least),
        clock_(clock),
        monitor_(monitor),
        parts_(named_parts(question.requirements)) {
    if (question.requirements.size() > kMostSought) {
      candidates_ = least_set();
    } else {
      candidates_ = all_candidates();
      if (candidates_.empty()) return;
      nodes_left_ = static_cast<long>(kSearches) * question.options.max_nodes;
    }
    allowed_ = by_part();
    take_over_least();
  }

  /// No candidates: the time was over before they were made.
  bool ready() const { return !candidates_.empty(); }
  bool ended() const { return monitor_.stopped() || clock_.expired(); }

  /// Holds a part to one requirement, if a set as good as the least one does with that.
  bool try_only(int part, int requirement) {
    std::vector<int> before{requirement};
    std::swap(allowed_[part], before);
    if (keep_set() || exchange_one(requirement) || search()) return true;
    std::swap(allowed_[part], before);
    return false;
  }

  int taken(int part) const { return met_by(choice_.of_part[part], part); }

  void write(MinimalGrippersResult& result) const {
    std::vector<int> requirement_of_part;
    for (int p = 0; p < parts_.count(); ++p) requirement_of_part.push_back(taken(p));
    write_gripper_set(question_, parts_.names, candidates_, choice_.of_part, requirement_of_part, result);
    result.preference_finished = finished_;
  }

 private:
  std::vector<std::vector<int>> by_part() const {
    std::vector<std::vector<int>> out(parts_.count());
    for (std::size_t r = 0; r < parts_.of_requirement.size(); ++r)
      out[parts_.of_requirement[r]].push_back(static_cast<int>(r));
    return out;
  }

  /// Candidates by requirements; none when the time was over first.
  std::vector<GripperCandidate> all_candidates() const {
    std::vector<int> each(question_.requirements.size());
    std::iota(each.begin(), each.end(), 0);
    return gripper_candidates(question_.requirements, each, static_cast<int>(each.size()), question_.actuators,
                              question_.options, [&] { return ended(); })
        .value_or(std::vector<GripperCandidate>{});
  }

  std::vector<GripperCandidate> least_set() const {
    std::vector<GripperCandidate> out;
    for (const Gripper& g : least_.grippers) {
      const int drive = drive_of(g);
      const GripperActuator& actuator = question_.actuators[drive];
      const auto count = static_cast<int>(question_.requirements.size());
      GripperCandidate& candidate =
          out.emplace_back(GripperCandidate{drive, g.min_opening, g.finger_length, actuator.cost, Bits(count)});
      for (int r = 0; r < count; ++r) {
        const SegmentRequirement& asked = question_.requirements[r];
        if (meets(actuator, g.min_opening, g.finger_length, asked, required_range(asked, question_.options)))
          candidate.parts.set(r);
      }
    }
    return out;
  }

  /// The least set's grippers, each as a candidate that does all that it does at no higher cost.
  void take_over_least() {
    for (std::size_t g = 0; g < least_.grippers.size(); ++g) {
      Bits asked(static_cast<int>(question_.requirements.size()));
      for (std::size_t p = 0; p < least_.gripper_of_part.size(); ++p)
        if (least_.gripper_of_part[p] == static_cast<int>(g)) asked.set(least_.requirement_of_part[p]);
      const auto place = std::find_if(candidates_.begin(), candidates_.end(), [&](const GripperCandidate& c) {
        return c.cost <= question_.actuators[drive_of(least_.grippers[g])].cost && asked.subset_of(c.parts);
      });
      if (place == candidates_.end()) throw std::logic_error("preferred_grippers: a gripper that is no candidate");
      set_.push_back(static_cast<int>(place - candidates_.begin()));
    }
    limit_.changes = least_.changes;
    limit_.gripper_cost = least_.cost - question_.options.change_cost * least_.changes;
    if (!keep_set()) throw std::logic_error("preferred_grippers: the least set cannot be taken over");
  }

  int drive_of(const Gripper& gripper) const {
    const auto place = std::find_if(question_.actuators.begin(), question_.actuators.end(),
                                    [&](const GripperActuator& a) { return a.name == gripper.actuator; });
    return static_cast<int>(place - question_.actuators.begin());
  }

  bool takes(int candidate, int part) const {
    const auto& ways = allowed_[part];
    return std::any_of(ways.begin(), ways.end(), [&](int r) { return candidates_[candidate].parts.test(r); });
  }

  int met_by(int candidate, int part) const {
    const auto& ways = allowed_[part];
    return *std::find_if(ways.begin(), ways.end(), [&](int r) { return candidates_[candidate].parts.test(r); });
  }

  /// Each gripper is kept for as long as one that took all since the last change takes the next part: fewest changes of
  /// a set. False when a part has no taker, or the choice is not as good as the least set.
  bool choose_from(const std::vector<int>& set) {
    GripperChoice choice;
    std::vector<int> holding, used;
    const auto end_run = [&] {
      const auto again = std::find_if(holding.begin(), holding.end(),
                                      [&](int g) { return std::find(used.begin(), used.end(), g) != used.end(); });
      const int gripper = again != holding.end() ? *again : holding.front();
      if (again == holding.end()) {
        used.push_back(gripper);
        choice.gripper_cost += candidates_[gripper].cost;
      }
      choice.of_part.resize(run_end_, gripper);
    };
    run_end_ = 0;
    for (int p = 0; p < parts_.count(); ++p) {
      std::vector<int> next;
      for (const int g : p == 0 ? set : holding)
        if (takes(g, p)) next.push_back(g);
      if (next.empty()) {
        if (p > 0) end_run();
        choice.changes += p > 0;
        if (choice.changes > limit_.changes) return false;
        for (const int g : set)
          if (takes(g, p)) next.push_back(g);
        if (next.empty()) return false;
      }
      holding = std::move(next);
      run_end_ = p + 1;
    }
    end_run();
    if (!as_good(choice)) return false;
    accept(std::move(choice));
    return true;
  }

  bool as_good(const GripperChoice& choice) const {
    const double per_change = question_.options.change_cost;
    return choice.changes <= limit_.changes &&
           choice.gripper_cost + per_change * choice.changes <=
               (limit_.gripper_cost + per_change * limit_.changes) * (1 + kSameCost);
  }

  void accept(GripperChoice choice) {
    choice_ = std::move(choice);
    set_ = choice_.of_part;
    std::sort(set_.begin(), set_.end());
    set_.erase(std::unique(set_.begin(), set_.end()), set_.end());
  }

  bool keep_set() { return choose_from(set_); }

  /// The set at hand with another gripper in place of one: one that meets the requirement.
  bool exchange_one(int requirement) {
    const std::vector<int> set = set_;
    for (std::size_t out = 0; out < set.size(); ++out) {
      for (int g = 0; g < static_cast<int>(candidates_.size()) && !ended(); ++g) {
        if (!candidates_[g].parts.test(requirement)) continue;
        if (candidates_[g].cost > candidates_[set[out]].cost * (1 + kSameCost)) continue;
        std::vector<int> exchanged = set;
        exchanged[out] = g;
        if (choose_from(exchanged)) return true;
      }
    }
    return false;
  }

  /// Any set, by branch and bound.
  bool search() {
    if (nodes_left_ <= 0 || ended()) {
      finished_ = false;
      return false;
    }
    std::vector<GripperCandidate> allowed;
    for (const GripperCandidate& c : candidates_) {
      GripperCandidate& out = allowed.emplace_back(c);
      out.parts = Bits(parts_.count());
    }
    for (int p = 0; p < parts_.count(); ++p) {
      for (int g = 0; g < static_cast<int>(candidates_.size()); ++g)
        if (takes(g, p)) allowed[g].parts.set(p);
    }
    MinimalGrippersOptions options = question_.options;
    options.max_nodes =
        static_cast<int>(std::min<long>(nodes_left_, std::max(1, question_.options.max_nodes / kOneTry)));
    options.time_limit = std::max(clock_.seconds_left(), 1e-3);
    // Where changes cost something, the bound counts them, too.
    const double least_cost = options.change_cost > 0 ? 0 : least_.lower_bound;
    const ChoiceAsGood answer = choice_as_good(allowed, parts_.count(), limit_, least_cost, options, monitor_, prices_);
    nodes_left_ -= answer.nodes;
    finished_ = finished_ && answer.decided;
    if (!answer.found || !as_good(*answer.found)) return false;
    accept(*answer.found);
    return true;
  }

  GripperSetQuestion question_;
  const MinimalGrippersResult& least_;
  const TimeLimit& clock_;
  const Monitor& monitor_;
  NamedParts parts_;
  std::vector<GripperCandidate> candidates_;  // Their `parts` are requirements.
  std::vector<std::vector<int>> allowed_;     // Requirements by part.
  std::vector<int> set_;                      // Candidates at hand,
  GripperChoice choice_;                      // and which of them takes which part.
  GripperChoice limit_;                       // Cost and changes of the least set.
  SearchPrices prices_;                       // Those of the last search.
  int run_end_ = 0;
  long nodes_left_ = 0;
  bool finished_ = true;
};

/// Requirements of a part that are worth more than the one that takes it, highest value first.
std::vector<int> better_ones(const std::vector<SegmentRequirement>& requirements, const std::vector<double>& values,
                             int taken) {
  std::vector<int> out;
  for (int r = 0; r < static_cast<int>(requirements.size()); ++r)
    if (requirements[r].part == requirements[taken].part && values[r] > values[taken] + kSameValue) out.push_back(r);
  std::stable_sort(out.begin(), out.end(), [&](int a, int b) { return values[a] > values[b]; });
  return out;
}

}  // namespace

MinimalGrippersResult preferred_grippers(const std::vector<SegmentRequirement>& requirements,
                                         const std::vector<double>& values,
                                         const std::vector<GripperActuator>& actuators,
                                         const MinimalGrippersOptions& options, const Monitor& monitor) {
  require(values.size() == requirements.size(), "values", values.size(), "must be one per requirement");
  for (const double v : values) require(!std::isnan(v), "values", v, "must be numbers");
  const TimeLimit clock(options.time_limit);
  MinimalGrippersResult result = minimal_grippers(requirements, actuators, options, monitor);
  if (result.grippers.empty()) return result;
  const MinimalGrippersResult least = result;
  Preference preference({requirements, actuators, options}, least, clock, monitor);
  result.preference_finished = false;
  if (!preference.ready()) return result;
  for (int part = 0; part < static_cast<int>(least.parts.size()); ++part) {
    monitor.report("best segments", static_cast<double>(part) / static_cast<double>(least.parts.size()));
    // Held to what takes it now where nothing better does: later parts must not take that away again.
    const int taken = preference.taken(part);
    std::vector<int> tries = better_ones(requirements, values, taken);
    tries.push_back(taken);
    for (const int r : tries)
      if (preference.try_only(part, r)) break;
  }
  preference.write(result);
  return result;
}

}  // namespace mmgrasp
