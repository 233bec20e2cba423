#include "structure/frame/beam_solve.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <cmath>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostDense = 300;        // unknowns; above, most of the matrix is zero and worth skipping
constexpr double kLeastPivot = 1e-12;  // of the matrix scaled to ones on its diagonal

[[noreturn]] void refuse() {
  throw InvalidInput(
      "supports: unstable, they leave the frame movable; clamp it, or hinder all six movements together");
}

}  // namespace

MatrixXd BeamEquations::solve(const std::vector<bool>& fixed) const {
  std::vector<int> column(fixed.size(), -1);
  int free = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i) column[i] = fixed[i] ? -1 : free++;
  VectorXd scale = VectorXd::Zero(free);  // displacements and rotations have other units
  const auto each = [&](const auto& entry) {
    for (const auto& [K, nodes] : elements_) {
      for (int p = 0; p < 12; ++p) {
        const int row = column[6 * nodes[p / 6] + p % 6];
        for (int q = 0; row >= 0 && q < 12; ++q) {
          const int to = column[6 * nodes[q / 6] + q % 6];
          if (to >= 0) entry(row, to, K(p, q));
        }
      }
    }
  };
  each([&](int i, int j, double k) { scale(i) += i == j ? k : 0; });
  scale = scale.cwiseSqrt().cwiseInverse().eval();
  MatrixXd right(free, loads.cols());
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (column[i] >= 0) right.row(column[i]) = scale(column[i]) * loads.row(static_cast<Eigen::Index>(i));
  }
  MatrixXd solution;
  if (free <= kMostDense) {
    MatrixXd K = MatrixXd::Zero(free, free);
    each([&](int i, int j, double k) { K(i, j) += scale(i) * k * scale(j); });
    const Eigen::LLT<MatrixXd> factor(K);
    if (free > 0 &&
        (factor.info() != Eigen::Success || factor.matrixLLT().diagonal().minCoeff() < std::sqrt(kLeastPivot)))
      refuse();
    solution = factor.solve(right);
  } else {
    std::vector<Eigen::Triplet<double>> entries;
    each([&](int i, int j, double k) { entries.emplace_back(i, j, scale(i) * k * scale(j)); });
    Eigen::SparseMatrix<double> K(free, free);
    K.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(K);
    if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > kLeastPivot)) refuse();
    solution = factor.solve(right);
  }
  MatrixXd out = MatrixXd::Zero(loads.rows(), loads.cols());
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (column[i] >= 0) out.row(static_cast<Eigen::Index>(i)) = scale(column[i]) * solution.row(column[i]);
  }
  return out;
}

MatrixXd BeamEquations::times_stiffness(const MatrixXd& displacements) const {
  MatrixXd out = MatrixXd::Zero(displacements.rows(), displacements.cols());
  for (const auto& [K, nodes] : elements_) {
    for (int p = 0; p < 2; ++p) {
      for (int q = 0; q < 2; ++q) {
        out.middleRows<6>(6 * nodes[p]) += K.block<6, 6>(6 * p, 6 * q) * displacements.middleRows<6>(6 * nodes[q]);
      }
    }
  }
  return out;
}

}  // namespace mmgrasp::detail
