#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Incremental 64-bit content hash (FNV-1a) used for cache keys and file checksums; not cryptographic.
class MMGRASP_EXPORT Hasher {
 public:
  Hasher& add(const void* bytes, std::size_t size);
  Hasher& add(const std::string& text);
  Hasher& add(double value);
  Hasher& add(std::int64_t value);
  /// Any other integer, enumeration or bool, hashed as 64 bits.
  template <typename T, std::enable_if_t<std::is_integral_v<T> || std::is_enum_v<T>, int> = 0>
  Hasher& add(T value) {
    return add(static_cast<std::int64_t>(value));
  }
  Hasher& add(const Eigen::Ref<const Eigen::MatrixXd>& values);
  std::uint64_t value() const { return hash_; }
  std::string hex() const;  ///< 16 hexadecimal digits.

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

}  // namespace mmgrasp
