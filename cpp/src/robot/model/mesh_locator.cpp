#include "robot/model/mesh_locator.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "mmgrasp/robot/packages.hpp"

namespace mmgrasp {
namespace fs = std::filesystem;
namespace detail {
namespace {

constexpr int kMaxClimb = 8;  // folders above the URDF that are searched for packages

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

std::string percent_decoded(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && std::isxdigit(static_cast<unsigned char>(text[i + 1])) &&
        std::isxdigit(static_cast<unsigned char>(text[i + 2]))) {
      result += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

/// <name> of a package.xml; read as text, because manifests come in several XML formats.
std::string manifest_name(const fs::path& manifest) {
  std::ifstream file(manifest);
  std::stringstream text;
  text << file.rdbuf();
  const std::string content = text.str();
  const std::size_t begin = content.find("<name>");
  const std::size_t end = content.find("</name>", begin);
  if (begin == std::string::npos || end == std::string::npos) return "";
  std::string name = content.substr(begin + 6, end - begin - 6);
  name.erase(std::remove_if(name.begin(), name.end(), [](unsigned char c) { return std::isspace(c); }), name.end());
  return name;
}

bool is_package(const fs::path& folder, const std::string& name) {
  const fs::path manifest = folder / "package.xml";
  return is_file(manifest) && (folder.filename() == name || manifest_name(manifest) == name);
}

std::vector<fs::path> sorted_subfolders(const fs::path& folder) {
  std::vector<fs::path> result;
  std::error_code error;
  for (fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, error), end;
       !error && it != end; it.increment(error))
    if (is_folder(it->path())) result.push_back(it->path());
  std::sort(result.begin(), result.end());  // the answer must not depend on the file system's order
  return result;
}

std::vector<fs::path> environment_paths(const char* variable) {
  std::vector<fs::path> paths;
  const char* value = std::getenv(variable);
  std::stringstream stream(value ? value : "");
  for (std::string part; std::getline(stream, part, ':');)
    if (!part.empty()) paths.emplace_back(part);
  return paths;
}

}  // namespace

MeshLocator::MeshLocator(fs::path urdf_dir, fs::path mesh_dir, std::map<std::string, std::string> package_dirs)
    : package_dirs_(std::move(package_dirs)) {
  std::error_code error;
  urdf_dir_ = fs::weakly_canonical(fs::absolute(urdf_dir.empty() ? "." : urdf_dir, error), error);
  mesh_dir_ = mesh_dir.empty() ? urdf_dir_ : fs::weakly_canonical(fs::absolute(mesh_dir, error), error);
}

const std::vector<fs::path>& MeshLocator::package_folders(const std::string& name) {
  const auto [entry, fresh] = folders_.try_emplace(name);
  std::vector<fs::path>& folders = entry->second;
  if (!fresh) return folders;
  const auto given = package_dirs_.find(name);
  if (given != package_dirs_.end()) folders.emplace_back(given->second);
  for (const fs::path& path : environment_paths("ROS_PACKAGE_PATH")) {
    if (is_package(path, name)) folders.push_back(path);
    if (is_folder(path / name)) folders.push_back(path / name);
  }
  for (const fs::path& path : environment_paths("AMENT_PREFIX_PATH"))
    if (is_folder(path / "share" / name)) folders.push_back(path / "share" / name);
  for (const char* variable : {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH"})  // where model://NAME is at home
    for (const fs::path& path : environment_paths(variable))
      if (is_folder(path / name)) folders.push_back(path / name);

  std::vector<fs::path> ancestors;
  for (fs::path path = urdf_dir_; static_cast<int>(ancestors.size()) < kMaxClimb; path = path.parent_path()) {
    if (path == path.root_path()) break;  // nobody keeps packages at the root: do not scan the whole machine
    ancestors.push_back(path);
  }
  for (const fs::path& ancestor : ancestors) {
    if (is_package(ancestor, name)) folders.push_back(ancestor);
    for (const fs::path& below : sorted_subfolders(ancestor))
      if (is_package(below, name)) folders.push_back(below);
  }
  for (const fs::path& ancestor : ancestors) {
    if (ancestor.filename() == name) folders.push_back(ancestor);
    if (is_folder(ancestor / name)) folders.push_back(ancestor / name);
  }
  folders.push_back(mesh_dir_ / name);
  return folders;
}

std::string MeshLocator::find_package(const std::string& name) {
  for (const fs::path& folder : package_folders(name))
    if (is_folder(folder)) return folder.string();
  return "";
}

std::string MeshLocator::find(const std::string& uri, std::vector<std::string>* looked) {
  const auto existing = [looked](const fs::path& path) -> std::string {
    if (is_file(path)) {
      std::error_code error;
      const fs::path canonical = fs::weakly_canonical(path, error);
      return (error ? path : canonical).string();
    }
    if (looked) looked->push_back(path.string());
    return "";
  };
  const std::size_t scheme_end = uri.find("://");
  if (scheme_end == std::string::npos) return existing(mesh_dir_ / uri);  // an absolute path replaces mesh_dir_
  const std::string scheme = uri.substr(0, scheme_end);
  const std::string rest = percent_decoded(uri.substr(scheme_end + 3));
  if (scheme == "file") return existing(mesh_dir_ / rest);
  if (scheme != "package" && scheme != "model") return "";
  const std::size_t slash = rest.find('/');
  if (slash == std::string::npos) return existing(mesh_dir_ / rest);
  const std::string inside = rest.substr(slash + 1);
  for (const fs::path& folder : package_folders(rest.substr(0, slash))) {
    const std::string found = existing(folder / inside);
    if (!found.empty()) return found;
  }
  return existing(mesh_dir_ / inside);  // package://meshes/... and the like: relative paths in disguise
}

}  // namespace detail

std::string find_package(const std::string& name, const std::string& folder,
                         const std::map<std::string, std::string>& package_dirs) {
  return detail::MeshLocator(folder, "", package_dirs).find_package(name);
}

}  // namespace mmgrasp
