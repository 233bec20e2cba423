#include "mmgrasp/optim/assignment.hpp"

#include <algorithm>
#include <string>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

std::vector<int> cheapest_assignment(const Eigen::MatrixXd& costs) {
  const std::string shape = "(" + std::to_string(costs.rows()) + ", " + std::to_string(costs.cols()) + ")";
  require(costs.rows() == costs.cols(), "shape of costs", shape, "must be square");
  for (Eigen::Index row = 0; row < costs.rows(); ++row)
    require_numbers(costs.row(row).transpose(), "costs[" + std::to_string(row) + "]", "", kLargestNumber);
  // Row and column 0 stand for "none": each row in turn finds the cheapest way to a free column over reduced costs.
  const std::size_t n = costs.rows();
  std::vector<double> row_price(n + 1, 0), column_price(n + 1, 0), slack(n + 1);
  std::vector<std::size_t> row_of(n + 1, 0), previous(n + 1, 0);
  std::vector<char> done(n + 1);
  for (std::size_t row = 1; row <= n; ++row) {
    row_of[0] = row;
    std::size_t column = 0;
    std::fill(slack.begin(), slack.end(), detail::kInfinity);
    std::fill(done.begin(), done.end(), 0);
    do {
      detail::throw_if_interrupted();
      done[column] = 1;
      const std::size_t at = row_of[column];
      std::size_t next = 0;
      double least = detail::kInfinity;
      for (std::size_t j = 1; j <= n; ++j) {
        if (done[j]) continue;
        const double reduced = costs(static_cast<Eigen::Index>(at - 1), static_cast<Eigen::Index>(j - 1)) -
                               row_price[at] - column_price[j];
        if (reduced < slack[j]) {
          slack[j] = reduced;
          previous[j] = column;
        }
        if (slack[j] < least) {
          least = slack[j];
          next = j;
        }
      }
      for (std::size_t j = 0; j <= n; ++j) {
        if (done[j]) {
          row_price[row_of[j]] += least;
          column_price[j] -= least;
        } else {
          slack[j] -= least;
        }
      }
      column = next;
    } while (row_of[column] != 0);
    for (; column != 0; column = previous[column]) row_of[column] = row_of[previous[column]];
  }
  std::vector<int> column_of(n);
  for (std::size_t j = 1; j <= n; ++j) column_of[row_of[j] - 1] = static_cast<int>(j - 1);
  return column_of;
}

}  // namespace mmgrasp
