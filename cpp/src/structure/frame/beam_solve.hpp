#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "structure/frame/beam_element.hpp"

namespace mmgrasp::detail {

/// Stiffness and loads of a frame, and its displacements where some are fixed to zero.
class BeamEquations {
 public:
  BeamEquations(int size, int load_cases) : loads(Eigen::MatrixXd::Zero(size, load_cases)) {}

  void add(const Matrix12d& stiffness, const std::array<int, 2>& nodes) { elements_.emplace_back(stiffness, nodes); }
  /// One factorisation, all load cases. Throws InvalidInput when the fixed ones leave the frame movable.
  Eigen::MatrixXd solve(const std::vector<bool>& fixed) const;
  Eigen::MatrixXd times_stiffness(const Eigen::MatrixXd& displacements) const;

  Eigen::MatrixXd loads;

 private:
  std::vector<std::pair<Matrix12d, std::array<int, 2>>> elements_;
};

}  // namespace mmgrasp::detail
