#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "collision/broad/sphere_cover.hpp"
#include "collision/narrow/solid.hpp"
#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// Pose of b in a: before * turn by the first angle about z * between * turn by the second about z * after.
struct RevolutePair {
  Rigid before, between, after;
  std::array<double, 2> rates{};  ///< How fast each turn can close a clearance between the two [m/rad].
};

struct TableBody {
  std::shared_ptr<const Solid> solid;
  std::shared_ptr<const BoundingVolumes> bounds;
};

/// Clearances between two bodies of a robot that two turning joints part, from below, over both angles: cells in three
/// sizes, the clearance in the middle of each measured when first asked for. What a cell says depends on nothing else,
/// so answers do not depend on what was asked before. Safe from several threads.
class MMGRASP_EXPORT ClearanceTable {
 public:
  /// The bodies must outlive it.
  ClearanceTable(const TableBody& a, const TableBody& b, const RevolutePair& joints);
  ~ClearanceTable();

  /// A lower bound of the clearance [m], not above 0 where none is known. Coarse cells are asked first, finer ones
  /// until the bound exceeds `wanted` [m] or cannot.
  double at_least(double first, double second, double wanted) const;

 private:
  static constexpr int kLevels = 3;
  using Code = std::atomic<std::uint8_t>;

  double clearance_in_middle(int level, int i, int j) const;
  double measured(int level, int i, int j) const;
  bool collide(const Rigid& b_in_a, double more) const;
  double widest(int level) const;

  const Solid &a_, &b_;
  const BoundingVolumes &bounds_a_, &bounds_b_;
  const RevolutePair joints_;
  std::array<double, kLevels> within_cell_{};  ///< What the clearance may be less at a cell's corner [m].
  mutable std::once_flag made_[kLevels];
  mutable std::unique_ptr<Code[]> cells_[kLevels];
};

/// The table of two bodies, shared by all that ask and kept as long as they live.
MMGRASP_EXPORT std::shared_ptr<const ClearanceTable> shared_clearance_table(const TableBody& a, const TableBody& b,
                                                                            const RevolutePair& joints);

}  // namespace mmgrasp::detail
