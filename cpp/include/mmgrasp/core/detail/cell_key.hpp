#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mmgrasp::detail {

/// Indices of a cell of a grid without an end along x, y and z.
using CellKey = std::array<std::int64_t, 3>;

/// For unordered containers of cells.
struct CellKeyHash {
  std::size_t operator()(const CellKey& key) const {
    std::uint64_t hash = 0;
    for (const std::int64_t index : key) hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15ull;
    return hash ^ (hash >> 32);
  }
};

}  // namespace mmgrasp::detail
