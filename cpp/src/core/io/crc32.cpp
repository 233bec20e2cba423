#include "mmgrasp/core/detail/crc32.hpp"

#include <array>
#include <cstring>

#include "mmgrasp/core/detail/interruption.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::uint32_t kPolynomial = 0xedb88320u;
constexpr int kSlices = 8;  // bytes a step
using Tables = std::array<std::array<std::uint32_t, 256>, kSlices>;

constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t value = byte;
    for (int bit = 0; bit < 8; ++bit) value = value & 1 ? (value >> 1) ^ kPolynomial : value >> 1;
    tables[0][byte] = value;
  }
  for (int slice = 1; slice < kSlices; ++slice) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t value = tables[slice - 1][byte];
      tables[slice][byte] = (value >> 8) ^ tables[0][value & 0xff];
    }
  }
  return tables;
}

constexpr Tables kTables = make_tables();

std::uint32_t little_endian(const unsigned char* bytes) {
  return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 |
         std::uint32_t{bytes[3]} << 24;
}

std::uint32_t of_piece(const unsigned char* at, std::size_t size, std::uint32_t before) {
  std::uint32_t value = ~before;
  for (; size >= kSlices; size -= kSlices, at += kSlices) {
    const std::uint32_t low = little_endian(at) ^ value, high = little_endian(at + 4);
    value = kTables[7][low & 0xff] ^ kTables[6][low >> 8 & 0xff] ^ kTables[5][low >> 16 & 0xff] ^
            kTables[4][low >> 24] ^ kTables[3][high & 0xff] ^ kTables[2][high >> 8 & 0xff] ^
            kTables[1][high >> 16 & 0xff] ^ kTables[0][high >> 24];
  }
  for (; size > 0; --size, ++at) value = (value >> 8) ^ kTables[0][(value ^ *at) & 0xff];
  return ~value;
}

}  // namespace

std::uint32_t crc32(const void* bytes, std::size_t size, std::uint32_t before) {
  constexpr std::size_t kPiece = 8 << 20;  // [bytes] between two looks for an interruption
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (; size > kPiece; size -= kPiece, at += kPiece) {
    throw_if_interrupted();
    before = of_piece(at, kPiece, before);
  }
  return of_piece(at, size, before);
}

}  // namespace mmgrasp::detail
