#pragma once

#include <cstdint>
#include <vector>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/task/ids.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp::detail {

/// All grasps of a problem, numbered through, with what is known of each whatever the base pose: the opening of the
/// fingers at the pre-grasp, and whether the open hand alone touches something there.
class GraspTable {
 public:
  /// All grasps count as blocked until find_blocked() has checked them. The problem must outlive the table.
  explicit GraspTable(const PartSupplyProblem& problem);

  /// Number of the first grasp of a part; its others follow.
  int first(PartRef part) const { return first_[part.tray][part.part]; }
  std::size_t size() const { return opening_.size(); }
  /// Openings that occur [m]; those that differ by rounding are one.
  const std::vector<double>& openings() const { return openings_; }
  /// Index into openings().
  int opening(int grasp) const { return opening_[grasp]; }
  bool blocked(int grasp) const { return blocked_[grasp] != 0; }

  /// Checks the hand alone at those grasps of these parts that are blocked so far.
  void find_blocked(const std::vector<PartRef>& parts, const World& world);

 private:
  const PartSupplyProblem* problem_;
  std::vector<std::vector<int>> first_;  // [tray][part]
  std::vector<double> openings_;
  std::vector<int> opening_;
  std::vector<std::uint8_t> blocked_;
};

}  // namespace mmgrasp::detail
