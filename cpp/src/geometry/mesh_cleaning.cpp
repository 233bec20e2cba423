#include "geometry/mesh_cleaning.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <utility>

#include "geometry/faces_inwards.hpp"
#include "geometry/open_seams.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/geometry/detail/mesh_topology.hpp"

namespace mmgrasp::detail {

namespace {

constexpr double kNoVolume = 1e-15;  // As a share of the cube of the diagonal: rounding.

using Triangles = std::vector<std::array<int, 3>>;

struct VectorHash {
  std::size_t operator()(const Eigen::Vector3d& v) const {
    std::uint64_t hash = 0x9e3779b97f4a7c15ull;
    for (int k = 0; k < 3; ++k) {
      std::uint64_t bits;
      std::memcpy(&bits, &v[k], sizeof bits);
      hash = (hash ^ bits) * 0xff51afd7ed558ccdull;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

// Lets equal vertices share an index; returns how many were removed.
int merge_vertices(std::vector<Eigen::Vector3d>& vertices, Triangles& triangles) {
  std::unordered_map<Eigen::Vector3d, int, VectorHash> index_of;
  std::vector<Eigen::Vector3d> kept;
  std::vector<int> new_index(vertices.size());
  InterruptionPoll poll;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    poll();
    const Eigen::Vector3d v = vertices[i].array() + 0.0;  // -0 becomes 0, which hashes alike
    const auto [it, is_new] = index_of.emplace(v, static_cast<int>(kept.size()));
    if (is_new) kept.push_back(v);
    new_index[i] = it->second;
  }
  const int removed = static_cast<int>(vertices.size() - kept.size());
  for (auto& triangle : triangles) {
    for (int& corner : triangle) corner = new_index[corner];
  }
  vertices = std::move(kept);
  return removed;
}

void drop_unused_vertices(std::vector<Eigen::Vector3d>& vertices, Triangles& triangles) {
  std::vector<int> new_index(vertices.size(), -1);
  std::vector<Eigen::Vector3d> kept;
  for (auto& triangle : triangles) {
    for (int& corner : triangle) {
      if (new_index[corner] < 0) {
        new_index[corner] = static_cast<int>(kept.size());
        kept.push_back(vertices[corner]);
      }
      corner = new_index[corner];
    }
  }
  vertices = std::move(kept);
}

bool has_equal_corners(const std::array<int, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

bool has_no_area(const std::vector<Eigen::Vector3d>& v, const std::array<int, 3>& t) {
  const Eigen::Vector3d a = v[t[1]] - v[t[0]], b = v[t[2]] - v[t[0]], c = v[t[2]] - v[t[1]];
  const double longest = std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()});
  return a.cross(b).norm() <= 1e-14 * longest;
}

/// The triangles without those that have the corners of an earlier one, turned either way.
Triangles without_repeats(const Triangles& triangles) {
  std::vector<std::pair<std::array<int, 3>, std::size_t>> corners;
  corners.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    std::array<int, 3> sorted = triangles[i];
    std::sort(sorted.begin(), sorted.end());
    corners.emplace_back(sorted, i);
  }
  InterruptionPoll poll;
  std::sort(corners.begin(), corners.end(), [&](const auto& a, const auto& b) {
    poll();
    return a < b;
  });
  std::vector<char> repeated(triangles.size(), 0);
  for (std::size_t i = 1; i < corners.size(); ++i)
    repeated[corners[i].second] = corners[i].first == corners[i - 1].first;
  Triangles kept;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (!repeated[i]) kept.push_back(triangles[i]);
  return kept;
}

/// Whether the triangles bound a solid; then they are oriented. Two coincident sheets are closed edge by edge but bound
/// nothing.
bool close(const std::vector<Eigen::Vector3d>& vertices, Triangles& triangles, EnclosedBodies& enclosed) {
  Triangles oriented = triangles;
  EnclosedBodies left_out;
  if (!orient_closed(vertices, oriented, &left_out)) return false;
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& v : vertices) bounds.extend(v);
  double six = 0;  // volumes
  for (const auto& t : oriented) {
    const Eigen::Vector3d &a = vertices[t[0]], &o = vertices[0];
    six += (a - o).dot((vertices[t[1]] - o).cross(vertices[t[2]] - o));
  }
  if (!(six > 6 * kNoVolume * std::pow(bounds.diagonal().norm(), 3))) return false;
  triangles = std::move(oriented);
  enclosed = left_out;
  return true;
}

/// Whether the triangles bound a solid once each is there only once; then they are what is left.
bool close_without_repeats(const std::vector<Eigen::Vector3d>& vertices, Triangles& triangles,
                           EnclosedBodies& enclosed) {
  Triangles once = without_repeats(triangles);
  if (once.size() == triangles.size() || !close(vertices, once, enclosed)) return false;
  triangles = std::move(once);
  return true;
}

/// A triangle that begins with its least corner, turned as it is.
std::array<int, 3> from_least(std::array<int, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

Triangles sorted_from_least(const Triangles& triangles) {
  Triangles out;
  out.reserve(triangles.size());
  for (const auto& t : triangles) out.push_back(from_least(t));
  InterruptionPoll poll;
  std::sort(out.begin(), out.end(), [&](const auto& a, const auto& b) {
    poll();
    return a < b;
  });
  return out;
}

/// Drops triangles that have the corners of an earlier one and are turned as it is.
void drop_copies(Triangles& triangles) {
  const Triangles sorted = sorted_from_least(triangles);
  Triangles copied;
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] == sorted[i - 1]) copied.push_back(sorted[i]);
  if (copied.empty()) return;
  std::vector<char> met(copied.size(), 0);
  Triangles kept;
  for (const auto& t : triangles) {
    const auto at = std::lower_bound(copied.begin(), copied.end(), from_least(t));
    if (at != copied.end() && *at == from_least(t) && std::exchange(met[at - copied.begin()], 1) != 0) continue;
    kept.push_back(t);
  }
  triangles = std::move(kept);
}

/// How many triangles a file has the other way round only.
int count_turned(const Triangles& file, const Triangles& triangles) {
  if (triangles == file) return 0;
  const Triangles sorted = sorted_from_least(file);
  return static_cast<int>(std::count_if(triangles.begin(), triangles.end(), [&](const auto& t) {
    return !std::binary_search(sorted.begin(), sorted.end(), from_least(t));
  }));
}

/// Makes the best of triangles that are no solid as they are: copies go, and faces that look another way than their
/// neighbours are turned, which may make them one after all.
bool mend_open(const std::vector<Eigen::Vector3d>& vertices, Triangles& triangles, EnclosedBodies& enclosed) {
  drop_copies(triangles);
  return orient_open(vertices, triangles) && close(vertices, triangles, enclosed);
}

/// The triangles with each corner's vertex replaced, without those that fall together.
Triangles with_vertices(Triangles triangles, const std::vector<int>& same) {
  for (auto& triangle : triangles)
    for (int& corner : triangle) corner = same[corner];
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), has_equal_corners), triangles.end());
  return triangles;
}

/// Whether some shell of a closed mesh is more than a sheet that was stored from both sides.
bool has_a_solid(const std::vector<Eigen::Vector3d>& vertices, const Triangles& triangles) {
  const std::vector<bool> thin = thin_shells(vertices, triangles);
  return std::count(thin.begin(), thin.end(), false) > 0;
}

/// Whether the triangles bound a solid once vertices on either side of their seams are the same; then they are joined
/// there, and `joined` says for each vertex which one stands for it. Sheets stored from both sides bound none.
bool close_seams(const std::vector<Eigen::Vector3d>& vertices, Triangles& triangles, EnclosedBodies& enclosed,
                 std::vector<int>& joined) {
  const std::vector<int> same = joined_at_seams(vertices, triangles);
  if (same.empty()) return false;
  Triangles closed = with_vertices(triangles, same);
  EnclosedBodies found = enclosed;
  if (!close_without_repeats(vertices, closed, found) && !close(vertices, closed, found)) return false;
  const std::vector<bool> thin = thin_shells(vertices, closed);
  if (std::count(thin.begin(), thin.end(), true) > 0) return false;
  triangles = std::move(closed);
  enclosed = found;
  joined = same;
  return true;
}

}  // namespace

std::shared_ptr<const TriangleMesh> clean_mesh(RawMesh raw, const std::string& source, MeshReport* report,
                                               MeshFaults* faults) {
  MeshReport found;
  found.path = source;
  found.vertices_read = static_cast<int>(raw.vertices.size());
  const std::size_t triangles_read = raw.triangles.size();

  auto mesh = std::make_shared<TriangleMesh>();
  mesh->source = source;
  mesh->vertices = std::move(raw.vertices);
  mesh->triangles = std::move(raw.triangles);
  found.vertices_merged = merge_vertices(mesh->vertices, mesh->triangles);
  Triangles& triangles = mesh->triangles;
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), has_equal_corners), triangles.end());
  // Slivers without area may be what closes the mesh over a T-shaped seam, so they go only after the question is
  // answered.
  // A file may hold each face twice, from either side. Faces that two solids share are no repeats: both stay where one
  // of them would leave the solids open.
  Triangles file = faults == nullptr ? Triangles{} : triangles;
  EnclosedBodies enclosed;
  std::vector<int> joined;
  mesh->closed = close_without_repeats(mesh->vertices, triangles, enclosed) ||
                 close(mesh->vertices, triangles, enclosed) || mend_open(mesh->vertices, triangles, enclosed) ||
                 close_seams(mesh->vertices, triangles, enclosed, joined);
  for (std::size_t i = 0; i < joined.size(); ++i) found.vertices_merged += joined[i] != static_cast<int>(i);
  if (!joined.empty()) file = with_vertices(std::move(file), joined);
  if (faults != nullptr)
    faults->repeated_triangles = static_cast<int>(file.size() - triangles.size()) - enclosed.triangles;
  triangles.erase(
      std::remove_if(triangles.begin(), triangles.end(), [&](const auto& t) { return has_no_area(mesh->vertices, t); }),
      triangles.end());
  if (!mesh->closed) mesh->closed = close(mesh->vertices, triangles, enclosed);
  if (mesh->closed) mesh->closed = has_a_solid(mesh->vertices, triangles);
  if (faults != nullptr) {
    faults->enclosed_bodies = enclosed.count;
    faults->turned_triangles = count_turned(file, triangles);
    faults->inside_out = mesh->closed ? faults->turned_triangles == static_cast<int>(triangles.size())
                                      : faces_inwards(mesh->vertices, triangles);
  }
  drop_unused_vertices(mesh->vertices, triangles);
  if (mesh->closed && !triangles.empty()) mesh->convex = is_convex(*mesh);

  found.degenerate_triangles = static_cast<int>(triangles_read - triangles.size());
  found.triangles = static_cast<int>(triangles.size());
  found.closed = mesh->closed;
  found.convex = mesh->convex;
  if (report != nullptr) *report = found;
  return mesh;
}

}  // namespace mmgrasp::detail
