#pragma once

#include <Eigen/Core>

#include "mmgrasp/core/pose.hpp"

namespace mmgrasp::detail {

/// sqrt(det(J J^T)), the product of J's singular values; from J itself, because J J^T would square its condition.
double volume(const Eigen::Ref<const Matrix6Xd>& J);

}  // namespace mmgrasp::detail
