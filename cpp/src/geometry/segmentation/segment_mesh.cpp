#include "mmgrasp/geometry/segment_mesh.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "geometry/segmentation/diameter_clusters.hpp"
#include "geometry/segmentation/face_graph.hpp"
#include "geometry/segmentation/find_threads.hpp"
#include "geometry/segmentation/grow_regions.hpp"
#include "geometry/segmentation/inner_walls.hpp"
#include "geometry/segmentation/join_regions.hpp"
#include "geometry/segmentation/surface_creases.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/detail/inside_out.hpp"

namespace mmgrasp {
namespace {

using detail::FaceGraph;
using Eigen::Vector3d;
constexpr std::size_t kMostTriangles = 10'000'000;
/// Segments more of whose area than this is thread are said to be threaded.
constexpr double kThreadShare = 0.1;
/// A face is split between regions when the smaller share of its area is more than this.
constexpr double kSplit = 0.1;

double diagonal_of(const std::vector<Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(p);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

/// Edge length at which even faces over the area would be about so many, but no finer than half the least size.
double longest_edge(const TriangleMesh& mesh, double diagonal, const MeshSegmentationOptions& options) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]];
    area += (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm() / 2;
  }
  require(area > 0, "mesh", area, "must have an area");
  return std::max(std::sqrt(4 * area / (std::sqrt(3.0) * options.faces)), 0.5 * options.min_size * diagonal);
}

/// Regions of the cut faces, and which of those are no inner walls.
struct FoundRegions {
  std::vector<int> labels;
  std::vector<char> outer;
};

/// Each step reads what the one before found.
FoundRegions find_regions(const FaceGraph& graph, const std::vector<int>& clusters, const std::vector<char>& on_bolt,
                          double diagonal, const MeshSegmentationOptions& options) {
  const double narrowest = options.min_size * diagonal;
  const int threads = options.diameter.threads;
  const std::vector<double> bends = detail::inward_bends(graph, narrowest, threads);
  detail::InnerWalls walls = detail::find_inner_walls(graph, threads);
  std::vector<char> outer(graph.faces.size()), seed(graph.faces.size()), passable(graph.borders.size());
  for (int f = 0; f < graph.size(); ++f) {
    if (on_bolt[graph.parents[f]]) walls.inner[f] = 0;  // smoothed threads may lie in folds
    outer[f] = !walls.inner[f];
    seed[f] = outer[f] && bends[f] < options.crease;
  }
  for (std::size_t k = 0; k < passable.size(); ++k) {
    const detail::FaceBorder& border = graph.borders[k];
    passable[k] = border.bend > -options.crease && clusters[border.first] == clusters[border.second];
  }
  std::vector<int> labels = detail::connected_regions(graph, seed, passable, narrowest * narrowest);
  detail::grow_regions(graph, outer, labels);
  const int count = detail::join_regions(graph, outer, narrowest, options.convexity, labels);
  detail::label_inner_walls(graph, walls, count, labels);
  detail::dissolve_islands(graph, narrowest * narrowest, labels);
  detail::join_regions(graph, outer, narrowest, options.convexity, labels);
  return {std::move(labels), std::move(outer)};
}

/// The label that most of each face's pieces have, by area; and the mean of the pieces' diameters.
void gather_pieces(const FaceGraph& graph, const std::vector<int>& labels, const std::vector<double>& diameters,
                   std::size_t faces, MeshSegmentation& out) {
  out.labels.assign(faces, 0);
  out.diameters.assign(faces, 0);
  std::vector<std::vector<int>> pieces(faces);
  for (int f = 0; f < graph.size(); ++f) pieces[graph.parents[f]].push_back(f);
  for (std::size_t f = 0; f < faces; ++f) {
    std::vector<std::pair<int, double>> shares;
    double sum = 0, area = 0;
    for (const int piece : pieces[f]) {
      const auto at =
          std::find_if(shares.begin(), shares.end(), [&](const auto& s) { return s.first == labels[piece]; });
      if (at == shares.end()) {
        shares.emplace_back(labels[piece], graph.areas[piece]);
      } else {
        at->second += graph.areas[piece];
      }
      if (diameters[piece] <= 0) continue;
      sum += graph.areas[piece] * diameters[piece];
      area += graph.areas[piece];
    }
    const auto most = std::max_element(shares.begin(), shares.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most != shares.end()) out.labels[f] = most->first;
    if (area > 0) out.diameters[f] = sum / area;
  }
}

/// Whether an outer face reaches over several regions. Walls of bores, which run through several bodies, are no outer
/// ones.
bool is_face_split(const FaceGraph& pieces, const std::vector<char>& outer, const std::vector<int>& labels,
                   std::size_t face_count) {
  std::vector<int> first(face_count, -1);
  std::vector<double> same(face_count, 0.0), other(face_count, 0.0);
  for (int f = 0; f < pieces.size(); ++f) {
    if (!outer[f]) continue;
    int& known = first[pieces.parents[f]];
    if (known < 0) known = labels[f];
    (known == labels[f] ? same : other)[pieces.parents[f]] += pieces.areas[f];
  }
  for (std::size_t f = 0; f < face_count; ++f)
    if (std::min(same[f], other[f]) > kSplit * (same[f] + other[f])) return true;
  return false;
}

/// Joins the regions that whole faces have once more: where faces are much longer than their pieces, one that reaches
/// over several regions is given to one of them, and what is left of the others may be no bodies of their own.
void join_whole_faces(const TriangleMesh& mesh, const std::vector<Vector3d>& known_normals, const FaceGraph& pieces,
                      const std::vector<char>& outer_pieces, double narrowest, double convexity,
                      std::vector<int>& labels) {
  FaceGraph graph;
  graph.vertices = mesh.vertices;
  graph.faces = mesh.triangles;
  graph.parents.resize(graph.faces.size());
  std::iota(graph.parents.begin(), graph.parents.end(), 0);
  graph.measure(known_normals);
  std::vector<char> outer(graph.faces.size(), 0);
  for (int f = 0; f < pieces.size(); ++f) outer[pieces.parents[f]] |= outer_pieces[f];
  detail::join_regions(graph, outer, narrowest, convexity, labels);
}

double median_by_area(std::vector<std::pair<double, double>> values) {
  std::sort(values.begin(), values.end());
  double total = 0, sum = 0;
  for (const auto& [value, weight] : values) total += weight;
  for (const auto& [value, weight] : values) {
    sum += weight;
    if (2 * sum >= total) return value;
  }
  return 0;
}

void list_segments(const TriangleMesh& mesh, double diagonal, MeshSegmentation& out) {
  std::vector<char> threaded(mesh.triangles.size(), 0);
  for (const ScrewThread& thread : out.threads) {
    for (const int f : thread.faces) threaded[f] = 1;
  }
  std::vector<MeshSegment> segments;
  std::vector<std::vector<std::pair<double, double>>> diameters;
  std::vector<double> thread_area;
  std::vector<Vector3d> moment;
  for (std::size_t f = 0; f < out.labels.size(); ++f) {
    const std::size_t s = out.labels[f];
    if (segments.size() <= s) {
      segments.resize(s + 1);
      diameters.resize(s + 1);
      thread_area.resize(s + 1, 0);
      moment.resize(s + 1, Vector3d::Zero());
    }
    const auto& t = mesh.triangles[f];
    const Vector3d a = mesh.vertices[t[0]];
    const double area = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm() / 2;
    segments[s].faces.push_back(static_cast<int>(f));
    segments[s].area += area;
    moment[s] += area * (a + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    if (out.diameters[f] > 0) diameters[s].emplace_back(out.diameters[f], area);
    if (threaded[f]) thread_area[s] += area;
  }
  double largest = 0;
  for (const MeshSegment& s : segments) largest = std::max(largest, s.area);
  // Segments of one size (the feet of a plate) by their place: neither rounding nor the order of a file's faces, which
  // another export changes, may swap them.
  const auto key = [&](int s) {
    const Vector3d middle = moment[s] / std::max(segments[s].area * diagonal, 1e-300);
    return std::array<double, 4>{-std::round(1e6 * segments[s].area / largest), std::round(1e6 * middle.x()),
                                 std::round(1e6 * middle.y()), std::round(1e6 * middle.z())};
  };
  std::vector<int> order;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    segments[s].diameter = median_by_area(std::move(diameters[s]));
    segments[s].threaded = thread_area[s] > kThreadShare * segments[s].area;
    if (!segments[s].faces.empty()) order.push_back(static_cast<int>(s));
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  std::vector<int> number(segments.size(), -1);
  for (std::size_t k = 0; k < order.size(); ++k) {
    number[order[k]] = static_cast<int>(k);
    out.segments.push_back(std::move(segments[order[k]]));
  }
  for (int& label : out.labels) label = number[label];
}

}  // namespace

void MeshSegmentationOptions::check() const {
  diameter.check();
  require(max_clusters >= 1 && max_clusters <= 32, "max_clusters", max_clusters, "must be from 1 to 32");
  require_not_negative(smoothing, "smoothing");
  require(crease > 0 && crease < detail::kPi, "crease", crease, "must be above 0 and below pi rad");
  require(min_size > 0 && min_size < 0.5, "min_size", min_size, "must be above 0 and below 0.5");
  require_not_negative(convexity, "convexity");
  require(faces >= 1 && faces <= 1'000'000, "faces", faces, "must be from 1 to 1000000");
}

MeshSegmentation segment_mesh(const TriangleMesh& mesh, const MeshSegmentationOptions& options,
                              const Monitor& monitor) {
  options.check();
  require(mesh.triangles.size() <= kMostTriangles, "mesh", static_cast<double>(mesh.triangles.size()),
          "must have at most 10 million triangles");
  const double diagonal = diagonal_of(mesh.vertices);
  const double longest = longest_edge(mesh, diagonal, options);
  MeshSegmentation out;
  const auto stopped = [&] {
    MeshSegmentation nothing;
    nothing.outcome = Outcome::stopped;
    return nothing;
  };
  TriangleMesh smooth = mesh;
  out.turned = detail::turn_outwards(smooth);
  if (options.smooth_threads) {
    monitor.report("threads", 0);
    out.threads = detail::find_threads(smooth);
    for (const ScrewThread& thread : out.threads) detail::smooth_thread(thread, smooth);
  }
  const std::size_t most = std::max<std::size_t>(2 * options.faces, mesh.triangles.size());
  const std::vector<Vector3d> thread_normals = detail::smoothed_normals(smooth, out.threads);
  const FaceGraph graph = detail::refined_faces(smooth, longest, most, thread_normals);
  const std::vector<double> diameters = shape_diameters(graph.mesh(), options.diameter, monitor);
  if (monitor.stopped()) return stopped();
  monitor.report("clusters", 0);
  const detail::DiameterClusters clusters =
      detail::cluster_diameters(graph, diameters, options.max_clusters, options.smoothing, options.seed);
  out.clusters = clusters.count;
  if (monitor.stopped()) return stopped();
  monitor.report("segments", 0);
  std::vector<char> on_bolt(mesh.triangles.size(), 0);
  for (const ScrewThread& thread : out.threads) {
    for (const int f : thread.faces) on_bolt[f] = detail::is_external(thread);
  }
  FoundRegions regions = find_regions(graph, clusters.labels, on_bolt, diagonal, options);
  if (monitor.stopped()) return stopped();
  for (int& label : regions.labels) label = std::max(label, 0);
  gather_pieces(graph, regions.labels, diameters, mesh.triangles.size(), out);
  if (is_face_split(graph, regions.outer, regions.labels, smooth.triangles.size()))
    join_whole_faces(smooth, thread_normals, graph, regions.outer, options.min_size * diagonal, options.convexity,
                     out.labels);
  list_segments(mesh, diagonal, out);
  return out;
}

}  // namespace mmgrasp
