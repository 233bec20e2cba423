#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace mmgrasp::detail {

/// Finds the files that a URDF's mesh URIs name. package://NAME/rest is looked for, in this order, in: the folder given
/// for NAME; packages under ROS_PACKAGE_PATH, AMENT_PREFIX_PATH, GAZEBO_MODEL_PATH and GZ_SIM_RESOURCE_PATH; packages
/// (a package.xml of that name) among the URDF's ancestors and one level below each; folders called NAME among the
/// ancestors or beside them; the mesh folder.
class MeshLocator {
 public:
  /// `mesh_dir` is where relative paths start; the search for packages climbs from `urdf_dir`.
  MeshLocator(std::filesystem::path urdf_dir, std::filesystem::path mesh_dir,
              std::map<std::string, std::string> package_dirs);

  /// Absolute path of an existing file, or empty. `looked` receives the places tried.
  std::string find(const std::string& uri, std::vector<std::string>* looked = nullptr);
  /// First existing folder of a package, or empty.
  std::string find_package(const std::string& name);

 private:
  /// Where a package may lie, best first.
  const std::vector<std::filesystem::path>& package_folders(const std::string& name);

  std::filesystem::path urdf_dir_, mesh_dir_;
  std::map<std::string, std::string> package_dirs_;
  std::map<std::string, std::vector<std::filesystem::path>> folders_;  // cache of package_folders
};

}  // namespace mmgrasp::detail
