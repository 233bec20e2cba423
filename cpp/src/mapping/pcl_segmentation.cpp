#include "mapping/pcl_segmentation.hpp"

#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/sac_model_perpendicular_plane.h>
#include <pcl/sample_consensus/sac_model_plane.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/detail/quiet_pcl.hpp"

namespace mmgrasp::detail {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// PCL keeps a number for each cell of the box around the points.
void check_lattice(const std::vector<Eigen::Vector3d>& points, double leaf) {
  constexpr double kMostCells = 1e8;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  const double cells = (box.sizes() / leaf + Eigen::Vector3d::Ones()).prod();
  require(cells <= kMostCells, "leaf", leaf,
          "is too fine for points " + std::to_string(box.sizes().maxCoeff()) + " m apart: at most 1e8 cells [m]");
}

Cloud::Ptr to_pcl(const std::vector<Eigen::Vector3d>& points) {
  Cloud::Ptr cloud(new Cloud);
  cloud->reserve(points.size());
  for (const Eigen::Vector3d& p : points) {
    cloud->emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
  }
  return cloud;
}

/// PCL's searches for planes ask for every plane that they try how many points lie on it. Once interrupted all
/// do, which ends the search: an exception must not leave PCL's loop, which is compiled for OpenMP.
template <typename Model>
class InterruptibleModel : public Model {
 public:
  using Model::Model;
  std::size_t countWithinDistance(const Eigen::VectorXf& coefficients, const double threshold) const override {
    const CancelToken* interruption = interruption_token();
    if (interruption != nullptr && interruption->stopped()) return this->indices_->size();
    return Model::countWithinDistance(coefficients, threshold);
  }
};

class PlaneSearch : public pcl::SACSegmentation<pcl::PointXYZ> {
 public:
  PlaneSearch() : SACSegmentation(false) {}  // not seeded from the clock

 protected:
  bool initSACModel(const int type) override {
    if (type == pcl::SACMODEL_PLANE) {
      model_.reset(new InterruptibleModel<pcl::SampleConsensusModelPlane<pcl::PointXYZ>>(input_, *indices_, random_));
      return true;
    }
    using Perpendicular = InterruptibleModel<pcl::SampleConsensusModelPerpendicularPlane<pcl::PointXYZ>>;
    pcl::shared_ptr<Perpendicular> model(new Perpendicular(input_, *indices_, random_));
    model->setAxis(axis_);
    model->setEpsAngle(eps_angle_);
    model_ = model;
    return true;
  }
};

/// Clusters are grown by one look around each point.
class InterruptibleTree : public pcl::search::KdTree<pcl::PointXYZ> {
 public:
  using pcl::search::KdTree<pcl::PointXYZ>::radiusSearch;
  int radiusSearch(const pcl::PointXYZ& point, double radius, pcl::Indices& indices, std::vector<float>& squared,
                   unsigned most = 0) const override {
    poll_();
    return pcl::search::KdTree<pcl::PointXYZ>::radiusSearch(point, radius, indices, squared, most);
  }

 private:
  mutable InterruptionPoll poll_{64};
};

}  // namespace

FoundPlane dominant_plane(const std::vector<Eigen::Vector3d>& points, double tolerance, int iterations,
                          const Eigen::Vector3d& axis, double angle) {
  FoundPlane out;
  if (points.size() < 3) return out;
  const QuietPcl quiet;
  PlaneSearch search;
  search.setMethodType(pcl::SAC_RANSAC);
  search.setModelType(axis.isZero() ? pcl::SACMODEL_PLANE : pcl::SACMODEL_PERPENDICULAR_PLANE);
  if (!axis.isZero()) {
    search.setAxis(axis.normalized().cast<float>());
    search.setEpsAngle(angle);
  }
  search.setDistanceThreshold(tolerance);
  search.setMaxIterations(iterations);
  search.setOptimizeCoefficients(true);
  search.setInputCloud(to_pcl(points));
  pcl::PointIndices inliers;
  pcl::ModelCoefficients plane;
  search.segment(inliers, plane);
  throw_if_interrupted();
  if (inliers.indices.size() < 3 || plane.values.size() != 4) return out;
  const Eigen::Vector3d normal(plane.values[0], plane.values[1], plane.values[2]);
  out.found = true;
  out.normal = normal.normalized();
  out.offset = -plane.values[3] / normal.norm();
  out.inliers.assign(inliers.indices.begin(), inliers.indices.end());
  return out;
}

std::vector<std::vector<int>> euclidean_clusters(const std::vector<Eigen::Vector3d>& points, double tolerance,
                                                 double leaf, int least) {
  std::vector<std::vector<int>> groups;
  if (points.empty()) return groups;
  check_lattice(points, leaf);
  const QuietPcl quiet;
  const Cloud::Ptr cloud = to_pcl(points);
  Cloud::Ptr thinned(new Cloud);
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(static_cast<float>(leaf), static_cast<float>(leaf), static_cast<float>(leaf));
  grid.setSaveLeafLayout(true);
  grid.filter(*thinned);

  std::vector<pcl::PointIndices> found;
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> search;
  const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new InterruptibleTree);
  search.setClusterTolerance(tolerance);
  search.setMinClusterSize(1);
  search.setMaxClusterSize(static_cast<int>(thinned->size()));
  search.setSearchMethod(tree);
  search.setInputCloud(thinned);
  search.extract(found);

  std::vector<int> group_of(thinned->size(), -1);
  for (std::size_t g = 0; g < found.size(); ++g) {
    for (const int i : found[g].indices) group_of[i] = static_cast<int>(g);
  }
  groups.resize(found.size());
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    const int cell = grid.getCentroidIndex((*cloud)[i]);
    if (cell < 0 || group_of[cell] < 0) continue;
    groups[group_of[cell]].push_back(static_cast<int>(i));
  }
  groups.erase(std::remove_if(groups.begin(), groups.end(),
                              [&](const auto& group) { return static_cast<int>(group.size()) < least; }),
               groups.end());
  std::stable_sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return groups;
}

}  // namespace mmgrasp::detail
