#include "optim/set_cover/set_cover_reduction.hpp"

#include <algorithm>

namespace mmgrasp::detail {

namespace {

/// Drops sets and elements that another one dominates, and takes sets that alone hold an element, until nothing
/// changes.
class Reduction {
 public:
  explicit Reduction(const SetCoverProblem& problem)
      : problem_(problem),
        set_alive_(problem.sets.size(), true),
        element_alive_(problem.elements, true),
        elements_of_(problem.sets.size(), Bits(problem.elements)),
        sets_of_(problem.elements, Bits(static_cast<int>(problem.sets.size()))) {
    for (int s = 0; s < set_count(); ++s) {
      for (int e : problem.sets[s]) {
        elements_of_[s].set(e);
        sets_of_[e].set(s);
      }
    }
  }

  ReducedCover run() {
    bool changed = true;
    while (changed) {
      changed = take_forced_sets();
      changed |= drop_dominated_sets();
      changed |= drop_dominated_elements();
    }
    ReducedCover result;
    result.forced = forced_;
    std::sort(result.forced.begin(), result.forced.end());
    for (int s = 0; s < set_count(); ++s) {
      if (set_alive_[s]) result.sets.push_back(s);
    }
    for (int e = 0; e < problem_.elements; ++e) {
      if (element_alive_[e]) result.elements.push_back(e);
    }
    return result;
  }

 private:
  int set_count() const { return static_cast<int>(problem_.sets.size()); }
  double cost(int s) const { return problem_.costs.empty() ? 1.0 : problem_.costs[s]; }

  void drop_set(int s) {
    set_alive_[s] = false;
    for (int e : problem_.sets[s]) sets_of_[e].reset(s);
  }

  void drop_element(int e) {
    element_alive_[e] = false;
    for (int s = 0; s < set_count(); ++s) {
      if (set_alive_[s]) elements_of_[s].reset(e);
    }
  }

  bool take_forced_sets() {
    bool changed = false;
    for (int e = 0; e < problem_.elements; ++e) {
      if (!element_alive_[e] || sets_of_[e].count() != 1) continue;
      const int s = sets_of_[e].first();
      forced_.push_back(s);
      for (int covered : problem_.sets[s]) {
        if (element_alive_[covered]) drop_element(covered);
      }
      drop_set(s);
      changed = true;
    }
    return changed;
  }

  bool drop_dominated_sets() {
    bool changed = false;
    for (int s = 0; s < set_count(); ++s) {
      if (!set_alive_[s]) continue;
      const int element = elements_of_[s].first();
      bool dominated = element < 0;
      // A dominating set contains every element of s, so looking through the sets of one of them is enough.
      for (int t = 0; !dominated && t < set_count(); ++t) {
        if (t == s || !sets_of_[element].test(t) || cost(t) > cost(s) || !elements_of_[s].subset_of(elements_of_[t]))
          continue;
        const bool twins = cost(t) == cost(s) && elements_of_[t].subset_of(elements_of_[s]);
        dominated = !twins || t < s;
      }
      if (!dominated) continue;
      drop_set(s);
      changed = true;
    }
    return changed;
  }

  bool drop_dominated_elements() {
    bool changed = false;
    for (int e = 0; e < problem_.elements; ++e) {
      if (!element_alive_[e]) continue;
      bool implied = false;
      for (int f = 0; !implied && f < problem_.elements; ++f) {
        if (f == e || !element_alive_[f] || !sets_of_[f].subset_of(sets_of_[e])) continue;
        implied = !sets_of_[e].subset_of(sets_of_[f]) || f < e;
      }
      if (!implied) continue;
      drop_element(e);
      changed = true;
    }
    return changed;
  }

  const SetCoverProblem& problem_;
  std::vector<bool> set_alive_, element_alive_;
  std::vector<Bits> elements_of_, sets_of_;
  std::vector<int> forced_;
};

}  // namespace

ReducedCover reduce_set_cover(const SetCoverProblem& problem) {
  return Reduction(problem).run();
}

}  // namespace mmgrasp::detail
