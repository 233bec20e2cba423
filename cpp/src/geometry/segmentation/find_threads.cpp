#include "geometry/segmentation/find_threads.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "geometry/segmentation/face_graph.hpp"
#include "geometry/segmentation/refine_models.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
constexpr double kPi = 3.14159265358979323846;
/// Edges that bend inwards by less are no roots [rad].
constexpr double kRootBend = 0.5;
constexpr double kLeastTurns = 2;
/// How well a chain's edges keep their place when the helix is unwound: 1 when all do, near 0 when none does. Two lines
/// of one thread's root, half a pitch apart at most, still have this much.
constexpr double kInPhase = 0.6;
/// Edges of a chain may differ in radius by this share of the pitch (standard deviation).
constexpr double kRadius = 0.15;
/// Depth of a thread from root to crest, in pitches; metric threads have 0.61, square ones 0.5.
constexpr double kDeepest = 1.0;

struct Helix {
  Vector3d axis = Vector3d::UnitZ(), point = Vector3d::Zero();
  double pitch_per_radian = 0;  ///< Along the axis [m/rad].
};

/// The screw motion along which the edges run: each edge e at x is parallel to moment + axis x x (least squares over
/// the six coordinates, edges weighted by their length).
std::optional<Helix> fit_helix(const FaceGraph& graph, const std::vector<int>& chain) {
  Vector3d middle = Vector3d::Zero();
  double length = 0;
  for (const int k : chain) {
    const FaceBorder& b = graph.borders[k];
    middle += b.length * 0.5 * (graph.vertices[b.vertices[0]] + graph.vertices[b.vertices[1]]);
    length += b.length;
  }
  if (length <= 0) return std::nullopt;
  middle /= length;
  double size = 0;
  for (const int k : chain) {
    for (const int v : graph.borders[k].vertices) size = std::max(size, (graph.vertices[v] - middle).norm());
  }
  const auto cross = [](const Vector3d& v) {
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
  };
  Matrix6d system = Matrix6d::Zero();
  for (const int k : chain) {
    const FaceBorder& b = graph.borders[k];
    const Vector3d u = (graph.vertices[b.vertices[0]] - middle) / size, v = (graph.vertices[b.vertices[1]] - middle) / size;
    if ((v - u).norm() <= 0) continue;
    // direction x (moment + axis x x) = 0
    const Eigen::Matrix3d along = cross((v - u).normalized());
    Eigen::Matrix<double, 3, 6> rows;
    rows << -along * cross(0.5 * (u + v)), along;
    system += b.length / length * rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(system);
  const Vector3d axis = solver.eigenvectors().col(0).head<3>(), moment = solver.eigenvectors().col(0).tail<3>();
  if (axis.norm() < 1e-6) return std::nullopt;
  Helix out;
  out.axis = axis.normalized();
  out.pitch_per_radian = axis.dot(moment) / axis.squaredNorm() * size;
  out.point = middle + size * axis.cross(moment) / axis.squaredNorm();
  return out;
}

/// Height, radius and direction from the axis of a point in a helix' frame.
struct Place {
  double height, radius;
  Vector3d outward;
};

Place place_at(const Helix& helix, const Vector3d& x) {
  const Vector3d d = x - helix.point;
  Place out;
  out.height = d.dot(helix.axis);
  const Vector3d radial = d - out.height * helix.axis;
  out.radius = radial.norm();
  out.outward = out.radius > 0 ? Vector3d(radial / out.radius) : Vector3d::Zero();
  return out;
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// Turns and moves the axis so that the chain's vertices lie at one distance from it, then takes the pitch from how far
/// they climb along it in all.
void refine_axis(const FaceGraph& graph, const std::vector<int>& chain, Helix& helix) {
  std::vector<Vector3d> points;
  std::vector<double> weights;
  double sum = 0, length = 0;
  for (const int k : chain) {
    for (const int vertex : graph.borders[k].vertices) {
      points.push_back(graph.vertices[vertex]);
      weights.push_back(graph.borders[k].length);
      sum += weights.back() * place_at(helix, points.back()).radius;
      length += weights.back();
    }
  }
  RoundFit cylinder;
  cylinder.axis = helix.axis;
  cylinder.point = helix.point;
  cylinder.radius = sum / length;
  if (!refine_cylinder(points, weights, cylinder)) return;
  helix.axis = cylinder.axis;
  helix.point = cylinder.point;
  double climbed = 0, turned = 0;
  for (const int k : chain) {
    const Vector3d &a = graph.vertices[graph.borders[k].vertices[0]], &b = graph.vertices[graph.borders[k].vertices[1]];
    const Place at = place_at(helix, 0.5 * (a + b));
    if (at.radius <= 0) continue;
    const double turn = (b - a).dot(helix.axis.cross(at.outward)) / at.radius;
    climbed += turn > 0 ? (b - a).dot(helix.axis) : -(b - a).dot(helix.axis);
    turned += std::abs(turn);
  }
  if (turned > 0) helix.pitch_per_radian = climbed / turned;
}

/// Whether the chain's edges run along the helix, at one radius, for long enough.
bool is_thread_root(const FaceGraph& graph, const std::vector<int>& chain, const Helix& helix, Range& heights,
                    double& radius) {
  double length = 0, turned = 0, mean = 0, square = 0;
  std::complex<double> phases = 0;
  const Vector3d side = helix.axis.unitOrthogonal(), across = helix.axis.cross(side);
  for (const int k : chain) {
    const FaceBorder& b = graph.borders[k];
    const Vector3d u = graph.vertices[b.vertices[0]], v = graph.vertices[b.vertices[1]];
    const Place at = place_at(helix, 0.5 * (u + v));
    if (at.radius <= 0) continue;
    const double angle = std::atan2(at.outward.dot(across), at.outward.dot(side));
    phases += b.length * std::polar(1.0, angle - at.height / helix.pitch_per_radian);
    length += b.length;
    turned += std::abs((v - u).dot(helix.axis.cross(at.outward))) / at.radius;
    const double r = 0.5 * (place_at(helix, u).radius + place_at(helix, v).radius);
    mean += b.length * r;
    square += b.length * r * r;
    heights.add(place_at(helix, u).height);
    heights.add(place_at(helix, v).height);
  }
  if (length <= 0) return false;
  mean /= length;
  radius = mean;
  const double pitch = 2 * kPi * std::abs(helix.pitch_per_radian);
  const double spread = std::sqrt(std::max(0.0, square / length - mean * mean));
  // A ring, straight or rounded, climbs nothing: its heights do not span its turns.
  return std::abs(phases) > kInPhase * length && turned > 2 * kPi * kLeastTurns && spread < kRadius * pitch &&
         heights.high - heights.low > 0.5 * kLeastTurns * pitch && pitch < 2 * mean && pitch > 0.01 * mean;
}

/// Chains of edges that share vertices, bend inwards and go straight on: several starts make several chains.
std::vector<std::vector<int>> root_chains(const FaceGraph& graph) {
  std::map<int, std::vector<int>> at_vertex;
  for (std::size_t k = 0; k < graph.borders.size(); ++k) {
    if (graph.borders[k].bend > -kRootBend) continue;
    for (const int v : graph.borders[k].vertices) at_vertex[v].push_back(static_cast<int>(k));
  }
  std::vector<char> taken(graph.borders.size(), 0);
  std::vector<std::vector<int>> chains;
  const auto leads_on = [&](int from, int to, int vertex) {
    const auto away = [&](int k) {
      const FaceBorder& b = graph.borders[k];
      const int other = b.vertices[0] == vertex ? b.vertices[1] : b.vertices[0];
      return Vector3d((graph.vertices[other] - graph.vertices[vertex]).normalized());
    };
    return away(from).dot(away(to)) < -0.5;
  };
  for (const auto& [vertex, edges] : at_vertex) {
    for (const int begin : edges) {
      if (taken[begin]) continue;
      std::vector<int> chain{begin};
      taken[begin] = 1;
      for (std::size_t i = 0; i < chain.size(); ++i) {
        for (const int v : graph.borders[chain[i]].vertices) {
          for (const int next : at_vertex.at(v)) {
            if (taken[next] || !leads_on(chain[i], next, v)) continue;
            taken[next] = 1;
            chain.push_back(next);
          }
        }
      }
      if (chain.size() >= 12) chains.push_back(std::move(chain));
    }
  }
  return chains;
}

/// The thread around a root: faces no higher or lower than half a pitch beyond it, from the root to the crest.
std::optional<ScrewThread> thread_around(const FaceGraph& graph, const Helix& helix, const Range& heights, double root) {
  const double pitch = 2 * kPi * std::abs(helix.pitch_per_radian), slack = 0.05 * pitch + 3e-3 * root;
  const auto faces_between = [&](double low, double high) {
    std::vector<int> faces;
    for (int f = 0; f < graph.size(); ++f) {
      bool inside = true, beyond = true, at_root = true;
      for (const int v : graph.faces[f]) {
        const Place at = place_at(helix, graph.vertices[v]);
        inside = inside && at.height > heights.low - 0.75 * pitch && at.height < heights.high + 0.75 * pitch &&
                 at.radius >= low - slack && at.radius <= high + slack;
        beyond = beyond && (at.height < heights.low || at.height > heights.high);
        at_root = at_root && std::abs(at.radius - root) < slack;
      }
      if (beyond && at_root) continue;  // the shaft that the thread ends on
      // A plane across the axis is no flank.
      if (inside && std::abs(graph.normals[f].dot(helix.axis)) < 0.985) faces.push_back(f);
    }
    return faces;
  };
  const auto area_of = [&](const std::vector<int>& faces) {
    double area = 0;
    for (const int f : faces) area += graph.areas[f];
    return area;
  };
  const std::vector<int> outside = faces_between(root, root + kDeepest * pitch);
  const std::vector<int> inside = faces_between(root - kDeepest * pitch, root);
  const bool external = area_of(outside) >= area_of(inside);
  ScrewThread out;
  out.faces = external ? outside : inside;
  if (out.faces.empty()) return std::nullopt;
  Range radii, span;
  for (const int f : out.faces) {
    for (const int v : graph.faces[f]) {
      const Place at = place_at(helix, graph.vertices[v]);
      radii.add(at.radius);
      span.add(at.height);
    }
  }
  const bool right_handed = helix.pitch_per_radian > 0;
  out.pitch = right_handed ? pitch : -pitch;
  out.root_radius = external ? radii.low : radii.high;
  out.crest_radius = external ? radii.high : radii.low;
  if (std::abs(out.crest_radius - out.root_radius) < 0.1 * pitch) return std::nullopt;
  out.length = span.high - span.low;
  out.T_mesh_thread.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), helix.axis).toRotationMatrix();
  out.T_mesh_thread.translation() = helix.point + 0.5 * (span.low + span.high) * helix.axis;
  return out;
}

}  // namespace

std::vector<ScrewThread> find_threads(const TriangleMesh& mesh) {
  FaceGraph graph;
  graph.vertices = mesh.vertices;
  graph.faces = mesh.triangles;
  graph.measure();
  std::vector<ScrewThread> out;
  std::vector<char> taken(graph.faces.size(), 0);
  std::vector<std::vector<int>> chains = root_chains(graph);
  std::stable_sort(chains.begin(), chains.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  for (const std::vector<int>& chain : chains) {
    const FaceBorder& first = graph.borders[chain.front()];
    if (taken[first.first] || taken[first.second]) continue;  // another start of the same thread
    std::optional<Helix> helix = fit_helix(graph, chain);
    if (helix) refine_axis(graph, chain, *helix);
    Range heights;
    double root = 0;
    if (!helix || !is_thread_root(graph, chain, *helix, heights, root)) continue;
    std::optional<ScrewThread> thread = thread_around(graph, *helix, heights, root);
    if (!thread) continue;
    for (const int f : thread->faces) taken[f] = 1;
    out.push_back(std::move(*thread));
  }
  return out;
}

void smooth_thread(const ScrewThread& thread, TriangleMesh& mesh) {
  const Vector3d axis = thread.T_mesh_thread.linear().col(2), point = thread.T_mesh_thread.translation();
  std::vector<char> done(mesh.vertices.size(), 0);
  for (const int f : thread.faces) {
    for (const int v : mesh.triangles[f]) {
      if (done[v]) continue;
      done[v] = 1;
      const Vector3d d = mesh.vertices[v] - point, up = d.dot(axis) * axis, radial = d - up;
      if (radial.norm() > 0) mesh.vertices[v] = point + up + thread.crest_radius * radial.normalized();
    }
  }
}

}  // namespace mmgrasp::detail
