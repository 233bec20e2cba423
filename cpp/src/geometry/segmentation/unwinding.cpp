#include "geometry/segmentation/unwinding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unsupported/Eigen/FFT>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

using Complex = std::complex<double>;
/// Cells for each winding: the fastest one turns by 2 pi / 16 from cell to cell.
constexpr int kCellsPerWinding = 16;

/// What a value at `t` between the second and the third of four cells is made of: Lagrange's cubic.
std::array<double, 4> cubic_shares(double t) {
  return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
          (t + 1) * t * (t - 1) / 6};
}

/// |unwound()| at the windings `first` + k `step`, k = 0 ... count - 1.
std::vector<double> lengths_unwound(const std::vector<HelixTurn>& turns, double first, double step, int count) {
  std::size_t size = 64;
  while (size < static_cast<std::size_t>(count) * kCellsPerWinding) size *= 2;
  double low = kInfinity;
  for (const HelixTurn& t : turns) low = std::min(low, t.height);
  const double cells_per_metre = std::abs(step) * static_cast<double>(size) / (2 * kPi);
  std::vector<Complex> cells(size), spectrum;
  InterruptionPoll poll;
  for (const HelixTurn& t : turns) {
    poll();
    const double place = (t.height - low) * cells_per_metre, cell = std::floor(place);
    const Complex arrow = std::polar(t.length, t.angle - first * (t.height - low));
    const std::array<double, 4> shares = cubic_shares(place - cell);
    for (std::size_t k = 0; k < 4; ++k)  // Round the ends: what is before the first cell is the last one's.
      cells[(static_cast<std::size_t>(cell) + k + size - 1) % size] += shares[k] * arrow;
  }
  throw_if_interrupted();
  Eigen::FFT<double> transform;
  transform.fwd(spectrum, cells);
  throw_if_interrupted();
  std::vector<double> out(count);
  for (int k = 0; k < count; ++k)  // A negative step winds the other way: the spectrum backwards.
    out[k] = std::abs(spectrum[step > 0 ? k : (size - static_cast<std::size_t>(k)) % size]);
  return out;
}

}  // namespace

Complex unwound(const std::vector<HelixTurn>& turns, double winding) {
  Complex sum = 0;
  for (const HelixTurn& t : turns) sum += std::polar(t.length, t.angle - winding * t.height);
  return sum;
}

double longest_unwound(const std::vector<HelixTurn>& turns, double least, double most, double step) {
  const int count = static_cast<int>(std::floor((most - least) / step)) + 1;
  const std::vector<double> forth = lengths_unwound(turns, least, step, count);
  const std::vector<double> back = lengths_unwound(turns, -least, -step, count);
  const auto longest_forth = std::max_element(forth.begin(), forth.end());
  const auto longest_back = std::max_element(back.begin(), back.end());
  if (*longest_back > *longest_forth) return -(least + step * static_cast<double>(longest_back - back.begin()));
  return least + step * static_cast<double>(longest_forth - forth.begin());
}

}  // namespace mmgrasp::detail
