#include "geometry/segmentation/face_graph.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <unordered_map>

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
using Face = std::array<int, 3>;

struct HalfEdge {
  int low, high, face;
  bool operator<(const HalfEdge& other) const {
    if (low != other.low) return low < other.low;
    if (high != other.high) return high < other.high;
    return face < other.face;
  }
};

std::uint64_t edge_key(int a, int b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint32_t>(std::max(a, b));
}

/// One pass: every edge longer than `longest` gets a vertex in its middle, and its faces are cut there.
bool cut_edges(FaceGraph& graph, double longest) {
  std::unordered_map<std::uint64_t, int> middles;
  const auto middle = [&](int a, int b) {
    if ((graph.vertices[a] - graph.vertices[b]).norm() <= longest) return -1;
    const auto [at, is_new] = middles.emplace(edge_key(a, b), static_cast<int>(graph.vertices.size()));
    if (is_new) graph.vertices.push_back(0.5 * (graph.vertices[a] + graph.vertices[b]));
    return at->second;
  };
  std::vector<Face> faces;
  std::vector<int> parents;
  for (std::size_t f = 0; f < graph.faces.size(); ++f) {
    Face v = graph.faces[f];
    std::array<int, 3> m{middle(v[0], v[1]), middle(v[1], v[2]), middle(v[2], v[0])};
    const int cuts = (m[0] >= 0) + (m[1] >= 0) + (m[2] >= 0);
    const auto keep = [&](int a, int b, int c) {
      faces.push_back({a, b, c});
      parents.push_back(graph.parents[f]);
    };
    if (cuts == 0) {
      keep(v[0], v[1], v[2]);
    } else if (cuts == 3) {
      keep(v[0], m[0], m[2]);
      keep(m[0], v[1], m[1]);
      keep(m[2], m[1], v[2]);
      keep(m[0], m[1], m[2]);
    } else {
      // Turned so that the edge from v[0] to v[1] is cut and, of two cuts, the edge from v[2] to v[0] is not.
      while (m[0] < 0 || m[2] >= 0) {
        std::rotate(v.begin(), v.begin() + 1, v.end());
        std::rotate(m.begin(), m.begin() + 1, m.end());
      }
      keep(v[0], m[0], v[2]);
      if (cuts == 1) {
        keep(m[0], v[1], v[2]);
      } else {
        keep(m[0], v[1], m[1]);
        keep(m[0], m[1], v[2]);
      }
    }
  }
  graph.faces.swap(faces);
  graph.parents.swap(parents);
  return !middles.empty();
}

/// The length down to which edges, longest first, may be cut in one pass so that no more than `most` faces come of it:
/// each cut makes one face of each face beside it more. At least `longest`.
double affordable_length(const FaceGraph& graph, double longest, std::size_t most) {
  std::vector<double> sides;
  for (const Face& v : graph.faces) {
    for (int k = 0; k < 3; ++k) {
      const double length = (graph.vertices[v[k]] - graph.vertices[v[(k + 1) % 3]]).norm();
      if (length > longest) sides.push_back(length);
    }
  }
  const std::size_t room = most > graph.faces.size() ? most - graph.faces.size() : 0;
  if (sides.size() <= room) return longest;
  const auto last = sides.begin() + static_cast<std::ptrdiff_t>(room);
  std::nth_element(sides.begin(), last, sides.end(), std::greater<>());
  return *last;
}

}  // namespace

void FaceGraph::measure(const std::vector<Vector3d>& known) {
  const std::size_t n = faces.size();
  centres.resize(n);
  normals.resize(n);
  areas.resize(n);
  borders.clear();
  area = 0;
  std::vector<HalfEdge> edges;
  edges.reserve(3 * n);
  for (std::size_t f = 0; f < n; ++f) {
    const Face& v = faces[f];
    centres[f] = (vertices[v[0]] + vertices[v[1]] + vertices[v[2]]) / 3;
    const Vector3d cross = (vertices[v[1]] - vertices[v[0]]).cross(vertices[v[2]] - vertices[v[0]]);
    const double twice = cross.norm();
    normals[f] = twice > 0 ? Vector3d(cross / twice) : Vector3d::Zero();
    if (!known.empty() && !known[parents[f]].isZero()) normals[f] = known[parents[f]];
    areas[f] = twice / 2;
    area += areas[f];
    for (int k = 0; k < 3; ++k) {
      const int a = v[k], b = v[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<int>(f)});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const HalfEdge &a = edges[i], &b = edges[i + 1];
    if (a.low != b.low || a.high != b.high) continue;
    const double cosine = std::clamp(normals[a.face].dot(normals[b.face]), -1.0, 1.0);
    const double sine = normals[a.face].cross(normals[b.face]).norm();
    const double angle = std::atan2(sine, cosine);
    // The neighbour's far corner lies below the face's plane where the solid is convex.
    const Vector3d middle = 0.5 * (vertices[a.low] + vertices[a.high]);
    const Vector3d beyond = centres[b.face] - middle, behind = centres[a.face] - middle;
    const bool crease = normals[a.face].dot(beyond) + normals[b.face].dot(behind) > 0;
    borders.push_back(
        {a.face, b.face, (vertices[a.low] - vertices[a.high]).norm(), crease ? -angle : angle, {a.low, a.high}});
    ++i;  // both are taken
  }
  first_border.assign(n + 1, 0);
  for (const FaceBorder& b : borders) {
    ++first_border[b.first + 1];
    ++first_border[b.second + 1];
  }
  for (std::size_t f = 0; f < n; ++f) first_border[f + 1] += first_border[f];
  border_of.resize(2 * borders.size());
  std::vector<int> next(first_border.begin(), first_border.end() - 1);
  for (std::size_t k = 0; k < borders.size(); ++k) {
    border_of[next[borders[k].first]++] = static_cast<int>(k);
    border_of[next[borders[k].second]++] = static_cast<int>(k);
  }
}

TriangleMesh FaceGraph::mesh() const {
  TriangleMesh out;
  out.vertices = vertices;
  out.triangles = faces;
  return out;
}

FaceGraph refined_faces(const TriangleMesh& mesh, double longest, std::size_t most,
                        const std::vector<Vector3d>& known_normals) {
  FaceGraph graph;
  graph.vertices = mesh.vertices;
  graph.faces = mesh.triangles;
  graph.parents.resize(mesh.triangles.size());
  for (std::size_t f = 0; f < graph.parents.size(); ++f) graph.parents[f] = static_cast<int>(f);
  // Halving comes down from any length; longer edges first, so that faces become even before they become many.
  double reach = 0;
  for (const Face& v : graph.faces) {
    for (int k = 0; k < 3; ++k) {
      reach = std::max(reach, (graph.vertices[v[k]] - graph.vertices[v[(k + 1) % 3]]).norm());
    }
  }
  while (reach > longest) {
    reach = std::max(longest, reach / 2);
    while (true) {
      const double cut = std::max(reach, affordable_length(graph, reach, most));
      if (!cut_edges(graph, cut)) break;
    }
  }
  graph.measure(known_normals);
  return graph;
}

}  // namespace mmgrasp::detail
