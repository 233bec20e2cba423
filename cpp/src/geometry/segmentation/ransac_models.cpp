#include "geometry/segmentation/ransac_models.hpp"

#include <pcl/point_types.h>
#include <pcl/segmentation/sac_segmentation.h>

#include "mmgrasp/geometry/detail/quiet_pcl.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kIterations = 500;
/// Weight of the angle between normals beside the distance.
constexpr double kNormalWeight = 0.1;

}  // namespace

std::vector<int> points_on_model(const std::vector<Eigen::Vector3d>& points,
                                 const std::vector<Eigen::Vector3d>& normals, RoundModel model, double tolerance) {
  if (points.size() < 5) return {};
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  pcl::PointCloud<pcl::Normal>::Ptr directions(new pcl::PointCloud<pcl::Normal>);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f p = points[i].cast<float>(), n = normals[i].cast<float>();
    cloud->emplace_back(p.x(), p.y(), p.z());
    directions->emplace_back(n.x(), n.y(), n.z());
  }
  pcl::SACSegmentationFromNormals<pcl::PointXYZ, pcl::Normal> search(false);  // not seeded from the clock
  search.setModelType(model == RoundModel::cylinder ? pcl::SACMODEL_CYLINDER
                      : model == RoundModel::cone   ? pcl::SACMODEL_CONE
                                                    : pcl::SACMODEL_NORMAL_SPHERE);
  search.setMethodType(pcl::SAC_RANSAC);
  search.setNormalDistanceWeight(kNormalWeight);
  search.setMaxIterations(kIterations);
  search.setDistanceThreshold(tolerance);
  search.setRadiusLimits(0, 10);
  if (model == RoundModel::cone) search.setMinMaxOpeningAngle(0.05, 1.4);
  search.setOptimizeCoefficients(false);
  search.setInputCloud(cloud);
  search.setInputNormals(directions);
  const QuietPcl quiet;
  pcl::PointIndices inliers;
  pcl::ModelCoefficients coefficients;
  search.segment(inliers, coefficients);
  return {inliers.indices.begin(), inliers.indices.end()};
}

}  // namespace mmgrasp::detail
