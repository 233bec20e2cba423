#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/grasp/hand_mask.hpp"
#include "mmgrasp/mapping/height_map.hpp"

namespace mmgrasp {

/// Hand poses that evaluate_graspability() tries over a height map, and what a grasp needs to be returned.
struct MMGRASP_EXPORT GraspabilityOptions {
  double margin = 0.001;     ///< Kept free around the hand [m]; >= 0.
  int orientations = 16;     ///< Closing directions over half a turn; > 0.
  int openings = 2;          ///< Openings tried: max_opening, and equal parts of it; > 0.
  double layer_step = 0.01;  ///< Between the heights at which fingertips are tried [m]; > 0.
  double lowest = 0.003;     ///< Height of the lowest fingertips above the map's frame [m].
  double insertion = 0.01;  ///< A part counts as between the fingers where it rises this far above their tips [m]; > 0.
  double smoothing = 0.01;  ///< Radius over which graspability is averaged [m]; >= 0.
  double min_contact = 0.4;     ///< Share of the pads' width that must meet the part, in (0, 1].
  double min_distance = 0.015;  ///< Between returned grasps of about one direction [m]; >= 0.
  int max_grasps = 100;         ///< Best kept; > 0.
  int threads = 0;
  void check() const;
};

/// Places of the hand that were checked more closely, by what became of them.
struct MMGRASP_EXPORT GraspabilityCounts {
  std::size_t tried = 0;        ///< Local maxima of graspability.
  std::size_t too_wide = 0;     ///< The part leaves no room for the fingers once the hand is centred on it.
  std::size_t poor = 0;         ///< The pads would meet too little of it, or two parts at once.
  std::size_t collision = 0;    ///< The hand, centred and opened for its width, would touch something.
  std::size_t near_better = 0;  ///< A better one lies beside it, or max_grasps better ones exist.
};

/// Grasps found in a height map, and what became of the other places that were checked.
struct MMGRASP_EXPORT Graspability {
  std::vector<Grasp> grasps;  ///< Best first; T_object_hand is the pose in the world.
  GraspabilityCounts counts;
};

/// Fast graspability evaluation (Domae et al. 2014; P1 3.7.2) on a height map: for every closing direction, opening and
/// height of the fingertips the contact mask is convolved with the cells that rise above the tips, the masks of fingers
/// and palm with those that would be touched. Graspability is the contact count where nothing is touched, smoothed; at
/// its local maxima the hand is centred on the part, its width measured (the grasp's opening), and the hand opened for
/// that width (Hand::pregrasp_opening) is checked again. Cells of which nothing is known, and all beyond the map, count
/// as touched. Grasps move straight in along -z of the map's frame. Their quality has five factors: `contact`, the
/// share of the pads in contact, and `solidity` of the part between them, of weight 1; `depth` of the hold, `centring`
/// on the part and `room` for the hand to shift, of weight 0.5. Same answer at any thread count. Throws InvalidInput on
/// a bad map, hand or option.
MMGRASP_EXPORT Graspability evaluate_graspability(const HeightMap& map, const Hand& hand,
                                                  const GraspabilityOptions& options = {}, const Monitor& monitor = {});

/// The smoothed graspability of one closing direction, opening and fingertip height, one value a cell in [0, 1]: the
/// picture of P1's figure 3.21d.
MMGRASP_EXPORT std::vector<float> graspability_map(const HeightMap& map, const Hand& hand, double angle, double opening,
                                                   double tip_height, const GraspabilityOptions& options = {});

/// Fills in the pixel of each grasp of evaluate_graspability in the image that the map was made of.
MMGRASP_EXPORT void find_pixels(const DepthImage& image, std::vector<Grasp>& grasps);

}  // namespace mmgrasp
