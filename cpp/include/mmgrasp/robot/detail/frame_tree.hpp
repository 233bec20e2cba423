#pragma once

#include <vector>

#include "mmgrasp/core/detail/rigid.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/detail/chain_kernel.hpp"

namespace mmgrasp::detail {

struct GroupModel;

/// How one robot joint depends on the configuration; column -1 when it stands still.
struct Drive {
  int column = -1;
  double multiplier = 1, offset = 0;
};

/// One motion about or along an axis through the origin of the frame that it makes. A planar joint is two prismatic
/// motions and a revolute one, a floating joint three prismatic ones and a spherical one, which takes three columns.
struct ElementaryMotion {
  int frame = 0, parent = 0;
  Rigid rest;            ///< The frame in its parent while the motion is at zero.
  Eigen::Vector3d axis;  ///< The same in both frames; a spherical motion ignores it.
  Motion motion = Motion::revolute;
  Drive drive;
};

/// A group's robot as a tree of the frames that the group moves. Frame numbers are link indices, and the root is frame
/// 0: the child of a moving joint is a frame, every other link stands in the nearest frame above it. The inner frames
/// of planar and floating joints have the numbers behind the links.
struct FrameTree {
  explicit FrameTree(const GroupModel& model);

  int frames;                             ///< Numbers in use, those of links that stand in another frame included.
  std::vector<ElementaryMotion> motions;  ///< Motions from the root outwards.
  std::vector<int> motion_of_frame;       ///< The motion that makes each frame; -1: none.
  std::vector<int> frame_of_link;
  std::vector<Rigid> link_in_frame;

  /// The motions on the way from a frame to the root, the nearest first.
  std::vector<const ElementaryMotion*> motions_above(int frame) const;
};

/// A rotation that takes z to the unit vector `axis`.
MMGRASP_EXPORT Eigen::Matrix3d rotation_from_z(const Eigen::Vector3d& axis);

}  // namespace mmgrasp::detail
