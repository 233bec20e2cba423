#include "structure/frame/longest_point.hpp"

#include <algorithm>
#include <array>

namespace mmgrasp::detail {
namespace {

using Coefficients = std::array<double, 9>;
constexpr double kSlack = 1e-9;
constexpr double kFour[5] = {1, 4, 6, 4, 1};
constexpr double kEight[9] = {1, 8, 28, 56, 70, 56, 28, 8, 1};
constexpr double kNarrowest = 1e-9;

/// |curve|^2, of degree eight.
Coefficients squared_norm(const Curve& curve) {
  Coefficients out{};
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) out[i + j] += kFour[i] * kFour[j] / kEight[i + j] * curve.col(i).dot(curve.col(j));
  }
  return out;
}

void raise(const Coefficients& values, double from, double to, LongestPoint& best, bool& raised) {
  double bound = 0;
  for (const double value : values) bound = std::max(bound, value);
  if (bound <= best.squared * (1 + kSlack)) return;
  for (const int end : {0, 8}) {
    if (values[end] <= best.squared) continue;
    best = {values[end], end == 0 ? from : to};
    raised = true;
  }
  if (bound <= best.squared * (1 + kSlack) || to - from < kNarrowest) return;
  Coefficients left{}, right = values;  // de Casteljau at the middle
  for (int level = 0; level <= 8; ++level) {
    left[level] = right[0];
    for (int i = 0; i + level < 8; ++i) right[i] = (right[i] + right[i + 1]) / 2;
  }
  const double middle = (from + to) / 2;
  raise(left, from, middle, best, raised);
  raise(right, middle, to, best, raised);
}

}  // namespace

bool raise_to_longest(const Curve& curve, LongestPoint& best) {
  const double bound = curve.colwise().squaredNorm().maxCoeff();
  if (bound <= best.squared * (1 + kSlack)) return false;
  bool raised = false;
  raise(squared_norm(curve), 0, 1, best, raised);
  return raised;
}

}  // namespace mmgrasp::detail
