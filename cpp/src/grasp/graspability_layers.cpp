#include "grasp/graspability_layers.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mmgrasp::detail {
namespace {

constexpr int kMostMaxima = 60;  // of one closing direction, opening and height

/// Running mean over 2 r + 1 values of a line, zeros beyond its ends.
void running_mean(const float* in, float* out, int n, int stride, int r) {
  // Counted in double from the same side, so that equal neighbourhoods give equal means but for rounding.
  double sum = 0;
  for (int i = 0; i < std::min(r, n); ++i) sum += in[static_cast<std::size_t>(i) * stride];
  const double scale = 1.0 / (2 * r + 1);
  for (int i = 0; i < n; ++i) {
    if (i + r < n) sum += in[static_cast<std::size_t>(i + r) * stride];
    out[static_cast<std::size_t>(i) * stride] = static_cast<float>(sum * scale);
    if (i - r >= 0) sum -= in[static_cast<std::size_t>(i - r) * stride];
  }
}

void smooth(std::vector<float>& values, int nx, int ny, int r) {
  if (r == 0) return;
  std::vector<float> other(values.size());
  for (int pass = 0; pass < 3; ++pass) {
    for (int y = 0; y < ny; ++y) {
      const std::size_t row = static_cast<std::size_t>(y) * nx;
      running_mean(values.data() + row, other.data() + row, nx, 1, r);
    }
    for (int x = 0; x < nx; ++x) running_mean(other.data() + x, values.data() + x, ny, nx, r);
  }
}

}  // namespace

TipLayer::TipLayer(const HeightMap& map, double tip, const GraspabilityOptions& options, int border) : tip_height(tip) {
  const std::size_t cells = map.height.size();
  std::vector<std::uint8_t> between(cells), low(cells), high(cells);
  const auto held = static_cast<float>(tip + options.insertion),
             fingers_free = static_cast<float>(tip - options.hand.margin);
  const auto palm_free = static_cast<float>(tip + options.hand.finger_length - options.hand.margin);
  for (std::size_t i = 0; i < cells; ++i) {
    between[i] = map.height[i] > held;
    low[i] = !(map.upper[i] <= fingers_free);  // unknown cells too
    high[i] = !(map.upper[i] <= palm_free);
  }
  contact = RowSums(between, map.nx, map.ny, border, false);
  fingers = RowSums(low, map.nx, map.ny, border, true);
  // What is unknown or beyond the map may reach up to the palm only if the fingers could be there, so it blocks those.
  for (std::size_t i = 0; i < cells; ++i) high[i] = high[i] && map.upper[i] > palm_free;
  palm = RowSums(high, map.nx, map.ny, border, false);
}

LayerMap layer_map(const TipLayer& layer, const HandRuns& hand, int smoothing_cells) {
  LayerMap map;
  const int nx = layer.contact.nx(), ny = layer.contact.ny();
  if (layer.contact.empty()) return map;
  map.raw.assign(static_cast<std::size_t>(nx) * ny, 0.0f);
  std::vector<std::uint16_t> contact(nx), touched(nx), palm(nx);
  const int first = std::max(0, layer.contact.first_row() - hand.contact.radius);
  const int last = std::min(ny - 1, layer.contact.last_row() + hand.contact.radius);
  for (int y = first; y <= last; ++y) {
    convolve_row(layer.contact, hand.contact, y, contact.data());
    if (std::all_of(contact.begin(), contact.end(), [](std::uint16_t c) { return c == 0; })) continue;
    convolve_row(layer.fingers, hand.fingers, y, touched.data());
    const bool palm_near = !layer.palm.empty() && y + hand.palm.radius >= layer.palm.first_row() &&
                           y - hand.palm.radius <= layer.palm.last_row();
    if (palm_near) convolve_row(layer.palm, hand.palm, y, palm.data());
    for (int x = 0; x < nx; ++x) {
      if (contact[x] == 0 || touched[x] != 0 || (palm_near && palm[x] != 0)) continue;
      map.raw[static_cast<std::size_t>(y) * nx + x] = static_cast<float>(contact[x]) / hand.contact_cells;
      map.empty = false;
    }
  }
  if (map.empty) return map;
  map.smooth = map.raw;
  smooth(map.smooth, nx, ny, smoothing_cells);
  return map;
}

std::vector<int> local_maxima(const LayerMap& map, int nx, int ny, double distance) {
  std::vector<int> maxima;
  if (map.empty) return maxima;
  // A wide mean breaks the ties of a plateau in favour of its middle.
  std::vector<float> value = map.smooth;
  smooth(value, nx, ny, std::max(1, static_cast<int>(distance)));
  std::vector<int> order;
  for (int i = 0; i < nx * ny; ++i) {
    if (map.raw[i] <= 0) continue;
    value[i] = map.smooth[i] + 0.1f * value[i];
    order.push_back(i);
  }
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return value[a] != value[b] ? value[a] > value[b] : a < b; });
  std::vector<char> covered(map.raw.size(), 0);
  const int r = static_cast<int>(distance);
  for (const int i : order) {
    if (covered[i]) continue;
    maxima.push_back(i);
    if (static_cast<int>(maxima.size()) == kMostMaxima) break;
    const int x = i % nx, y = i / nx;
    for (int dy = -r; dy <= r; ++dy) {
      for (int dx = -r; dx <= r; ++dx) {
        if (x + dx < 0 || x + dx >= nx || y + dy < 0 || y + dy >= ny || dx * dx + dy * dy > r * r) continue;
        covered[static_cast<std::size_t>(y + dy) * nx + x + dx] = 1;
      }
    }
    covered[i] = 1;
  }
  return maxima;
}

std::vector<double> tip_heights(const HeightMap& map, const GraspabilityOptions& options) {
  float top = -std::numeric_limits<float>::infinity();
  for (const float h : map.height) {
    if (h > top) top = h;
  }
  std::vector<double> heights;
  constexpr int kMost = 1000;
  for (int i = 0; i < kMost; ++i) {
    const double tip = options.lowest + i * options.layer_step;
    if (!(tip + options.insertion < top)) break;
    heights.push_back(tip);
  }
  return heights;
}

}  // namespace mmgrasp::detail
