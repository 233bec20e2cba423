#pragma once

#include <cstddef>
#include <vector>

#include "gripper_design/gripper_candidates.hpp"

namespace mmgrasp::detail {

/// Which candidates a bound is of: those that may be chosen, and those of them that are chosen already.
struct CandidateChoice {
  const Bits& allowed;
  const Bits& chosen;
};

/// How often grippers change at least along the order of assembly, with grippers that cost no more than a budget. Each
/// use of a gripper by a part has a price; a gripper is paid for where the prices of its uses exceed its cost
/// (Lagrangian relaxation of "a part is only taken by a gripper that is there"), and the cheapest way through the parts
/// is found by a dynamic programme. Any prices >= 0 prove a bound; subgradient steps raise it.
class ChangePrices {
 public:
  ChangePrices(const std::vector<GripperCandidate>& candidates, int part_count);

  struct Prices {
    std::vector<double> of_use;  ///< One per use, in the order of parts and of candidates.
    double of_cost = 0;          ///< What a unit of gripper cost is worth in changes.
  };

  /// What steps begin with: uses are worth nothing yet, a gripper of the least cost some changes.
  Prices first_prices() const;

  /// Prices by candidate and part (candidate times the number of parts, and the part), and back again.
  Prices compact(const std::vector<double>& of_use, double of_cost) const;
  std::vector<double> spread(const Prices& prices) const;

  struct Goal {
    double budget = 0;  ///< Grippers beside the chosen ones cost no more.
    double enough = 0;  ///< The bound need not be raised beyond.
    int steps = 0;
  };

  /// A bound of the changes of every choice among the allowed candidates within the budget. Begins with `prices` and
  /// leaves the best ones there; ends early when it is told to.
  double raise(const CandidateChoice& among, const Goal& goal, Prices& prices, const Ended& ended);

  /// After raise(): what taking an allowed candidate adds to the bound, when positive.
  double reduced_cost(int candidate) const { return reduced_[candidate]; }

  std::size_t use_count() const { return gripper_of_use_.size(); }
  double work() const { return work_; }  ///< Uses looked at in all steps so far.

 private:
  struct Use {
    int number = 0;        // Number over all candidates.
    int part = 0;          // Part that is taken.
    int gripper = 0;       // Candidate.
    int before = -1;       // The same gripper's place in uses_ for the part before; -1: none.
    bool is_free = false;  // The gripper is chosen.
  };

  void select(const CandidateChoice& among, const Prices& prices);
  double bound(double budget);
  void find_way();
  double turn_direction(double budget);

  const std::vector<GripperCandidate>& candidates_;
  std::vector<int> gripper_of_use_;
  std::vector<std::vector<int>> uses_of_part_;
  std::vector<Use> uses_;              // Those of allowed candidates, part by part;
  std::vector<std::size_t> begin_;     // where those of each part begin.
  std::vector<double> prices_;         // One per place in uses_.
  double of_cost_ = 0;                 // That of Prices.
  std::vector<int> open_;              // Allowed, and not chosen.
  std::vector<double> reduced_;        // One per candidate.
  std::vector<double> reach_;          // What the cheapest way to a place in uses_ costs,
  std::vector<char> stays_;            // and whether it comes from the same gripper.
  std::vector<std::size_t> cheapest_;  // The use by which ways to each part end most cheaply.
  std::vector<std::size_t> way_;       // The use of each part on the cheapest way.
  std::vector<double> direction_;      // Direction of steps, one per place in uses_.
  double cost_direction_ = 0;
  double work_ = 0;
};

}  // namespace mmgrasp::detail
