#include "geometry/nested_shells.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "mmgrasp/core/detail/interruption.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Triangle = std::array<int, 3>;

/// Corners of a shell that are looked at, evenly out of all, to see whether another one is around it.
constexpr std::size_t kLookedAt = 64;
/// They are moved from its middle by this share, out and in: what lies within another shell when they are moved in, but
/// not when they are moved out, touches it from inside.
constexpr double kMoved = 1e-6;

struct ShellExtent {
  double volume = 0;  // [m^3], below zero where it looks inwards
  Eigen::AlignedBox3d bounds;
  std::vector<int> triangles;
};

std::vector<ShellExtent> extents(const std::vector<Vector3d>& v, const std::vector<Triangle>& triangles,
                                 const Shells& shells) {
  std::vector<ShellExtent> out(shells.count);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    ShellExtent& shell = out[shells.shell_of_triangle[t]];
    const Vector3d& origin = v[shell.triangles.empty() ? triangles[t][0] : triangles[shell.triangles[0]][0]];
    const auto at = [&](int corner) -> Vector3d { return v[triangles[t][corner]] - origin; };
    shell.volume += at(0).dot(at(1).cross(at(2))) / 6;
    for (const int corner : triangles[t]) shell.bounds.extend(v[corner]);
    shell.triangles.push_back(static_cast<int>(t));
  }
  return out;
}

/// A point of a shell, and how often the shell that is asked about goes around it.
struct ShellPoint {
  Vector3d place;
  int shell;
  bool moved_out;
  int winding = 0;
};

/// Where the ray through a point meets the plane z = 0.
Vector2d shadow_of(const Vector3d& p) {
  return (p - p.z() * ray_direction()).head<2>();
}

/// Counts the windings of a shell around points, which come back sorted by their shadows.
void count_windings(const std::vector<Vector3d>& v, const std::vector<Triangle>& triangles, const ShellExtent& around,
                    std::vector<ShellPoint>& points) {
  std::sort(points.begin(), points.end(),
            [](const ShellPoint& a, const ShellPoint& b) { return shadow_of(a.place).x() < shadow_of(b.place).x(); });
  std::vector<Vector2d> shadows;
  for (const ShellPoint& p : points) shadows.push_back(shadow_of(p.place));
  const double margin = 1e-9 * around.bounds.diagonal().norm();
  InterruptionPoll poll;
  for (const int t : around.triangles) {
    poll();
    const Vector3d &a = v[triangles[t][0]], &b = v[triangles[t][1]], &c = v[triangles[t][2]];
    Eigen::AlignedBox2d box(shadow_of(a));
    box.extend(shadow_of(b)).extend(shadow_of(c));
    const auto first = std::lower_bound(shadows.begin(), shadows.end(), box.min().x() - margin,
                                        [](const Vector2d& s, double x) { return s.x() < x; });
    for (auto at = first; at != shadows.end() && at->x() <= box.max().x() + margin; ++at) {
      if (at->y() < box.min().y() - margin || at->y() > box.max().y() + margin) continue;
      ShellPoint& p = points[at - shadows.begin()];
      p.winding += ray_crossing(a - p.place, b - p.place, c - p.place);
    }
  }
}

/// Corners of a shell, moved out from its middle a little, and in.
void add_points(const std::vector<Vector3d>& v, const std::vector<Triangle>& triangles, const ShellExtent& shell,
                int number, std::vector<ShellPoint>& out) {
  const Vector3d middle = shell.bounds.center();
  const std::size_t stride = 1 + shell.triangles.size() / kLookedAt;
  for (std::size_t i = 0; i < shell.triangles.size(); i += stride)
    for (const int corner : triangles[shell.triangles[i]])
      for (const bool outwards : {true, false})
        out.push_back({v[corner] + (outwards ? kMoved : -kMoved) * (v[corner] - middle), number, outwards});
}

/// Pairs (outer, inner) of shells whose bounds lie in each other.
std::vector<std::vector<int>> within_bounds(const std::vector<ShellExtent>& shells) {
  std::vector<int> order(shells.size()), open;
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return shells[a].bounds.min().x() < shells[b].bounds.min().x(); });
  std::vector<std::vector<int>> out(shells.size());
  InterruptionPoll poll;
  for (const int s : order) {
    const double low = shells[s].bounds.min().x();
    open.erase(std::remove_if(open.begin(), open.end(), [&](int o) { return shells[o].bounds.max().x() < low; }),
               open.end());
    for (const int o : open) {
      poll();
      if (shells[o].bounds.contains(shells[s].bounds)) out[o].push_back(s);
    }
    open.push_back(s);
  }
  return out;
}

struct Nesting {
  std::vector<std::vector<int>> around;  ///< For each shell those that it lies wholly in.
  std::vector<char> touches;             ///< Whether it touches one of them, or of others, from inside.
};

Nesting nesting(const std::vector<Vector3d>& v, const std::vector<Triangle>& triangles,
                const std::vector<ShellExtent>& shells) {
  const std::vector<std::vector<int>> within = within_bounds(shells);
  Nesting out{std::vector<std::vector<int>>(shells.size()), std::vector<char>(shells.size(), 0)};
  std::vector<char> outside(shells.size()), crosses(shells.size());
  for (std::size_t o = 0; o < shells.size(); ++o) {
    if (within[o].empty()) continue;
    std::vector<ShellPoint> points;
    for (const int s : within[o]) {
      outside[s] = crosses[s] = 0;
      add_points(v, triangles, shells[s], s, points);
    }
    count_windings(v, triangles, shells[o], points);
    for (const ShellPoint& p : points) (p.moved_out ? outside : crosses)[p.shell] |= p.winding == 0;
    for (const int s : within[o]) {
      if (!outside[s]) out.around[s].push_back(static_cast<int>(o));
      out.touches[s] |= outside[s] && !crosses[s];
    }
  }
  return out;
}

}  // namespace

std::vector<ShellFate> shell_fates(const std::vector<Vector3d>& vertices, const std::vector<Triangle>& triangles,
                                   const Shells& shells) {
  const std::vector<ShellExtent> all = extents(vertices, triangles, shells);
  const Nesting nested = nesting(vertices, triangles, all);
  const std::vector<std::vector<int>>& around = nested.around;
  std::vector<int> order(all.size()), sense(all.size(), 0);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return around[a].size() < around[b].size(); });
  std::vector<char> was_inside_out(all.size(), 0);
  std::vector<ShellFate> out(all.size(), ShellFate::keep);
  for (const int s : order) {
    int winding = 0, innermost = -1;
    for (const int o : around[s]) {
      winding += sense[o];
      if (innermost < 0 || around[o].size() > around[innermost].size()) innermost = o;
    }
    const bool inwards = all[s].volume < 0;
    const bool in_material = winding > 0 && !nested.touches[s];
    sense[s] = in_material && (inwards || was_inside_out[innermost]) ? -1 : 1;
    was_inside_out[s] = in_material ? was_inside_out[innermost] : inwards;
    const bool bounds_solid = !in_material || winding + sense[s] == 0;
    if (!bounds_solid) {
      out[s] = ShellFate::leave_out;
    } else if (inwards != (sense[s] < 0)) {
      out[s] = ShellFate::turn;
    }
  }
  return out;
}

}  // namespace mmgrasp::detail
