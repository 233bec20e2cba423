#include "geometry/simplify/decimate_outwards.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>

#include "geometry/hierarchy/triangle_tree.hpp"
#include "mmgrasp/core/detail/interruption.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-12;     // of the size: how far a point may lie behind a plane that holds it
constexpr std::size_t kMaxPlanes = 30;  // around an edge; busier places are left alone
constexpr int kTries = 3;               // cheapest points tried for one edge
constexpr double kLeastHeight = 1e-3;   // of a new triangle over its longest edge
constexpr double kLeastTurn = 0.2;      // cosine between a triangle's normals before and after

struct Plane {
  Vector3d normal;  // unit, outwards
  double offset;
};

struct Collapse {
  double volume;  // added
  int from, to;   // the edge; `to` is removed, `from` moves
  int version;    // of both ends together when this was worked out
  Vector3d target;
  bool operator<(const Collapse& other) const {
    if (volume != other.volume) return volume > other.volume;  // the queue's top is the cheapest
    return from != other.from ? from > other.from : to > other.to;
  }
};

/// Collapses edges, the cheapest first, to points that lie outside of all planes around: the solid only grows.
class OutwardCollapse {
 public:
  OutwardCollapse(const TriangleMesh& mesh, double reach)
      : mesh_(mesh), tree_(mesh), reach_(reach), points_(mesh.vertices), triangles_(mesh.triangles) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& p : points_) box.extend(p);
    slack_ = kRounding * box.diagonal().norm();
    around_.resize(points_.size());
    version_.assign(points_.size(), 0);
    alive_.assign(triangles_.size(), true);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (const int corner : triangles_[t]) around_[corner].push_back(static_cast<int>(t));
  }

  std::shared_ptr<const TriangleMesh> run() {
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (int k = 0; k < 3; ++k)
        if (triangles_[t][k] < triangles_[t][(k + 1) % 3]) offer(triangles_[t][k], triangles_[t][(k + 1) % 3]);
    while (!queue_.empty()) {
      const Collapse next = queue_.top();
      queue_.pop();
      if (around_[next.from].empty() || around_[next.to].empty()) continue;
      if (version_[next.from] + version_[next.to] == next.version) {
        apply(next);
      } else if (neighbours(next.from).count(next.to)) {
        offer(next.from, next.to);  // its surroundings have changed
      }
    }
    return result();
  }

 private:
  struct Ring {
    std::vector<int> sorted;
    std::size_t count(int vertex) const { return std::binary_search(sorted.begin(), sorted.end(), vertex); }
  };

  Ring neighbours(int vertex) const {
    Ring ring;
    for (const int t : around_[vertex])
      for (const int corner : triangles_[t])
        if (corner != vertex) ring.sorted.push_back(corner);
    std::sort(ring.sorted.begin(), ring.sorted.end());
    ring.sorted.erase(std::unique(ring.sorted.begin(), ring.sorted.end()), ring.sorted.end());
    return ring;
  }

  /// Triangles with either end as a corner.
  std::vector<int> star(int a, int b) const {
    std::vector<int> faces = around_[a];
    faces.insert(faces.end(), around_[b].begin(), around_[b].end());
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }

  bool has(int triangle, int vertex) const {
    const auto& t = triangles_[triangle];
    return t[0] == vertex || t[1] == vertex || t[2] == vertex;
  }

  Vector3d area_normal(const std::array<int, 3>& t) const {
    return (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]);
  }

  /// Collapsing an edge keeps the surface's topology when its ends share just the two corners across from it.
  bool topology_allows(int a, int b, const std::vector<int>& faces) const {
    const auto shared = std::count_if(faces.begin(), faces.end(), [&](int t) { return has(t, a) && has(t, b); });
    if (shared != 2) return false;
    const Ring of_a = neighbours(a), of_b = neighbours(b);
    std::vector<int> common;
    std::set_intersection(of_a.sorted.begin(), of_a.sorted.end(), of_b.sorted.begin(), of_b.sorted.end(),
                          std::back_inserter(common));
    return common.size() == 2 && of_a.sorted.size() + of_b.sorted.size() > 6;  // a tetrahedron stays
  }

  void offer(int a, int b) {
    poll_();
    const std::vector<int> faces = star(a, b);
    if (!topology_allows(a, b, faces)) return;
    const std::optional<Collapse> found = best_target(a, b, faces);
    if (found) queue_.push(*found);
  }

  std::vector<Plane> planes_of(const std::vector<int>& faces) const {
    std::vector<Plane> planes;
    for (const int t : faces) {
      const Vector3d n = area_normal(triangles_[t]);
      if (!(n.norm() > 0)) continue;  // bounds no volume with any point
      const Plane plane{n.normalized(), n.normalized().dot(points_[triangles_[t][0]])};
      const auto same = std::find_if(planes.begin(), planes.end(), [&](const Plane& known) {
        return (known.normal - plane.normal).squaredNorm() < 1e-24 && std::abs(known.offset - plane.offset) < slack_;
      });
      if (same == planes.end())
        planes.push_back(plane);
      else
        same->offset = std::max(same->offset, plane.offset);
    }
    return planes;
  }

  /// The added volume is linear in the target, so that it is least where planes meet: three of them, or fewer where
  /// they are parallel to the volume's gradient, then as near to the edge's middle as can be.
  std::vector<Vector3d> corners_of(const std::vector<Plane>& planes, int a, int b) const {
    const Vector3d middle = 0.5 * (points_[a] + points_[b]);
    std::vector<Vector3d> corners = {middle, points_[a], points_[b]};
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const Vector3d on_plane = middle + (planes[i].offset - planes[i].normal.dot(middle)) * planes[i].normal;
      corners.push_back(on_plane);
      for (std::size_t j = i + 1; j < planes.size(); ++j) {
        const Vector3d line = planes[i].normal.cross(planes[j].normal);
        if (line.squaredNorm() < 1e-8) continue;
        // Along plane i, across the common line, to plane j.
        const Vector3d across = line.cross(planes[i].normal).normalized();
        const double step = (planes[j].offset - planes[j].normal.dot(on_plane)) / planes[j].normal.dot(across);
        const Vector3d on_line = on_plane + step * across;
        corners.push_back(on_line);
        for (std::size_t k = j + 1; k < planes.size(); ++k) {
          const double slope = planes[k].normal.dot(line);
          if (std::abs(slope) < 1e-6) continue;
          corners.push_back(on_line + (planes[k].offset - planes[k].normal.dot(on_line)) / slope * line);
        }
      }
    }
    return corners;
  }

  std::optional<Collapse> best_target(int a, int b, const std::vector<int>& faces) const {
    const std::vector<Plane> planes = planes_of(faces);
    if (planes.size() > kMaxPlanes) return std::nullopt;
    Vector3d gradient = Vector3d::Zero();
    double constant = 0;
    for (const int t : faces) {
      const Vector3d n = area_normal(triangles_[t]) / 6;
      gradient += n;
      constant += n.dot(points_[triangles_[t][0]]);
    }
    const Vector3d middle = 0.5 * (points_[a] + points_[b]);
    const double near = reach_ + (points_[a] - points_[b]).norm();
    std::vector<std::pair<double, Vector3d>> allowed;
    for (const Vector3d& p : corners_of(planes, a, b)) {
      if (!((p - middle).squaredNorm() <= near * near)) continue;
      const bool in_front = std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
        return plane.normal.dot(p) >= plane.offset - slack_;
      });
      if (in_front) allowed.emplace_back(std::max(0.0, gradient.dot(p) - constant), p);
    }
    std::stable_sort(allowed.begin(), allowed.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    for (std::size_t i = 0; i < allowed.size() && i < kTries; ++i) {
      const Vector3d& target = allowed[i].second;
      if (!shapely(target, a, b, faces) || !near_enough(target, a, b, faces)) continue;
      return Collapse{allowed[i].first, a, b, version_[a] + version_[b], target};
    }
    return std::nullopt;
  }

  /// The triangles that stay neither fold over nor become slivers.
  bool shapely(const Vector3d& target, int a, int b, const std::vector<int>& faces) const {
    for (const int t : faces) {
      if (has(t, a) && has(t, b)) continue;
      const Vector3d before = area_normal(triangles_[t]);
      Vector3d corner[3];
      for (int k = 0; k < 3; ++k)
        corner[k] = triangles_[t][k] == a || triangles_[t][k] == b ? target : points_[triangles_[t][k]];
      const Vector3d after = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
      const double longest = std::max({(corner[1] - corner[0]).squaredNorm(), (corner[2] - corner[1]).squaredNorm(),
                                       (corner[0] - corner[2]).squaredNorm()});
      if (!(after.norm() > kLeastHeight * longest)) return false;
      if (before.norm() > 0 && after.dot(before) < kLeastTurn * after.norm() * before.norm()) return false;
    }
    return true;
  }

  /// Some points of the new triangles, so that the proof that follows seldom fails: over a concavity not the corners
  /// stand off but what spans between them.
  bool near_enough(const Vector3d& target, int a, int b, const std::vector<int>& faces) const {
    if (tree_.distance(target) > reach_) return false;
    for (const int t : faces) {
      if (has(t, a) && has(t, b)) continue;
      Vector3d centre = target / 3;
      for (const int corner : triangles_[t]) {
        if (corner == a || corner == b) continue;
        centre += points_[corner] / 3;
        for (const double share : {0.5, 0.25, 0.75})
          if (tree_.distance(target + share * (points_[corner] - target)) > reach_) return false;
      }
      if (tree_.distance(centre) > reach_) return false;
    }
    return true;
  }

  void apply(const Collapse& collapse) {
    const int kept = collapse.from, removed = collapse.to;
    std::vector<int> staying;
    for (const int t : star(kept, removed)) {
      if (!has(t, kept) || !has(t, removed)) {
        for (int& corner : triangles_[t])
          if (corner == removed) corner = kept;
        staying.push_back(t);
        continue;
      }
      alive_[t] = false;
      for (const int corner : triangles_[t])
        around_[corner].erase(std::remove(around_[corner].begin(), around_[corner].end(), t), around_[corner].end());
    }
    points_[kept] = collapse.target;
    around_[kept] = staying;
    around_[removed].clear();
    ++version_[kept];
    const Ring ring = neighbours(kept);
    for (const int vertex : ring.sorted) ++version_[vertex];
    for (const int vertex : ring.sorted) offer(std::min(kept, vertex), std::max(kept, vertex));
  }

  std::shared_ptr<const TriangleMesh> result() const {
    std::vector<std::array<int, 3>> left;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (alive_[t]) left.push_back(triangles_[t]);
    if (left.size() >= mesh_.triangles.size()) return nullptr;
    const std::shared_ptr<const TriangleMesh> made = make_mesh(points_, left, mesh_.source);
    return made->closed ? made : nullptr;
  }

  const TriangleMesh& mesh_;
  TriangleTree tree_;
  double reach_, slack_ = 0;
  std::vector<Vector3d> points_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::vector<int>> around_;  // triangles of each vertex
  std::vector<int> version_;              // of each vertex, raised when a triangle around it changes
  std::vector<bool> alive_;
  std::priority_queue<Collapse> queue_;
  InterruptionPoll poll_{64};
};

}  // namespace

std::shared_ptr<const TriangleMesh> decimate_outwards(const TriangleMesh& mesh, double reach) {
  return OutwardCollapse(mesh, reach).run();
}

}  // namespace mmgrasp::detail
