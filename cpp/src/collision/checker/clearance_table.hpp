#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "collision/broad/sphere_cover.hpp"
#include "collision/narrow/closing.hpp"
#include "collision/narrow/solid.hpp"
#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// The pose of b in a when two revolute joints part them: before * rotation by the first joint's angle about z *
/// between
/// * rotation by the second's about z * after.
struct RevolutePair {
  Rigid before, between, after;
  std::array<double, 2> rates{};  ///< How fast each joint can close a clearance between the two [m/rad].
};

/// One of the two bodies of a table.
struct TableBody {
  std::shared_ptr<const Solid> solid;
  std::shared_ptr<const BoundingVolumes> bounds;
};

/// Lower bounds of the clearance between two bodies of a robot that two revolute joints part, over both angles: cells
/// in three sizes, the clearance in the middle of each measured when first needed. Where that is too little, a cell of
/// the finest size is proven free as a whole, if it is, with the directions in which the bodies' points move. A cell
/// depends on nothing else, so answers do not depend on earlier queries. Safe from several threads.
class MMGRASP_EXPORT ClearanceTable {
 public:
  /// The bodies must outlive it.
  ClearanceTable(const TableBody& a, const TableBody& b, const RevolutePair& joints);
  ~ClearanceTable();

  /// A lower bound of the clearance [m], not above 0 where none is known. Coarse cells are read first, then finer ones
  /// until the bound exceeds `wanted` [m] or cannot.
  double at_least(double first, double second, double wanted) const;
  /// True when the bodies are proven apart at from + k step for every whole k in [first, last]. Both angles.
  bool stays_apart(const std::array<double, 2>& from, const std::array<double, 2>& step, long first, long last) const;

 private:
  static constexpr int kLevels = 3;
  using Code = std::atomic<std::uint8_t>;

  /// The code of a cell: 0 not measured yet, kWholeCell, or 1 + the clearance in its middle in quanta.
  std::uint8_t code(int level, int i, int j) const;
  std::uint8_t measured(int level, int i, int j) const;
  bool collide(const Rigid& b_in_a, const Closing& closing) const;
  /// Whether the bodies are proven apart everywhere in a cell of the finest level.
  bool stays_apart_in_cell(int i, int j) const;
  /// Whether the finest cell at the angles is proven so.
  bool in_whole_cell(double first, double second) const;
  double widest(int level) const;

  const Solid &a_, &b_;
  const BoundingVolumes &bounds_a_, &bounds_b_;
  const RevolutePair joints_;
  std::array<double, kLevels> within_cell_{};  ///< How much less the clearance may be at a cell's corner [m].
  mutable std::once_flag made_[kLevels];
  mutable std::unique_ptr<Code[]> cells_[kLevels];
};

/// The table of two bodies, shared by all checkers and kept as long as the bodies live.
MMGRASP_EXPORT std::shared_ptr<const ClearanceTable> shared_clearance_table(const TableBody& a, const TableBody& b,
                                                                            const RevolutePair& joints);

}  // namespace mmgrasp::detail
