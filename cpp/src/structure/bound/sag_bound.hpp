#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/structure/supported_frame.hpp"
#include "structure/bound/linear_form.hpp"

namespace mmgrasp::detail {

/// Bounds the sum of largest displacements (O2) from below over an interval of clamps on one member. Seen from a clamp
/// that moves along a member, the displacement of any place that is not inside that member is a polynomial of degree
/// six in the clamp's distance, and linear in gravity; it is found by interpolation.
class MMGRASP_EXPORT SagBound {
 public:
  /// `gravity`: in the object's frame, for each pose that counts [m/s2].
  SagBound(const BeamFrame& frame, std::vector<Eigen::Vector3d> gravity);

  /// Below the sum for every clamp at middle + half x, x in [-1, 1]; the slope is that in x [m].
  LinearForm below(int member, double middle, double half) const;

 private:
  static constexpr int kTerms = 9;
  using Powers = Eigen::Matrix<double, 12, kTerms>;  ///< Row 4 k + j: component k for gravity j (3: without gravity).
  /// Displacements of one place by powers of t, -1 at the member's first node and 1 at its second.
  std::vector<std::vector<Powers>> places_;  ///< One entry for each clamped member.
  std::vector<std::vector<double>> off_;  ///< How far each polynomial may be off, by the size of what it was made from.
  std::vector<double> length_;
  std::vector<Eigen::Vector3d> gravity_;
};

}  // namespace mmgrasp::detail
