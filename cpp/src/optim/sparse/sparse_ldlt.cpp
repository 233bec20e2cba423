#include "optim/sparse/sparse_ldlt.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

/// Makes room for `count` more, cleared, after the first `end`.
double* more(std::vector<double>& data, std::size_t end, std::size_t count) {
  if (data.size() < end + count) data.resize(std::max(end + count, 2 * data.size()));
  double* begin = data.data() + end;
  std::fill(begin, begin + count, 0.0);
  return begin;
}

std::size_t square(int n) {
  return static_cast<std::size_t>(n) * n;
}

/// y := D^-1 y.
void divide(double* y, const Pivot* pivots, int count) {
  for (int k = 0; k < count; ++k) {
    const double a = pivots[k].own, b = pivots[k].cross;
    if (!pivots[k].first_of_two) {
      y[k] /= a;
      continue;
    }
    const double c = pivots[k + 1].own, largest = std::max({std::abs(a), std::abs(b), std::abs(c)});
    const double det = a / largest * c - b / largest * b;
    const double u = y[k] / largest, v = y[k + 1] / largest;
    y[k] = (c * u - b * v) / det;
    y[++k] = (a * v - b * u) / det;
  }
}

}  // namespace

SparseLdlt::SparseLdlt(const LowerColumns& pattern) : tree_(pattern) {
  const int n = pattern.size(), m = static_cast<int>(tree_.fronts.size());
  std::vector<int> front_of(n);
  for (int f = 0; f < m; ++f)
    for (int c = 0; c < tree_.fronts[f].columns; ++c) front_of[tree_.fronts[f].first + c] = f;
  entries_from_.assign(m + 1, 0);
  entries_.reserve(pattern.rows.size());
  for (int c = 0; c < n; ++c) {
    for (int e = pattern.starts[c]; e < pattern.starts[c + 1]; ++e) {
      const auto [earlier, later] = std::minmax(tree_.position[c], tree_.position[pattern.rows[e]]);
      entries_.push_back({e, later, earlier});
      ++entries_from_[front_of[earlier] + 1];
    }
  }
  for (int f = 0; f < m; ++f) entries_from_[f + 1] += entries_from_[f];
  std::vector<Entry> sorted(entries_.size());
  std::vector<int> to(entries_from_.begin(), entries_from_.end() - 1);
  for (const Entry& entry : entries_) sorted[to[front_of[entry.column]]++] = entry;
  entries_ = std::move(sorted);
  blocks_.resize(m);
  place_.resize(n);
  pivots_.resize(n);
  ordered_.resize(n);
  local_.resize(n);
}

bool SparseLdlt::factor(const double* values, double threshold, double tiny) {
  factor_end_ = index_end_ = stack_end_ = 0;
  eliminated_ = negative_ = waited_ = largest_front_ = 0;
  rests_.clear();
  for (std::size_t f = 0; f < tree_.fronts.size(); ++f) factor_front(static_cast<int>(f), values, threshold, tiny);
  return eliminated_ == size();
}

void SparseLdlt::add_rest(const Rest& rest, const Block& block, double* panel, int columns, double* mine) const {
  const int* index = index_.data() + rest.index;
  const double* from = stack_.data() + rest.data;
  const int below = block.rows - columns;
  for (int c = 0; c < rest.size; ++c, from += rest.size) {
    const int at = place_[index[c]];
    if (c < rest.waiting) {
      // Columns that wait stand before the front's own ones, among which their rows may come in any order.
      for (int r = c; r < rest.size; ++r) {
        const auto [low, high] = std::minmax(at, place_[index[r]]);
        panel[static_cast<std::size_t>(low) * block.rows + high] += from[r];
      }
      continue;
    }
    double* to = at < columns ? panel + static_cast<std::size_t>(at) * block.rows
                              : mine + static_cast<std::size_t>(at - columns) * below - columns;
    for (int r = c; r < rest.size; ++r) to[place_[index[r]]] += from[r];
  }
}

void SparseLdlt::factor_front(int f, const double* values, double threshold, double tiny) {
  const AssemblyTree::Front& front = tree_.fronts[f];
  Block& block = blocks_[f];
  const auto children = rests_.end() - front.children;
  int waiting = 0;
  for (auto rest = children; rest != rests_.end(); ++rest) waiting += rest->waiting;
  const int columns = waiting + front.columns, below = static_cast<int>(front.rows.size());
  block = {factor_end_, index_end_, columns + below, 0};
  waited_ += waiting;
  largest_front_ = std::max(largest_front_, block.rows);

  if (index_.size() < index_end_ + block.rows) index_.resize(2 * (index_end_ + block.rows));
  int* index = index_.data() + index_end_;
  int at = 0;
  for (auto rest = children; rest != rests_.end(); ++rest)
    for (int i = 0; i < rest->waiting; ++i) index[at++] = index_[rest->index + i];
  for (int i = 0; i < front.columns; ++i) index[at++] = front.first + i;
  std::copy(front.rows.begin(), front.rows.end(), index + at);
  index_end_ += block.rows;
  for (int i = 0; i < block.rows; ++i) place_[index[i]] = i;

  double* panel = more(factor_, factor_end_, static_cast<std::size_t>(block.rows) * columns);
  const std::size_t mine_at = stack_end_;
  double* mine = more(stack_, mine_at, square(below));
  for (int e = entries_from_[f]; e < entries_from_[f + 1]; ++e) {
    const Entry& entry = entries_[e];
    panel[static_cast<std::size_t>(place_[entry.column]) * block.rows + place_[entry.row]] += values[entry.value];
  }
  for (auto rest = children; rest != rests_.end(); ++rest) add_rest(*rest, block, panel, columns, mine);

  block.first_pivot = eliminated_;
  Pivot* pivots = pivots_.data() + eliminated_;
  const FrontPivots found = eliminate_front(panel, block.rows, columns, threshold, tiny, index, pivots);
  block.pivots = found.count;
  eliminated_ += found.count;
  negative_ += found.negative;
  factor_end_ += static_cast<std::size_t>(block.rows) * block.pivots;
  update_rest(mine, below, panel + columns, block.rows, block.pivots, pivots, work_);

  Rest rest;
  rest.data = front.children > 0 ? children->data : mine_at;
  rest.index = block.index + block.pivots;
  rest.waiting = columns - block.pivots;
  rest.size = rest.waiting + below;
  rests_.erase(children, rests_.end());
  std::size_t from = mine_at;
  if (rest.waiting > 0) {
    from += square(below);
    double* all = more(stack_, from, square(rest.size));
    mine = stack_.data() + mine_at;
    for (int c = 0; c < rest.size; ++c, all += rest.size) {
      const double* column = c < rest.waiting
                                 ? panel + static_cast<std::size_t>(block.pivots + c) * block.rows + block.pivots
                                 : mine + static_cast<std::size_t>(c - rest.waiting) * below - rest.waiting;
      std::copy(column + c, column + rest.size, all + c);
    }
  }
  if (from != rest.data) std::copy_n(stack_.data() + from, square(rest.size), stack_.data() + rest.data);
  stack_end_ = rest.data + square(rest.size);
  rests_.push_back(rest);
}

void SparseLdlt::solve(double* b) {
  const std::size_t n = tree_.position.size();
  for (std::size_t i = 0; i < n; ++i) ordered_[tree_.position[i]] = b[i];
  double* x = ordered_.data();
  double* y = local_.data();
  for (const Block& block : blocks_) {
    const int* index = index_.data() + block.index;
    for (int i = 0; i < block.rows; ++i) y[i] = x[index[i]];
    const double* l = factor_.data() + block.factor;
    for (int k = 0; k < block.pivots; ++k, l += block.rows) {
      const double factor = y[k];
      for (int i = k + 1; i < block.rows; ++i) y[i] -= factor * l[i];
    }
    divide(y, pivots_.data() + block.first_pivot, block.pivots);
    for (int i = 0; i < block.rows; ++i) x[index[i]] = y[i];
  }
  for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) {
    const int* index = index_.data() + block->index;
    for (int i = 0; i < block->rows; ++i) y[i] = x[index[i]];
    for (int k = block->pivots - 1; k >= 0; --k) {
      const double* l = factor_.data() + block->factor + static_cast<std::size_t>(k) * block->rows;
      double sum = 0;
      for (int i = k + 1; i < block->rows; ++i) sum += l[i] * y[i];
      y[k] -= sum;
    }
    for (int i = 0; i < block->pivots; ++i) x[index[i]] = y[i];
  }
  for (std::size_t i = 0; i < n; ++i) b[i] = ordered_[tree_.position[i]];
}

}  // namespace mmgrasp::detail
