#pragma once

#include <cstdint>
#include <vector>

#include "mmgrasp/optim/set_cover.hpp"

namespace mmgrasp::detail {

/// Fixed-size bit set over sets or elements.
class Bits {
 public:
  explicit Bits(int size = 0) : words_((size + 63) / 64, 0) {}
  void set(int i) { words_[i / 64] |= std::uint64_t{1} << (i % 64); }
  void reset(int i) { words_[i / 64] &= ~(std::uint64_t{1} << (i % 64)); }
  bool test(int i) const { return (words_[i / 64] >> (i % 64)) & 1; }
  bool subset_of(const Bits& other) const;
  int count() const;
  int first() const;  ///< -1 when empty.

 private:
  std::vector<std::uint64_t> words_;
};

/// What remains of a set cover problem once nothing more follows by logic alone.
struct ReducedCover {
  std::vector<int> forced;    ///< Sets that some cheapest cover contains.
  std::vector<int> sets;      ///< Sets still to be decided, ascending.
  std::vector<int> elements;  ///< Elements not covered by `forced`, without those implied by others, ascending.
};

/// Repeats until nothing changes: take the only set of an element; drop a set whose elements another set covers for no
/// more cost; drop an element that is covered whenever another one is. Every element must lie in some set.
ReducedCover reduce_set_cover(const SetCoverProblem& problem);

}  // namespace mmgrasp::detail
