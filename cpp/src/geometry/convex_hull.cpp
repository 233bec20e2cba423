// Convex hulls of points (Quickhull).
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/detail/mesh_topology.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp {

namespace {

struct Face {
  std::array<int, 3> corner{};
  std::array<int, 3> neighbour{};  // across the side from corner k to corner k + 1
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double offset = 0;
  std::vector<int> outside;  // points in front of it that no other face has taken
  bool alive = true;
};

// Quickhull: always adds the point farthest from some face, so that points within `tolerance` never make slivers.
class HullBuilder {
 public:
  HullBuilder(const std::vector<Eigen::Vector3d>& points, double tolerance) : points_(points), tolerance_(tolerance) {}

  // False when the points lie in one plane (within the tolerance) or rounding broke the surface.
  bool build() {
    if (!start_tetrahedron()) return false;
    while (!pending_.empty()) {
      poll_();
      const int f = pending_.back();
      pending_.pop_back();
      if (!faces_[f].alive || faces_[f].outside.empty()) continue;
      if (!add_point(f)) return false;
    }
    return true;
  }

  std::vector<std::array<int, 3>> triangles() const {
    std::vector<std::array<int, 3>> out;
    for (const Face& face : faces_) {
      if (face.alive) out.push_back(face.corner);
    }
    return out;
  }

  // Farthest any point stands out; every face of a small hull is asked, some of a large one.
  double worst_excess() const {
    double worst = 0;
    const std::size_t stride = 1 + faces_.size() * points_.size() / 5'000'000;
    for (std::size_t i = 0; i < faces_.size(); i += stride) {
      const Face& face = faces_[i];
      if (!face.alive) continue;
      detail::throw_if_interrupted();
      for (const Eigen::Vector3d& p : points_) worst = std::max(worst, face.normal.dot(p) - face.offset);
    }
    return worst;
  }

 private:
  double height(const Face& face, int point) const { return face.normal.dot(points_[point]) - face.offset; }

  int add_face(int a, int b, int c) {
    Face face;
    face.corner = {a, b, c};
    face.normal = (points_[b] - points_[a]).cross(points_[c] - points_[a]);
    const double length = face.normal.norm();
    if (length > 0) face.normal /= length;
    face.offset = face.normal.dot(points_[a] + points_[b] + points_[c]) / 3;
    faces_.push_back(face);
    return static_cast<int>(faces_.size()) - 1;
  }

  bool start_tetrahedron() {
    const int n = static_cast<int>(points_.size());
    std::array<int, 4> t{};
    const auto farthest = [&](const auto& measure) {
      int best = 0;
      for (int i = 1; i < n; ++i) {
        if (measure(i) > measure(best)) best = i;
      }
      return best;
    };
    t[0] = farthest([&](int i) { return -points_[i].x(); });
    t[1] = farthest([&](int i) { return (points_[i] - points_[t[0]]).squaredNorm(); });
    const Eigen::Vector3d along = (points_[t[1]] - points_[t[0]]).normalized();
    t[2] = farthest([&](int i) { return along.cross(points_[i] - points_[t[0]]).squaredNorm(); });
    const Eigen::Vector3d cross = along.cross(points_[t[2]] - points_[t[0]]);
    if (!(cross.norm() > tolerance_)) return false;
    const Eigen::Vector3d normal = cross.normalized();
    t[3] = farthest([&](int i) { return std::abs(normal.dot(points_[i] - points_[t[0]])); });
    const double signed_height = normal.dot(points_[t[3]] - points_[t[0]]);
    if (!(std::abs(signed_height) > tolerance_)) return false;
    if (signed_height > 0) std::swap(t[1], t[2]);
    add_face(t[0], t[1], t[2]);
    add_face(t[0], t[3], t[1]);
    add_face(t[1], t[3], t[2]);
    add_face(t[2], t[3], t[0]);
    faces_[0].neighbour = {1, 2, 3};
    faces_[1].neighbour = {3, 2, 0};
    faces_[2].neighbour = {1, 3, 0};
    faces_[3].neighbour = {2, 1, 0};
    std::vector<int> all(n);
    for (int i = 0; i < n; ++i) all[i] = i;
    distribute(all, {0, 1, 2, 3});
    return true;
  }

  void distribute(const std::vector<int>& points, const std::vector<int>& faces) {
    for (const int p : points) {
      poll_();
      double best = tolerance_;
      int owner = -1;
      for (const int f : faces) {
        const double h = height(faces_[f], p);
        if (h > best) best = h, owner = f;
      }
      if (owner >= 0) faces_[owner].outside.push_back(p);
    }
    for (const int f : faces) {
      if (!faces_[f].outside.empty()) pending_.push_back(f);
    }
  }

  struct HorizonEdge {
    int from, to, outer;
  };

  bool add_point(int start) {
    const std::vector<int>& outside = faces_[start].outside;
    const int apex = *std::max_element(outside.begin(), outside.end(), [&](int a, int b) {
      return height(faces_[start], a) < height(faces_[start], b);
    });
    std::vector<int> visible = visible_faces(start, apex), orphans;
    std::vector<HorizonEdge> horizon;
    for (const int f : visible) {
      for (int k = 0; k < 3; ++k) {
        const int other = faces_[f].neighbour[k];
        if (faces_[other].alive) horizon.push_back({faces_[f].corner[k], faces_[f].corner[(k + 1) % 3], other});
      }
      for (const int p : faces_[f].outside) {
        if (p != apex) orphans.push_back(p);
      }
      faces_[f].outside.clear();
    }
    return close_cone(horizon, apex, orphans);
  }

  // Connected region seen from the point; its faces die here.
  std::vector<int> visible_faces(int start, int apex) {
    std::vector<int> visible{start};
    faces_[start].alive = false;
    for (std::size_t i = 0; i < visible.size(); ++i) {
      for (const int other : faces_[visible[i]].neighbour) {
        if (!faces_[other].alive || height(faces_[other], apex) <= tolerance_) continue;
        faces_[other].alive = false;
        visible.push_back(other);
      }
    }
    return visible;
  }

  bool close_cone(const std::vector<HorizonEdge>& horizon, int apex, const std::vector<int>& orphans) {
    std::vector<int> cone;
    for (const HorizonEdge& edge : horizon) {
      const int f = add_face(edge.from, edge.to, apex);
      faces_[f].neighbour = {edge.outer, -1, -1};
      Face& outer = faces_[edge.outer];
      for (int k = 0; k < 3; ++k) {
        if (outer.corner[k] == edge.to && outer.corner[(k + 1) % 3] == edge.from) outer.neighbour[k] = f;
      }
      cone.push_back(f);
    }
    for (std::size_t i = 0; i < horizon.size(); ++i) {
      int matches = 0;
      for (std::size_t j = 0; j < horizon.size(); ++j) {
        if (horizon[j].from != horizon[i].to) continue;
        faces_[cone[i]].neighbour[1] = cone[j];
        faces_[cone[j]].neighbour[2] = cone[i];
        ++matches;
      }
      if (matches != 1) return false;  // The horizon is no single loop.
    }
    distribute(orphans, cone);
    return true;
  }

  const std::vector<Eigen::Vector3d>& points_;
  double tolerance_;
  std::vector<Face> faces_;
  std::vector<int> pending_;
  detail::InterruptionPoll poll_{1024};
};

std::shared_ptr<const TriangleMesh> finish(const std::vector<Eigen::Vector3d>& points,
                                           const std::vector<std::array<int, 3>>& triangles) {
  auto mesh = std::make_shared<TriangleMesh>();
  std::vector<int> new_index(points.size(), -1);
  for (auto triangle : triangles) {
    for (int& corner : triangle) {
      if (new_index[corner] < 0) {
        new_index[corner] = static_cast<int>(mesh->vertices.size());
        mesh->vertices.push_back(points[corner]);
      }
      corner = new_index[corner];
    }
    mesh->triangles.push_back(triangle);
  }
  mesh->closed = detail::orient_closed(mesh->vertices, mesh->triangles);
  mesh->convex = mesh->closed;
  return mesh;
}

}  // namespace

std::shared_ptr<const TriangleMesh> convex_hull(const std::vector<Eigen::Vector3d>& points) {
  require(points.size() >= 4, "convex hull points", std::to_string(points.size()), "at least four are needed");
  Eigen::AlignedBox3d bounds;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) throw InvalidInput("convex hull: point " + std::to_string(i) + " is not finite");
    bounds.extend(points[i]);
  }
  const double extent = bounds.diagonal().norm();
  // Rounding can break the surface of nearly coplanar points; a coarser tolerance drops the points that did it.
  for (const double relative : {1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6}) {
    HullBuilder builder(points, relative * extent);
    if (!builder.build() || builder.worst_excess() > 50 * relative * extent) continue;
    auto mesh = finish(points, builder.triangles());
    if (mesh->closed) return mesh;
  }
  throw InvalidInput("convex hull of " + std::to_string(points.size()) + " points: they lie in one plane");
}

}  // namespace mmgrasp
