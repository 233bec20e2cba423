#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// Where the entries of a symmetric matrix stand: its lower triangle by columns. Entries may repeat: they add up.
struct LowerColumns {
  std::vector<int> starts;  ///< First entry of each column, and the number of entries.
  std::vector<int> rows;    ///< Row of each entry, at least its column.
  int size() const { return static_cast<int>(starts.size()) - 1; }
};

/// The order in which a symmetric sparse matrix is eliminated, and the dense matrices ("fronts", Duff and Reid 1983).
/// A front takes its own columns out, all of which have non-zeros in about the same rows, and hands what is left of the
/// others to its parent.
struct MMGRASP_EXPORT AssemblyTree {
  struct Front {
    int first = 0, columns = 0;  ///< Its own columns, as positions in the order.
    std::vector<int> rows;       ///< The other positions, ascending, all of them later.
    int children = 0;            ///< The fronts that hand on to it are the last that nobody has taken.
  };
  std::vector<int> position;  ///< Where each row and column comes in the order.
  std::vector<Front> fronts;  ///< Children before their parents.

  /// Order of least degree (AMD), for little fill; small fronts are joined with their parents.
  explicit AssemblyTree(const LowerColumns& pattern);
};

}  // namespace mmgrasp::detail
