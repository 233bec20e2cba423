#pragma once

#include <map>
#include <string>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Folder of the ROS package NAME that a file in `folder` means by package://NAME or $(find NAME); empty when there is
/// none. Looked for where meshes are: the folder given for NAME, then ROS_PACKAGE_PATH, AMENT_PREFIX_PATH,
/// GAZEBO_MODEL_PATH and GZ_SIM_RESOURCE_PATH, then a
/// package.xml of that name among the folder's ancestors and one level below each, then folders called NAME there.
MMGRASP_EXPORT std::string find_package(const std::string& name, const std::string& folder,
                                        const std::map<std::string, std::string>& package_dirs = {});

}  // namespace mmgrasp
