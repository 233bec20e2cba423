#include "mmgrasp/geometry/detail/separate_bodies.hpp"

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <numeric>
#include <vector>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/geometry/detail/mesh_topology.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr double kTouching = 1e-5;  // Shells that are apart by less touch: a share of the mesh's diagonal.

/// A piece of the surface whose triangles hang together over corners.
struct BodyShell {
  TriangleMesh mesh;
  Eigen::AlignedBox3d bounds;
  std::unique_ptr<RayCaster> caster = nullptr;
  const RayCaster& rays() {
    if (!caster) caster = std::make_unique<RayCaster>(mesh);
    return *caster;
  }
};

class Bodies {
 public:
  explicit Bodies(const TriangleMesh& mesh) : closed_(mesh.closed) {
    std::vector<int> of_vertex(mesh.vertices.size());
    std::iota(of_vertex.begin(), of_vertex.end(), 0);
    for (const auto& t : mesh.triangles)
      for (const int v : t) unite(of_vertex, t[0], v);
    std::map<int, std::size_t> number;
    InterruptionPoll poll;
    for (const auto& t : mesh.triangles) {
      poll();
      const auto [at, is_new] = number.emplace(root(of_vertex, t[0]), shells_.size());
      if (is_new) shells_.emplace_back();
      BodyShell& shell = shells_[at->second];
      const int first = static_cast<int>(shell.mesh.vertices.size());
      for (const int v : t) {
        shell.mesh.vertices.push_back(mesh.vertices[v]);
        shell.bounds.extend(mesh.vertices[v]);
      }
      shell.mesh.triangles.push_back({first, first + 1, first + 2});
    }
    Eigen::AlignedBox3d all;
    for (BodyShell& shell : shells_) {
      shell.mesh.closed = closed_;
      all.extend(shell.bounds);
    }
    touching_ = all.isEmpty() ? 0 : kTouching * all.diagonal().norm();
    body_of_.resize(shells_.size());
    std::iota(body_of_.begin(), body_of_.end(), 0);
  }

  int count() {
    for (std::size_t a = 0; a < shells_.size(); ++a) {
      for (std::size_t b = a + 1; b < shells_.size(); ++b) {
        throw_if_interrupted();
        const int i = static_cast<int>(a), k = static_cast<int>(b);
        if (root(body_of_, i) != root(body_of_, k) && meet(shells_[a], shells_[b])) unite(body_of_, i, k);
      }
      if (closed_) join_what_it_lies_in(static_cast<int>(a));
    }
    int out = 0;
    for (int i = 0; i < static_cast<int>(shells_.size()); ++i) out += root(body_of_, i) == i;
    return out;
  }

 private:
  static int root(std::vector<int>& parent, int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  static void unite(std::vector<int>& parent, int i, int k) { parent[root(parent, i)] = root(parent, k); }

  /// Whether the surfaces touch or cross: an edge of either meets the other one.
  bool meet(BodyShell& a, BodyShell& b) {
    const Vector3d margin = Vector3d::Constant(touching_);
    if (!Eigen::AlignedBox3d(a.bounds.min() - margin, a.bounds.max() + margin).intersects(b.bounds)) return false;
    return !closed_ || edges_meet(a, b) || edges_meet(b, a);
  }

  bool edges_meet(const BodyShell& a, BodyShell& b) {
    InterruptionPoll poll;
    for (const auto& t : a.mesh.triangles) {
      poll();
      for (int i = 0; i < 3; ++i) {
        const Vector3d &from = a.mesh.vertices[t[i]], &to = a.mesh.vertices[t[(i + 1) % 3]];
        const double length = (to - from).norm();
        if (!(length > 0)) continue;
        const Vector3d along = (to - from) / length;
        if (b.rays().any_hit({from - touching_ * along, along, 0, length + 2 * touching_})) return true;
      }
    }
    return false;
  }

  /// Unites a shell with the smallest one around it: a cavity, and a solid that stands in another one's material.
  void join_what_it_lies_in(int number) {
    BodyShell& shell = shells_[number];
    const Vector3d& point = shell.mesh.vertices[0];
    int around = -1, winding = 0;
    for (int i = 0; i < static_cast<int>(shells_.size()); ++i) {
      if (i == number || !shells_[i].bounds.contains(point)) continue;
      throw_if_interrupted();
      int of_it = 0;
      const TriangleMesh& m = shells_[i].mesh;
      for (const auto& t : m.triangles)
        of_it += ray_crossing(m.vertices[t[0]] - point, m.vertices[t[1]] - point, m.vertices[t[2]] - point);
      winding += of_it;
      if (of_it > 0 && (around < 0 || shells_[i].bounds.volume() < shells_[around].bounds.volume())) around = i;
    }
    const bool cavity = mesh_volume(shell.mesh) < 0;
    if (around >= 0 && (cavity || winding > 0)) unite(body_of_, number, around);
  }

  bool closed_;
  double touching_ = 0;  // [m]
  std::vector<BodyShell> shells_;
  std::vector<int> body_of_;
};

}  // namespace

int count_bodies(const TriangleMesh& mesh) {
  return Bodies(mesh).count();
}

}  // namespace mmgrasp::detail
