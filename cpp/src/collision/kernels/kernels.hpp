#pragma once

#include <cstdint>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// The loops that decide how quick a check is. They exchange plain arrays and are compiled twice: for every machine of
/// the platform and for AVX2 with FMA; which one runs is decided at run time. Everything in single precision takes
/// a slack that covers its rounding, so that it may only err towards "not proven".

constexpr int kLanes = 8;

/// Up to eight boxes turned any way, coordinate by coordinate. Lanes without a box are infinitely far away.
struct BoxPack {
  float axes[9][kLanes];  ///< Row k of the inverse rotation: 3k .. 3k + 2.
  float centre[3][kLanes];
  float half[3][kLanes];
  float radius[kLanes];  ///< Radius of the sphere around the box.
};

/// Placed spheres, coordinate by coordinate; the arrays end with whole lanes.
struct SphereRows {
  const float *x, *y, *z, *radius;
  SphereRows from(int sphere) const { return {x + sphere, y + sphere, z + sphere, radius + sphere}; }
};

/// A sphere and up to eight others in a row that it may meet.
struct PairBlock {
  int sphere, first;   ///< The others are first .. first + kLanes - 1.
  std::uint8_t lanes;  ///< Which of them make pairs.
};

/// A bounding sphere that moves with a frame.
struct FrameSphere {
  double p[3];
  double radius;
  int frame;
};

/// Small spheres that cover a body together, in its own frame. No point of the body lies outside all outer spheres;
/// each inner sphere lies within the body (radius negative: none).
struct CoverView {
  const float *x, *y, *z, *outer, *inner;
  int count;   ///< Multiple of kLanes; the last ones are infinitely far away.
  int filled;  ///< Spheres without the padding.
};

/// R (rows) and t of a body in the frame of another one, single precision.
struct FloatRigid {
  float R[9], t[3];
};

/// A grid of distances to a body from below (DistanceGrid).
struct GridView {
  float low[3], per_step;    ///< Lower corner; cells per metre.
  float quantum;             ///< Metres per unit of a cell.
  float spread;              ///< Taken off for each cell of distance from the cell's centre [m].
  float centre[3], half[3];  ///< Bounding box of the body, for points beyond the grid.
  int count[3];
  const std::int8_t* cells;  ///< Negative: wholly within the body.
};

enum CoverAnswer : unsigned { kApart = 0, kMaybe = 1, kOverlap = 2 };

struct Kernels {
  /// Which of `count` points (x of all, then y, then z; count a multiple of kLanes) lies farthest along `d`; the first
  /// of equals.
  int (*farthest)(const double* points, int count, const double* d);
  /// The same in single precision: no point lies farther by more than its rounding.
  int (*nearly_farthest)(const float* points, int count, const float* d);
  /// World centre and radius of each sphere, the radius with a slack for single precision: x, y, z and radius in rows
  /// of `row` numbers. frames: 4 x 4 poses, column by column.
  void (*place_spheres)(const FrameSphere* spheres, int count, const double* frames, float* out, int row);
  /// masks[b * packs + k]: which boxes of pack k sphere b meets.
  void (*spheres_meet_boxes)(const BoxPack* packs, int pack_count, const SphereRows& spheres, int sphere_count,
                             std::uint8_t* masks);
  /// squared: squared distance of a point to each box, kLanes for each pack. Returns the least of them.
  float (*boxes_from_point)(const BoxPack* packs, int pack_count, float x, float y, float z, float* squared);
  /// masks[i]: which pairs of block i meet.
  void (*sphere_pairs_meet)(const PairBlock* blocks, int block_count, const SphereRows& spheres, std::uint8_t* masks);
  /// Cover against a box placed in its frame. `grow` is added to the outer radii, `slack` covers rounding. Without
  /// `seek_overlap` the first sphere that may touch ends the search.
  CoverAnswer (*cover_meets_box)(const CoverView& cover, const FloatRigid& box, const float* half, float grow,
                                 float slack, bool seek_overlap);
  /// A lower bound of the clearance of the two; not above 0 where a sphere may touch, which ends the search.
  float (*cover_to_box)(const CoverView& cover, const FloatRigid& box, const float* half, float slack);
  /// A grid against covers placed in its frame, each level with kLanes spheres for each sphere of the level above: only
  /// where a sphere may touch are its parts tested.
  CoverAnswer (*cover_tree_meets_grid)(const GridView& grid, const CoverView* levels, int level_count,
                                       const FloatRigid& cover_in_field, float grow, float slack, bool seek_overlap);
  /// A box placed in the frame of such covers against them.
  CoverAnswer (*cover_tree_meets_box)(const CoverView* levels, int level_count, const FloatRigid& box,
                                      const float* half, float grow, float slack, bool seek_overlap);
};

/// The version for the instruction set in use (mmgrasp/core/detail/instruction_set.hpp).
MMGRASP_EXPORT const Kernels& kernels();

}  // namespace mmgrasp::detail
