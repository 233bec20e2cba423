#include "optim/sparse/dense_front.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

/// A panel of columns of a symmetric matrix, lower triangle.
struct Panel {
  double* data;
  int rows, columns;
  double* column(int j) const { return data + static_cast<std::ptrdiff_t>(j) * rows; }
  /// The entry wherever it stands; one of them is a column of the panel.
  double& at(int i, int j) const { return i >= j ? column(j)[i] : column(i)[j]; }

  /// Exchanges rows and columns a < b.
  void exchange(int a, int b) const {
    if (a == b) return;
    for (int j = 0; j < a; ++j) std::swap(column(j)[a], column(j)[b]);
    for (int i = a + 1; i < b; ++i) std::swap(column(a)[i], column(i)[b]);
    for (int i = b + 1; i < rows; ++i) std::swap(column(a)[i], column(b)[i]);
    std::swap(column(a)[a], column(b)[b]);
  }

  /// The largest entry of column j off the diagonal, from `first` on; `except` is left out.
  double largest(int j, int first, int except = -1) const {
    double value = 0;
    for (int i = first; i < j; ++i)
      if (i != except) value = std::max(value, std::abs(column(i)[j]));
    for (int i = j + 1; i < rows; ++i)
      if (i != except) value = std::max(value, std::abs(column(j)[i]));
    return value;
  }
  /// Which of the panel's columns has the largest entry with column j; -1 when all are 0.
  int partner(int j, int first) const {
    int best = -1;
    double value = 0;
    for (int i = first; i < columns; ++i) {
      if (i == j || std::abs(at(i, j)) <= value) continue;
      value = std::abs(at(i, j));
      best = i;
    }
    return best;
  }
};

/// Whether columns j and r together are a pivot whose inverse, times what is left of them, stays within the threshold.
bool is_pair(const Panel& p, int j, int r, int first, double threshold, double tiny) {
  const double a = p.at(j, j), b = p.at(r, j), c = p.at(r, r);
  const double largest = std::max({std::abs(a), std::abs(b), std::abs(c)});
  if (largest < tiny) return false;
  // Scaled, and refused where the two products cancel.
  const double one = a / largest * c, two = b / largest * b, det = one - two;
  if (std::abs(det) < std::max({tiny, 0.5 * std::abs(one), 0.5 * std::abs(two)})) return false;
  const double scale = std::abs(det * largest);
  const double gj = p.largest(j, first, r), gr = p.largest(r, first, j);
  return threshold * (std::abs(c) * gj + std::abs(b) * gr) <= scale &&
         threshold * (std::abs(b) * gj + std::abs(a) * gr) <= scale;
}

void eliminate_one(const Panel& p, int k, Pivot& pivot) {
  double* own = p.column(k);
  pivot = {own[k], 0, false};
  const double inverse = 1 / own[k];
  for (int j = k + 1; j < p.columns; ++j) {
    const double factor = own[j] * inverse;
    if (factor == 0) continue;
    double* column = p.column(j);
    for (int i = j; i < p.rows; ++i) column[i] -= factor * own[i];
  }
  for (int i = k + 1; i < p.rows; ++i) own[i] *= inverse;
}

void eliminate_two(const Panel& p, int k, Pivot* pivots) {
  double *one = p.column(k), *two = p.column(k + 1);
  const double a = one[k], b = one[k + 1], c = two[k + 1];
  pivots[0] = {a, b, true};
  pivots[1] = {c, 0, false};
  const double largest = std::max({std::abs(a), std::abs(b), std::abs(c)});
  const double det = (a / largest * c - b / largest * b) * largest;
  const double first = c / det, cross = -b / det, second = a / det;
  for (int j = k + 2; j < p.columns; ++j) {
    const double f = first * one[j] + cross * two[j];
    const double g = cross * one[j] + second * two[j];
    if (f == 0 && g == 0) continue;
    double* column = p.column(j);
    for (int i = j; i < p.rows; ++i) column[i] -= f * one[i] + g * two[i];
  }
  one[k + 1] = 0;
  for (int i = k + 2; i < p.rows; ++i) {
    const double u = one[i], v = two[i];
    one[i] = first * u + cross * v;
    two[i] = cross * u + second * v;
  }
}

/// Negative eigenvalues of [a b; b c] that is not singular.
int negative_of_two(double a, double b, double c) {
  const double largest = std::max({std::abs(a), std::abs(b), std::abs(c)});
  if (a / largest * c - b / largest * b < 0) return 1;
  return a < 0 ? 2 : 0;
}

}  // namespace

FrontPivots eliminate_front(double* panel, int rows, int columns, double threshold, double tiny, int* index,
                            Pivot* pivots) {
  const Panel p{panel, rows, columns};
  FrontPivots found;
  int k = 0;
  const auto bring = [&](int from, int to) {
    p.exchange(to, from);
    std::swap(index[to], index[from]);
  };
  // Columns that had no pivot may have one once others are eliminated.
  for (int j = 0, failed = 0; k < columns && failed < columns - k;) {
    if (j >= columns) j = k;
    const double diagonal = std::abs(p.column(j)[j]);
    if (diagonal > tiny && diagonal >= threshold * p.largest(j, k)) {
      bring(j, k);
      eliminate_one(p, k, pivots[k]);
      found.negative += pivots[k].own < 0;
      ++k;
    } else if (const int r = p.partner(j, k); r >= 0 && is_pair(p, j, r, k, threshold, tiny)) {
      bring(std::min(j, r), k);
      bring(std::max(j, r), k + 1);
      eliminate_two(p, k, pivots + k);
      found.negative += negative_of_two(pivots[k].own, pivots[k].cross, pivots[k + 1].own);
      k += 2;
    } else {
      ++failed;
      ++j;
      continue;
    }
    failed = 0;
    j = std::max(j, k);
  }
  found.count = k;
  return found;
}

void update_rest(double* rest, int size, const double* lower, int stride, int columns, const Pivot* pivots,
                 std::vector<double>& work) {
  // D L^T, one column of it for each row of `rest`.
  const std::size_t n = static_cast<std::size_t>(size) * columns;
  if (work.size() < n) work.resize(n);
  for (int k = 0; k < columns; ++k) {
    const double* l = lower + static_cast<std::ptrdiff_t>(k) * stride;
    double* w = work.data() + k;
    if (!pivots[k].first_of_two) {
      for (int i = 0; i < size; ++i, w += columns) *w = pivots[k].own * l[i];
      continue;
    }
    const double* m = l + stride;
    const double a = pivots[k].own, b = pivots[k].cross, c = pivots[++k].own;
    for (int i = 0; i < size; ++i, w += columns) {
      w[0] = a * l[i] + b * m[i];
      w[1] = b * l[i] + c * m[i];
    }
  }
  for (int j = 0; j < size; ++j) {
    const double* w = work.data() + static_cast<std::size_t>(j) * columns;
    double* column = rest + static_cast<std::ptrdiff_t>(j) * size;
    for (int k = 0; k < columns; ++k) {
      const double* l = lower + static_cast<std::ptrdiff_t>(k) * stride;
      const double f = w[k];
      if (f == 0) continue;
      for (int i = j; i < size; ++i) column[i] -= f * l[i];
    }
  }
}

}  // namespace mmgrasp::detail
