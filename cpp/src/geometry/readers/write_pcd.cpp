// write_pcd(): point clouds as PCL reads them.
#include <cstdint>
#include <cstring>

#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/point_cloud.hpp"

namespace mmgrasp {
namespace {

std::string header_of(const PointCloud& cloud) {
  const bool labelled = !cloud.labels.empty();
  const Eigen::Vector3d p = cloud.T_world_sensor.translation();
  const Eigen::Quaterniond q(cloud.T_world_sensor.linear());
  std::string viewpoint;
  for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) viewpoint += " " + std::to_string(value);
  const std::string size = std::to_string(cloud.points.size());
  return std::string("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n") +
         (labelled ? "FIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F I\nCOUNT 1 1 1 1\n"
                   : "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n") +
         "WIDTH " + std::to_string(cloud.width) + "\nHEIGHT " + std::to_string(cloud.height) + "\nVIEWPOINT" +
         viewpoint + "\nPOINTS " + size + "\nDATA binary\n";
}

}  // namespace

void write_pcd(const std::string& path, const PointCloud& cloud) {
  require(static_cast<std::size_t>(cloud.width) * cloud.height == cloud.points.size(), "cloud.points",
          std::to_string(cloud.points.size()), "must be width * height many");
  require(cloud.labels.empty() || cloud.labels.size() == cloud.points.size(), "cloud.labels",
          std::to_string(cloud.labels.size()), "must be one a point, or none");
  std::string data;
  data.reserve(cloud.points.size() * 16);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    char bytes[16];
    const Eigen::Vector3f point = cloud.points[i].cast<float>();
    std::memcpy(bytes, point.data(), 12);
    if (!cloud.labels.empty()) {
      const std::int32_t label = cloud.labels[i];
      std::memcpy(bytes + 12, &label, 4);
    }
    data.append(bytes, cloud.labels.empty() ? 12 : 16);
  }
  detail::write_file(path, "point cloud file", {header_of(cloud), data});
}

}  // namespace mmgrasp
