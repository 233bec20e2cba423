#pragma once

#include <string>

#include "robot/model/robot_data.hpp"

namespace mmgrasp::detail {

/// Reads a URDF's kinematics, limits and collision shapes. Meshes are left as URIs (mesh_uri, mesh_scale; the shape is
/// an empty MeshShape). Throws InvalidInput naming file, line, element, value and rule; doubts become warnings.
RobotParts read_urdf(const std::string& text, const std::string& origin);

}  // namespace mmgrasp::detail
