#include "structure/frame/beam_solve.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <type_traits>

#include "structure/frame/wide.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kMostDense = 300;  // unknowns; above, most of the matrix is zero and worth skipping
// The matrix is scaled to ones on its diagonal; what can move leaves a pivot of some roundings, 1e-16 and 1e-34 each.
template <class Scalar>
constexpr double kLeastPivot = std::is_same_v<Scalar, double> ? 1e-12 : 1e-29;

}  // namespace

template <class Scalar>
std::optional<typename BeamEquations<Scalar>::Matrix> BeamEquations<Scalar>::solve(
    const std::vector<bool>& fixed) const {
  std::vector<int> column(fixed.size(), -1);
  int free = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i) column[i] = fixed[i] ? -1 : free++;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  Vector scale = Vector::Zero(free);  // displacements and rotations have other units
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
  each([&](int i, int j, const Scalar& k) {
    if (i == j) scale(i) += k;
  });
  scale = scale.cwiseSqrt().cwiseInverse().eval();
  Matrix right(free, loads.cols());
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (column[i] >= 0) right.row(column[i]) = scale(column[i]) * loads.row(static_cast<Eigen::Index>(i));
  }
  Matrix solution;
  if (std::is_same_v<Scalar, double> && free <= kMostDense) {
    Matrix K = Matrix::Zero(free, free);
    each([&](int i, int j, const Scalar& k) { K(i, j) += scale(i) * k * scale(j); });
    const Eigen::LLT<Matrix> factor(K);
    if (free > 0 &&
        (factor.info() != Eigen::Success || factor.matrixLLT().diagonal().minCoeff() < std::sqrt(kLeastPivot<Scalar>)))
      return {};
    solution = factor.solve(right);
  } else {
    std::vector<Eigen::Triplet<Scalar>> entries;
    each([&](int i, int j, const Scalar& k) {
      if (i >= j) entries.emplace_back(i, j, scale(i) * k * scale(j));
    });
    Eigen::SparseMatrix<Scalar> K(free, free);
    K.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<Scalar>> factor(K);
    if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > kLeastPivot<Scalar>)) return {};
    solution = factor.solve(right);
  }
  Matrix out = Matrix::Zero(loads.rows(), loads.cols());
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (column[i] >= 0) out.row(static_cast<Eigen::Index>(i)) = scale(column[i]) * solution.row(column[i]);
  }
  return out;
}

template class BeamEquations<double>;
template class BeamEquations<Wide>;

}  // namespace mmgrasp::detail
