#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mmgrasp::detail {

/// A subset of 0 ... size - 1. Those that meet must have the same size.
class Bits {
 public:
  explicit Bits(int size = 0) : words_((size + 63) / 64, 0) {}
  void set(int i) { words_[i / 64] |= std::uint64_t{1} << (i % 64); }
  void reset(int i) { words_[i / 64] &= ~(std::uint64_t{1} << (i % 64)); }
  bool test(int i) const { return (words_[i / 64] >> (i % 64)) & 1; }

  bool subset_of(const Bits& other) const {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      if (words_[w] & ~other.words_[w]) return false;
    }
    return true;
  }
  bool meets(const Bits& other) const {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      if (words_[w] & other.words_[w]) return true;
    }
    return false;
  }
  int count() const {
    int total = 0;
    for (const std::uint64_t word : words_) total += __builtin_popcountll(word);
    return total;
  }
  int first() const { return next(0); }  ///< -1 when empty.
  int next(int from) const {             ///< The first at or after `from`, or -1.
    for (std::size_t w = from / 64; w < words_.size(); ++w) {
      std::uint64_t word = words_[w];
      if (w == static_cast<std::size_t>(from / 64)) word &= ~std::uint64_t{0} << (from % 64);
      if (word) return static_cast<int>(64 * w) + __builtin_ctzll(word);
    }
    return -1;
  }

  Bits& operator&=(const Bits& other) {
    for (std::size_t w = 0; w < words_.size(); ++w) words_[w] &= other.words_[w];
    return *this;
  }
  Bits& operator|=(const Bits& other) {
    for (std::size_t w = 0; w < words_.size(); ++w) words_[w] |= other.words_[w];
    return *this;
  }
  Bits& operator-=(const Bits& other) {  ///< Clears the bits that are set in `other`.
    for (std::size_t w = 0; w < words_.size(); ++w) words_[w] &= ~other.words_[w];
    return *this;
  }
  bool operator<(const Bits& other) const { return words_ < other.words_; }

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace mmgrasp::detail
