// paired_order() and optimised_order(): which part of each tray is picked in which round.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/optim/assignment.hpp"
#include "mmgrasp/task/policies.hpp"
#include "task/base_sequence/region_patches.hpp"

namespace mmgrasp {
namespace {

constexpr int kPairingRounds = 20;

/// Parts of `other` matched to those of `tray` so that the distances differ least from their mean: the mean and the
/// matching follow each other until neither changes.
std::vector<int> matched(const std::vector<Eigen::Vector2d>& tray, const std::vector<Eigen::Vector2d>& other) {
  const auto n = static_cast<Eigen::Index>(std::max(tray.size(), other.size()));
  const auto both = [&](Eigen::Index i, Eigen::Index j) {
    return i < static_cast<Eigen::Index>(tray.size()) && j < static_cast<Eigen::Index>(other.size());
  };
  const auto distance = [&](Eigen::Index i, Eigen::Index j) { return (tray[i] - other[j]).norm(); };
  std::vector<int> best;
  double best_spread = 0;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
  for (const auto& p : tray) offset -= p / static_cast<double>(tray.size());
  for (const auto& p : other) offset += p / static_cast<double>(other.size());
  double mean = offset.norm();
  for (int round = 0; round < kPairingRounds; ++round) {
    const Eigen::MatrixXd costs = Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index i, Eigen::Index j) {
      return both(i, j) ? (distance(i, j) - mean) * (distance(i, j) - mean) : 0.0;
    });
    detail::throw_if_interrupted();
    const std::vector<int> match = cheapest_assignment(costs);
    double sum = 0, squares = 0, count = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const int j = match[i];
      if (!both(i, j)) continue;
      sum += distance(i, j);
      squares += distance(i, j) * distance(i, j);
      count += 1;
    }
    const double spread = squares - sum * sum / std::max(1.0, count);
    if (!best.empty() && spread >= best_spread - 1e-15) break;
    best = match;
    best_spread = spread;
    mean = sum / std::max(1.0, count);
  }
  return best;
}

/// The order within one group of trays that share a stop.
class GroupOrder {
 public:
  GroupOrder(const PartRegions& parts, const std::vector<int>& trays, int rounds, const OrderOptions& options)
      : trays_(trays), rounds_(rounds), options_(options) {
    offsets_.push_back(0);
    std::vector<BaseRegion> regions;  // Each part's, as if it lay in a tray of its own.
    for (const int tray : trays) {
      for (const CellMask& mask : parts.cells[tray]) {
        regions.emplace_back();
        regions.back().cells = mask;
      }
      offsets_.push_back(static_cast<int>(regions.size()));
    }
    patches_ = std::make_unique<detail::RegionPatches>(parts.grid, regions);
  }

  using Order = std::vector<std::vector<int>>;  // [tray of the group][round]

  struct Value {
    double smallest = 0, sum = 0;
  };

  /// Best order, and whether that is proven. `order` is where it starts.
  bool improve(Order& order, Value& value) {
    value = value_of(order);
    if (trays_.size() < 2 || rounds_ == 0) return true;
    if (trays_.size() == 2) {
      reassign(order, 1);
      value = value_of(order);
      return true;
    }
    if (orders() <= static_cast<double>(options_.max_tried)) {
      try_all(order, value);
      return true;
    }
    climb(order, value);
    Rng rng(options_.seed);
    for (int restart = 0; restart < options_.restarts; ++restart) {
      Order other = order;
      for (std::size_t t = 1; t < other.size(); ++t) {
        for (std::size_t i = other[t].size(); i > 1; --i) std::swap(other[t][i - 1], other[t][rng.index(i)]);
      }
      Value found = value_of(other);
      climb(other, found);
      if (!better(found, value)) continue;
      order = other;
      value = found;
    }
    return false;
  }

 private:
  bool better(const Value& a, const Value& b) const {
    constexpr double kTie = 1e-9;  // values that differ by less are equally good
    if (options_.smallest_first && std::abs(a.smallest - b.smallest) > kTie) return a.smallest > b.smallest;
    return a.sum > b.sum + kTie;
  }

  /// Number of orders with the first tray's kept.
  double orders() const {
    double factorial = 1;
    for (int i = 2; i <= rounds_; ++i) factorial *= i;
    return std::pow(factorial, static_cast<double>(trays_.size() - 1));
  }

  double radius(const std::vector<int>& picks) {
    detail::throw_if_interrupted();
    std::vector<TrayId> ids;
    for (std::size_t t = 0; t < picks.size(); ++t) ids.emplace_back(offsets_[t] + picks[t]);
    const auto [it, is_new] = known_.try_emplace(ids, 0.0);
    if (is_new) it->second = patches_->widest(ids).radius;
    return it->second;
  }

  std::vector<int> picks_in(const Order& order, int round) const {
    std::vector<int> picks;
    for (const auto& tray : order) picks.push_back(tray[round]);
    return picks;
  }

  Value value_of(const Order& order) {
    Value value;
    for (int round = 0; round < rounds_; ++round) {
      const double r = radius(picks_in(order, round));
      value.smallest = round == 0 ? r : std::min(value.smallest, r);
      value.sum += r;
    }
    return value;
  }

  /// The best order of one tray's parts while the others keep theirs, by assignment of parts to rounds.
  void reassign(Order& order, std::size_t tray) {
    const std::vector<int> parts = order[tray];
    Eigen::MatrixXd radii(rounds_, rounds_);
    for (int round = 0; round < rounds_; ++round) {
      std::vector<int> picks = picks_in(order, round);
      for (int p = 0; p < rounds_; ++p) {
        picks[tray] = parts[p];
        radii(round, p) = radius(picks);
      }
    }
    std::vector<int> best = cheapest_assignment(-radii);
    if (options_.smallest_first) best = with_largest_smallest(radii);
    for (int round = 0; round < rounds_; ++round) order[tray][round] = parts[best[round]];
  }

  /// Bisection over the radii: those below the bound cost more than all others together.
  static std::vector<int> with_largest_smallest(const Eigen::MatrixXd& radii) {
    std::vector<double> values(radii.data(), radii.data() + radii.size());
    std::sort(values.begin(), values.end());
    const double barred = (radii.maxCoeff() + 1) * static_cast<double>(radii.rows() + 1);
    std::vector<int> best;
    std::size_t low = 0, high = values.size();  // values[low] is reached, values[high] is not
    while (high - low > 1 || best.empty()) {
      const std::size_t middle = best.empty() ? 0 : (low + high) / 2;
      const Eigen::MatrixXd costs = radii.unaryExpr([&](double r) { return r < values[middle] ? barred : -r; });
      const std::vector<int> match = cheapest_assignment(costs);
      bool reached = true;
      for (Eigen::Index i = 0; i < radii.rows(); ++i) reached = reached && radii(i, match[i]) >= values[middle];
      if (reached) {
        best = match;
        low = middle;
      } else {
        high = middle;
      }
    }
    return best;
  }

  void climb(Order& order, Value& value) {
    for (bool improved = true; improved;) {
      improved = false;
      for (std::size_t tray = 0; tray < order.size(); ++tray) {
        Order trial = order;
        reassign(trial, tray);
        const Value found = value_of(trial);
        if (!better(found, value)) continue;
        order = std::move(trial);
        value = found;
        improved = true;
      }
    }
  }

  void try_all(Order& order, Value& value) {
    Order trial = order;
    for (std::size_t t = 1; t < trial.size(); ++t) std::sort(trial[t].begin(), trial[t].end());
    while (true) {
      const Value found = value_of(trial);
      if (better(found, value)) {
        value = found;
        order = trial;
      }
      std::size_t t = 1;
      while (t < trial.size() && !std::next_permutation(trial[t].begin(), trial[t].end())) ++t;
      if (t == trial.size()) return;
    }
  }

  std::vector<int> trays_;
  int rounds_;
  const OrderOptions& options_;
  std::vector<int> offsets_;
  std::unique_ptr<detail::RegionPatches> patches_;
  std::map<std::vector<TrayId>, double> known_;
};

}  // namespace

void OrderOptions::check() const {
  require_count(restarts, "restarts", 0);
}

PickingOrder paired_order(const std::vector<std::vector<Eigen::Vector2d>>& places) {
  PickingOrder order;
  for (std::size_t tray = 0; tray < places.size(); ++tray) {
    for (const Eigen::Vector2d& p : places[tray]) require_numbers(p, "places[" + std::to_string(tray) + "]", "m");
    std::vector<int> own(places[tray].size());
    std::iota(own.begin(), own.end(), 0);
    if (tray == 0 || own.empty() || order.back().empty()) {
      order.push_back(own);
      continue;
    }
    std::vector<Eigen::Vector2d> before;  // in the order picked
    std::vector<std::size_t> rounds;      // in which those are picked; then those left for parts without a partner
    for (std::size_t round = 0; round < order.back().size(); ++round) {
      const int part = order.back()[round];
      if (part < 0) continue;
      before.push_back(places[tray - 1][part]);
      rounds.push_back(round);
    }
    for (std::size_t round = 0; rounds.size() < before.size() + own.size(); ++round) {
      if (round >= order.back().size() || order.back()[round] < 0) rounds.push_back(round);
    }
    std::vector<int> picks;
    const std::vector<int> match = matched(before, places[tray]);
    for (std::size_t i = 0; i < match.size(); ++i) {
      if (match[i] >= static_cast<int>(own.size())) continue;
      picks.resize(std::max(picks.size(), rounds[i] + 1), -1);
      picks[rounds[i]] = match[i];
    }
    order.push_back(std::move(picks));
  }
  return order;
}

OptimisedOrder optimised_order(const PartRegions& parts, const std::vector<std::vector<int>>& groups,
                               const PickingOrder& start, const OrderOptions& options) {
  parts.check();
  options.check();
  require(start.size() == parts.cells.size(), "start", static_cast<double>(start.size()), "must have one list a tray");
  std::vector<int> times(start.size(), 0);
  OptimisedOrder result;
  result.order = start;
  double sum = 0;
  std::size_t count = 0;
  for (const std::vector<int>& trays : groups) {
    require(!trays.empty(), "groups", 0, "must not hold an empty group");
    std::vector<std::vector<int>> order;
    for (const int tray : trays) {
      require(tray >= 0 && tray < static_cast<int>(start.size()) && ++times[tray] == 1, "groups", tray,
              "must hold each tray at most once");
      order.push_back(start[tray]);
      std::vector<int> sorted = order.back(), all(parts.cells[tray].size());
      std::sort(sorted.begin(), sorted.end());
      std::iota(all.begin(), all.end(), 0);
      require(sorted == all && order.back().size() == order.front().size(), "start[" + std::to_string(tray) + "]",
              static_cast<double>(sorted.size()),
              "must hold every part of the tray once, as many as the group's others");
    }
    const int rounds = static_cast<int>(order.front().size());
    GroupOrder group(parts, trays, rounds, options);
    GroupOrder::Value value;
    result.proven = group.improve(order, value) && result.proven;
    for (std::size_t t = 0; t < trays.size(); ++t) result.order[trays[t]] = order[t];
    if (rounds == 0) continue;
    result.smallest_radius = count == 0 ? value.smallest : std::min(result.smallest_radius, value.smallest);
    sum += value.sum;
    count += rounds;
  }
  result.mean_radius = count > 0 ? sum / static_cast<double>(count) : 0;
  return result;
}

}  // namespace mmgrasp
