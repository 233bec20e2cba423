#include "mmgrasp/robot/robot_source.hpp"

#include "mmgrasp/robot/robot.hpp"
#include "robot/model/robot_data.hpp"

namespace mmgrasp {

RobotSource source_of(const Robot& robot) {
  const Robot::Data& data = robot.data();
  return {data.base, data.base_limits, data.urdfs, data.added_links, robot.to_srdf()};
}

RobotSource written_source(const Robot& robot) {
  UrdfSource written;
  written.urdf = robot.to_urdf();
  written.origin = "robot \"" + robot.name() + "\" as read";
  for (const Link& link : robot.links()) {
    for (const LinkShape& shape : link.collisions)
      if (!shape.mesh_path.empty()) written.mesh_files[shape.mesh_path] = shape.mesh_path;
  }
  return {robot.base(), robot.base_limits(), {written}, {}, robot.to_srdf()};
}

}  // namespace mmgrasp
