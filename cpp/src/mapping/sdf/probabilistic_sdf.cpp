#include "mmgrasp/mapping/probabilistic_sdf.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/sdf/cast_rays.hpp"
#include "mapping/sdf/crossing_cells.hpp"
#include "mapping/sdf/extract_mesh.hpp"
#include "mapping/sdf/integrate.hpp"
#include "mapping/sdf/obstacle_cells.hpp"
#include "mapping/sdf/query_points.hpp"
#include "mapping/sdf/sdf_field.hpp"
#include "mapping/sdf/sdf_file.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp {
namespace {

// Numbers of points and rays in one work item.
constexpr Eigen::Index kFewestPoints = 4096, kMostPoints = 1 << 20, kFewestRays = 1024, kMostRays = 1 << 16;

/// Calls work(first, last) for pieces of [0, count). Later ones are smaller: some rays cost a hundred times what others
/// do, and threads are to end together.
template <typename Work>
void by_pieces(Eigen::Index count, Eigen::Index fewest, Eigen::Index most, int threads, const Work& work) {
  const Eigen::Index shares = 2 * resolve_threads(threads);
  std::vector<Eigen::Index> ends{0};
  while (ends.back() < count) {
    const Eigen::Index left = count - ends.back();
    ends.push_back(ends.back() + std::min(left, std::clamp(left / shares, fewest, most)));
  }
  parallel_for(ends.size() - 1, threads, [&](std::size_t item, int) { work(ends[item], ends[item + 1]); });
}

}  // namespace

void SdfOptions::check() const {
  require_positive(voxel, "voxel", "m");
  require_number(truncation, "truncation", "m");
  require(truncation >= 3 * voxel * (1 - 1e-9), "truncation", truncation,
          "must be finite and at least three voxels [m]");
  require(truncation <= 100 * voxel, "truncation", truncation,
          "must be at most 100 voxels: finer ones take too much memory [m]");
  require(max_incidence > 0 && max_incidence < 1.55, "max_incidence", max_incidence,
          "must be above 0 and below 1.55 [rad]");
  require(outlier_gate == 0 || (std::isfinite(outlier_gate) && outlier_gate >= 3), "outlier_gate", outlier_gate,
          "must be 0 or at least 3 standard deviations and finite");
  require(persistence >= 1 && persistence <= 254, "persistence", persistence, "must be from 1 to 254 frames");
  require_positive(max_memory, "max_memory", "bytes", kLargestNumber);
  resolve_threads(threads);
}

ProbabilisticSdf::ProbabilisticSdf(const SdfOptions& options) {
  options.check();
  grid_ = std::make_shared<detail::SdfGrid>(options);
}

ProbabilisticSdf::ProbabilisticSdf(std::shared_ptr<detail::SdfGrid> grid) : grid_(std::move(grid)) {}

const SdfOptions& ProbabilisticSdf::options() const {
  return grid_->options;
}

IntegrationReport ProbabilisticSdf::integrate(const DepthImage& image, const DepthCamera& camera,
                                              const FrameUncertainty& uncertainty) {
  // Copies and fields of this map keep what they had.
  if (grid_.use_count() > 1) grid_ = std::make_shared<detail::SdfGrid>(*grid_);
  grid_->forget_crossing_cells();
  return detail::integrate_frame(*grid_, image, camera, uncertainty);
}

SdfValues ProbabilisticSdf::query(const Eigen::Ref<const Eigen::Matrix3Xd>& points, int threads) const {
  require_positions(points, "point");
  SdfValues out;
  out.mean.resize(points.cols());
  out.sigma.resize(points.cols());
  out.known.resize(points.cols());
  by_pieces(points.cols(), kFewestPoints, kMostPoints, threads,
            [&](Eigen::Index first, Eigen::Index last) { detail::query_points(*grid_, points, first, last, out); });
  return out;
}

SdfHits ProbabilisticSdf::cast_rays(const Eigen::Ref<const Eigen::Matrix3Xd>& origins,
                                    const Eigen::Ref<const Eigen::Matrix3Xd>& directions, int threads) const {
  require(origins.cols() == directions.cols(), "directions", std::to_string(directions.cols()),
          "must be as many as origins, " + std::to_string(origins.cols()));
  require_positions(origins, "origin");
  require_positions(directions, "direction");
  for (Eigen::Index i = 0; i < directions.cols(); ++i) {
    if (directions.col(i).isZero(0)) throw InvalidInput("direction " + std::to_string(i) + ": must not be zero");
  }
  const Eigen::Index count = origins.cols();
  SdfHits out;
  out.hit.resize(count);
  out.distance.resize(count);
  out.point.resize(3, count);
  out.normal.resize(3, count);
  out.sigma.resize(count);
  const std::shared_ptr<detail::CrossingCells> crossing = grid_->crossing_cells();
  by_pieces(count, kFewestRays, kMostRays, threads, [&](Eigen::Index first, Eigen::Index last) {
    detail::cast_rays(*grid_, *crossing, origins, directions, first, last, out);
  });
  return out;
}

ProbabilisticSdf ProbabilisticSdf::cropped(const Eigen::AlignedBox3d& box) const {
  return ProbabilisticSdf(grid_->cropped(box));
}

SdfMesh ProbabilisticSdf::mesh(const Monitor& monitor) const {
  return detail::extract_mesh(*grid_, nullptr, monitor);
}

SdfMesh ProbabilisticSdf::mesh(const Eigen::AlignedBox3d& within, const Monitor& monitor) const {
  return detail::extract_mesh(*grid_, &within, monitor);
}

SdfPoints ProbabilisticSdf::points(const Monitor& monitor) const {
  const SdfMesh surface = mesh(monitor);
  const auto& vertices = surface.mesh->vertices;
  SdfPoints out;
  const auto count = static_cast<Eigen::Index>(vertices.size());
  out.point.resize(3, count);
  out.normal.setZero(3, count);
  out.sigma = Eigen::Map<const Eigen::VectorXd>(surface.sigma.data(), count);
  for (Eigen::Index i = 0; i < count; ++i) out.point.col(i) = vertices[i];
  // Normals of the triangles around, weighted by their areas.
  for (const auto& t : surface.mesh->triangles) {
    const Eigen::Vector3d normal = (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
    for (const int corner : t) out.normal.col(corner) += normal;
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const double length = out.normal.col(i).norm();
    if (length > 0) out.normal.col(i) /= length;
  }
  return out;
}

void SdfObstacleOptions::check() const {
  require_not_negative(sigmas, "sigmas");
  require(unknown != UnknownSpace::unknown, "unknown", "unknown", "must be free or occupied");
  if (bounds.isEmpty()) return;  // none
  require_numbers(bounds.min(), "bounds[0]", "m");
  require_numbers(bounds.max(), "bounds[1]", "m");
}

std::vector<Voxels> ProbabilisticSdf::obstacle_cells(const SdfObstacleOptions& options) const {
  return detail::obstacle_cells(*grid_, options);
}

std::shared_ptr<const DistanceField> ProbabilisticSdf::distance_field(double sigmas, UnknownSpace unknown) const {
  return std::make_shared<detail::SdfField>(grid_, sigmas, unknown);
}

int ProbabilisticSdf::frames() const {
  return grid_->frames;
}

std::size_t ProbabilisticSdf::blocks() const {
  return grid_->keys.size();
}

std::size_t ProbabilisticSdf::memory() const {
  return grid_->bytes();
}

Eigen::AlignedBox3d ProbabilisticSdf::bounds() const {
  return grid_->bounds;
}

void ProbabilisticSdf::save(const std::string& path) const {
  detail::write_sdf(*grid_, path);
}

ProbabilisticSdf ProbabilisticSdf::load(const std::string& path, int threads) {
  auto grid = detail::read_sdf(path);
  resolve_threads(threads);
  grid->options.threads = threads;
  return ProbabilisticSdf(std::move(grid));
}

}  // namespace mmgrasp
