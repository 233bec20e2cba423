#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "structure/frame/beam_element.hpp"

namespace mmgrasp::detail {

/// Stiffness and loads of a frame, and its displacements where some are fixed to zero. `Scalar` is double or Wide.
template <class Scalar>
class BeamEquations {
 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  BeamEquations(int size, int load_cases) : loads(Matrix::Zero(size, load_cases)) {}

  void add(const Matrix12<Scalar>& stiffness, const std::array<int, 2>& nodes) {
    elements_.emplace_back(stiffness, nodes);
  }
  /// One factorisation, all load cases; none when the fixed ones leave the frame movable, as far as `Scalar` can tell.
  std::optional<Matrix> solve(const std::vector<bool>& fixed) const;

  Matrix loads;

 private:
  std::vector<std::pair<Matrix12<Scalar>, std::array<int, 2>>> elements_;
};

}  // namespace mmgrasp::detail
