#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"

namespace mmgrasp {

/// Points of a scan [m]. An organised cloud (height > 1) keeps the image's rows; NaN stands where nothing was measured.
struct MMGRASP_EXPORT PointCloud {
  std::vector<Eigen::Vector3d> points;  ///< width * height of them, row by row.
  int width = 0, height = 1;
  std::vector<int> labels;  ///< One a point where the file has a field "label", else empty.
  Pose T_world_sensor =
      Pose::Identity();  ///< The file's VIEWPOINT: where the scanner stood, in the frame of the points.
  std::string warning;   ///< What the reader put up with, or empty.
};

/// Reads a PCD file (ascii, binary or binary_compressed) with the fields x, y and z; other fields but "label" are
/// skipped. More ascii rows than announced are read and reported in `warning`. Throws IoError naming the file and the
/// rule when it is missing, truncated, damaged or without coordinates; coordinates that are not finite become NaN.
MMGRASP_EXPORT PointCloud read_pcd(const std::string& path);

/// Writes a PCD file of the version 0.7, binary, with x, y and z as 32-bit numbers and label where the cloud has some.
/// Throws IoError when it cannot be written, InvalidInput when width * height is not the number of points.
MMGRASP_EXPORT void write_pcd(const std::string& path, const PointCloud& cloud);

}  // namespace mmgrasp
