#pragma once

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// Mean less a margin of standard deviations, as a field that others can ask.
class SdfField : public DistanceField {
 public:
  SdfField(std::shared_ptr<const SdfGrid> grid, double sigmas, UnknownSpace unknown);
  DistanceFieldProperties properties() const override;

 private:
  void evaluate(const Eigen::Matrix3Xd& points, Eigen::VectorXd& distances, Eigen::Matrix3Xd* gradients) const override;

  std::shared_ptr<const SdfGrid> grid_;
  double sigmas_;
  UnknownSpace unknown_;
};

}  // namespace mmgrasp::detail
