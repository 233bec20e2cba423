#include "collision/narrow/distance_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/narrow/solid.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/geometry/detail/triangle_distance.hpp"

namespace mmgrasp::detail {

namespace {

constexpr double kMeshCells = 2e5, kVoxelCells = 2e7;
constexpr double kBand = 2;  // cells about a mesh whose distance is computed exactly
constexpr std::int8_t kFree = 127;
constexpr int kMeshQuanta = 4, kVoxelQuanta = 2;  // per cell
// Half of a cell's diagonal, in cells.
constexpr double kHalfDiagonal = 0.8660254037844387;

// Squared distance in cells from every cell to the nearest one where it is 0, one line at a time (Felzenszwalb and
// Huttenlocher: the lower envelope of parabolas). `line` holds the result of the axes before.
void line_distances(std::vector<float>& line, std::vector<float>& out, std::vector<int>& peak,
                    std::vector<float>& border) {
  const int n = static_cast<int>(line.size());
  constexpr float kFar = 1e12f;
  int k = -1;
  for (int q = 0; q < n; ++q) {
    if (line[q] >= kFar) continue;
    float s = -std::numeric_limits<float>::infinity();
    while (k >= 0) {
      const int p = peak[k];
      // Double precision: squares of long lines have more digits than a float.
      s = static_cast<float>((double(line[q]) - line[p]) / (2.0 * (q - p)) + 0.5 * (double(q) + p));
      if (s > border[k]) break;
      --k;
    }
    if (k < 0) s = -std::numeric_limits<float>::infinity();
    ++k;
    peak[k] = q;
    border[k] = s;
  }
  if (k < 0) {
    std::fill(out.begin(), out.end(), kFar);
    return;
  }
  for (int q = 0, v = 0; q < n; ++q) {
    while (v < k && border[v + 1] < static_cast<float>(q)) ++v;
    const float d = static_cast<float>(q - peak[v]);
    out[q] = d * d + line[peak[v]];
  }
}

}  // namespace

void DistanceGrid::lay_out(const Eigen::AlignedBox3d& body, const Eigen::Vector3d& low, double step,
                           const std::array<int, 3>& count, int quanta_per_cell) {
  body_ = body;
  low_ = low;
  step_ = step;
  per_step_ = 1 / step;
  // Rounded down, so that rounding never overstates a distance.
  quantum_ = step / quanta_per_cell * (1 - 1e-5);
  count_ = count;
  size_ = {double(count[0]), double(count[1]), double(count[2])};
  cells_.assign(static_cast<std::size_t>(count[0]) * count[1] * count[2], kFree);
  extent_ = 0;
  for (int k = 0; k < 3; ++k)
    extent_ = static_cast<float>(std::max({double(extent_), std::abs(low[k]), std::abs(low[k] + step * count[k])}));
}

DistanceGrid::DistanceGrid(const TriangleMesh& mesh, const Solid& solid) {
  Eigen::AlignedBox3d body;
  for (const Eigen::Vector3d& v : mesh.vertices) body.extend(v);
  // Room for distances around the body; farther out its bounding box is as good a bound.
  const double room = 0.03 + 0.1 * body.sizes().maxCoeff();
  const Eigen::Vector3d size = body.sizes() + Eigen::Vector3d::Constant(2 * room);
  const double step = std::cbrt(size.prod() / kMeshCells);
  std::array<int, 3> count{};
  for (int k = 0; k < 3; ++k) count[k] = static_cast<int>(std::ceil(size[k] / step)) + 1;
  lay_out(body, body.min() - Eigen::Vector3d::Constant(room), step, count, kMeshQuanta);
  spread_ = step;
  for (const auto& t : mesh.triangles) mark(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  fill(solid);
  const double band = kBand * step;
  measure_centres(centre_distances(mesh, band), band);
}

DistanceGrid::DistanceGrid(const std::vector<Eigen::Vector3d>& centres, double resolution) {
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * resolution);
  Eigen::AlignedBox3d body;
  for (const Eigen::Vector3d& c : centres) {
    body.extend(Eigen::Vector3d(c - half));
    body.extend(Eigen::Vector3d(c + half));
  }
  constexpr int kRoom = 8;
  double coarse = 1;
  const auto cells = [&](double factor) {
    return (body.sizes().array() / (resolution * factor) + 2 * kRoom + 1).prod();
  };
  while (cells(coarse) > kVoxelCells) coarse *= 1.5;
  const double step = coarse * resolution;
  std::array<int, 3> count{};
  for (int k = 0; k < 3; ++k) count[k] = static_cast<int>(std::ceil(body.sizes()[k] / step - 1e-6)) + 2 * kRoom;
  lay_out(body, body.min() - Eigen::Vector3d::Constant(kRoom * step), step, count, kVoxelQuanta);
  InterruptionPoll poll(256);
  for (const Eigen::Vector3d& c : centres) {
    poll();
    int first[3], last[3];
    bool aligned = true;
    for (int k = 0; k < 3; ++k) {
      const double from = (c[k] - half[k] - low_[k]) / step, to = (c[k] + half[k] - low_[k]) / step;
      // A voxel on the lattice owns one cell; rounding must not spill it over to its neighbours.
      first[k] = std::clamp(static_cast<int>(std::floor(from + 1e-6)), 0, count[k] - 1);
      last[k] = std::clamp(static_cast<int>(std::ceil(to - 1e-6)) - 1, 0, count[k] - 1);
      aligned = aligned && first[k] == last[k] && coarse == 1;
    }
    for (int i = first[0]; i <= last[0]; ++i) {
      for (int j = first[1]; j <= last[1]; ++j) {
        for (int k = first[2]; k <= last[2]; ++k) {
          std::int8_t& cell = cells_[index(i, j, k)];
          if (cell != kSolidCell) cell = aligned ? kSolidCell : kSurfaceCell;
        }
      }
    }
  }
  measure_cells();
}

GridView DistanceGrid::view() const {
  GridView out{};
  for (int k = 0; k < 3; ++k) {
    out.low[k] = static_cast<float>(low_[k]);
    out.count[k] = count_[k];
    out.centre[k] = static_cast<float>(body_.center()[k]);
    out.half[k] = static_cast<float>(0.5 * body_.sizes()[k]);
  }
  out.per_step = static_cast<float>(per_step_);
  out.quantum = static_cast<float>(quantum_);
  out.spread = static_cast<float>(spread_);
  out.cells = cells_.data();
  return out;
}

void DistanceGrid::mark(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  throw_if_interrupted();
  const Eigen::Vector3d p[3] = {(a - low_) / step_, (b - low_) / step_, (c - low_) / step_};  // in cells
  const Eigen::Vector3d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
  const Eigen::Vector3d n = (p[1] - p[0]).cross(p[2] - p[0]);
  // Cells are grown by this, so that rounding marks rather one too many.
  constexpr double kGrow = 1e-4, kHalf = 0.5 + kGrow;
  // Unsure only in the plane of projection where the triangle stands on its edge; there the other planes decide.
  const auto outside_edges = [&](const Eigen::Vector3d& middle) {
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int e = 0; e < 3; ++e) {
        const Eigen::Vector3d &from = p[e], &to = p[(e + 1) % 3], &other = p[(e + 2) % 3];
        double nu = -(to[v] - from[v]), nv = to[u] - from[u];  // normal of the edge in the plane
        const double inner = nu * (other[u] - from[u]) + nv * (other[v] - from[v]);
        if (inner < 0) nu = -nu, nv = -nv;
        const double reach = kHalf * (std::abs(nu) + std::abs(nv));
        if (nu * (middle[u] - from[u]) + nv * (middle[v] - from[v]) < std::min(0.0, inner) - reach) return true;
      }
    }
    return false;
  };
  int first[3], last[3];
  for (int k = 0; k < 3; ++k) {
    first[k] = std::clamp(static_cast<int>(std::floor(low[k] - kGrow)), 0, count_[k] - 1);
    last[k] = std::clamp(static_cast<int>(std::floor(high[k] + kGrow)), 0, count_[k] - 1);
  }
  const double reach = kHalf * n.lpNorm<1>();
  for (int i = first[0]; i <= last[0]; ++i) {
    for (int j = first[1]; j <= last[1]; ++j) {
      for (int k = first[2]; k <= last[2]; ++k) {
        const Eigen::Vector3d middle(i + 0.5, j + 0.5, k + 0.5);
        if (std::abs(n.dot(middle - p[0])) > reach || outside_edges(middle)) continue;
        cells_[index(i, j, k)] = kSurfaceCell;
      }
    }
  }
}

void DistanceGrid::fill(const Solid& solid) {
  // Floods from each cell not seen yet; the first flood starts in a corner and is the outside.
  std::vector<char> seen(cells_.size(), 0);
  std::vector<std::array<int, 3>> stack;
  InterruptionPoll poll;
  const auto flood = [&](int i, int j, int k, std::int8_t value) {
    stack.push_back({i, j, k});
    seen[index(i, j, k)] = 1;
    while (!stack.empty()) {
      poll();
      const std::array<int, 3> at = stack.back();
      stack.pop_back();
      cells_[index(at[0], at[1], at[2])] = value;
      for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {-1, 1}) {
          std::array<int, 3> next = at;
          next[axis] += side;
          if (next[axis] < 0 || next[axis] >= count_[axis]) continue;
          const std::size_t n = index(next[0], next[1], next[2]);
          if (seen[n] || cells_[n] == kSurfaceCell) continue;
          seen[n] = 1;
          stack.push_back(next);
        }
      }
    }
  };
  flood(0, 0, 0, kFree);
  for (int i = 0; i < count_[0]; ++i) {
    for (int j = 0; j < count_[1]; ++j) {
      for (int k = 0; k < count_[2]; ++k) {
        const std::size_t n = index(i, j, k);
        if (seen[n] || cells_[n] == kSurfaceCell) continue;
        const Eigen::Vector3d middle = low_ + step_ * Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5);
        flood(i, j, k, solid.contains(middle) ? kSolidCell : kSurfaceCell);
      }
    }
  }
}

std::vector<float> DistanceGrid::centre_distances(const TriangleMesh& mesh, double band) const {
  std::vector<float> squared(cells_.size(), std::numeric_limits<float>::infinity());
  for (const auto& t : mesh.triangles) {
    throw_if_interrupted();
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Eigen::Vector3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const Eigen::Vector3d middle = (a + b + c) / 3;
    const double radius =
        std::sqrt(std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()}));
    int first[3], last[3];
    for (int k = 0; k < 3; ++k) {
      first[k] = std::clamp(static_cast<int>((low[k] - band - low_[k]) * per_step_ - 0.5), 0, count_[k] - 1);
      last[k] = std::clamp(static_cast<int>((high[k] + band - low_[k]) * per_step_ + 0.5), 0, count_[k] - 1);
    }
    for (int i = first[0]; i <= last[0]; ++i) {
      for (int j = first[1]; j <= last[1]; ++j) {
        for (int k = first[2]; k <= last[2]; ++k) {
          const std::size_t n = index(i, j, k);
          if (cells_[n] != kFree) continue;
          const Eigen::Vector3d centre = low_ + step_ * Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5);
          const double most = radius + std::min(band, std::sqrt(double(squared[n])));
          if ((centre - middle).squaredNorm() > most * most) continue;
          const double distance = triangle_distance(centre, a, b, c);
          squared[n] = std::min(squared[n], static_cast<float>(distance * distance));
        }
      }
    }
  }
  for (float& value : squared) value = std::sqrt(value);
  return squared;
}

void DistanceGrid::spread_out(std::vector<float>& squared) const {
  const std::size_t stride[3] = {static_cast<std::size_t>(count_[1]) * count_[2], static_cast<std::size_t>(count_[2]),
                                 1};
  for (int axis = 0; axis < 3; ++axis) {
    const int n = count_[axis], u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<float> line(n), out(n), border(n + 1);
    std::vector<int> peak(n);
    for (int i = 0; i < count_[u]; ++i) {
      throw_if_interrupted();
      for (int j = 0; j < count_[v]; ++j) {
        float* first = squared.data() + i * stride[u] + j * stride[v];
        for (int q = 0; q < n; ++q) line[q] = first[q * stride[axis]];
        line_distances(line, out, peak, border);
        for (int q = 0; q < n; ++q) first[q * stride[axis]] = out[q];
      }
    }
  }
}

void DistanceGrid::measure_centres(const std::vector<float>& near, double band) {
  std::vector<float> squared(cells_.size());
  for (std::size_t n = 0; n < cells_.size(); ++n) squared[n] = cells_[n] == kFree ? 1e12f : 0;
  spread_out(squared);
  for (std::size_t n = 0; n < cells_.size(); ++n) {
    if (cells_[n] != kFree) continue;
    // The mesh may come as near as the corners of the nearest cell that holds some of it.
    const double at_least = (std::sqrt(double(squared[n])) - kHalfDiagonal) * step_;
    const double distance = near[n] <= band ? near[n] * (1 - 1e-6) : std::max(at_least, band);
    cells_[n] = static_cast<std::int8_t>(std::clamp(std::floor(distance / quantum_), 0.0, 126.0));
  }
}

void DistanceGrid::measure_cells() {
  // Distances from cell to cell are those of their nearest corners: as if the others were grown by a cell all around.
  std::vector<float> squared(cells_.size(), 1e12f);
  for (int i = 0; i < count_[0]; ++i) {
    throw_if_interrupted();
    for (int j = 0; j < count_[1]; ++j) {
      for (int k = 0; k < count_[2]; ++k) {
        if (cells_[index(i, j, k)] == kFree) continue;
        for (int a = std::max(0, i - 1); a <= std::min(i + 1, count_[0] - 1); ++a) {
          for (int b = std::max(0, j - 1); b <= std::min(j + 1, count_[1] - 1); ++b) {
            for (int c = std::max(0, k - 1); c <= std::min(k + 1, count_[2] - 1); ++c) squared[index(a, b, c)] = 0;
          }
        }
      }
    }
  }
  spread_out(squared);
  for (std::size_t n = 0; n < cells_.size(); ++n) {
    if (cells_[n] == kFree)
      cells_[n] =
          static_cast<std::int8_t>(std::min(126.0, std::floor(kVoxelQuanta * std::sqrt(double(squared[n])) + 1e-4)));
  }
}

}  // namespace mmgrasp::detail
