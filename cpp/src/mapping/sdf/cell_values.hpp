#pragma once

// Values at the eight corners of a cell in two registers of four floats, which every processor of 64 bits has.

namespace mmgrasp::detail {

using Four = float __attribute__((vector_size(16)));

/// Corners 0 to 3 and 4 to 7 of a cell: corner k lies beyond the lowest one along x, y, z by the bits of k.
struct CellValues {
  Four low, high;
  float operator[](int k) const { return k < 4 ? low[k] : high[k - 4]; }
  void set(int k, float value) { (k < 4 ? low : high)[k & 3] = value; }
};

/// Whether all four are above zero. A comparison gives all bits or none of each; two by two they are whole numbers.
inline bool all_positive(const Four& values) {
  using Bits = long long __attribute__((vector_size(16)));
  const Bits above = (Bits)(values > Four{0, 0, 0, 0});
  return (above[0] & above[1]) == -1;
}

inline Four least_of(const Four& a, const Four& b) {
  return a < b ? a : b;
}

/// Interpolates along x, then y, then z to a place in the cell, from (0, 0, 0) to (1, 1, 1).
inline float trilinear(const CellValues& v, const float* t) {
  const Four even = __builtin_shufflevector(v.low, v.high, 0, 2, 4, 6),
             odd = __builtin_shufflevector(v.low, v.high, 1, 3, 5, 7);
  const Four on_edges = even + t[0] * (odd - even);
  const float e = on_edges[0] + t[1] * (on_edges[1] - on_edges[0]),
              f = on_edges[2] + t[1] * (on_edges[3] - on_edges[2]);
  return e + t[2] * (f - e);
}

}  // namespace mmgrasp::detail
