#pragma once

#include <limits>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp {

/// How densely sample_suction_grasps() covers a body.
struct MMGRASP_EXPORT SuctionSamplerOptions {
  int turns = 8;              ///< Turns of the hand about its approach at each place; > 0.
  int surface_samples = 300;  ///< Places drawn on the surface, beside those through the centre of mass; >= 0.
  int max_grasps = 96;        ///< Best kept, spread over approach directions and turns; > 0.
  unsigned seed = 1;
  void check() const;
};

/// What sample_suction_grasps() found, and what it left out.
struct MMGRASP_EXPORT SampledSuctionGrasps {
  std::vector<Grasp> grasps;
  int unsealed = 0;   ///< Places and turns at which some cup does not seal.
  int too_heavy = 0;  ///< Where all seal, but would not hold the mass in every direction.
  double least_share = std::numeric_limits<double>::infinity();  ///< Least suction_share_any_way() where all seal.
};

/// Grasps of a rigid body by suction cups: where every cup seals (seal_gap) and, with a mass [kg] > 0, the part is held
/// at rest however the hand is turned (suction_share_any_way). Sorted by quality, then by order of sampling.
///
/// - Places are the surface's points in 26 directions from the centre of mass (of a solid of uniform density), and
///   points drawn evenly over the surface. The hand faces along the plane that fits the surface at the rims, turned by
///   each of `turns` about it, and stands kSuctionStandoff before what it meets first.
/// - Quality has two parts of weight 0.5: `holding`, 1 less the share of the force that is needed (without a mass: of
///   the centre of mass lies within the rims), and `seal`, what is left of max_gap.
///
/// Collisions of the hand are not checked here. Throws InvalidInput on a hand without suction, an empty object, a
/// plane, a bad shape or option.
MMGRASP_EXPORT SampledSuctionGrasps sample_suction_grasps(const std::vector<LinkShape>& object, const Hand& hand,
                                                          double mass = 0, const SuctionSamplerOptions& options = {});

}  // namespace mmgrasp
