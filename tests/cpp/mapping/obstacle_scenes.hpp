#pragma once

// What the tests of the map's obstacle cells share: cells to look points up in, scenes, and the points that pixels saw.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "mapping/sdf_scenes.hpp"

namespace mmgrasp::test {

using Eigen::Vector3d;

/// Cells to look points up in, whatever their sizes.
class CellSet {
 public:
  explicit CellSet(const std::vector<Voxels>& sizes) {
    for (const Voxels& voxels : sizes) {
      Level level{voxels.resolution, {}};
      for (const Vector3d& c : *voxels.centres) level.cells.insert(cell(c / voxels.resolution));
      EXPECT_EQ(level.cells.size(), voxels.centres->size()) << "cells twice";
      levels_.push_back(std::move(level));
    }
  }

  /// Cells are closed: a point on their boundary belongs to them.
  bool has(const Vector3d& point) const {
    for (const Level& level : levels_) {
      for (int k = 0; k < 8; ++k) {
        const Vector3d side(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
        if (level.cells.count(cell(point / level.edge + 1e-9 * side))) return true;
      }
    }
    return false;
  }
  /// The same for a point that lies on no boundary.
  bool holds(const Vector3d& point) const {
    for (const Level& level : levels_) {
      if (level.cells.count(cell(point / level.edge))) return true;
    }
    return false;
  }

 private:
  using Cell = std::array<long, 3>;
  struct Level {
    double edge;
    std::set<Cell> cells;
  };
  static Cell cell(const Vector3d& at) {
    return {std::lround(std::floor(at[0])), std::lround(std::floor(at[1])), std::lround(std::floor(at[2]))};
  }
  std::vector<Level> levels_;
};

inline SdfObstacleOptions at_sigmas(double sigmas, UnknownSpace unknown = UnknownSpace::free) {
  SdfObstacleOptions options;
  options.sigmas = sigmas;
  options.unknown = unknown;
  return options;
}

inline CellSet cells_of(const ProbabilisticSdf& sdf, double sigmas) {
  return CellSet(sdf.obstacle_cells(at_sigmas(sigmas)));
}

inline Pose placed(const Vector3d& shift, double angle = 0) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(angle, Vector3d(1, 2, 3).normalized()).matrix();
  T.translation() = shift;
  return T;
}

/// Exact frames of a scene from `views` sides; upwards ones only where it stands on a floor.
inline std::vector<DepthImage> exact_frames(const std::vector<PlacedShape>& scene, int views, bool from_above) {
  std::vector<DepthImage> out;
  for (int k = 0; k < views; ++k) {
    Vector3d from = direction_of(k, views);
    if (from_above) from = Vector3d(from.x(), from.y(), std::abs(from.z()) + 0.3).normalized();
    if (views == 1) from = Vector3d(0.3, 0.2, 0.9).normalized();
    out.push_back(frame_of(scene, small_camera(), look_at(0.32 * from, Vector3d::Zero())));
  }
  return out;
}

/// Away from the solid at a point of its surface.
inline Vector3d outward(const PlacedShape& placed, const Vector3d& point, double& distance) {
  const Vector3d p = placed.T_world_shape.inverse() * point;
  Vector3d best = Vector3d::UnitZ();
  distance = 1;
  const auto offer = [&](double off, const Vector3d& normal) {
    if (std::abs(off) >= distance) return;
    distance = std::abs(off);
    best = normal;
  };
  if (const auto* box = std::get_if<Box>(&placed.shape)) {
    if ((p.cwiseAbs() - 0.5 * box->size).maxCoeff() > 1e-5) return best;
    for (int k = 0; k < 3; ++k) offer(std::abs(p[k]) - 0.5 * box->size[k], Vector3d::Unit(k) * (p[k] > 0 ? 1 : -1));
  } else if (const auto* sphere = std::get_if<Sphere>(&placed.shape)) {
    offer(p.norm() - sphere->radius, p.normalized());
  } else if (const auto* cylinder = std::get_if<Cylinder>(&placed.shape)) {
    offer(p.head<2>().norm() - cylinder->radius, Vector3d(p.x(), p.y(), 0).normalized());
    offer(std::abs(p.z()) - 0.5 * cylinder->length, Vector3d::UnitZ() * (p.z() > 0 ? 1 : -1));
  }
  return placed.T_world_shape.linear() * best;
}

/// The last one stands on a floor.
inline std::vector<std::vector<PlacedShape>> primitive_scenes() {
  const Pose turned = placed({0.0007, 0.0003, 0.0011}, 0.5);
  return {
      {{Box{{0.10, 0.07, 0.05}}, Pose::Identity()}},
      {{Box{{0.10, 0.07, 0.05}}, turned}},
      {{Sphere{0.05}, turned}},
      {{Cylinder{0.03, 0.1}, turned}},
      {{Cylinder{0.003, 0.2}, turned}},
      {{Box{{0.12, 0.09, 0.001}}, turned}},
      {{Box{{0.12, 0.09, 0.003}}, Pose::Identity()}},
      {{Box{{0.3, 0.25, 0.02}}, placed({0, 0, -0.0103})}, {Box{{0.05, 0.04, 0.04}}, placed({0.001, 0.0005, 0.0203})}}};
}

struct SeenPoints {
  int count = 0, outside = 0;
};

/// The true points of the surface at the centres of pixels that the map uses, and how many of them no cell holds.
inline SeenPoints look_up(const std::vector<PlacedShape>& scene, const std::vector<DepthImage>& frames,
                          const CellSet& cells) {
  SeenPoints out;
  for (const DepthImage& frame : frames) {
    for (int v = 0; v < frame.camera.height; ++v) {
      for (int u = 0; u < frame.camera.width; ++u) {
        if (!(frame.at(u, v) > 0)) continue;
        const Vector3d point = frame.point(u, v);
        const Vector3d ray = (point - frame.T_world_camera.translation()).normalized();
        double nearest = 1;
        Vector3d normal = Vector3d::Zero();
        for (const PlacedShape& shape : scene) {
          double distance;
          const Vector3d each = outward(shape, point, distance);
          if (distance >= nearest) continue;
          nearest = distance;
          normal = each;
        }
        if (-ray.dot(normal) < std::cos(1.0)) continue;  // SdfOptions::max_incidence is 1.05
        ++out.count;
        out.outside += !cells.has(point);
      }
    }
  }
  return out;
}

}  // namespace mmgrasp::test
