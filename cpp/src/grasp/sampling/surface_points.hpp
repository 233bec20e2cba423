#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

struct SurfacePoint {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  ///< Unit, by the triangle's winding.
};

/// Points drawn evenly over a surface of at least one triangle, each with an area.
class SurfacePoints {
 public:
  explicit SurfacePoints(const TriangleMesh& mesh);

  SurfacePoint draw(Rng& rng) const;

 private:
  struct Triangle {
    Eigen::Vector3d a, ab, ac, normal;
  };
  std::vector<Triangle> triangles_;
  std::vector<double> cumulative_area_;
};

}  // namespace mmgrasp::detail
