// The grippers that a least set can be chosen from (P1 5.3.4).
#include "gripper_design/gripper_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kEqual = 1e-9;  // [m]
/// Among dearer grippers, the proof of the least set (to 1e-9 of its cost) would not tell the cheap ones apart.
constexpr double kMostTimesLeast = 1e6;

/// One actuator's requirements, and the places where an opening or a finger length may be.
class Places {
 public:
  Places(const std::vector<SegmentRequirement>& requirements, const GripperActuator& actuator,
         const MinimalGrippersOptions& options)
      : actuator_(actuator), options_(options) {
    for (std::size_t r = 0; r < requirements.size(); ++r) {
      const RequiredRange range = required_range(requirements[r], options);
      if (requirements[r].fingers != actuator.fingers || !range.can_be_met(actuator)) continue;
      index_.push_back(static_cast<int>(r));
      ranges_.push_back(range);
      openings_.push_back(requirements[r].opening);
      lengths_.push_back(requirements[r].min_finger_length);
      if (std::isfinite(requirements[r].max_finger_length)) lengths_.push_back(requirements[r].max_finger_length);
    }
  }

  bool empty() const { return index_.empty(); }

  /// Calls `add(min_opening, finger_length)` for grippers of which one takes whatever any gripper takes.
  template <class Add>
  void for_each_exact(const Add& add) const {
    std::vector<double> lows;
    for (const RequiredRange& range : ranges_) {
      lows.push_back(std::min(range.lowest, actuator_.max_opening - actuator_.stroke));
    }
    std::sort(lows.begin(), lows.end());
    lows.erase(std::unique(lows.begin(), lows.end()), lows.end());
    for (const double low : lows) {
      for (const double length : shortest_lengths(low)) add(low, length);
    }
  }

  /// P1's samples: n largest openings from the least that takes the narrowest segment to the widest segment's, and m
  /// lengths between the limits that the segments set.
  template <class Add>
  void for_each_on_grid(const Add& add) const {
    const auto [narrowest, widest] = std::minmax_element(openings_.begin(), openings_.end());
    const auto [shortest, longest] = std::minmax_element(lengths_.begin(), lengths_.end());
    const double first = std::min(*narrowest + actuator_.stroke, *widest);
    for (int i = 0; i < options_.grid_openings; ++i) {
      const double high = std::max(at(first, *widest, i, options_.grid_openings), actuator_.stroke);
      for (int k = 0; k < options_.grid_lengths; ++k) {
        const double length = at(*shortest, *longest, k, options_.grid_lengths);
        add(high - actuator_.stroke, std::clamp(length, options_.shortest_finger, options_.longest_finger));
      }
    }
  }

 private:
  static double at(double from, double to, int i, int count) {
    return count == 1 ? to : from + (to - from) * i / (count - 1);
  }

  /// Finger lengths as short as what they take allows, such that no other one takes more: where the next longer one
  /// would lose something, or nothing longer is asked.
  std::vector<double> shortest_lengths(double low) const {
    std::vector<std::pair<double, double>> ranges;
    for (const RequiredRange& range : ranges_) {
      if (low <= range.lowest + kEqual && range.highest <= low + actuator_.stroke + kEqual)
        ranges.emplace_back(range.shortest, range.longest);
    }
    std::sort(ranges.begin(), ranges.end());
    std::vector<double> lengths;
    double first_end = kInfinity;  // Least upper end of the ranges that the current length takes.
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      if (i > 0 && ranges[i].first > first_end + kEqual) {
        lengths.push_back(ranges[i - 1].first);
        first_end = kInfinity;
        for (std::size_t k = 0; k < i; ++k) {
          if (ranges[k].second >= ranges[i].first - kEqual) first_end = std::min(first_end, ranges[k].second);
        }
      }
      first_end = std::min(first_end, ranges[i].second);
    }
    if (!ranges.empty()) lengths.push_back(ranges.back().first);
    return lengths;
  }

  const GripperActuator& actuator_;
  const MinimalGrippersOptions& options_;
  std::vector<int> index_;
  std::vector<RequiredRange> ranges_;
  std::vector<double> openings_, lengths_;
};

/// Those that take more than any other of no higher cost, in the order given.
std::vector<GripperCandidate> undominated(std::vector<GripperCandidate> all) {
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
  for (const int i : order) {
    const auto beaten = [&](int k) { return all[k].cost <= all[i].cost && all[i].parts.subset_of(all[k].parts); };
    if (std::none_of(kept.begin(), kept.end(), beaten)) kept.push_back(i);
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
  return highest <= actuator.max_opening + kEqual && highest - lowest <= actuator.stroke + kEqual &&
         shortest <= longest + kEqual;
}

RequiredRange required_range(const SegmentRequirement& requirement, const MinimalGrippersOptions& options) {
  RequiredRange range;
  range.lowest = std::max(0.0, requirement.opening - options.opening_margin);
  range.highest = requirement.opening + options.opening_margin;
  range.shortest = std::max(options.shortest_finger, requirement.min_finger_length + options.length_margin);
  range.longest = std::min(options.longest_finger, requirement.max_finger_length - options.length_margin);
  return range;
}

bool meets(const GripperActuator& actuator, double min_opening, double finger_length,
           const SegmentRequirement& requirement, const RequiredRange& range) {
  return requirement.fingers == actuator.fingers && range.can_be_met(actuator) &&
         min_opening <= range.lowest + kEqual && range.highest <= min_opening + actuator.stroke + kEqual &&
         range.shortest <= finger_length + kEqual && finger_length <= range.longest + kEqual;
}

std::vector<GripperCandidate> gripper_candidates(const std::vector<SegmentRequirement>& requirements,
                                                 const std::vector<int>& part_of, int part_count,
                                                 const std::vector<GripperActuator>& actuators,
                                                 const MinimalGrippersOptions& options) {
  std::vector<RequiredRange> ranges;
  for (const SegmentRequirement& r : requirements) ranges.push_back(required_range(r, options));
  std::vector<GripperCandidate> all;
  std::map<std::pair<double, Bits>, int> seen;  // Index by cost and parts.
  for (std::size_t a = 0; a < actuators.size(); ++a) {
    const Places places(requirements, actuators[a], options);
    if (places.empty()) continue;
    const auto add = [&](double min_opening, double finger_length) {
      GripperCandidate candidate{static_cast<int>(a), min_opening, finger_length, actuators[a].cost, Bits(part_count)};
      for (std::size_t r = 0; r < requirements.size(); ++r) {
        if (meets(actuators[a], min_opening, finger_length, requirements[r], ranges[r]))
          candidate.parts.set(part_of[r]);
      }
      if (candidate.parts.first() < 0) return;
      if (seen.emplace(std::make_pair(candidate.cost, candidate.parts), 0).second) all.push_back(std::move(candidate));
    };
    if (options.grid_openings > 0) {
      places.for_each_on_grid(add);
    } else {
      places.for_each_exact(add);
    }
  }
  return undominated(std::move(all));
}

}  // namespace mmgrasp::detail
