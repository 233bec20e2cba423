#include "grasp/graspability/graspability_layers.hpp"
#include "mmgrasp/core/detail/interruption.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mmgrasp::detail {
namespace {

constexpr int kMaxMaxima = 60;  // kept of one closing direction, opening and height

/// Running mean along x over 2 r + 1 values, zeros beyond the ends.
void mean_along_rows(const std::vector<float>& in, std::vector<float>& out, int nx, int ny, int r) {
  const double scale = 1.0 / (2 * r + 1);
  for (int y = 0; y < ny; ++y) {
    const float* from = in.data() + static_cast<std::size_t>(y) * nx;
    float* to = out.data() + static_cast<std::size_t>(y) * nx;
    double sum = 0;
    for (int x = 0; x < std::min(r, nx); ++x) sum += from[x];
    for (int x = 0; x < nx; ++x) {
      if (x + r < nx) sum += from[x + r];
      to[x] = static_cast<float>(sum * scale);
      if (x - r >= 0) sum -= from[x - r];
    }
  }
}

/// The same along y, a whole row at a time.
void mean_along_columns(const std::vector<float>& in, std::vector<float>& out, int nx, int ny, int r) {
  const double scale = 1.0 / (2 * r + 1);
  std::vector<double> sum(nx, 0.0);
  const auto add = [&](int y, double sign) {
    const float* row = in.data() + static_cast<std::size_t>(y) * nx;
    for (int x = 0; x < nx; ++x) sum[x] += sign * row[x];
  };
  for (int y = 0; y < std::min(r, ny); ++y) add(y, 1);
  for (int y = 0; y < ny; ++y) {
    if (y + r < ny) add(y + r, 1);
    float* to = out.data() + static_cast<std::size_t>(y) * nx;
    for (int x = 0; x < nx; ++x) to[x] = static_cast<float>(sum[x] * scale);
    if (y - r >= 0) add(y - r, -1);
  }
}

/// Three running means over the part of the map that they can change.
void smooth(std::vector<float>& values, int nx, int ny, int r) {
  int x0 = nx, x1 = -1, y0 = ny, y1 = -1;
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) {
      if (values[static_cast<std::size_t>(y) * nx + x] == 0) continue;
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
      y0 = std::min(y0, y);
      y1 = y;
    }
  }
  if (r == 0 || x1 < 0) return;
  x0 = std::max(0, x0 - 3 * r);
  x1 = std::min(nx - 1, x1 + 3 * r);
  y0 = std::max(0, y0 - 3 * r);
  y1 = std::min(ny - 1, y1 + 3 * r);
  const int w = x1 - x0 + 1, h = y1 - y0 + 1;
  std::vector<float> some(static_cast<std::size_t>(w) * h), other(some.size());
  for (int y = 0; y < h; ++y) {
    const float* row = values.data() + static_cast<std::size_t>(y + y0) * nx + x0;
    std::copy(row, row + w, some.data() + static_cast<std::size_t>(y) * w);
  }
  for (int pass = 0; pass < 3; ++pass) {
    throw_if_interrupted();
    mean_along_rows(some, other, w, h, r);
    mean_along_columns(other, some, w, h, r);
  }
  for (int y = 0; y < h; ++y) {
    const float* row = some.data() + static_cast<std::size_t>(y) * w;
    std::copy(row, row + w, values.data() + static_cast<std::size_t>(y + y0) * nx + x0);
  }
}

}  // namespace

Pieces::Pieces(const HeightMap& map, double above, double step) : map_(map), label_(map.height.size(), -1) {
  const auto limit = static_cast<float>(above), jump = static_cast<float>(step);
  std::vector<int> queue;
  InterruptionPoll poll;
  for (int seed = 0; seed < map.nx * map.ny; ++seed) {
    if (label_[seed] >= 0 || !(map.height[seed] > limit)) continue;
    const int label = static_cast<int>(pieces_.size());
    queue.assign(1, seed);
    label_[seed] = label;
    Piece piece;
    for (std::size_t next = 0; next < queue.size(); ++next) {
      poll();
      const int i = queue[next], x = i % map.nx, y = i / map.nx;
      piece.middle += map.centre(x, y);
      const auto visit = [&](int k) {
        if (label_[k] >= 0 || !(map.height[k] > limit) || std::abs(map.height[k] - map.height[i]) > jump) return;
        label_[k] = label;
        queue.push_back(k);
      };
      if (x > 0) visit(i - 1);
      if (x + 1 < map.nx) visit(i + 1);
      if (y > 0) visit(i - map.nx);
      if (y + 1 < map.ny) visit(i + map.nx);
    }
    piece.middle /= static_cast<double>(queue.size());
    for (const int i : queue)
      piece.radius = std::max(piece.radius, (map.centre(i % map.nx, i / map.nx) - piece.middle).norm());
    pieces_.push_back(piece);
  }
}

double Pieces::centring(const Eigen::Vector2d& point) const {
  const int ix = static_cast<int>(std::floor(point.x() / map_.resolution + 0.5 * map_.nx));
  const int iy = static_cast<int>(std::floor(point.y() / map_.resolution + 0.5 * map_.ny));
  if (ix < 0 || iy < 0 || ix >= map_.nx || iy >= map_.ny || label_[map_.index(ix, iy)] < 0) return 0;
  const Piece& piece = pieces_[label_[map_.index(ix, iy)]];
  return std::max(0.0, 1 - (point - piece.middle).norm() / (piece.radius + map_.resolution));
}

TipLayer::TipLayer(const HeightMap& map, double tip, const Hand& hand, const GraspabilityOptions& options, int border)
    : tip_height(tip), pieces(map, tip + options.insertion, options.insertion) {
  const std::size_t cells = map.height.size();
  std::vector<std::uint8_t> between(cells), low(cells), high(cells);
  const auto held = static_cast<float>(tip + options.insertion),
             fingers_free = static_cast<float>(tip - options.margin);
  const auto palm_free = static_cast<float>(tip + hand.body.finger_length - options.margin);
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
    throw_if_interrupted();
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
    if (static_cast<int>(maxima.size()) == kMaxMaxima) break;
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
  constexpr int kMaxHeights = 1000;
  for (int i = 0; i < kMaxHeights; ++i) {
    const double tip = options.lowest + i * options.layer_step;
    if (!(tip + options.insertion < top)) break;
    heights.push_back(tip);
  }
  return heights;
}

}  // namespace mmgrasp::detail
