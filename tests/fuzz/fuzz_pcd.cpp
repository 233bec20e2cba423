// PCD files in all three encodings: a cloud that was read has as many points as it says.
#include <cmath>

#include "expect.hpp"
#include "geometry/readers/pcd_reader.hpp"
#include "mmgrasp/core/error.hpp"

using namespace mmgrasp;
using fuzzing::expect;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  PointCloud cloud;
  try {
    cloud = detail::parse_pcd("fuzz.pcd", content);
  } catch (const IoError& refusal) {
    fuzzing::expect_names(refusal, "fuzz.pcd");
    return 0;
  }
  expect(static_cast<std::size_t>(cloud.width) * cloud.height == cloud.points.size(), "width * height points");
  expect(cloud.labels.empty() || cloud.labels.size() == cloud.points.size(), "one label a point");
  for (const Eigen::Vector3d& p : cloud.points)
    expect(p.allFinite() || (std::isnan(p.x()) && std::isnan(p.y()) && std::isnan(p.z())), "finite or not measured");
  expect(cloud.T_world_sensor.matrix().allFinite(), "a pose is finite");
  expect(cloud.points.size() <= 100 * size + 1, "no more points than the file can hold");
  return 0;
}
