#include "mmgrasp/mapping/height_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Every pixel takes the nearest depth around it; with `only_holes` only those without one.
std::vector<float> nearest_around(const std::vector<float>& depth, int width, int height, bool only_holes) {
  std::vector<float> out = depth;
  for (int v = 0; v < height; ++v) {
    detail::throw_if_interrupted();
    for (int u = 0; u < width; ++u) {
      float& z = out[static_cast<std::size_t>(v) * width + u];
      if (only_holes && z > 0) continue;
      for (int dv = std::max(0, v - 1); dv <= std::min(height - 1, v + 1); ++dv) {
        for (int du = std::max(0, u - 1); du <= std::min(width - 1, u + 1); ++du) {
          const float other = depth[static_cast<std::size_t>(dv) * width + du];
          if (other > 0 && (z <= 0 || other < z)) z = other;
        }
      }
    }
  }
  return out;
}

/// Draws triangles from above into the cells whose centres they cover; the highest counts.
class CellPainter {
 public:
  CellPainter(const HeightMap& map, std::vector<float>& cells) : map_(map), cells_(cells) {}

  void paint(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double h = map_.resolution;
    const Eigen::Vector2d corner(-0.5 * map_.nx * h, -0.5 * map_.ny * h);
    const Eigen::Vector2d p = (a.head<2>() - corner) / h, q = (b.head<2>() - corner) / h,
                          r = (c.head<2>() - corner) / h;
    const double area = cross(q - p, r - p);
    if (area == 0) return;
    // Cell ix is covered when its centre ix + 0.5 is.
    const int x0 = first(std::min({p.x(), q.x(), r.x()}), map_.nx), x1 = last(std::max({p.x(), q.x(), r.x()}), map_.nx);
    const int y0 = first(std::min({p.y(), q.y(), r.y()}), map_.ny), y1 = last(std::max({p.y(), q.y(), r.y()}), map_.ny);
    for (int iy = y0; iy <= y1; ++iy) {
      for (int ix = x0; ix <= x1; ++ix) {
        const Eigen::Vector2d s(ix + 0.5, iy + 0.5);
        const double wa = cross(q - s, r - s) / area, wb = cross(r - s, p - s) / area, wc = cross(p - s, q - s) / area;
        constexpr double kEdge = -1e-9;
        if (wa < kEdge || wb < kEdge || wc < kEdge) continue;
        float& cell = cells_[map_.index(ix, iy)];
        const auto z = static_cast<float>(wa * a.z() + wb * b.z() + wc * c.z());
        if (!(cell >= z)) cell = z;
      }
    }
  }

 private:
  static double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
  // Triangles may lie anywhere: clamped before they become whole numbers.
  static int first(double lower, int size) {
    return static_cast<int>(std::clamp(std::ceil(lower - 0.5 - 1e-9), 0.0, double(size)));
  }
  static int last(double upper, int size) {
    return static_cast<int>(std::clamp(std::floor(upper - 0.5 + 1e-9), -1.0, size - 1.0));
  }

  const HeightMap& map_;
  std::vector<float>& cells_;
};

/// Triangles between neighbouring pixels. With `jump` those across a jump are left out.
void paint_surface(const DepthImage& image, const std::vector<float>& depth, double jump, const Pose& T_map_camera,
                   HeightMap& map, std::vector<float>& cells) {
  const PinholeCamera& camera = image.camera;
  const auto pixel = [&](int u, int v) { return static_cast<std::size_t>(v) * camera.width + u; };
  std::vector<Vector3d> points(depth.size());
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double z = depth[pixel(u, v)];
      points[pixel(u, v)] =
          T_map_camera * Vector3d((u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z);
    }
  }
  CellPainter painter(map, cells);
  const auto paint = [&](std::size_t i, std::size_t j, std::size_t k) {
    const float a = depth[i], b = depth[j], c = depth[k];
    if (a <= 0 || b <= 0 || c <= 0) return;
    if (std::max({a, b, c}) - std::min({a, b, c}) > jump) return;
    painter.paint(points[i], points[j], points[k]);
  };
  for (int v = 0; v + 1 < camera.height; ++v) {
    detail::throw_if_interrupted();
    for (int u = 0; u + 1 < camera.width; ++u) {
      paint(pixel(u, v), pixel(u + 1, v), pixel(u, v + 1));
      paint(pixel(u + 1, v), pixel(u + 1, v + 1), pixel(u, v + 1));
    }
  }
}

}  // namespace

void HeightMap::check() const {
  checked_pose(T_world_map.matrix(), "T_world_map");
  require_length(resolution, "map.resolution");
  require(nx > 0 && ny > 0, "map", std::to_string(nx) + " x " + std::to_string(ny) + " cells", "must have cells");
  const std::size_t cells = static_cast<std::size_t>(nx) * ny;
  require(height.size() == cells, "map.height", std::to_string(height.size()), "must be one a cell");
  require(upper.size() == cells, "map.upper", std::to_string(upper.size()), "must be one a cell");
  require_not_negative(pixel, "map.pixel", "m");
}

void HeightMapOptions::check() const {
  require_length(resolution, "resolution");
  require_count(hole_radius, "hole_radius", 0);
  require(jump > 0, "jump", jump, "must be positive [m]");
}

HeightMap make_height_map(const DepthImage& image, const Pose& T_world_map, const Eigen::Vector2d& size,
                          const HeightMapOptions& options) {
  options.check();
  image.check();
  for (int k = 0; k < 2; ++k) {
    const bool fits = size[k] >= options.resolution && size[k] <= 20000 * options.resolution;
    require(fits, "size", size[k], "must be from 1 to 20000 cells of the resolution [m]");
  }
  HeightMap map;
  map.T_world_map = checked_pose(T_world_map.matrix(), "T_world_map");
  map.resolution = options.resolution;
  map.nx = static_cast<int>(std::lround(size.x() / options.resolution));
  map.ny = static_cast<int>(std::lround(size.y() / options.resolution));
  map.height.assign(static_cast<std::size_t>(map.nx) * map.ny, kUnknown);
  map.upper = map.height;

  DepthImage clean = image;
  clean.clean();
  const int width = image.camera.width, height = image.camera.height;
  for (int i = 0; i < options.hole_radius; ++i) {
    std::vector<float> filled = nearest_around(clean.depth, width, height, true);
    if (filled == clean.depth) break;  // no hole is left, or nothing around it
    clean.depth = std::move(filled);
  }
  const Pose T_map_camera = map.T_world_map.inverse(Eigen::Isometry) * image.T_world_camera;
  paint_surface(image, clean.depth, options.jump, T_map_camera, map, map.height);
  paint_surface(image, nearest_around(clean.depth, width, height, false), detail::kInfinity, T_map_camera, map,
                map.upper);
  for (std::size_t i = 0; i < map.upper.size(); ++i) {
    if (map.height[i] > map.upper[i]) map.upper[i] = map.height[i];
  }
  const double distance = std::abs((T_map_camera * Vector3d::Zero()).norm());
  map.pixel = distance / std::min(image.camera.fx, image.camera.fy);
  return map;
}

}  // namespace mmgrasp
