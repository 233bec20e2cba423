#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "collision/moving_frames.hpp"
#include "collision/solid.hpp"

namespace mmgrasp::detail {

struct BodyShape;

/// The one to three joints between two bodies of which one hangs below the other, and where the bodies sit.
struct PairChain {
  struct Axis {
    Rigid before;               ///< The frame before it moves, in the frame of the axis above (z is the axis).
    double multiplier, offset;  ///< Joint value = multiplier * q[column] + offset.
    int column;
    bool slides;                 ///< Along z rather than about it.
    double low, size, per_size;  ///< Values that the table covers [rad or m]; per_size = 1 / size.
    bool wraps;                  ///< All of a turn.
  };
  static constexpr int kMaxAxes = 3;

  Rigid upper_in_frame, lower_in_frame;
  std::vector<Axis> axes;  ///< From the upper body to the lower one.
};

/// Cells of joint values between two bodies in which they are proven apart. The motion of the lower body's balls and
/// triangles away from where they are in the middle of a cell is bounded, each by its own distance from the joints'
/// axes; when none comes that near to the upper body, the cell is free. A proof is sought once as much time was spent
/// on other checks within the cell as the proof may take; what is not proven stays to those. Safe from several threads.
class PairTable {
 public:
  explicit PairTable(const PairChain& chain);

  /// True when the two are proven apart.
  bool apart(const double* q) const;

  /// What finding the two apart in another way costs there: a unit is about a quarter of a microsecond.
  enum Cost : int { kBoxCost = 1, kFieldCost = 6, kExactCost = 80 };
  /// Tells the table of it; true when it has proven the two apart. The bodies must be the ones it is kept for.
  bool spent(const double* q, int cost, const BodyShape& upper, const BodyShape& lower) const;

 private:
  /// A cell's costs so far, or what is known of it.
  enum State : std::uint8_t { kWorth = 80, kWorthFinest = 240, kUnsure = 254, kApart = 255 };
  struct Level {
    int bits;   ///< 2^bits cells along each axis.
    int shift;  ///< From numbers on the finest level to those on this one.
    std::unique_ptr<std::atomic<std::uint8_t>[]> cells;
  };
  /// Numbers on the finest level; false outside the table.
  bool find(const double* q, int* fine) const;
  std::atomic<std::uint8_t>& at(const Level& level, const int* fine) const;
  bool proven(const Level& level, const int* fine, const BodyShape& upper, const BodyShape& lower) const;

  PairChain chain_;
  std::vector<Level> levels_;  ///< Coarse to fine; at most 270,000 cells of a byte in all.
};

/// The table of two bodies joined by this chain, null when they are of no kind that has one. Kept as long as both
/// sources (the meshes the bodies were made of) live.
std::shared_ptr<const PairTable> shared_table(const PairChain& chain, const std::shared_ptr<const Solid>& upper,
                                              const std::shared_ptr<const Solid>& lower);

}  // namespace mmgrasp::detail
