#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp {

/// How a part may lie on a level floor.
struct MMGRASP_EXPORT RestingPose {
  Pose T_floor_part = Pose::Identity();  ///< Centre of mass above the origin, lowest point at height 0.
  double probability = 0;                ///< All of a part's sum to 1.
};

/// The faces of a body's convex hull on which it does not tip over (its centre of mass lies above the face), most
/// probable first. A face's probability is its share of the solid angle seen from the centre of mass: how often it
/// comes to lie down if the body is turned at random and let down slowly. The body is of one density; shapes that
/// overlap count twice. Throws InvalidInput for an empty or flat body or a plane.
MMGRASP_EXPORT std::vector<RestingPose> resting_poses(const std::vector<LinkShape>& part);

/// How many parts random_placement() puts into a tray, whether on top of one another, and how long it looks for room.
struct MMGRASP_EXPORT PlacementOptions {
  int count = 12;     ///< Parts wanted; >= 0. P1's fill of 75 % of a tray for twelve is nine.
  int draws = 100;    ///< Random places tried for each part; > 0.
  bool stack = true;  ///< A part that finds no place on the floor may lie on others, no higher than the walls.
  double clearance =
      0.0005;         ///< Left to the walls, under parts on the floor and, at most, under those on others [m]; > 0.
  unsigned seed = 1;  ///< Same seed, same places.
  void check() const;
};

/// Where a part lies in its tray, and which of its resting_poses() it took.
struct MMGRASP_EXPORT PlacedPart {
  Pose T_tray_part = Pose::Identity();
  int resting_pose = 0;
  bool on_floor = true;  ///< False: it lies on others.
};

/// The parts that found room in a tray, and how many did not.
struct MMGRASP_EXPORT RandomPlacement {
  std::vector<PlacedPart> parts;
  int not_placed = 0;  ///< Parts for which no place was found.
};

/// Alike parts lying in a tray at random (P1 3.5.2, 3.7.2), without physics: one after another each takes a resting
/// pose, a turn and a place at random and is let down until it meets the floor or a part. No two bodies touch: every
/// place was checked with exact distances. A part that lies on others keeps the turn it was let down in, whether or not
/// it would tip over there. `tray_size` are outer lengths, the tray's frame is the middle of the floor's upper face.
/// Throws InvalidInput on a bad part, tray or option, or when the part does not fit the empty tray in any resting pose.
MMGRASP_EXPORT RandomPlacement random_placement(const std::vector<LinkShape>& part, const Eigen::Vector3d& tray_size,
                                                double wall, const PlacementOptions& options = {},
                                                const Monitor& monitor = {});

/// Floor and four walls of a tray, outer lengths [m]; the frame is the middle of the floor's upper face.
MMGRASP_EXPORT std::vector<LinkShape> tray_shapes(const Eigen::Vector3d& size, double wall);

}  // namespace mmgrasp
