#include "mapping/sdf/sdf_field.hpp"

#include "mapping/sdf/sdf_sampler.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp::detail {

SdfField::SdfField(std::shared_ptr<const SdfGrid> grid, double sigmas, UnknownSpace unknown)
    : grid_(std::move(grid)), sigmas_(sigmas), unknown_(unknown) {
  require_not_negative(sigmas, "sigmas");
}

DistanceFieldProperties SdfField::properties() const {
  DistanceFieldProperties out;
  const Eigen::Vector3d everywhere = Eigen::Vector3d::Constant(kInfinity);
  out.domain =
      unknown_ == UnknownSpace::unknown ? grid_->bounds : Eigen::AlignedBox3d(Eigen::Vector3d(-everywhere), everywhere);
  out.error = grid_->options.voxel;
  out.truncation = grid_->options.truncation;
  return out;
}

void SdfField::evaluate(const Eigen::Matrix3Xd& points, Eigen::VectorXd& distances, Eigen::Matrix3Xd* gradients) const {
  SdfSampler sampler(*grid_);
  const double limit = grid_->options.truncation;
  const double elsewhere = unknown_ == UnknownSpace::unknown ? std::numeric_limits<double>::quiet_NaN()
                           : unknown_ == UnknownSpace::free  ? limit
                                                             : -limit;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d p = points.col(i);
    const Sample sample = sampler.at(p);
    distances[i] =
        sample.known ? std::clamp(sample.mean - sigmas_ * std::sqrt(sample.variance), -limit, limit) : elsewhere;
    if (gradients) gradients->col(i) = sample.known ? sampler.direction(p) : Eigen::Vector3d::Zero();
  }
}

}  // namespace mmgrasp::detail
