#pragma once

#include <cstddef>
#include <cstdint>

namespace mmgrasp::detail {

/// CRC-32 as zlib, gzip and PNG define it, so that any language can check what was written. `before` is the CRC of the
/// bytes in front.
std::uint32_t crc32(const void* bytes, std::size_t size, std::uint32_t before = 0);

}  // namespace mmgrasp::detail
