// preferred_grippers: the least set again, with each part held to its best segment as long as the set stays as good.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/gripper_design/minimal_grippers.hpp"

namespace mmgrasp {
namespace {

using detail::TimeLimit;

constexpr double kSameCost = 1e-9, kSameValue = 1e-9;

/// Requirements by number, those of one part together, parts in the order in which they are first named: so that the
/// order of assembly stays when some are left out.
std::vector<int> by_part(const std::vector<SegmentRequirement>& requirements) {
  std::map<std::string, int> first;
  for (const SegmentRequirement& r : requirements) first.emplace(r.part, static_cast<int>(first.size()));
  std::vector<int> out(requirements.size());
  std::iota(out.begin(), out.end(), 0);
  std::stable_sort(out.begin(), out.end(),
                   [&](int a, int b) { return first[requirements[a].part] < first[requirements[b].part]; });
  return out;
}

/// Which requirements each part may be taken by; some are struck out as parts are held to their best.
class Preference {
 public:
  Preference(const std::vector<SegmentRequirement>& requirements, const std::vector<GripperActuator>& actuators,
             const MinimalGrippersOptions& options, const Monitor& monitor)
      : requirements_(requirements),
        actuators_(actuators),
        options_(options),
        monitor_(monitor),
        clock_(options.time_limit) {
    allowed_ = by_part(requirements);
    best_ = solve(allowed_);
  }

  /// Holds a part to one requirement, if the set stays as good with it.
  bool try_only(int requirement) {
    std::vector<int> left;
    for (const int r : allowed_)
      if (r == requirement || requirements_[r].part != requirements_[requirement].part) left.push_back(r);
    MinimalGrippersResult found = solve(left);
    if (found.grippers.empty() || !found.uncovered.empty() || found.outcome == Outcome::stopped) return false;
    if (found.cost > best_.cost + kSameCost || found.changes > best_.changes) return false;
    found.outcome = best_.outcome;  // what is proven of all requirements, not of these alone
    found.lower_bound = best_.lower_bound;
    found.changes_bound = best_.changes_bound;
    found.candidates = best_.candidates;
    best_ = std::move(found);
    allowed_ = std::move(left);
    return true;
  }

  const MinimalGrippersResult& best() const { return best_; }
  bool ended() const { return monitor_.stopped() || clock_.expired(); }

 private:
  MinimalGrippersResult solve(const std::vector<int>& allowed) const {
    std::vector<SegmentRequirement> some;
    some.reserve(allowed.size());
    for (const int r : allowed) some.push_back(requirements_[r]);
    MinimalGrippersOptions rest = options_;
    rest.time_limit = std::max(clock_.seconds_left(), 1e-3);
    MinimalGrippersResult found = minimal_grippers(some, actuators_, rest, monitor_);
    for (int& r : found.requirement_of_part) r = allowed[r];
    return found;
  }

  const std::vector<SegmentRequirement>& requirements_;
  const std::vector<GripperActuator>& actuators_;
  const MinimalGrippersOptions& options_;
  const Monitor& monitor_;
  TimeLimit clock_;
  std::vector<int> allowed_;
  MinimalGrippersResult best_;
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
  Preference preference(requirements, actuators, options, monitor);
  const auto parts = static_cast<int>(preference.best().requirement_of_part.size());
  for (int part = 0; part < parts; ++part) {
    // Held to what takes it now where nothing better does: later parts must not take that away again.
    const int taken = preference.best().requirement_of_part[part];
    std::vector<int> tries = better_ones(requirements, values, taken);
    tries.push_back(taken);
    for (const int r : tries) {
      if (preference.ended()) return preference.best();
      if (preference.try_only(r)) break;
    }
  }
  return preference.best();
}

}  // namespace mmgrasp
