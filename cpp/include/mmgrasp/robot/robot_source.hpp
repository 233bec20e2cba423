#pragma once

#include <map>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint.hpp"
#include "mmgrasp/robot/planar_base.hpp"

namespace mmgrasp {

class Robot;

/// A URDF as it was given, unread, and where its root link hangs.
struct MMGRASP_EXPORT UrdfSource {
  std::string urdf;                       ///< The text; xacro is expanded.
  std::string origin = "<string>";        ///< File or other source, for messages.
  std::string prefix;                     ///< Stands in front of every name in it.
  std::string parent_link;                ///< Carries its root link by the fixed joint "<prefix>mount_joint"; empty for
                                          ///< the robot's own root.
  Pose T_parent_root = Pose::Identity();  ///< Pose of its root link in the parent link.
  /// Mesh file for each `filename` in the URDF; empty: the robot was loaded without this mesh.
  std::map<std::string, std::string> mesh_files = {};
};

/// A link that came from no URDF: a tool centre point, a bin. The fixed joint "<name>_joint" carries it.
struct MMGRASP_EXPORT AddedLink {
  std::string name, parent_link;
  Pose T_parent_link = Pose::Identity();
  std::vector<LinkShape> shapes = {};
};

/// What a robot was made of, for those who read it by other means than Robot does (verify/plan_to_check.hpp). It
/// holds nothing that Robot understood of the URDFs but the files that were found for their meshes.
struct MMGRASP_EXPORT RobotSource {
  BaseKind base = BaseKind::fixed;
  BaseLimits base_limits;
  std::vector<UrdfSource> urdfs;  ///< URDFs in the order of mounting.
  std::vector<AddedLink> added_links;
  std::string srdf;  ///< Robot::to_srdf(): pairs of links that need no check, computed ones among them.
};

MMGRASP_EXPORT RobotSource source_of(const Robot& robot);
/// The robot as Robot understood it: Robot::to_urdf() as its only URDF. Throws InvalidInput for meshes without a file.
MMGRASP_EXPORT RobotSource written_source(const Robot& robot);

}  // namespace mmgrasp
