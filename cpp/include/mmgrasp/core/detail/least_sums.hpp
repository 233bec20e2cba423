#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace mmgrasp::detail {

/// Chooses one value from each of several ascending lists, in the order of the choices' sums. Only as many choices are
/// made as are asked for.
class LeastSums {
 public:
  /// No choice when a list is empty.
  explicit LeastSums(std::vector<std::vector<double>> lists) : lists_(std::move(lists)) {
    double sum = 0;
    for (const auto& list : lists_) {
      if (list.empty()) return;
      sum += list.front();
    }
    open_.push_back({sum, std::vector<int>(lists_.size(), 0), 0});
  }

  /// The next choice: an index into each list, and the sum. False when there are no more.
  bool next(std::vector<int>& choice, double& sum) {
    if (open_.empty()) return false;
    std::pop_heap(open_.begin(), open_.end(), later);
    Choice best = std::move(open_.back());
    open_.pop_back();
    // Each other choice comes from one: that with its last index above zero lowered by one.
    for (std::size_t i = best.last; i < lists_.size(); ++i) {
      const std::size_t at = best.index[i];
      if (at + 1 == lists_[i].size()) continue;
      Choice more = best;
      ++more.index[i];
      more.last = i;
      more.sum += lists_[i][at + 1] - lists_[i][at];
      open_.push_back(std::move(more));
      std::push_heap(open_.begin(), open_.end(), later);
    }
    choice = std::move(best.index);
    sum = best.sum;
    return true;
  }

 private:
  struct Choice {
    double sum;
    std::vector<int> index;
    std::size_t last;  ///< Indices after this one are zero.
  };
  static bool later(const Choice& a, const Choice& b) { return a.sum != b.sum ? a.sum > b.sum : a.index > b.index; }

  std::vector<std::vector<double>> lists_;
  std::vector<Choice> open_;  ///< A heap.
};

}  // namespace mmgrasp::detail
