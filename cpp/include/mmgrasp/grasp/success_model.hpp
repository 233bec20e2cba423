#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/contact_patch.hpp"

namespace mmgrasp {

/// Parameters of P3's model of a grasp's success (4.4.3). Weights are P3's, tuned on one object; they must sum to 1.
struct MMGRASP_EXPORT SuccessOptions {
  double friction = 0.5;          ///< Coulomb coefficient: P3's theta is 2 atan(friction), the cone's whole angle; > 0.
  double angle_weight = 0.6;      ///< w_1 of the angle between pads and patches; in [0, 1].
  double placement_weight = 0.1;  ///< w_2 of the pads' distances from the surface.
  double centring_weight = 0.2;   ///< w_3 of the distance of the contacts' line from the object's middle.
  double certainty_weight = 0.1;  ///< w_4 of the surface's standard deviation.
  double placement_scale = 0.01;  ///< sigma_h^2 of (4.6): pads off by this in sum multiply P_2 by 1/e [m]; > 0.
  double max_sigma = 0.005;       ///< sigma_max of (4.8): surfaces less certain are not touched [m]; > 0.
  void check() const;
};

/// What (4.7) asks of the object: the middle of its bounding box stands for its centre of mass.
struct MMGRASP_EXPORT ObjectExtent {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  double longest = 0.1;                              ///< Longest side of the bounding box, l_bb [m]; > 0.
};

/// The share of each criterion in a grasp's success, each in [0, 1].
struct MMGRASP_EXPORT GraspSuccess {
  double angle = 0;            ///< P_1 (4.5).
  double placement = 0;        ///< P_2 (4.6).
  double centring = 0;         ///< P_3 (4.7).
  double certainty = 0;        ///< P_4 (4.8).
  double weighted = 0;         ///< (4.9) as printed; up to 0.4 for grasps that cannot hold.
  bool force_closure = false;  ///< See has_force_closure().
  double probability = 0;      ///< `weighted`, and 0 without force closure or where P_1 or P_4 is 0.
};

/// P_1 (4.5): product over the contacts of 1 - |beta| / (theta / 2), beta = pi - angle(n_i, c_i); 0 outside the cone.
MMGRASP_EXPORT double angle_criterion(const std::vector<ContactPatch>& patches, double friction);

/// P_2 (4.6) with the absolute value that it needs to stay below 1: exp(- sum |d_i - offset| / scale), all [m].
MMGRASP_EXPORT double placement_criterion(const std::vector<ContactPatch>& patches, double offset, double scale);

/// P_3 (4.7): 1 - d / (l_bb / 2) of the distance between the object's middle and the line of contact; 0 beyond. Of more
/// than two contacts those that push to either side of their common axis count as one, at their mean.
MMGRASP_EXPORT double centring_criterion(const std::vector<ContactPatch>& patches, const ObjectExtent& object);

/// P_4 (4.8): product over the contacts of 1 - sigma / max_sigma; 0 where one is not below max_sigma.
MMGRASP_EXPORT double certainty_criterion(const std::vector<ContactPatch>& patches, double max_sigma);

/// Whether contacts with friction can resist any wrench. Two patches: the line that joins them lies inside both
/// friction cones (Nguyen 1988), the patches taking the torque about it. More: zero is interior to the convex hull of
/// the wrenches of point contacts, each cone replaced by the pyramid of eight edges inscribed in it, hence on the safe
/// side. Fewer than two: false.
MMGRASP_EXPORT bool has_force_closure(const std::vector<ContactPatch>& patches, double friction);

/// P(S | x, g) of (4.9), gated as P3's errata ask: a weighted sum alone gives 0.4 to a grasp whose fingers slip off.
/// `offset` is P3's h, the distance between pad and surface before closing [m]. Throws InvalidInput on options or an
/// object out of range.
MMGRASP_EXPORT GraspSuccess evaluate_success(const std::vector<ContactPatch>& patches, const ObjectExtent& object,
                                             double offset, const SuccessOptions& options = {});

}  // namespace mmgrasp
