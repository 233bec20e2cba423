#include "task/base_sequence/equal_covers.hpp"

#include <algorithm>

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kMaxSteps = 300'000;

/// Goes through covers of one size by depth first, each of them once, and leaves branches that cannot be finished.
class Enumeration {
 public:
  Enumeration(const SetCoverProblem& problem, double cost, std::size_t size, std::size_t count)
      : problem_(problem),
        allowed_(cost + 1e-9 * cost),
        size_(size),
        count_(count),
        times_(problem.elements, 0),
        sets_of_(problem.elements),
        barred_(problem.sets.size(), 0),
        open_(problem.elements) {
    for (std::size_t s = 0; s < problem.sets.size(); ++s) {
      largest_ = std::max(largest_, problem.sets[s].size());
      const double cost_here = cost_of(s);
      cheapest_ = s == 0 ? cost_here : std::min(cheapest_, cost_here);
      for (int e : problem.sets[s]) sets_of_[e].push_back(static_cast<int>(s));
    }
  }

  std::vector<std::vector<int>> run() {
    descend(0);
    return std::move(found_);
  }

 private:
  double cost_of(std::size_t s) const { return problem_.costs.empty() ? 1.0 : problem_.costs[s]; }

  void descend(double cost) {
    if (found_.size() >= count_ || ++steps_ > kMaxSteps) return;
    if (open_ == 0) {
      found_.push_back(chosen_);
      std::sort(found_.back().begin(), found_.back().end());
      return;
    }
    const std::size_t more = (open_ + largest_ - 1) / std::max<std::size_t>(1, largest_);
    if (chosen_.size() + more > size_ || cost + static_cast<double>(more) * cheapest_ > allowed_) return;
    // The open element with the fewest sets left; each cover is met once: a set tried is barred from then on.
    int element = -1;
    std::size_t fewest = 0;
    for (std::size_t e = 0; e < times_.size(); ++e) {
      if (times_[e] > 0) continue;
      const std::size_t choices =
          std::count_if(sets_of_[e].begin(), sets_of_[e].end(), [&](int s) { return barred_[s] == 0; });
      if (element < 0 || choices < fewest) {
        element = static_cast<int>(e);
        fewest = choices;
      }
      if (fewest == 0) return;
    }
    std::vector<int> tried;
    for (int s : sets_of_[element]) {
      if (barred_[s]) continue;
      const double with = cost + cost_of(s);
      if (with <= allowed_) {
        take(s);
        descend(with);
        leave(s);
      }
      barred_[s] = 1;
      tried.push_back(s);
    }
    for (int s : tried) barred_[s] = 0;
  }

  void take(int set) {
    chosen_.push_back(set);
    for (int e : problem_.sets[set]) open_ -= times_[e]++ == 0;
  }

  void leave(int set) {
    chosen_.pop_back();
    for (int e : problem_.sets[set]) open_ += --times_[e] == 0;
  }

  const SetCoverProblem& problem_;
  double allowed_, cheapest_ = 0;
  std::size_t size_, count_, largest_ = 0, steps_ = 0;
  std::vector<int> times_;
  std::vector<std::vector<int>> sets_of_;
  std::vector<char> barred_;
  int open_;
  std::vector<int> chosen_;
  std::vector<std::vector<int>> found_;
};

}  // namespace

std::vector<std::vector<int>> equal_covers(const SetCoverProblem& problem, double cost, std::size_t size,
                                           std::size_t count) {
  return Enumeration(problem, cost, size, count).run();
}

}  // namespace mmgrasp::detail
