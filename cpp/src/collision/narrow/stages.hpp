#pragma once

namespace mmgrasp::detail {

/// The ladder of checks (docs/methods/collision.md): each stage decides what it can prove and leaves the rest to the
/// next one, so that the answer is the same without it. The library runs them all; benchmarks/core/run_stages.py
/// compiles the checker again without one, to find out what it is worth.
enum Stage : unsigned {
  kSphereStage = 1,          ///< One bounding sphere per shape, eight at a time.
  kCoverStage = 2,           ///< Up to 64 spheres per shape against a bounding box.
  kFineStage = 4,            ///< Covers in three levels, and distance grids.
  kHullStage = 8,            ///< Hulls around meshes and convex bodies inside them.
  kLastCollisionStage = 16,  ///< What collided last is tested first.
  kIntervalStage = 32,       ///< Edges: proofs for a whole interval.
  kTableStage = 64           ///< Edges: clearance tables.
};

#ifndef MMGRASP_STAGES_LEFT_OUT
#define MMGRASP_STAGES_LEFT_OUT 0
#endif

constexpr bool runs(Stage stage) {
  return (static_cast<unsigned>(MMGRASP_STAGES_LEFT_OUT) & stage) == 0;
}

}  // namespace mmgrasp::detail
