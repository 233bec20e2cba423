#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/contact_patch.hpp"
#include "mmgrasp/grasp/success_model.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"

namespace mmgrasp {

/// How surfaces are drawn from a map: mean + sigma g with one smooth random field g of N(0, 1) a draw.
struct MMGRASP_EXPORT SurfaceDrawOptions {
  int draws = 200;  ///< Surfaces; > 0.
  /// Length over which g changes: at a distance r its correlation is exp(-r^2 / (2 length^2)). Assumed, since the map
  /// keeps no covariances: the longer, the more a patch moves as a whole [m]; > 0.
  double correlation_length = 0.02;
  unsigned seed = 1;  ///< Same seed, same surfaces for every grasp: what ranks them is not the draw.
  void check() const;
};

/// The whole probability (4.1), by drawing surfaces.
struct MMGRASP_EXPORT DrawnSuccess {
  double probability = 0;     ///< Mean of P(S | x, g) over the drawn surfaces.
  double standard_error = 0;  ///< Standard error of that mean.
  double holds = 0;           ///< Share of the surfaces on which the pads meet planes in force closure.
};

/// P(S) of (4.1): the mean of (4.9) over surfaces drawn from the map, each of which is certain, so that w_4 is left out
/// and the other weights share its part. Where the pads' rays meet the mean surface it moves by sigma g along its
/// normal; patches are fitted and rated anew. A surface that a pad would stand in counts as failed. The hand's other
/// bodies are not checked again. Throws InvalidInput on options out of range, or when w_4 is all there is.
MMGRASP_EXPORT DrawnSuccess draw_success(const ProbabilisticSdf& map, const std::vector<FingerPad>& pads,
                                         const Pose& T_world_hand, const ObjectExtent& object, double offset,
                                         const SurfaceDrawOptions& options = {}, const SuccessOptions& success = {},
                                         const ContactPatchOptions& patch = {});

/// The same of the rays' hits on the mean surface, one entry a pad: what draw_success() does once it cast them.
MMGRASP_EXPORT DrawnSuccess draw_success(const std::vector<SdfHits>& hits, const std::vector<PadRays>& rays,
                                         double reach, const ObjectExtent& object, double offset,
                                         const SurfaceDrawOptions& options = {}, const SuccessOptions& success = {},
                                         const ContactPatchOptions& patch = {});

}  // namespace mmgrasp
