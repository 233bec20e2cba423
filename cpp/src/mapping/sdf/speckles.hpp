#pragma once

// Single pixels apart from the surface around them.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace mmgrasp::detail {

/// A speckle has at most one neighbour on its own surface, while at least five of the eight lie on one surface. Its
/// inverse depth in `q` (row by row, 0: none) becomes their median, so that it parts no surface; returns which pixels
/// these were. `joined(i, j)` says whether the neighbouring pixels i and j, by the values in `q`, lie on one surface.
template <typename Joined>
std::vector<std::uint8_t> fill_speckles(std::vector<float>& q, int width, int height, const Joined& joined) {
  std::vector<std::uint8_t> speckles(q.size(), 0);
  std::vector<std::pair<std::size_t, float>> filled;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * width + u;
      if (q[i] == 0) continue;
      std::array<std::size_t, 8> around;
      int count = 0, own = 0;
      for (int y = std::max(0, v - 1); y <= std::min(height - 1, v + 1); ++y) {
        for (int x = std::max(0, u - 1); x <= std::min(width - 1, u + 1); ++x) {
          const std::size_t j = static_cast<std::size_t>(y) * width + x;
          if (j == i || q[j] == 0) continue;
          around[count++] = j;
          own += joined(i, j);
        }
      }
      if (own > 1 || count < 5) continue;
      const auto middle = around.begin() + count / 2;
      std::nth_element(around.begin(), middle, around.begin() + count,
                       [&](std::size_t a, std::size_t b) { return q[a] < q[b] || (q[a] == q[b] && a < b); });
      int others = 0;
      for (int k = 0; k < count; ++k) others += around[k] == *middle || joined(*middle, around[k]);
      if (others < 5) continue;
      speckles[i] = 1;
      filled.emplace_back(i, q[*middle]);
    }
  }
  for (const auto& [i, value] : filled) q[i] = value;
  return speckles;
}

}  // namespace mmgrasp::detail
