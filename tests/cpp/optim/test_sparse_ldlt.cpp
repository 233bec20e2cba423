// The sparse factorisation against dense eigenvalues and solutions.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <random>
#include <vector>

#include "optim/sparse/sparse_ldlt.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kThreshold = 1e-8;  // Ipopt's

/// Lower triangle of a matrix by columns; some entries are given as two that add up.
struct Given {
  LowerColumns pattern;
  std::vector<double> values;
};

Given given(const MatrixXd& A, std::mt19937* split = nullptr) {
  Given out;
  out.pattern.starts = {0};
  const auto add = [&](Eigen::Index row, double value) {
    out.pattern.rows.push_back(static_cast<int>(row));
    out.values.push_back(value);
  };
  for (Eigen::Index c = 0; c < A.cols(); ++c) {
    for (Eigen::Index r = c; r < A.rows(); ++r) {
      if (A(r, c) == 0) continue;
      const double part = split && (*split)() % 4 == 0 ? 0.25 : 0;
      if (part > 0) add(r, part * A(r, c));
      add(r, (1 - part) * A(r, c));
    }
    out.pattern.starts.push_back(static_cast<int>(out.pattern.rows.size()));
  }
  return out;
}

/// A band, and a border of rows that may reach every column; entries are missing at random, the diagonal's too. Every
/// third row of a saddle point has nothing in common with the others of its kind, as multipliers have.
MatrixXd banded(std::mt19937& rng, int n, int band, int border, bool saddle) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share;
  MatrixXd A = MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      if (i - j > band && i < n - border) continue;
      if (share(rng) < (i == j ? 0.5 : 0.4)) continue;
      if (saddle && i % 3 == 1 && j % 3 == 1) continue;
      A(i, j) = A(j, i) = normal(rng) * std::pow(10, 2 * share(rng));
    }
  }
  return A;
}

int negative(const VectorXd& eigenvalues) {
  return static_cast<int>((eigenvalues.array() < 0).count());
}

/// |A y - b| over |A| |y|, y the answer for b.
double residual(SparseLdlt& ldlt, const MatrixXd& A, const VectorXd& b) {
  VectorXd y = b;
  ldlt.solve(y.data());
  return (A * y - b).norm() / std::max(1e-300, A.norm() * y.norm());
}

TEST(SparseLdlt, FindsInertiaAndSolutionOfBandsWithBorders) {
  std::mt19937 rng(1);
  int regular = 0, waited = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const int n = 1 + static_cast<int>(rng() % 60);
    const MatrixXd A = banded(rng, n, 1 + static_cast<int>(rng() % 6), static_cast<int>(rng() % 3), rng() % 2 == 0);
    const VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
    if (eigenvalues.cwiseAbs().minCoeff() <= 1e-9 * eigenvalues.cwiseAbs().maxCoeff()) continue;
    ++regular;
    const Given g = given(A, &rng);
    SparseLdlt ldlt(g.pattern);
    ASSERT_TRUE(ldlt.factor(g.values.data(), kThreshold)) << "trial " << trial;
    EXPECT_EQ(ldlt.negative(), negative(eigenvalues)) << "trial " << trial;
    waited += ldlt.waited();
    // Entries of L may be as large as 1 / threshold.
    EXPECT_LT(residual(ldlt, A, VectorXd::Random(n)), 1e-16 / kThreshold) << "trial " << trial;
    ASSERT_TRUE(ldlt.factor(g.values.data(), 0.1));
    EXPECT_EQ(ldlt.negative(), negative(eigenvalues)) << "trial " << trial;
    EXPECT_LT(residual(ldlt, A, VectorXd::Random(n)), 1e-13) << "trial " << trial;
  }
  EXPECT_GT(regular, 1000);
  EXPECT_GT(waited, 200);
}

TEST(SparseLdlt, SaysWhatIsSingular) {
  std::mt19937 rng(2);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 5 + static_cast<int>(rng() % 40);
    MatrixXd A = banded(rng, n, 4, 1, true);
    const int empty = static_cast<int>(rng() % n);
    A.row(empty).setZero();
    A.col(empty).setZero();
    const Given g = given(A);
    SparseLdlt ldlt(g.pattern);
    EXPECT_FALSE(ldlt.factor(g.values.data(), kThreshold));
  }
  // A constraint that stands there twice: x0 + x1 = 1 and 2 x0 + 2 x1 = 2.
  MatrixXd A(4, 4);
  A << 1, 0, 1, 2, 0, 1, 1, 2, 1, 1, 0, 0, 2, 2, 0, 0;
  Given g = given(A);
  SparseLdlt ldlt(g.pattern);
  EXPECT_FALSE(ldlt.factor(g.values.data(), kThreshold));
  // More multipliers than variables that they can go with.
  MatrixXd B = MatrixXd::Zero(5, 5);
  B.row(0).tail(3).setOnes();
  B(1, 1) = 1;
  g = given(MatrixXd(B.transpose() + B));
  EXPECT_FALSE(SparseLdlt(g.pattern).factor(g.values.data(), kThreshold));
}

TEST(SparseLdlt, TakesPairsWhereTheDiagonalIsEmpty) {
  // Eigenvalues come as +-: half are negative.
  std::mt19937 rng(3);
  std::normal_distribution<double> normal;
  for (int n : {1, 2, 5, 30}) {
    MatrixXd B(n, n);
    for (Eigen::Index i = 0; i < B.size(); ++i) B.data()[i] = normal(rng);
    MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);
    A.topRightCorner(n, n) = B;
    A.bottomLeftCorner(n, n) = B.transpose();
    const Given g = given(A);
    SparseLdlt ldlt(g.pattern);
    ASSERT_TRUE(ldlt.factor(g.values.data(), 0.01));
    EXPECT_EQ(ldlt.negative(), n);
    EXPECT_LT(residual(ldlt, A, VectorXd::Random(2 * n)), 1e-13);
  }
}

TEST(SparseLdlt, FactorsOtherValuesOfThePattern) {
  std::mt19937 rng(4);
  const MatrixXd A = banded(rng, 50, 5, 2, false) + 30 * MatrixXd::Identity(50, 50);
  const Given g = given(A);
  SparseLdlt ldlt(g.pattern), fresh(g.pattern);
  std::vector<double> values = g.values;
  for (int trial = 0; trial < 20; ++trial) {
    for (double& value : values) value = (static_cast<int>(rng() % 2001) - 1000) * 1e-3;
    ldlt.factor(values.data(), kThreshold);
  }
  ASSERT_TRUE(ldlt.factor(g.values.data(), kThreshold));
  ASSERT_TRUE(fresh.factor(g.values.data(), kThreshold));
  EXPECT_EQ(ldlt.negative(), fresh.negative());
  VectorXd a = VectorXd::LinSpaced(50, -1, 1), b = a;
  ldlt.solve(a.data());
  fresh.solve(b.data());
  EXPECT_EQ(a, b);
}

TEST(SparseLdlt, FillsLittleOfAChainWithABorder) {
  // Blocks of 10 on a chain of 400, each joined to the next; two rows that all columns meet.
  const int blocks = 400, size = 10, n = blocks * size + 2;
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  LowerColumns pattern;
  pattern.starts = {0};
  std::vector<double> values;
  for (int c = 0; c < n; ++c) {
    const int end = std::min(blocks * size, (c / size + 2) * size);
    for (int r = c; r < n; ++r) {
      if (r == end && r < n - 2) r = n - 2;
      pattern.rows.push_back(r);
      values.push_back(normal(rng));
    }
    pattern.starts.push_back(static_cast<int>(pattern.rows.size()));
  }
  SparseLdlt ldlt(pattern);
  ASSERT_TRUE(ldlt.factor(values.data(), kThreshold));
  EXPECT_LT(ldlt.largest_front(), 5 * size);
  VectorXd b = VectorXd::Random(n), x = b, product = VectorXd::Zero(n);
  ldlt.solve(x.data());
  for (int c = 0; c < n; ++c) {
    for (int e = pattern.starts[c]; e < pattern.starts[c + 1]; ++e) {
      const int r = pattern.rows[e];
      product[r] += values[e] * x[c];
      if (r != c) product[c] += values[e] * x[r];
    }
  }
  EXPECT_LT((product - b).norm(), 1e-6 * b.norm());
}

}  // namespace
}  // namespace mmgrasp::detail
