#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "optim/sparse/assembly_tree.hpp"
#include "optim/sparse/dense_front.hpp"

namespace mmgrasp::detail {

/// L D L^T of a sparse symmetric indefinite matrix by dense fronts along its assembly tree, D of blocks of one and two
/// columns; columns that have no pivot in their front wait for its parent (Duff and Reid 1983). No state outside of it.
///
///     SparseLdlt ldlt(pattern);
///     if (ldlt.factor(values, 1e-8)) ldlt.solve(x);
class MMGRASP_EXPORT SparseLdlt {
 public:
  explicit SparseLdlt(const LowerColumns& pattern);
  int size() const { return static_cast<int>(tree_.position.size()); }

  /// Values in the order of the pattern. Entries of L are at most 1 / threshold, which is in (0, 0.5]. False when the
  /// matrix is singular: columns are left with nothing above `tiny`.
  bool factor(const double* values, double threshold, double tiny = 1e-20);
  int negative() const { return negative_; }  ///< Negative eigenvalues of the matrix factored last.
  int waited() const { return waited_; }      ///< Times that a column had to wait.
  int largest_front() const { return largest_front_; }

  /// Puts the solution of A x = b into b. Not before factor() was true.
  void solve(double* b);

 private:
  struct Entry {
    int value, row, column;  ///< Which value; positions.
  };
  /// A factored front: its pivots' columns of L, and the positions of its rows, pivots first.
  struct Block {
    std::size_t factor = 0, index = 0;
    int rows = 0, pivots = 0, first_pivot = 0;
  };
  /// What a front hands on: the lower triangle of a dense matrix.
  struct Rest {
    std::size_t data = 0, index = 0;
    int size = 0, waiting = 0;  ///< Its first `waiting` rows are columns that had no pivot.
  };
  void factor_front(int f, const double* values, double threshold, double tiny);
  void add_rest(const Rest& rest, const Block& block, double* panel, int columns, double* mine) const;

  AssemblyTree tree_;
  std::vector<Entry> entries_;
  std::vector<int> entries_from_;  ///< First of each front, and their number.
  std::vector<Block> blocks_;
  std::vector<double> factor_, stack_, work_, local_, ordered_;
  std::vector<int> index_, place_;
  std::vector<Pivot> pivots_;
  std::vector<Rest> rests_;
  std::size_t factor_end_ = 0, index_end_ = 0, stack_end_ = 0;
  int eliminated_ = 0, negative_ = 0, waited_ = 0, largest_front_ = 0;
};

}  // namespace mmgrasp::detail
