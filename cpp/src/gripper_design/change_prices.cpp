#include "gripper_design/change_prices.hpp"

#include <algorithm>
#include <utility>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kStallLimit = 50;      // Steps without a better bound before they are shortened,
constexpr double kShorter = 0.8;     // to this share.
constexpr double kLeastGain = 1e-3;  // A bound that is better by less is no better,
constexpr double kShortest = 1e-6;   // and steps of a smaller share than this are none.
constexpr double kNewShare = 0.03;   // Share of a direction that is new: the rest is that of the step before.
constexpr double kFirstWorth = 3;    // What the cheapest gripper is worth at first, in changes.
constexpr double kRounding = 1e-12;  // Share of all terms that roundings may have added to a bound.

}  // namespace

ChangePrices::ChangePrices(const std::vector<GripperCandidate>& candidates, int part_count)
    : candidates_(candidates),
      uses_of_part_(part_count),
      reduced_(candidates.size(), 0.0),
      cheapest_(part_count),
      way_(part_count) {
  for (int p = 0; p < part_count; ++p) {
    for (int g = 0; g < static_cast<int>(candidates.size()); ++g) {
      if (!candidates[g].parts.test(p)) continue;
      uses_of_part_[p].push_back(static_cast<int>(use_count()));
      gripper_of_use_.push_back(g);
    }
  }
}

ChangePrices::Prices ChangePrices::first_prices() const {
  double least = kInfinity;
  for (const GripperCandidate& c : candidates_) least = std::min(least, c.cost);
  return {std::vector<double>(use_count(), 0.0), kFirstWorth / least};
}

ChangePrices::Prices ChangePrices::compact(const std::vector<double>& of_use, double of_cost) const {
  Prices out{{}, of_cost};
  for (std::size_t p = 0; p < uses_of_part_.size(); ++p)
    for (const int u : uses_of_part_[p]) out.of_use.push_back(of_use[gripper_of_use_[u] * uses_of_part_.size() + p]);
  return out;
}

std::vector<double> ChangePrices::spread(const Prices& prices) const {
  std::vector<double> out(candidates_.size() * uses_of_part_.size(), 0.0);
  for (std::size_t p = 0; p < uses_of_part_.size(); ++p)
    for (const int u : uses_of_part_[p]) out[gripper_of_use_[u] * uses_of_part_.size() + p] = prices.of_use[u];
  return out;
}

double ChangePrices::raise(const CandidateChoice& among, const Goal& goal, Prices& prices, const Ended& ended) {
  select(among, prices);
  std::vector<double> best_prices = prices_;
  double best_of_cost = of_cost_, best = -kInfinity, share = 1;
  int since = 0;
  for (int k = 0; k < goal.steps && share > kShortest; ++k) {
    const double reached = bound(goal.budget);
    since = reached > best + kLeastGain ? 0 : since + 1;
    if (reached > best) {
      best = reached;
      best_prices = prices_;
      best_of_cost = of_cost_;
    }
    if (best > goal.enough || ended()) break;
    if (since > kStallLimit) {
      since = 0;
      share *= kShorter;
      prices_ = best_prices;
      of_cost_ = best_of_cost;
      continue;
    }
    const double squares = turn_direction(goal.budget);
    if (squares == 0) break;
    const double length = share * (goal.enough + 1 - reached) / squares;
    for (std::size_t i = 0; i < uses_.size(); ++i) prices_[i] = std::max(0.0, prices_[i] + length * direction_[i]);
    of_cost_ = std::max(0.0, of_cost_ + length * cost_direction_);
  }
  prices_ = std::move(best_prices);
  of_cost_ = best_of_cost;
  for (std::size_t i = 0; i < uses_.size(); ++i) prices.of_use[uses_[i].number] = prices_[i];
  prices.of_cost = of_cost_;
  return bound(goal.budget);
}

void ChangePrices::select(const CandidateChoice& among, const Prices& prices) {
  open_.clear();
  for (int g = among.allowed.first(); g >= 0; g = among.allowed.next(g + 1))
    if (!among.chosen.test(g)) open_.push_back(g);
  std::vector<int> last(candidates_.size(), -1);
  uses_.clear();
  begin_.clear();
  for (std::size_t p = 0; p < uses_of_part_.size(); ++p) {
    begin_.push_back(uses_.size());
    for (const int number : uses_of_part_[p]) {
      const int g = gripper_of_use_[number];
      if (!among.allowed.test(g)) continue;
      const bool goes_on = last[g] >= 0 && uses_[last[g]].part + 1 == static_cast<int>(p);
      uses_.push_back({number, static_cast<int>(p), g, goes_on ? last[g] : -1, among.chosen.test(g)});
      last[g] = static_cast<int>(uses_.size()) - 1;
    }
  }
  begin_.push_back(uses_.size());
  reach_.resize(uses_.size());
  stays_.resize(uses_.size());
  direction_.assign(uses_.size(), 0.0);
  cost_direction_ = 0;
  prices_.clear();
  for (const Use& u : uses_) prices_.push_back(u.is_free ? 0 : prices.of_use[u.number]);
  of_cost_ = prices.of_cost;
}

double ChangePrices::bound(double budget) {
  work_ += static_cast<double>(uses_.size());
  find_way();
  for (const int g : open_) reduced_[g] = of_cost_ * candidates_[g].cost;
  for (std::size_t i = 0; i < uses_.size(); ++i) reduced_[uses_[i].gripper] -= prices_[i];
  double sum = reach_[way_.back()] - of_cost_ * budget, terms = reach_[way_.back()] + of_cost_ * budget;
  for (const int g : open_) {
    sum += std::min(0.0, reduced_[g]);
    terms += 2 * of_cost_ * candidates_[g].cost - reduced_[g];
  }
  return sum - kRounding * terms;
}

void ChangePrices::find_way() {
  for (std::size_t p = 0; p + 1 < begin_.size(); ++p) {
    const double changed = p == 0 ? 0 : reach_[cheapest_[p - 1]] + 1;
    cheapest_[p] = begin_[p];
    for (std::size_t i = begin_[p]; i < begin_[p + 1]; ++i) {
      const int before = uses_[i].before;
      stays_[i] = before >= 0 && reach_[before] < changed;
      reach_[i] = (stays_[i] ? reach_[before] : changed) + prices_[i];
      if (reach_[i] < reach_[cheapest_[p]]) cheapest_[p] = i;
    }
  }
  std::size_t at = cheapest_.back();
  for (std::size_t p = way_.size(); p-- > 0;) {
    way_[p] = at;
    if (p > 0) at = stays_[at] ? static_cast<std::size_t>(uses_[at].before) : cheapest_[p - 1];
  }
}

/// Turns the direction of steps towards the slopes at the prices at hand; its square.
double ChangePrices::turn_direction(double budget) {
  double spent = 0, squares = 0;
  for (const int g : open_)
    if (reduced_[g] < 0) spent += candidates_[g].cost;
  const auto turn = [&](double& direction, double slope, double price) {
    direction = (1 - kNewShare) * direction + kNewShare * slope;
    if (price == 0 && direction < 0) direction = 0;
    squares += direction * direction;
  };
  turn(cost_direction_, spent - budget, of_cost_);
  for (std::size_t i = 0; i < uses_.size(); ++i) {
    const Use& u = uses_[i];
    if (u.is_free) continue;
    const double on_way = way_[u.part] == i ? 1 : 0, paid = reduced_[u.gripper] < 0 ? 1 : 0;
    turn(direction_[i], on_way - paid, prices_[i]);
  }
  return squares;
}

}  // namespace mmgrasp::detail
