#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/gripper_design/minimal_grippers.hpp"

namespace mmgrasp::test {

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

inline SegmentRequirement segment(const std::string& part, int fingers, double opening, double shortest = 0,
                                  double longest = kInfinite) {
  return {part, "", fingers, opening, shortest, longest};
}

/// Figure 5.13 of P1 in millimetres at full size; part 7 has one of its eight segments twice removed: all widths count.
inline std::vector<SegmentRequirement> figure_5_13(double scale) {
  struct Row {
    const char* part;
    int fingers;
    double opening, shortest;
  };
  const Row rows[] = {{"1", 3, 227, 0},  {"2", 3, 227, 0},  {"3", 3, 110, 0},   {"4", 3, 25, 0},
                      {"5", 3, 32, 0},   {"5", 3, 40, 41},  {"6", 3, 18, 0},    {"7", 2, 16.7, 0},
                      {"7", 2, 19.1, 0}, {"7", 2, 17.2, 0}, {"7", 2, 15.9, 0},  {"7", 2, 16.5, 0},
                      {"7", 2, 15.8, 0}, {"7", 2, 16.9, 0}, {"7", 2, 18.5, 0},  {"8", 2, 60, 0},
                      {"8", 3, 40, 50},  {"9", 3, 32, 0},   {"9", 3, 40, 41},   {"10", 2, 17, 4.5},
                      {"11", 3, 20, 0},  {"12", 2, 15, 0},  {"12", 2, 32.8, 0}, {"13", 3, 37.5, 22.7}};
  std::vector<SegmentRequirement> out;
  for (const Row& r : rows) {
    out.push_back(segment(r.part, r.fingers, 1e-3 * scale * r.opening, 1e-3 * scale * r.shortest));
  }
  return out;
}

inline const std::vector<GripperActuator> kAirChucks{{"SMC MHF2-12D2", 2, 0.048}, {"SMC MHSL3-32D", 3, 0.008}};

/// Least cost, then fewest changes, by trying every set of grippers at every pair of ends: openings that begin or end
/// at a segment's width, finger lengths at either limit.
struct BruteForce {
  struct Candidate {
    double cost;
    unsigned parts;
  };
  std::vector<Candidate> candidates;
  std::vector<std::string> parts;

  BruteForce(const std::vector<SegmentRequirement>& requirements, const std::vector<GripperActuator>& actuators,
             const MinimalGrippersOptions& options) {
    for (const auto& r : requirements) {
      if (std::find(parts.begin(), parts.end(), r.part) == parts.end()) parts.push_back(r.part);
    }
    for (const auto& a : actuators) {
      std::vector<double> lows{0, a.max_opening - a.stroke}, lengths{options.shortest_finger, options.longest_finger};
      for (const auto& r : requirements) {
        for (const double low : {r.opening, r.opening + 2 * r.clearance - a.stroke, r.least_min_opening})
          lows.push_back(low);
        for (const double length : {r.min_finger_length, r.max_finger_length}) lengths.push_back(length);
      }
      for (const double low : lows) {
        if (low < 0 || !(low + a.stroke <= a.max_opening + 1e-9)) continue;
        for (const double length : lengths) {
          if (length < options.shortest_finger || length > options.longest_finger) continue;
          add(requirements, a, low, length);
        }
      }
    }
  }

  void add(const std::vector<SegmentRequirement>& requirements, const GripperActuator& a, double low, double length) {
    unsigned mask = 0;
    for (const auto& r : requirements) {
      const bool holds = r.fingers == a.fingers && a.stroke <= r.max_stroke + 1e-9 &&
                         r.least_min_opening <= low + 1e-9 && low <= r.opening + 1e-9 &&
                         r.opening + 2 * r.clearance <= low + a.stroke + 1e-9 && r.min_finger_length <= length + 1e-9 &&
                         length <= r.max_finger_length + 1e-9;
      if (holds) mask |= 1u << (std::find(parts.begin(), parts.end(), r.part) - parts.begin());
    }
    for (const auto& c : candidates) {
      if (c.parts == mask && c.cost == a.cost) return;
    }
    if (mask) candidates.push_back({a.cost, mask});
  }

  int changes(const std::vector<int>& chosen) const {
    std::vector<int> best(chosen.size(), 0);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const int least = *std::min_element(best.begin(), best.end());
      for (std::size_t g = 0; g < chosen.size(); ++g) {
        const bool takes = candidates[chosen[g]].parts >> p & 1;
        best[g] = takes ? std::min(best[g], least + (p > 0)) : 1000;
      }
    }
    return *std::min_element(best.begin(), best.end());
  }

  std::pair<double, int> least(double change_cost) const {
    std::pair<double, int> best{kInfinite, 0};
    std::vector<int> chosen;
    search(0, 0, 0, change_cost, chosen, best);
    return best;
  }

  void search(std::size_t next, unsigned covered, double cost, double change_cost, std::vector<int>& chosen,
              std::pair<double, int>& best) const {
    if (cost > best.first + 1e-9) return;
    if (covered == (1u << parts.size()) - 1) {
      const int needed = changes(chosen);
      const double total = cost + change_cost * needed;
      if (total < best.first - 1e-9 || (total < best.first + 1e-9 && needed < best.second)) best = {total, needed};
    }
    for (std::size_t g = next; g < candidates.size(); ++g) {
      chosen.push_back(static_cast<int>(g));
      search(g + 1, covered | candidates[g].parts, cost + candidates[g].cost, change_cost, chosen, best);
      chosen.pop_back();
    }
  }
};

inline void expect_complete(const MinimalGrippersResult& r, const std::vector<SegmentRequirement>& requirements) {
  ASSERT_EQ(r.gripper_of_part.size(), r.parts.size());
  int changes = 0;
  for (std::size_t p = 0; p < r.parts.size(); ++p) {
    const SegmentRequirement& taken = requirements.at(r.requirement_of_part[p]);
    EXPECT_EQ(taken.part, r.parts[p]);
    EXPECT_TRUE(r.grippers.at(r.gripper_of_part[p]).holds(taken)) << taken.name();
    changes += p > 0 && r.gripper_of_part[p] != r.gripper_of_part[p - 1];
  }
  EXPECT_EQ(changes, r.changes);
}

}  // namespace mmgrasp::test
