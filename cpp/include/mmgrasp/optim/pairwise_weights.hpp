#pragma once

#include <Eigen/Core>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Weights from pairwise comparisons (Saaty's Analytic Hierarchy Process; P2 3.3.2).
struct MMGRASP_EXPORT PairwiseWeights {
  Eigen::VectorXd weights;      ///< Averages of the rows after each column is divided by its sum (P2); they sum to 1.
  Eigen::VectorXd eigenvector;  ///< The principal eigenvector, Saaty's own weights; they sum to 1.
  double largest_eigenvalue = 0;
  /// (largest eigenvalue - m) / (m - 1) over the random index of P2 table 3.1; 0 for two.
  double consistency_ratio = 0;
};

/// `comparison(i, j)` says how much i is preferred to j. Throws InvalidInput naming the entry unless it is square with
/// 2 to 10 rows, positive and reciprocal (comparison(j, i) = 1 / comparison(i, j), within 1e-6 of it), and when its
/// consistency ratio exceeds the most allowed: Saaty's rule is 10 %.
MMGRASP_EXPORT PairwiseWeights pairwise_weights(const Eigen::MatrixXd& comparison, double max_consistency_ratio = 0.1);

}  // namespace mmgrasp
