#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <algorithm>

#include "arrays.hpp"
#include "long_call.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"

namespace mmgrasp::python {

/// Rows first .. first + count of a batch_argument() as columns.
inline Eigen::Map<const Eigen::MatrixXd> columns_of(const py::array_t<double>& rows, Eigen::Index first,
                                                    Eigen::Index count) {
  const Eigen::Index n = rows.shape(1);
  return {rows.data() + first * n, n, count};
}

/// Rows of a batch_argument() of three columns as positions.
inline Eigen::Map<const Eigen::Matrix3Xd> positions_of(const py::array_t<double>& rows) {
  return {rows.data(), 3, rows.shape(0)};
}

/// What work() returns for a batch of `rows`, without the GIL. Ctrl-C ends the work of a large one, of which
/// parallel_for() does the most.
template <typename Work>
auto for_rows(Eigen::Index rows, Work&& work) {
  constexpr Eigen::Index kFew = 4096;  // take less than the thread of a call that can be interrupted is worth
  if (rows > kFew) return interruptible(work);
  const Unlocked unlocked;
  return work();
}

/// Calls work(first, count) without the GIL for pieces of a batch of `rows`, and looks for signals between them: Ctrl-C
/// raises KeyboardInterrupt within about a tenth of a second, however large the batch. Rows must not depend on each
/// other.
template <typename Work>
void in_pieces(Eigen::Index rows, Work&& work) {
  constexpr double kShortest = 0.05;  // [s]: pieces that take less are made larger, so that starting them costs nothing
  Eigen::Index size = 256, first = 0;
  do {  // also for no rows: work() checks its other arguments
    const Eigen::Index count = std::min(size, rows - first);
    const detail::Stopwatch watch;
    {
      const Unlocked unlocked;
      work(first, count);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (watch.seconds() < kShortest) size *= 2;
    first += count;
  } while (first < rows);
}

}  // namespace mmgrasp::python
