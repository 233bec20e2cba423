#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp {

/// One suction cup of a hand: its rim is a circle in the plane through the tool frame's origin, across the approach.
struct MMGRASP_EXPORT SuctionCup {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< Middle of the rim in the tool frame [m].
  double radius = 0.02;                                ///< Radius of the rim [m]; > 0.
};

/// Suction cups that hold a part together: how far their rims give way, and how hard they pull.
///
/// A cup seals where the part's surface lies within `max_gap` before its whole rim. The force is vacuum times area.
struct MMGRASP_EXPORT Suction {
  std::vector<SuctionCup> cups;    ///< At least one.
  double max_gap = 1.5e-3;         ///< How far the surface may fall back from the rim's plane [m]; from 4e-4 to 0.1.
  double vacuum = 6e4;             ///< Below the pressure of the air [Pa]; in (0, 1.1e5].
  double friction = 0.5;           ///< Coulomb coefficient of rim and part; in (0, 10].
  double safety = 2.0;             ///< The force is so many times what holding needs; in [1, 100].
  void check() const;              ///< Throws InvalidInput naming field, value and rule.
  double force() const;            ///< What all cups pull with [N].
  Eigen::Vector3d middle() const;  ///< Mean of the cups' positions [m].
};

/// A hand that stands so far off the surface that the rims touch nothing: 0.2 mm, a part of `max_gap`.
inline constexpr double kSuctionStandoff = 2e-4;
/// Planners use no more than this share of the force, so that a judge who rounds otherwise agrees.
inline constexpr double kSuctionUsed = 0.95;

/// How far [m] the body's surface falls back from the rims' planes at most, with the tool frame at T_object_hand and
/// the cups facing along `approach` (unit, tool frame). Infinite where a rim or a cup's opening reaches beside the body
/// or over a hole; negative, how deep, where the body reaches through a rim's plane. On a plane that the rims lie on 0,
/// on a sphere or across a cylinder of radius R a cup of radius r falls back by R - sqrt(R^2 - r^2).
MMGRASP_EXPORT double seal_gap(const std::vector<LinkShape>& object, const Pose& T_object_hand,
                               const Eigen::Vector3d& approach, const Suction& suction);

/// Share of the cups' force that holding takes, safety included: above 1 the part comes off. `pull`: what acts on each
/// kilogram of the part, in the tool frame: gravity less acceleration [m/s^2].
///
/// With n the approach, t the rest of the pull, c the centre of mass from the middle of the cups and rho the radius of
/// the largest disc about that middle within the rims' hull, the rims press with N = F / safety - m pull.n, and must
/// bear the friction, mu N >= m |(|t|, torsion / rho)|, and the tilting moment, N rho >= m |tilt|; torsion and tilt are
/// the parts of c x pull along n and across it.
MMGRASP_EXPORT double suction_share(const Suction& suction, const Eigen::Vector3d& approach, double mass,
                                    const Eigen::Vector3d& centre_of_mass, const Eigen::Vector3d& pull);

/// The largest suction_share() at rest, however the hand is turned: with A^2 = (1 + (d / rho)^2) / mu^2 and c = (h, d)
/// along and across the approach, m g safety / F times the larger of sqrt(1 + A^2) and
/// sqrt((1 + d / rho)^2 + (h / rho)^2).
MMGRASP_EXPORT double suction_share_any_way(const Suction& suction, const Eigen::Vector3d& approach, double mass,
                                            const Eigen::Vector3d& centre_of_mass);

}  // namespace mmgrasp
