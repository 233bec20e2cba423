// Parts of an operation that stand in each other: an order or a pose that cannot be meant.
#include "mmgrasp/gripper_design/operation_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/distance_field.hpp"
#include "mmgrasp/grasp/detail/motion_looks.hpp"

namespace mmgrasp {
namespace {

constexpr double kStep = 0.002, kTurn = 0.05;  // [m], [rad] between two looks
constexpr std::size_t kPoints = 4000;

/// A mesh with points of its surface, and where it is solid.
struct Body {
  Eigen::Matrix3Xd points;
  Eigen::AlignedBox3d box;
  std::optional<MeshDistanceField> field;  // Closed meshes only.
};

Eigen::Matrix3Xd surface_points(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> out;
  const std::size_t stride = std::max<std::size_t>(1, (mesh.vertices.size() + kPoints - 1) / kPoints);
  for (std::size_t i = 0; i < mesh.vertices.size(); i += stride) out.push_back(mesh.vertices[i]);
  std::vector<double> area_up_to;
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    area += (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
    area_up_to.push_back(area);
  }
  Rng rng(1);
  for (std::size_t i = 0; i < kPoints && area > 0; ++i) {
    const auto at = std::upper_bound(area_up_to.begin(), area_up_to.end(), rng.uniform(0, area));
    const auto& t = mesh.triangles[std::min<std::size_t>(at - area_up_to.begin(), mesh.triangles.size() - 1)];
    double u = rng.uniform(), v = rng.uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    out.push_back(a + u * (mesh.vertices[t[1]] - a) + v * (mesh.vertices[t[2]] - a));
  }
  return Eigen::Map<const Eigen::Matrix3Xd>(out.front().data(), 3, static_cast<Eigen::Index>(out.size()));
}

/// How deep the points of `from`, moved by `T_to_from`, lie in `to`.
double depth_in(const Body& to, const Body& from, const Pose& T_to_from) {
  if (!to.field) return 0;
  Eigen::Matrix3Xd inside(3, from.points.cols());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < from.points.cols(); ++i) {
    const Eigen::Vector3d p = T_to_from * from.points.col(i);
    if (to.box.contains(p)) inside.col(count++) = p;
  }
  if (count == 0) return 0;
  return std::max(0.0, -to.field->distances(inside.leftCols(count)).minCoeff());
}

class Overlaps {
 public:
  explicit Overlaps(const AssemblyOperation& operation) : operation_(operation) {}

  OperationOverlap at(const Pose& T_passive_active) {
    OperationOverlap out;
    for (const PlacedMesh& a : operation_.active) {
      for (const PlacedMesh& p : operation_.passive) {
        const Body &active = body(*a.mesh), &passive = body(*p.mesh);
        const Pose T = p.pose.inverse() * T_passive_active * a.pose;
        const double reach = (active.box.diagonal().norm() + passive.box.diagonal().norm()) / 2;
        if ((T * active.box.center() - passive.box.center()).norm() > reach) continue;
        const double depth = std::max(depth_in(passive, active, T), depth_in(active, passive, T.inverse()));
        if (depth > out.depth) out = {depth, a.name, p.name, 0};
      }
    }
    return out;
  }

 private:
  const Body& body(const TriangleMesh& mesh) {
    const auto [place, is_new] = bodies_.try_emplace(&mesh);
    if (is_new) {
      place->second.points = surface_points(mesh);
      for (const Eigen::Vector3d& v : mesh.vertices) place->second.box.extend(v);
      if (mesh.closed) place->second.field.emplace(mesh);
    }
    return place->second;
  }

  const AssemblyOperation& operation_;
  std::map<const TriangleMesh*, Body> bodies_;
};

}  // namespace

OperationOverlap operation_overlap(const AssemblyOperation& operation, double allowed, const Monitor& monitor) {
  operation.check();
  require_not_negative(allowed, "allowed", "m");
  Overlaps overlaps(operation);
  const OperationOverlap at_end = overlaps.at(operation.motion.back());
  if (at_end.depth > allowed) return at_end;
  const Eigen::Vector3d middle = detail::middle_of(operation.active);
  const Poses looks = detail::motion_looks(operation.motion, middle, kStep, kTurn);
  double way = 0;
  for (std::size_t i = looks.size() - 1; i-- > 0 && !monitor.stopped();) {
    way += (looks[i + 1] * middle - looks[i] * middle).norm();
    OperationOverlap found = overlaps.at(looks[i]);
    if (found.depth <= allowed) continue;
    found.before_end = way;
    return found;
  }
  return at_end;
}

}  // namespace mmgrasp
