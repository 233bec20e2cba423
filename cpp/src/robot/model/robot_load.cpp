// Robot::load and from_strings: files, packages, meshes.
#include <cmath>
#include <filesystem>

#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/detail/utf8.hpp"
#include "mmgrasp/core/detail/xml_document.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/geometry/simplify_mesh.hpp"
#include "robot/model/mesh_locator.hpp"
#include "robot/model/robot_data.hpp"
#include "robot/model/srdf_reader.hpp"
#include "robot/model/urdf_reader.hpp"

namespace mmgrasp {
namespace {
namespace fs = std::filesystem;

constexpr double kLargestLink = 5.0;    // [m] beyond this a file is probably in other units
constexpr double kSmallestLink = 1e-3;  // [m]

/// Reads each mesh file once per scale, although robots use the same wheel or finger several times.
class MeshCache {
 public:
  explicit MeshCache(double tolerance) : tolerance_(tolerance) {}

  /// Puts the mesh, or what stands in for it, into a shape whose file is known.
  void load(LinkShape& shape, RobotReport& report) {
    const Eigen::Vector3d& s = shape.mesh_scale;
    MeshStandIn& entry = meshes_[shape.mesh_path + "|" + detail::number_text(s[0]) + "|" + detail::number_text(s[1]) +
                                 "|" + detail::number_text(s[2])];
    const auto* known = std::get_if<MeshShape>(&entry.shape);
    if (known && !known->mesh) {
      MeshReport mesh_report;
      entry = simplify_mesh(load_mesh(shape.mesh_path, s, &mesh_report), tolerance_);
      mesh_report.chosen = entry.chosen;
      mesh_report.triangles_saved = entry.triangles_saved;
      mesh_report.deviation = entry.deviation;
      report.meshes.push_back(mesh_report);
    }
    shape.shape = entry.shape;
    shape.T_link_shape = shape.T_link_shape * entry.T_mesh_shape;
    if (std::holds_alternative<MeshShape>(entry.shape)) return;
    shape.mesh_uri.clear();  // a primitive like any other: files written from here hold it, not the mesh
    shape.mesh_path.clear();
    shape.mesh_scale.setOnes();
  }

 private:
  double tolerance_;
  std::map<std::string, MeshStandIn> meshes_;
};

std::string missing_message(const std::string& origin, const std::string& link, const std::string& uri,
                            const std::vector<std::string>& looked) {
  std::string text = origin + ": link \"" + link + "\": mesh = \"" + uri + "\": file not found";
  for (std::size_t i = 0; i < std::min<std::size_t>(looked.size(), 4); ++i)
    text += (i ? ", " : "; looked for ") + looked[i];
  if (looked.size() > 4) text += " and " + std::to_string(looked.size() - 4) + " more places";
  if (uri.rfind("package://", 0) == 0) {
    const std::string name = uri.substr(10, uri.find('/', 10) - 10);
    text += "; name the package's folder with package_dirs {\"" + name + "\": ...}";
  }
  return text;
}

void resolve_meshes(detail::RobotParts& parts, const RobotOptions& options) {
  detail::MeshLocator locator(fs::path(parts.origin).parent_path(), options.mesh_dir, options.package_dirs);
  MeshCache cache(options.mesh_tolerance);
  std::map<std::string, std::string>& mesh_files = parts.urdfs.front().mesh_files;
  for (Link& link : parts.links) {
    std::vector<LinkShape> kept;
    for (LinkShape& shape : link.collisions) {
      if (shape.mesh_uri.empty()) {
        kept.push_back(shape);
        continue;
      }
      mesh_files[shape.mesh_uri] = "";
      if (!options.load_meshes) {
        parts.shapes_left_out.insert(link.name);
        continue;
      }
      std::vector<std::string> looked;
      shape.mesh_path = locator.find(shape.mesh_uri, &looked);
      if (shape.mesh_path.empty()) {
        const std::string message = missing_message(parts.origin, link.name, shape.mesh_uri, looked);
        if (!options.allow_missing_meshes) throw IoError(message);
        parts.shapes_left_out.insert(link.name);
        parts.report.missing.push_back(shape.mesh_uri);
        parts.report.warnings.push_back(message);
        continue;
      }
      mesh_files[shape.mesh_uri] = shape.mesh_path;
      cache.load(shape, parts.report);
      kept.push_back(shape);
    }
    link.collisions = std::move(kept);
  }
}

void warn_of_odd_sizes(detail::RobotParts& parts) {
  for (const Link& link : parts.links) {
    Eigen::AlignedBox3d bounds;
    for (const LinkShape& shape : link.collisions) bounds.extend(shape_bounds(shape.shape, shape.T_link_shape));
    if (bounds.isEmpty()) continue;
    const double size = bounds.sizes().maxCoeff();
    if (size > kLargestLink || size < kSmallestLink)
      parts.report.warnings.push_back(parts.origin + ": link \"" + link.name + "\": its collision shapes span " +
                                      detail::number_text(size) + " m: check the units");
  }
}

Robot load_robot(const std::string& urdf, const std::string& urdf_origin, const std::string& srdf,
                 const std::string& srdf_origin, const RobotOptions& options) {
  options.base_limits.check();
  require_not_negative(options.mesh_tolerance, "mesh_tolerance");
  detail::RobotParts parts = detail::read_urdf(urdf, urdf_origin);
  parts.base = options.base;
  parts.base_limits = options.base_limits;
  parts.urdfs.emplace_back();
  parts.urdfs.front().urdf = detail::is_utf8(urdf) ? urdf : detail::utf8_from_latin1(urdf);
  parts.urdfs.front().origin = urdf_origin;
  // The tree first: its faults are the reader's own, and cheaper to find than a missing mesh.
  detail::build_robot(parts);
  resolve_meshes(parts, options);
  warn_of_odd_sizes(parts);
  auto data = detail::build_robot(parts);
  if (!srdf.empty()) detail::read_srdf(srdf, srdf_origin, *data);
  return Robot(std::move(data));
}

}  // namespace

Robot Robot::load(const std::string& urdf_path, const std::string& srdf_path, const RobotOptions& options) {
  const std::string urdf = detail::file_content(urdf_path, "URDF file", detail::kLargestText);
  std::string srdf;
  if (!srdf_path.empty()) srdf = detail::file_content(srdf_path, "SRDF file", detail::kLargestText);
  return load_robot(urdf, urdf_path, srdf, srdf_path, options);
}

Robot Robot::from_strings(const std::string& urdf, const std::string& srdf, const RobotOptions& options,
                          const std::string& origin, const std::string& srdf_origin) {
  return load_robot(urdf, origin, srdf, srdf_origin.empty() ? origin + " (SRDF)" : srdf_origin, options);
}

}  // namespace mmgrasp
