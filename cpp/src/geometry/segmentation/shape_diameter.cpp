#include "mmgrasp/geometry/shape_diameter.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
/// Faces whose rays are cast together.
constexpr std::size_t kBatch = 64;
/// Shells that a ray may pass through before it is given up.
constexpr int kMostShells = 16;
/// Where a ray begins, as a share of the mesh's size: past the face that it comes from.
constexpr double kOffset = 1e-7;

/// Directions around +z at equal shares of the cone's solid angle, on a spiral of the golden angle.
std::vector<Vector3d> cone_directions(int rays, double cone) {
  const double lowest = std::cos(cone / 2), golden = detail::kPi * (3 - std::sqrt(5.0));
  std::vector<Vector3d> out;
  for (int k = 0; k < rays; ++k) {
    const double z = 1 - (1 - lowest) * (k + 0.5) / rays, r = std::sqrt(1 - z * z);
    out.emplace_back(r * std::cos(golden * k), r * std::sin(golden * k), z);
  }
  return out;
}

struct Width {
  double value, weight;
};

/// Weighted mean of what lies within `outlier` standard deviations of the median.
double mean_width(std::vector<Width>& widths, double outlier) {
  if (widths.empty()) return 0;
  const auto less = [](const Width& a, const Width& b) { return a.value < b.value; };
  std::sort(widths.begin(), widths.end(), less);
  const std::size_t n = widths.size();
  const double median = 0.5 * (widths[(n - 1) / 2].value + widths[n / 2].value);
  double variance = 0;
  for (const Width& w : widths) variance += (w.value - median) * (w.value - median) / static_cast<double>(n);
  const double reach = outlier * std::sqrt(variance) + 1e-12 * median;
  double sum = 0, weights = 0;
  for (const Width& w : widths) {
    if (std::abs(w.value - median) > reach) continue;
    sum += w.weight * w.value;
    weights += w.weight;
  }
  return weights > 0 ? sum / weights : median;
}

/// Measures faces one by one: casts their cones of rays, and takes the mean without outliers.
class DiameterMeter {
 public:
  DiameterMeter(const TriangleMesh& mesh, const ShapeDiameterOptions& options)
      : mesh_(mesh), options_(options), caster_(mesh), cone_(cone_directions(options.rays, options.cone)) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& v : mesh.vertices) box.extend(v);
    offset_ = kOffset * box.diagonal().norm();
  }

  void measure(std::size_t begin, std::size_t end, std::vector<double>& out) const {
    std::vector<Ray> rays;
    std::vector<Vector3d> normals;
    for (std::size_t f = begin; f < end; ++f) {
      const auto& v = mesh_.triangles[f];
      const Vector3d a = mesh_.vertices[v[0]], b = mesh_.vertices[v[1]], c = mesh_.vertices[v[2]];
      const Vector3d cross = (b - a).cross(c - a);
      normals.push_back(cross.norm() > 0 ? Vector3d(cross.normalized()) : Vector3d::Zero());
      if (normals.back().isZero()) continue;
      const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), -normals.back());
      for (const Vector3d& d : cone_) rays.push_back({(a + b + c) / 3, turn * d, offset_});
    }
    std::vector<RayHit> hits;
    caster_.closest_hits(rays, hits, 1);
    std::vector<Width> widths;
    std::size_t next = 0;
    for (std::size_t f = begin; f < end; ++f) {
      const Vector3d& n = normals[f - begin];
      if (n.isZero()) continue;
      widths.clear();
      for (std::size_t k = 0; k < cone_.size(); ++k, ++next) {
        const RayHit exit = hits[next] && hits[next].front ? leave(rays[next], hits[next]) : hits[next];
        if (!exit || exit.front) continue;
        // A back that is met is crossed along its outward normal, so n - exit.normal is never small here.
        const Vector3d across = n - exit.normal;
        const double width = options_.ray_lengths
                                 ? exit.distance
                                 : 2 * (rays[next].origin - exit.point).dot(across) / across.squaredNorm();
        if (width > 0) widths.push_back({width, cone_[k].z()});
      }
      out[f] = mean_width(widths, options_.outlier);
    }
  }

 private:
  /// Follows a ray that met the front of a shell inside the solid to where it leaves the solid.
  RayHit leave(Ray ray, RayHit hit) const {
    int depth = 1;
    for (int k = 0; k < kMostShells && hit; ++k) {
      depth += hit.front ? 1 : -1;
      if (depth == 0) return hit;
      ray.nearest = hit.distance + offset_;
      hit = caster_.closest_hit(ray);
    }
    return {};
  }

  const TriangleMesh& mesh_;
  const ShapeDiameterOptions& options_;
  RayCaster caster_;
  std::vector<Vector3d> cone_;
  double offset_ = 0;
};

}  // namespace

void ShapeDiameterOptions::check() const {
  require(rays >= 1 && rays <= 1000, "rays", rays, "must be from 1 to 1000");
  require(cone > 0 && cone < detail::kPi, "cone", cone, "must be above 0 and below pi rad");
  require_positive(outlier, "outlier");
  resolve_threads(threads);  // says what is wrong
}

std::vector<double> shape_diameters(const TriangleMesh& mesh, const ShapeDiameterOptions& options,
                                    const Monitor& monitor) {
  options.check();
  std::vector<double> out(mesh.triangles.size(), 0);
  if (out.empty()) return out;
  const DiameterMeter meter(mesh, options);
  const std::size_t batches = (out.size() + kBatch - 1) / kBatch;
  parallel_for(
      batches, options.threads,
      [&](std::size_t batch, int) { meter.measure(batch * kBatch, std::min(out.size(), (batch + 1) * kBatch), out); },
      monitor, "shape diameters");
  return out;
}

}  // namespace mmgrasp
