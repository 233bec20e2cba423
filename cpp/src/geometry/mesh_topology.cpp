#include "mmgrasp/geometry/detail/mesh_topology.hpp"
#include "mmgrasp/core/detail/interruption.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/nested_shells.hpp"

namespace mmgrasp::detail {

namespace {

constexpr double kEncloses = 1e-6;  // Less of the volumes of a sheet's tetrahedra is rounding.

struct HalfEdge {
  int low, high;       // the edge's vertices, low < high
  int triangle, side;  // side k goes from corner k to corner k + 1
  bool forward;        // runs from low to high
};

/// Sorts by low, high and triangle: counted into place by low, then each vertex's few are sorted.
std::vector<HalfEdge> sorted_half_edges(const std::vector<std::array<int, 3>>& triangles) {
  int vertices = 0;
  for (const auto& t : triangles) vertices = std::max({vertices, t[0] + 1, t[1] + 1, t[2] + 1});
  std::vector<std::size_t> place(static_cast<std::size_t>(vertices) + 1, 0);  // where the edges of a vertex begin
  for (const auto& t : triangles)
    for (int k = 0; k < 3; ++k) ++place[std::min(t[k], t[(k + 1) % 3]) + 1];
  std::partial_sum(place.begin(), place.end(), place.begin());
  std::vector<std::size_t> next = place;
  std::vector<HalfEdge> edges(3 * triangles.size());
  InterruptionPoll poll;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    poll();
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[t][k], b = triangles[t][(k + 1) % 3], low = std::min(a, b);
      edges[next[low]++] = {low, std::max(a, b), static_cast<int>(t), k, a < b};
    }
  }
  for (int v = 0; v < vertices; ++v) {
    poll();
    std::sort(edges.begin() + place[v], edges.begin() + place[v + 1], [](const HalfEdge& a, const HalfEdge& b) {
      return std::tie(a.high, a.triangle) < std::tie(b.high, b.triangle);
    });
  }
  return edges;
}

struct Neighbour {
  int triangle = -1;
  bool same_orientation = true;
};
using Neighbours = std::vector<std::array<Neighbour, 3>>;

// Joins the half-edges of one edge in pairs. Two may run alike (one triangle is turned over); more than two, where
// solids touch along an edge, must balance: each pairs with one that runs against it.
bool pair_up(const HalfEdge* begin, const HalfEdge* end, Neighbours& neighbours) {
  std::vector<const HalfEdge*> forward, backward;
  for (const HalfEdge* e = begin; e != end; ++e) (e->forward ? forward : backward).push_back(e);
  const auto join = [&](const HalfEdge& a, const HalfEdge& b) {
    const bool same = a.forward != b.forward;
    neighbours[a.triangle][a.side] = {b.triangle, same};
    neighbours[b.triangle][b.side] = {a.triangle, same};
  };
  if (end - begin == 2) {
    join(begin[0], begin[1]);
    return begin[0].triangle != begin[1].triangle;
  }
  if (forward.size() != backward.size()) return false;
  for (std::size_t i = 0; i < forward.size(); ++i) join(*forward[i], *backward[i]);
  return true;
}

bool find_neighbours(const std::vector<std::array<int, 3>>& triangles, Neighbours& neighbours) {
  const std::vector<HalfEdge> edges = sorted_half_edges(triangles);
  neighbours.assign(triangles.size(), {});
  InterruptionPoll poll;
  for (std::size_t i = 0; i < edges.size();) {
    poll();
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    if (!pair_up(&edges[i], &edges[0] + end, neighbours)) return false;
    i = end;
  }
  return true;
}

// Flips triangles so that all of one shell agree with its first; false on a one-sided surface (a Klein bottle).
bool make_consistent(std::vector<std::array<int, 3>>& triangles, const Neighbours& neighbours, Shells& shells) {
  std::vector<signed char> flip(triangles.size(), -1);
  shells.shell_of_triangle.assign(triangles.size(), -1);
  std::vector<int> stack;
  InterruptionPoll poll;
  for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
    if (flip[seed] >= 0) continue;
    flip[seed] = 0;
    stack.push_back(static_cast<int>(seed));
    while (!stack.empty()) {
      poll();
      const int t = stack.back();
      stack.pop_back();
      shells.shell_of_triangle[t] = shells.count;
      for (const Neighbour& n : neighbours[t]) {
        if (n.triangle < 0) continue;  // a border
        const signed char wanted = n.same_orientation ? flip[t] : 1 - flip[t];
        if (flip[n.triangle] < 0) {
          flip[n.triangle] = wanted;
          stack.push_back(n.triangle);
        } else if (flip[n.triangle] != wanted) {
          return false;
        }
      }
    }
    ++shells.count;
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (flip[t] == 1) std::swap(triangles[t][1], triangles[t][2]);
  }
  return true;
}

double six_volumes(const std::vector<Eigen::Vector3d>& v, const std::array<int, 3>& t, const Eigen::Vector3d& origin) {
  return (v[t[0]] - origin).dot((v[t[1]] - origin).cross(v[t[2]] - origin));
}

// Neighbours over edges of two triangles; a border elsewhere.
Neighbours neighbours_over_plain_edges(const std::vector<std::array<int, 3>>& triangles) {
  const std::vector<HalfEdge> edges = sorted_half_edges(triangles);
  Neighbours out(triangles.size());
  InterruptionPoll poll;
  for (std::size_t i = 0; i < edges.size();) {
    poll();
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    if (end - i == 2) pair_up(&edges[i], &edges[0] + end, out);
    i = end;
  }
  return out;
}

/// Turns shells, and leaves out bodies in the material of others, so that the mesh bounds its solid.
EnclosedBodies settle_shells(const std::vector<Eigen::Vector3d>& vertices, std::vector<std::array<int, 3>>& triangles,
                             const Shells& shells) {
  const std::vector<ShellFate> fates = shell_fates(vertices, triangles, shells);
  EnclosedBodies out;
  out.count = static_cast<int>(std::count(fates.begin(), fates.end(), ShellFate::leave_out));
  std::vector<std::array<int, 3>> kept;
  kept.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const ShellFate fate = fates[shells.shell_of_triangle[t]];
    if (fate == ShellFate::leave_out) continue;
    kept.push_back(triangles[t]);
    if (fate == ShellFate::turn) std::swap(kept.back()[1], kept.back()[2]);
  }
  out.triangles = static_cast<int>(triangles.size() - kept.size());
  triangles = std::move(kept);
  return out;
}

// Every neighbour bends backwards: measured as height over the larger triangle, which slivers do not spoil.
bool locally_convex(const TriangleMesh& mesh, double tolerance) {
  Neighbours neighbours;
  if (!find_neighbours(mesh.triangles, neighbours)) return false;
  const auto& v = mesh.vertices;
  const auto normal = [&](int t) -> Eigen::Vector3d {
    const auto& tri = mesh.triangles[t];
    return (v[tri[1]] - v[tri[0]]).cross(v[tri[2]] - v[tri[0]]);
  };
  InterruptionPoll poll;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    poll();
    const Eigen::Vector3d n = normal(static_cast<int>(t));
    for (int k = 0; k < 3; ++k) {
      const int other = neighbours[t][k].triangle;
      if (n.norm() < normal(other).norm()) continue;
      for (const int corner : mesh.triangles[other]) {
        if (n.dot(v[corner] - v[mesh.triangles[t][k]]) > tolerance * n.norm()) return false;
      }
    }
  }
  return true;
}

}  // namespace

Eigen::Vector3d ray_direction() {
  return {0.21132486540518713, 0.35682208977308993, 1.0};
}

int ray_crossing(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d d = ray_direction();
  const auto shadow = [&](const Eigen::Vector3d& p) -> Eigen::Vector2d {
    return {p.x() - d.x() * p.z(), p.y() - d.y() * p.z()};
  };
  const Eigen::Vector2d sa = shadow(a), sb = shadow(b), sc = shadow(c);
  const double ab = edge_side(sa, sb), bc = edge_side(sb, sc), ca = edge_side(sc, sa);
  // A side of exactly zero needs a decision that the neighbour, who sees the edge reversed, takes the other way round.
  const auto positive = [](double side, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    if (side != 0) return side > 0;
    return from.x() != to.x() ? from.x() < to.x() : from.y() < to.y();
  };
  const bool p = positive(ab, sa, sb);
  if (positive(bc, sb, sc) != p || positive(ca, sc, sa) != p) return 0;
  const double total = ab + bc + ca;
  const double height = total != 0 ? (bc * a.z() + ca * b.z() + ab * c.z()) / total : a.z();
  return height > 0 ? (p ? 1 : -1) : 0;
}

bool orient_closed(const std::vector<Eigen::Vector3d>& vertices, std::vector<std::array<int, 3>>& triangles,
                   EnclosedBodies* enclosed) {
  Neighbours neighbours;
  if (triangles.size() < 4 || !find_neighbours(triangles, neighbours)) return false;
  Shells shells;
  std::vector<std::array<int, 3>> oriented = triangles;
  if (!make_consistent(oriented, neighbours, shells)) return false;
  const EnclosedBodies left_out = settle_shells(vertices, oriented, shells);
  if (enclosed != nullptr) *enclosed = left_out;
  triangles = std::move(oriented);
  return true;
}

bool orient_open(const std::vector<Eigen::Vector3d>& vertices, std::vector<std::array<int, 3>>& triangles) {
  if (triangles.empty()) return true;
  Shells shells;
  std::vector<std::array<int, 3>> oriented = triangles;
  if (!make_consistent(oriented, neighbours_over_plain_edges(triangles), shells)) return false;
  std::vector<Eigen::AlignedBox3d> bounds(shells.count);
  for (std::size_t t = 0; t < oriented.size(); ++t)
    for (const int corner : oriented[t]) bounds[shells.shell_of_triangle[t]].extend(vertices[corner]);
  struct Sense {
    double volume = 0, scale = 0, as_they_were = 0, turned = 0;
  };
  std::vector<Sense> senses(shells.count);
  for (std::size_t t = 0; t < oriented.size(); ++t) {
    const int s = shells.shell_of_triangle[t];
    const double part = six_volumes(vertices, oriented[t], bounds[s].center());
    senses[s].volume += part;
    senses[s].scale += std::abs(part);
    const Eigen::Vector3d& a = vertices[oriented[t][0]];
    const double area = (vertices[oriented[t][1]] - a).cross(vertices[oriented[t][2]] - a).norm();
    (oriented[t] == triangles[t] ? senses[s].as_they_were : senses[s].turned) += area;
  }
  for (std::size_t t = 0; t < oriented.size(); ++t) {
    const Sense& sense = senses[shells.shell_of_triangle[t]];
    const bool at_one = sense.turned == 0 || sense.as_they_were == 0;
    const bool encloses = std::abs(sense.volume) > kEncloses * sense.scale;
    const bool wrong = at_one ? sense.turned > 0 : encloses ? sense.volume < 0 : sense.turned > sense.as_they_were;
    if (wrong) std::swap(oriented[t][1], oriented[t][2]);
  }
  triangles = std::move(oriented);
  return true;
}

Shells find_shells(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<int> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  const std::vector<HalfEdge> edges = sorted_half_edges(triangles);
  InterruptionPoll poll;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    poll();
    if (edges[i].low != edges[i - 1].low || edges[i].high != edges[i - 1].high) continue;
    const int a = find(edges[i - 1].triangle), b = find(edges[i].triangle);
    parent[std::max(a, b)] = std::min(a, b);
  }
  Shells shells;
  shells.shell_of_triangle.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const int root = find(static_cast<int>(t));
    shells.shell_of_triangle[t] = root == static_cast<int>(t) ? shells.count++ : shells.shell_of_triangle[root];
  }
  return shells;
}

bool is_convex(const TriangleMesh& mesh) {
  if (!mesh.closed || find_shells(mesh.triangles).count != 1) return false;
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& v : mesh.vertices) bounds.extend(v);
  const double tolerance = 2e-7 * bounds.diagonal().norm();
  // Closed, of a sphere's topology (F = 2 V - 4) and bending backwards at every edge: convex but for surfaces that wind
  // around themselves, which the look from some faces over all vertices finds.
  if (mesh.triangles.size() != 2 * mesh.vertices.size() - 4) return false;
  if (!locally_convex(mesh, tolerance)) return false;
  const std::size_t stride = 1 + mesh.triangles.size() * mesh.vertices.size() / 2'000'000;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
    throw_if_interrupted();
    const auto& t = mesh.triangles[i];
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    const Eigen::Vector3d n = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    // The plane of a small face is uncertain far away, in proportion to distance over the face's own height.
    const double longest = std::max((mesh.vertices[t[1]] - a).norm(), (mesh.vertices[t[2]] - a).norm());
    const double allowed = tolerance * (100 * n.norm() + 10 * bounds.diagonal().norm() * longest);
    for (const Eigen::Vector3d& v : mesh.vertices) {
      if (n.dot(v - a) > allowed) return false;
    }
  }
  return true;
}

}  // namespace mmgrasp::detail
