#include "mmgrasp/optim/pairwise_weights.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

PairwiseWeights pairwise_weights(const Eigen::MatrixXd& comparison, double max_consistency_ratio) {
  constexpr double kRandomIndex[] = {0, 0, 0, 0.58, 0.9, 1.12, 1.24, 1.32, 1.41, 1.45, 1.49};  // P2 table 3.1
  const Eigen::Index m = comparison.rows();
  require(comparison.cols() == m && m >= 2 && m <= 10, "comparison",
          "of shape (" + std::to_string(m) + ", " + std::to_string(comparison.cols()) + ")",
          "must be square with 2 to 10 rows");
  require(max_consistency_ratio >= 0, "max_consistency_ratio", max_consistency_ratio, "must be zero or positive");
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j < m; ++j) {
      const std::string entry = "comparison[" + std::to_string(i) + ", " + std::to_string(j) + "]";
      require_positive(comparison(i, j), entry, "", kLargestNumber);
      if (std::abs(comparison(i, j) * comparison(j, i) - 1) <= 1e-6) continue;
      std::ostringstream opposite;
      opposite << std::setprecision(9) << 1 / comparison(j, i);
      require(false, entry, comparison(i, j),
              "must be one over its opposite, " + opposite.str() + ": the matrix is not reciprocal");
    }
  }
  PairwiseWeights out;
  out.weights = (comparison.array().rowwise() / comparison.colwise().sum().array()).rowwise().mean();
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(comparison);
  Eigen::Index largest = 0;
  solver.eigenvalues().real().maxCoeff(&largest);  // real and simple for a positive matrix (Perron)
  out.largest_eigenvalue = solver.eigenvalues()(largest).real();
  out.eigenvector = solver.eigenvectors().col(largest).real();
  out.eigenvector /= out.eigenvector.sum();
  if (m > 2) {
    out.consistency_ratio =
        (out.largest_eigenvalue - static_cast<double>(m)) / static_cast<double>(m - 1) / kRandomIndex[m];
  }
  require(out.consistency_ratio <= max_consistency_ratio, "comparison",
          "inconsistent by a ratio of " + std::to_string(out.consistency_ratio),
          "must be at most " + std::to_string(max_consistency_ratio) + " (Saaty's rule: 10 %); compare again");
  return out;
}

}  // namespace mmgrasp
