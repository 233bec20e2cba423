#include "optim/tour/tour_search.hpp"

#include <algorithm>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr int kLongestRun = 3;  // Stops moved together.
constexpr double kWork = 4e7;   // Moves checked, about.
constexpr int kMaxRestarts = 2000;
constexpr double kGain = 1e-10;  // Relative: less is rounding.

std::vector<int> cheapest_insertion(const Eigen::MatrixXd& lengths, int n) {
  // Each stop knows its cheapest gap; only gaps that changed are checked again.
  struct Gap {
    double extra = kInfinity;
    int before = -1;
  };
  std::vector<int> next(n + 2, -1);
  next[n] = n + 1;
  std::vector<Gap> best(n);
  std::vector<char> placed(n, 0);
  const auto look = [&](int stop, int before) {
    const int after = next[before];
    const double extra = lengths(before, stop) + lengths(stop, after) - lengths(before, after);
    Gap& gap = best[stop];
    if (extra < gap.extra) gap = {extra, before};
  };
  for (int stop = 0; stop < n; ++stop) look(stop, n);
  for (int round = 0; round < n; ++round) {
    throw_if_interrupted();
    int chosen = -1;
    for (int stop = 0; stop < n; ++stop) {
      if (placed[stop]) continue;
      if (chosen < 0 || best[stop].extra < best[chosen].extra) chosen = stop;
    }
    const int before = best[chosen].before;
    next[chosen] = next[before];
    next[before] = chosen;
    placed[chosen] = 1;
    for (int stop = 0; stop < n; ++stop) {
      if (placed[stop]) continue;
      if (best[stop].before == before) {  // that gap is no more
        best[stop] = {};
        throw_if_interrupted();
        for (int at = n; at != n + 1; at = next[at]) look(stop, at);
      } else {
        look(stop, before);
        look(stop, chosen);
      }
    }
  }
  std::vector<int> order;
  for (int at = next[n]; at != n + 1; at = next[at]) order.push_back(at);
  return order;
}

/// A way with start and goal as its ends, and what moves in it would gain.
class Way {
 public:
  Way(const Eigen::MatrixXd& lengths, const std::vector<int>& order) : lengths_(&lengths) {
    const int n = static_cast<int>(order.size());
    at_.push_back(n);
    at_.insert(at_.end(), order.begin(), order.end());
    at_.push_back(n + 1);
    sum_up();
  }

  double length() const { return ahead_.back(); }
  std::vector<int> order() const { return {at_.begin() + 1, at_.end() - 1}; }
  double moves_looked_at() const { return looked_; }

  void improve() {
    while (reverse_best() || move_best()) {
    }
  }

  /// a b c d becomes a c b d.
  void exchange(int i, int j, int k) {
    std::rotate(at_.begin() + i, at_.begin() + j, at_.begin() + k);
    sum_up();
  }

 private:
  double d(int i, int j) const { return (*lengths_)(at_[i], at_[j]); }
  int last() const { return static_cast<int>(at_.size()) - 1; }

  void sum_up() {
    ahead_.assign(at_.size(), 0);
    back_.assign(at_.size(), 0);
    for (int i = 1; i <= last(); ++i) {
      ahead_[i] = ahead_[i - 1] + d(i - 1, i);
      back_[i] = back_[i - 1] + d(i, i - 1);
    }
  }

  /// Lengths inside positions i..j, driven as they are or the other way round.
  double inside(int i, int j) const { return ahead_[j] - ahead_[i]; }
  double inside_reversed(int i, int j) const { return back_[j] - back_[i]; }

  bool reverse_best() {
    double best = -kGain * (1 + length());
    int best_i = -1, best_j = -1;
    for (int i = 1; i < last() - 1; ++i) {
      poll_();
      for (int j = i + 1; j < last(); ++j) {
        const double change =
            d(i - 1, j) + d(i, j + 1) - d(i - 1, i) - d(j, j + 1) + inside_reversed(i, j) - inside(i, j);
        if (change < best) {
          best = change;
          best_i = i;
          best_j = j;
        }
      }
    }
    looked_ += 0.5 * last() * last();
    if (best_i < 0) return false;
    std::reverse(at_.begin() + best_i, at_.begin() + best_j + 1);
    sum_up();
    return true;
  }

  /// Runs of stops go elsewhere, either way round.
  bool move_best() {
    double best = -kGain * (1 + length());
    int best_i = -1, best_j = -1, best_gap = -1;
    bool best_reversed = false;
    for (int i = 1; i < last(); ++i) {
      poll_();
      for (int j = i; j < std::min(last(), i + kLongestRun); ++j) {
        const double out = d(i - 1, j + 1) - d(i - 1, i) - d(j, j + 1);
        const double turned = inside_reversed(i, j) - inside(i, j);
        for (int gap = 0; gap < last(); ++gap) {  // between gap and gap + 1
          if (gap >= i - 1 && gap <= j) continue;
          const double without = out - d(gap, gap + 1);
          const double same = without + d(gap, i) + d(j, gap + 1), other = without + turned + d(gap, j) + d(i, gap + 1);
          if (std::min(same, other) >= best) continue;
          best = std::min(same, other);
          best_i = i;
          best_j = j;
          best_gap = gap;
          best_reversed = other < same;
        }
      }
    }
    looked_ += kLongestRun * 1.0 * last() * last();
    if (best_i < 0) return false;
    if (best_reversed) std::reverse(at_.begin() + best_i, at_.begin() + best_j + 1);
    if (best_gap < best_i) {
      std::rotate(at_.begin() + best_gap + 1, at_.begin() + best_i, at_.begin() + best_j + 1);
    } else {
      std::rotate(at_.begin() + best_i, at_.begin() + best_j + 1, at_.begin() + best_gap + 1);
    }
    sum_up();
    return true;
  }

  const Eigen::MatrixXd* lengths_;
  std::vector<int> at_;
  std::vector<double> ahead_, back_;
  InterruptionPoll poll_{64};
  double looked_ = 0;
};

}  // namespace

std::vector<int> short_order(const Eigen::MatrixXd& lengths) {
  const int n = static_cast<int>(lengths.rows()) - 2;
  Way best(lengths, cheapest_insertion(lengths, n));
  best.improve();
  if (n < 3) return best.order();
  Rng rng(kSeed);
  double work = best.moves_looked_at();
  for (int restart = 0; restart < kMaxRestarts && work < kWork; ++restart) {
    Way way(lengths, best.order());
    // Three cuts not far apart: what is good elsewhere stays.
    const int span = std::min(n, 30);
    const int first = 1 + static_cast<int>(rng.index(n - span + 1));
    int cuts[3];
    do {
      for (int& cut : cuts) cut = first + static_cast<int>(rng.index(span + 1));
      std::sort(cuts, cuts + 3);
    } while (cuts[0] == cuts[1] || cuts[1] == cuts[2]);
    way.exchange(cuts[0], cuts[1], cuts[2]);
    way.improve();
    work += way.moves_looked_at();
    if (way.length() < best.length() * (1 - kGain)) best = Way(lengths, way.order());
  }
  return best.order();
}

}  // namespace mmgrasp::detail
