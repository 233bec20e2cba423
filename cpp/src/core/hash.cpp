#include "mmgrasp/core/hash.hpp"

#include <algorithm>
#include <cstdio>

#include "mmgrasp/core/detail/interruption.hpp"

namespace mmgrasp {

Hasher& Hasher::add(const void* bytes, std::size_t size) {
  constexpr std::size_t kPiece = 1 << 20;  // [bytes], about a millisecond
  const auto* data = static_cast<const unsigned char*>(bytes);
  for (std::size_t first = 0; first < size; first += kPiece) {
    if (first > 0) detail::throw_if_interrupted();
    const std::size_t end = std::min(size, first + kPiece);
    for (std::size_t i = first; i < end; ++i) {
      hash_ ^= data[i];
      hash_ *= 0x100000001b3ull;
    }
  }
  return *this;
}

Hasher& Hasher::add(const std::string& text) {
  // The length goes first, so that ("ab", "c") and ("a", "bc") differ.
  add(static_cast<std::int64_t>(text.size()));
  return add(text.data(), text.size());
}

Hasher& Hasher::add(double value) {
  if (value == 0) value = 0;  // -0 and 0 are the same number
  return add(&value, sizeof(value));
}

Hasher& Hasher::add(std::int64_t value) {
  return add(&value, sizeof(value));
}

Hasher& Hasher::add(const Eigen::Ref<const Eigen::MatrixXd>& values) {
  add(static_cast<std::int64_t>(values.rows()));
  add(static_cast<std::int64_t>(values.cols()));
  for (Eigen::Index column = 0; column < values.cols(); ++column)
    for (Eigen::Index row = 0; row < values.rows(); ++row) add(values(row, column));
  return *this;
}

std::string Hasher::hex() const {
  char text[17];
  std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(hash_));
  return text;
}

}  // namespace mmgrasp
