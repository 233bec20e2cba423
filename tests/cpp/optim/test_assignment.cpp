#include "mmgrasp/optim/assignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

double cost_of(const Eigen::MatrixXd& costs, const std::vector<int>& columns) {
  double sum = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) sum += costs(static_cast<Eigen::Index>(i), columns[i]);
  return sum;
}

TEST(Assignment, EqualsEveryPermutation) {
  Rng rng(3);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const int n = static_cast<int>(rng.index(8));
    Eigen::MatrixXd costs(n, n);
    for (double& c : costs.reshaped()) c = repeat % 2 ? rng.uniform(-5, 5) : static_cast<double>(rng.index(4));
    std::vector<int> columns(n);
    std::iota(columns.begin(), columns.end(), 0);
    double best = std::numeric_limits<double>::infinity();
    do {
      best = std::min(best, cost_of(costs, columns));
    } while (std::next_permutation(columns.begin(), columns.end()));
    std::vector<int> found = cheapest_assignment(costs);
    EXPECT_NEAR(cost_of(costs, found), best, 1e-9);
    std::sort(found.begin(), found.end());
    std::iota(columns.begin(), columns.end(), 0);
    EXPECT_EQ(found, columns);
  }
}

TEST(Assignment, RefusesBadInput) {
  EXPECT_THROW(cheapest_assignment(Eigen::MatrixXd::Zero(2, 3)), InvalidInput);
  EXPECT_THROW(cheapest_assignment(Eigen::MatrixXd::Constant(2, 2, std::numeric_limits<double>::infinity())),
               InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
