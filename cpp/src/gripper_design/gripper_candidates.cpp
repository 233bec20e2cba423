// The grippers that a least set can be chosen from (P1 5.3.4).
#include "gripper_design/gripper_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "mmgrasp/core/detail/lengths.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp::detail {
namespace {

/// Among dearer grippers, the proof of the least set (to 1e-9 of its cost) would not tell the cheap ones apart.
constexpr double kMostTimesLeast = 1e6;

/// One actuator's requirements, by opening, and the places where an opening or a finger length may be.
class Places {
 public:
  Places(const std::vector<SegmentRequirement>& requirements, const GripperActuator& actuator,
         const MinimalGrippersOptions& options, const Ended& ended)
      : actuator_(actuator), options_(options), ended_(ended) {
    for (std::size_t r = 0; r < requirements.size(); ++r) {
      const RequiredRange range = required_range(requirements[r], options);
      if (requirements[r].fingers != actuator.fingers || !range.can_be_met(actuator)) continue;
      asked_.push_back({static_cast<int>(r), range});
      shortest_ = std::min(shortest_, requirements[r].min_finger_length + options.length_margin);
      for (const double length : {requirements[r].min_finger_length + options.length_margin,
                                  requirements[r].max_finger_length - options.length_margin})
        if (std::isfinite(length)) longest_ = std::max(longest_, length);
    }
    std::stable_sort(asked_.begin(), asked_.end(),
                     [](const Asked& a, const Asked& b) { return a.range.highest < b.range.highest; });
  }

  bool empty() const { return asked_.empty(); }

  /// Calls `add(min_opening, finger_length, requirements taken)` for grippers of which one takes whatever any takes.
  template <class Add>
  void for_each_exact(const Add& add) const {
    std::vector<double> lows;
    for (const Asked& a : asked_) lows.push_back(std::min(a.range.lowest, actuator_.max_opening - actuator_.stroke));
    lows.erase(std::unique(lows.begin(), lows.end()), lows.end());
    for (const double low : lows) {
      const std::vector<Asked> within = between(low);
      for (const double length : shortest_lengths(within)) {
        if (ended_()) return;
        add(low, length, taken(within, length));
      }
    }
  }

  /// P1's samples: n largest openings from the least that takes the narrowest segment to the one that takes the widest
  /// segment, and m lengths between the limits that the segments set, margins counted.
  template <class Add>
  void for_each_on_grid(const Add& add) const {
    const double widest = asked_.back().range.highest;
    const double first = std::min(asked_.front().range.lowest + actuator_.stroke, widest);
    for (int i = 0; i < options_.grid_openings; ++i) {
      const double high = std::max(at(first, widest, i, options_.grid_openings), actuator_.stroke);
      const std::vector<Asked> within = between(high - actuator_.stroke);
      for (int k = 0; k < options_.grid_lengths; ++k) {
        if (ended_()) return;
        const double length = std::clamp(at(shortest_, longest_, k, options_.grid_lengths), options_.shortest_finger,
                                         options_.longest_finger);
        add(high - actuator_.stroke, length, taken(within, length));
      }
    }
  }

 private:
  struct Asked {
    int requirement;
    RequiredRange range;
  };

  static double at(double from, double to, int i, int count) {
    return count == 1 ? to : from + (to - from) * i / (count - 1);
  }

  /// What lies between the openings of a gripper that opens from `low`, by the shortest fingers asked.
  std::vector<Asked> between(double low) const {
    const auto begin = std::partition_point(asked_.begin(), asked_.end(),
                                            [&](const Asked& a) { return !at_most(low, a.range.highest); });
    const auto end = std::partition_point(
        begin, asked_.end(), [&](const Asked& a) { return at_most(a.range.highest, low + actuator_.stroke); });
    std::vector<Asked> out;
    // Unequal clearances: what opens widest need not close least.
    std::copy_if(begin, end, std::back_inserter(out),
                 [&](const Asked& a) { return at_most(low, a.range.lowest) && at_most(a.range.least_closed, low); });
    std::sort(out.begin(), out.end(), [](const Asked& a, const Asked& b) {
      return std::make_pair(a.range.shortest, a.range.longest) < std::make_pair(b.range.shortest, b.range.longest);
    });
    return out;
  }

  static std::vector<int> taken(const std::vector<Asked>& within, double length) {
    std::vector<int> out;
    for (const Asked& a : within) {
      if (!at_most(a.range.shortest, length)) break;
      if (at_most(length, a.range.longest)) out.push_back(a.requirement);
    }
    return out;
  }

  /// Finger lengths as short as what they take allows, such that no other one takes more: where the next longer one
  /// would lose something, or nothing longer is asked.
  static std::vector<double> shortest_lengths(const std::vector<Asked>& within) {
    std::vector<double> lengths;
    double first_end = kInfinity;  // Least upper end of the ranges that the current length takes.
    for (std::size_t i = 0; i < within.size(); ++i) {
      const RequiredRange& range = within[i].range;
      if (i > 0 && !at_most(range.shortest, first_end)) {
        lengths.push_back(within[i - 1].range.shortest);
        first_end = kInfinity;
        for (std::size_t k = 0; k < i; ++k) {
          const double end = within[k].range.longest;
          if (at_most(range.shortest, end)) first_end = std::min(first_end, end);
        }
      }
      first_end = std::min(first_end, range.longest);
    }
    if (!within.empty()) lengths.push_back(within.back().range.shortest);
    return lengths;
  }

  const GripperActuator& actuator_;
  const MinimalGrippersOptions& options_;
  const Ended& ended_;
  std::vector<Asked> asked_;                            // Sorted by opening.
  double shortest_ = kInfinity, longest_ = -kInfinity;  // Finger lengths asked.
};

/// Candidates of different cost or parts, in the order in which they were added.
class DistinctCandidates {
 public:
  void add(GripperCandidate candidate) {
    std::uint64_t mixed = 0;
    for (int p = candidate.parts.first(); p >= 0; p = candidate.parts.next(p + 1))
      mixed = (mixed ^ static_cast<std::uint64_t>(p + 1)) * 0x9E3779B97F4A7C15ull + (mixed >> 29);
    const auto [begin, end] = known_.equal_range(mixed);
    const bool again = std::any_of(begin, end, [&](const auto& entry) {
      const GripperCandidate& other = all_[entry.second];
      return other.cost == candidate.cost && other.parts.subset_of(candidate.parts) &&
             candidate.parts.subset_of(other.parts);
    });
    if (again) return;
    known_.emplace(mixed, static_cast<int>(all_.size()));
    all_.push_back(std::move(candidate));
  }

  std::vector<GripperCandidate> take() { return std::move(all_); }

 private:
  std::vector<GripperCandidate> all_;
  std::unordered_multimap<std::uint64_t, int> known_;  // Keys are mixtures of the parts.
};

/// Those that take more than any other of no higher cost, in the order given. What takes all of a candidate's parts
/// takes the one of them that fewest of those kept take.
std::vector<GripperCandidate> undominated(std::vector<GripperCandidate> all, int part_count, const Ended& ended) {
  std::vector<int> order(all.size());
  std::vector<int> sizes(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    order[i] = static_cast<int>(i);
    sizes[i] = all[i].parts.count();
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return sizes[a] != sizes[b] ? sizes[a] > sizes[b] : all[a].cost < all[b].cost;
  });
  std::vector<int> kept;
  std::vector<std::vector<int>> takers(part_count);  // Kept candidates by part.
  for (const int i : order) {
    if (ended()) break;
    const Bits& parts = all[i].parts;
    int rarest = parts.first();
    for (int p = rarest; p >= 0; p = parts.next(p + 1))
      if (takers[p].size() < takers[rarest].size()) rarest = p;
    const auto beaten = [&](int k) { return all[k].cost <= all[i].cost && parts.subset_of(all[k].parts); };
    if (std::any_of(takers[rarest].begin(), takers[rarest].end(), beaten)) continue;
    kept.push_back(i);
    for (int p = parts.first(); p >= 0; p = parts.next(p + 1)) takers[p].push_back(i);
  }
  std::sort(kept.begin(), kept.end());
  std::vector<GripperCandidate> out;
  for (const int i : kept) out.push_back(std::move(all[i]));
  return out;
}

}  // namespace

void check_actuators(const std::vector<GripperActuator>& actuators) {
  if (actuators.empty()) throw InvalidInput("actuators is empty: name at least one drive");
  std::set<std::string> names;
  for (const GripperActuator& a : actuators) {
    const std::string of = " of actuator '" + a.name + "'";
    if (a.name.empty()) throw InvalidInput("name of an actuator is empty: every actuator must have one");
    if (!names.insert(a.name).second) throw InvalidInput("actuator '" + a.name + "' is there twice: names must differ");
    require(a.fingers == 2 || a.fingers == 3, "fingers" + of, a.fingers, "must be 2 or 3");
    require_positive(a.stroke, "stroke" + of, "m");
    require(a.max_opening >= a.stroke, "max_opening" + of, a.max_opening, "must be at least the stroke [m]");
    require_positive(a.cost, "cost" + of, "", kLargestNumber);
  }
  const double least = std::min_element(actuators.begin(), actuators.end(), [](const auto& a, const auto& b) {
                         return a.cost < b.cost;
                       })->cost;
  for (const GripperActuator& a : actuators) {
    require(a.cost <= kMostTimesLeast * least, "cost of actuator '" + a.name + "'", a.cost,
            "must be at most 1e6 times the least one");
  }
}

bool RequiredRange::can_be_met(const GripperActuator& actuator) const {
  return at_most(highest, actuator.max_opening) && at_most(highest - lowest, actuator.stroke) &&
         at_most(actuator.stroke, longest_stroke) && at_most(shortest, longest) &&
         at_most(least_closed, std::min(lowest, actuator.max_opening - actuator.stroke));
}

RequiredRange required_range(const SegmentRequirement& requirement, const MinimalGrippersOptions& options) {
  RequiredRange range;
  range.lowest = std::max(0.0, requirement.opening - options.opening_margin);
  range.highest = requirement.opening + std::max(options.opening_margin, 2 * requirement.clearance);
  range.least_closed = requirement.least_min_opening;
  range.longest_stroke = requirement.max_stroke;
  range.shortest = std::max(options.shortest_finger, requirement.min_finger_length + options.length_margin);
  range.longest = std::min(options.longest_finger, requirement.max_finger_length - options.length_margin);
  return range;
}

bool meets(const GripperActuator& actuator, double min_opening, double finger_length,
           const SegmentRequirement& requirement, const RequiredRange& range) {
  return requirement.fingers == actuator.fingers && range.can_be_met(actuator) &&
         at_most(range.least_closed, min_opening) && at_most(min_opening, range.lowest) &&
         at_most(range.highest, min_opening + actuator.stroke) && at_most(range.shortest, finger_length) &&
         at_most(finger_length, range.longest);
}

std::optional<std::vector<GripperCandidate>> gripper_candidates(const std::vector<SegmentRequirement>& requirements,
                                                                const std::vector<int>& part_of, int part_count,
                                                                const std::vector<GripperActuator>& actuators,
                                                                const MinimalGrippersOptions& options,
                                                                const Ended& ended) {
  DistinctCandidates distinct;
  for (std::size_t a = 0; a < actuators.size(); ++a) {
    const Places places(requirements, actuators[a], options, ended);
    if (places.empty()) continue;
    const auto add = [&](double min_opening, double finger_length, const std::vector<int>& taken) {
      GripperCandidate candidate{static_cast<int>(a), min_opening, finger_length, actuators[a].cost, Bits(part_count)};
      for (const int r : taken) candidate.parts.set(part_of[r]);
      if (!taken.empty()) distinct.add(std::move(candidate));
    };
    if (options.grid_openings > 0) {
      places.for_each_on_grid(add);
    } else {
      places.for_each_exact(add);
    }
  }
  std::vector<GripperCandidate> out = undominated(distinct.take(), part_count, ended);
  if (ended()) return std::nullopt;
  return out;
}

}  // namespace mmgrasp::detail
