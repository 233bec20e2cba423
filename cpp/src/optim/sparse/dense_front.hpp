#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// A column of D. The first of two that are one pivot has their common entry in `cross`.
struct Pivot {
  double own = 0, cross = 0;
  bool first_of_two = false;
};

/// What eliminating a front's columns came to.
struct FrontPivots {
  int count = 0;     ///< Columns that were eliminated; they stand first.
  int negative = 0;  ///< Negative eigenvalues among their pivots.
};

/// Eliminates as many of the first `columns` columns of a dense symmetric matrix as have a pivot: L D L^T with pivots
/// of one or two columns, chosen among them such that no entry of L exceeds 1 / threshold (Duff and Reid 1983). `panel`
/// holds these columns, `rows` long each, lower triangle; afterwards L in the eliminated ones, the remaining matrix in
/// the others. `index` (of length `rows`) and `pivots` follow the exchange of columns; entries below `tiny` are no
/// pivots.
MMGRASP_EXPORT FrontPivots eliminate_front(double* panel, int rows, int columns, double threshold, double tiny,
                                           int* index, Pivot* pivots);

/// rest -= L D L^T for the rows of a panel that are no columns of it, lower triangle. `lower` is L in the first of
/// these rows, `stride` long; `size` rows, `columns` columns. `work` grows to size * columns.
MMGRASP_EXPORT void update_rest(double* rest, int size, const double* lower, int stride, int columns,
                                const Pivot* pivots, std::vector<double>& work);

}  // namespace mmgrasp::detail
