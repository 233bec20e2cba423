#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace mmgrasp::verify::detail {

/// A set of regions as bits: searches ask for supersets far too often for trees.
class RegionBits {
 public:
  explicit RegionBits(int size = 0) : words_((static_cast<std::size_t>(size) + 63) / 64, 0) {}
  void insert(int i) { words_[static_cast<std::size_t>(i) / 64] |= std::uint64_t{1} << (i % 64); }
  void insert(const RegionBits& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
  }
  bool has(int i) const { return words_[static_cast<std::size_t>(i) / 64] >> (i % 64) & 1u; }
  bool empty() const {
    for (const std::uint64_t word : words_) {
      if (word != 0) return false;
    }
    return true;
  }
  bool holds(const RegionBits& inner) const {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (inner.words_[i] & ~words_[i]) return false;
    }
    return true;
  }
  int count() const {
    std::size_t bits = 0;
    for (const std::uint64_t word : words_) bits += std::bitset<64>(word).count();
    return static_cast<int>(bits);
  }
  bool operator<(const RegionBits& other) const { return words_ < other.words_; }

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace mmgrasp::verify::detail
