#include "mmgrasp/core/hash.hpp"

#include <cstdio>

namespace mmgrasp {

Hasher& Hasher::add(const void* bytes, std::size_t size) {
  const auto* data = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < size; ++i) {
    hash_ ^= data[i];
    hash_ *= 0x100000001b3ull;
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
