#include "geometry/segmentation/find_threads.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "geometry/segmentation/face_graph.hpp"
#include "geometry/segmentation/refine_models.hpp"
#include "geometry/segmentation/thread_faces.hpp"
#include "geometry/segmentation/unwinding.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
/// Edges that bend inwards by less are no roots [rad].
constexpr double kRootBend = 0.35;
constexpr double kLeastTurns = 2;
/// How well the edges come to lie at one angle when the helix is unwound: 1 when all do, near 0 when they lie anywhere.
constexpr double kInPhase = 0.3;
/// Windings slower than this share of the best one are another one, and as good when the edges are as long by this one.
constexpr double kSlower = 0.8, kAsLong = 0.9;
/// Edges this far from the common angle belong to the root [rad].
constexpr double kPhase = 0.8;
/// Along a pitch edges in phase go around by this share of a turn at least.
constexpr double kFullTurn = 0.4;
/// Pitches looked for, in radii of the root.
constexpr double kFinest = 0.02, kCoarsest = 1.5;
/// The pitch is sought in so much of a thread above and below its middle, in radii of the root.
constexpr double kLookedAt = 50;
/// Edges of a chain may differ in radius by this share of the pitch (standard deviation).
constexpr double kRadius = 0.15;
/// Radii that differ by this share are one, whatever the pitch: which edges of rings count must not hang on rounding.
constexpr double kSameRadius = 1e-3;
/// Edges that differ more in direction from the helix are left out of its fit: the sine of the angle.
constexpr double kDirection = 0.35;
constexpr int kFits = 4;
/// Edges on either side of a face run alike: the cosine between them.
constexpr double kAlike = 0.94;
/// Longest chains tried.
constexpr std::size_t kMostChains = 12;

/// How the mesh shows the root of a thread: edges run along it, or, on a grid around the axis, they run along the
/// grid's rings and the root steps from ring to ring.
enum class RootForm { swept, stepped };

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
    const Vector3d u = (graph.vertices[b.vertices[0]] - middle) / size,
                   v = (graph.vertices[b.vertices[1]] - middle) / size;
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

/// Turns and moves the axis so that the chain's vertices lie at one distance from it.
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
}

/// The roots of all that run along the helix at the radius that most of the chain's edges have: not those of the head
/// that the thread ends on nor branches that noise makes, but pieces of the chain that noise broke off.
std::vector<int> edges_along(const FaceGraph& graph, const std::vector<int>& all, const std::vector<int>& chain,
                             const Helix& helix) {
  std::vector<std::pair<double, double>> radii;
  double length = 0;
  for (const int k : chain) {
    const FaceBorder& b = graph.borders[k];
    const Vector3d middle = 0.5 * (graph.vertices[b.vertices[0]] + graph.vertices[b.vertices[1]]);
    radii.emplace_back(place_at(helix, middle).radius, b.length);
    length += b.length;
  }
  std::sort(radii.begin(), radii.end());
  double median = 0, sum = 0;
  for (const auto& [radius, weight] : radii) {
    median = radius;
    sum += weight;
    if (2 * sum >= length) break;
  }
  const double reach = std::max(kRadius * kTwoPi * std::abs(helix.pitch_per_radian), kSameRadius * median);
  std::vector<int> out;
  InterruptionPoll poll;
  for (const int k : all) {
    poll();
    const FaceBorder& b = graph.borders[k];
    const Vector3d u = graph.vertices[b.vertices[0]], v = graph.vertices[b.vertices[1]];
    const HelixPlace at = place_at(helix, 0.5 * (u + v));
    const Vector3d motion = helix.axis.cross(at.outward) * at.radius + helix.pitch_per_radian * helix.axis;
    if (b.length <= 0 || motion.norm() <= 0 || std::abs(at.radius - median) > reach) continue;
    if (((v - u) / b.length).cross(motion.normalized()).norm() < kDirection) out.push_back(k);
  }
  return out;
}

/// Edges around the axis of a helix, and their mean radius by length.
struct EdgesAround {
  std::vector<HelixTurn> turns;
  double radius = 0;
};

EdgesAround edges_around(const FaceGraph& graph, const std::vector<int>& edges, const Helix& helix) {
  const Vector3d side = helix.axis.unitOrthogonal(), across = helix.axis.cross(side);
  EdgesAround out;
  double length = 0;
  for (const int k : edges) {
    const FaceBorder& b = graph.borders[k];
    const HelixPlace at = place_at(helix, 0.5 * (graph.vertices[b.vertices[0]] + graph.vertices[b.vertices[1]]));
    out.turns.push_back({std::atan2(at.outward.dot(across), at.outward.dot(side)), at.height, b.length, k});
    out.radius += b.length * at.radius;
    length += b.length;
  }
  if (length > 0) out.radius /= length;
  return out;
}

/// A winding [rad/m], and how long the edges are together as arrows once it is taken off them.
struct Unwinding {
  double winding, length;
};

/// The longest for a winding of either sense from `least` to `most`.
Unwinding best_unwinding(const std::vector<HelixTurn>& turns, double least, double most, double step) {
  Unwinding out{longest_unwound(turns, least, most, step), 0};
  out.length = std::abs(unwound(turns, out.winding));
  for (double part = step / 2; part > 1e-4 * step; part /= 2) {
    for (const double tried : {out.winding - part, out.winding + part}) {
      const double found = std::abs(unwound(turns, tried));
      if (found > out.length) out = {tried, found};
    }
  }
  return out;
}

/// The winding at which edges, unwound, come to lie at one angle [rad/m]. None where they do not: edges of rings are
/// spread evenly over the turn whatever the winding, and so are edges that noise makes.
std::optional<double> common_winding(const EdgesAround& edges, RootForm form) {
  HelixSpan heights, looked_at;
  for (const HelixTurn& t : edges.turns) heights.add(t.height);
  // The steps grow with the height looked at: without an end where the edges lie on the axis itself, as those of a bore
  // may with noise.
  const double middle = (heights.low + heights.high) / 2;
  std::vector<HelixTurn> near;
  double length = 0;
  for (const HelixTurn& t : edges.turns) {
    if (std::abs(t.height - middle) > kLookedAt * edges.radius) continue;
    near.push_back(t);
    length += t.length;
    looked_at.add(t.height);
  }
  const double span = looked_at.high - looked_at.low;
  if (near.empty() || !(edges.radius > 0) || !(span > kFinest * edges.radius)) return std::nullopt;
  const double most = kTwoPi / (kFinest * edges.radius), least = kTwoPi / (kCoarsest * edges.radius), step = 1 / span;
  Unwinding best = best_unwinding(near, least, most, step);
  // Edges on a grid around the axis lie at one angle for faster windings, too: their heights are multiples of the
  // grid's. Refined, a winding may come out a little faster than asked for: each is sought below the last.
  double below = kInfinity;
  while (form == RootForm::stepped && (below = kSlower * std::min(below, std::abs(best.winding))) > least) {
    const Unwinding slower = best_unwinding(near, least, below, step);
    if (slower.length < kAsLong * best.length) break;
    best = slower;
  }
  if (best.length < kInPhase * length) return std::nullopt;
  return best.winding;
}

/// The edges that lie at one angle when they are unwound by their common winding, which the helix takes over.
std::vector<int> edges_in_phase(const FaceGraph& graph, const std::vector<int>& edges, RootForm form, Helix& helix) {
  const EdgesAround around = edges_around(graph, edges, helix);
  const std::optional<double> winding = common_winding(around, form);
  if (!winding) return {};
  helix.pitch_per_radian = 1 / *winding;
  const double phase = std::arg(unwound(around.turns, *winding));
  std::vector<int> out;
  for (const HelixTurn& t : around.turns) {
    if (std::abs(shortest_turn(t.angle - *winding * t.height - phase)) < kPhase) out.push_back(t.edge);
  }
  return out;
}

/// A helix along edges: its axis and its pitch by where they run. Of a stepped root they run along rings, and its pitch
/// is by where they are; where they are at no winding (a ring) it is the pitch by which they run.
std::optional<Helix> helix_along(const FaceGraph& graph, const std::vector<int>& edges, RootForm form) {
  std::optional<Helix> out = fit_helix(graph, edges);
  if (!out || form == RootForm::swept) return out;
  if (const std::optional<double> winding = common_winding(edges_around(graph, edges, *out), form))
    out->pitch_per_radian = 1 / *winding;
  return out;
}

/// Those of one thread among edges in phase: where they go nearly all around, turn upon turn. A ring at the root's
/// radius, on a shaft far from the thread, has a quarter of its edges in phase; noise has a few anywhere.
std::vector<int> edges_of_one_thread(const FaceGraph& graph, const std::vector<int>& edges, const Helix& helix) {
  struct RootEdge {
    double height, turned;  // turned: the angle that it goes around the axis [rad]
    int number;
  };
  std::vector<RootEdge> sorted;
  for (const int k : edges) {
    const FaceBorder& b = graph.borders[k];
    const Vector3d u = graph.vertices[b.vertices[0]], v = graph.vertices[b.vertices[1]];
    const HelixPlace at = place_at(helix, 0.5 * (u + v));
    const double turned = std::abs((v - u).dot(helix.axis.cross(at.outward))) / std::max(at.radius, 1e-300);
    sorted.push_back({at.height, turned, k});
  }
  std::sort(sorted.begin(), sorted.end(), [](const RootEdge& a, const RootEdge& b) {
    return std::tie(a.height, a.number) < std::tie(b.height, b.number);
  });
  std::vector<double> up_to{0};
  for (const RootEdge& e : sorted) up_to.push_back(up_to.back() + e.turned);
  const double pitch = kTwoPi * std::abs(helix.pitch_per_radian);
  const auto first_from = [&](double height) {
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), height,
                                     [](const RootEdge& e, double h) { return e.height < h; });
    return static_cast<std::size_t>(at - sorted.begin());
  };
  std::vector<std::vector<int>> runs;
  std::vector<double> lengths;
  double last = -kInfinity;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double below = up_to[i + 1] - up_to[first_from(sorted[i].height - pitch)];
    const double above = up_to[first_from(sorted[i].height + pitch)] - up_to[i];
    if (std::max(below, above) < kFullTurn * 2 * kPi) continue;
    if (sorted[i].height - last > pitch) {
      runs.emplace_back();
      lengths.push_back(0);
    }
    last = sorted[i].height;
    runs.back().push_back(sorted[i].number);
    lengths.back() += sorted[i].turned;
  }
  if (runs.empty()) return {};
  return runs[std::max_element(lengths.begin(), lengths.end()) - lengths.begin()];
}

/// Whether the edges run at one radius for long enough.
bool is_thread_root(const FaceGraph& graph, const std::vector<int>& edges, const Helix& helix, HelixSpan& heights,
                    double& radius) {
  double length = 0, turned = 0, mean = 0, square = 0;
  for (const int k : edges) {
    const FaceBorder& b = graph.borders[k];
    const Vector3d u = graph.vertices[b.vertices[0]], v = graph.vertices[b.vertices[1]];
    const HelixPlace at = place_at(helix, 0.5 * (u + v));
    if (at.radius <= 0) continue;
    length += b.length;
    turned += std::abs((v - u).dot(helix.axis.cross(at.outward))) / at.radius;
    mean += b.length * at.radius;
    square += b.length * at.radius * at.radius;
    heights.add(place_at(helix, u).height);
    heights.add(place_at(helix, v).height);
  }
  if (length <= 0) return false;
  mean /= length;
  radius = mean;
  const double pitch = kTwoPi * std::abs(helix.pitch_per_radian);
  const double spread = std::sqrt(std::max(0.0, square / length - mean * mean));
  return turned > 2 * kPi * kLeastTurns && spread < kRadius * pitch && heights.high - heights.low > kLeastTurns * pitch;
}

/// Edges that bend inwards, by vertex.
using RootsAt = std::map<int, std::vector<int>>;

RootsAt roots_at(const FaceGraph& graph) {
  RootsAt out;
  for (std::size_t k = 0; k < graph.borders.size(); ++k) {
    if (graph.borders[k].bend > -kRootBend) continue;
    for (const int v : graph.borders[k].vertices) out[v].push_back(static_cast<int>(k));
  }
  return out;
}

/// Edges that bend inwards and go on from one: straight on from its ends, and of a stepped root beside it, alike,
/// across a face.
std::vector<int> roots_beside(const FaceGraph& graph, const RootsAt& roots, RootForm form, int edge) {
  const FaceBorder& from = graph.borders[edge];
  const auto away = [&](int k, int vertex) -> Vector3d {
    const FaceBorder& b = graph.borders[k];
    const int other = b.vertices[0] == vertex ? b.vertices[1] : b.vertices[0];
    return (graph.vertices[other] - graph.vertices[vertex]).normalized();
  };
  std::vector<int> out;
  for (const int v : from.vertices)
    for (const int next : roots.at(v))
      if (away(edge, v).dot(away(next, v)) < -0.5) out.push_back(next);
  if (form == RootForm::swept) return out;
  for (const int face : {from.first, from.second}) {
    for (const int v : graph.faces[face]) {
      const auto found = roots.find(v);
      if (v == from.vertices[0] || v == from.vertices[1] || found == roots.end()) continue;
      for (const int next : found->second)
        if (std::abs(away(edge, from.vertices[0]).dot(away(next, v))) > kAlike) out.push_back(next);
    }
  }
  return out;
}

/// Chains of edges that bend inwards and lead on from one another: several starts make several chains.
std::vector<std::vector<int>> root_chains(const FaceGraph& graph, RootForm form) {
  const RootsAt roots = roots_at(graph);
  std::vector<char> taken(graph.borders.size(), 0);
  std::vector<std::vector<int>> chains;
  InterruptionPoll poll;
  for (const auto& [vertex, edges] : roots) {
    for (const int begin : edges) {
      if (taken[begin]) continue;
      std::vector<int> chain{begin};
      taken[begin] = 1;
      for (std::size_t i = 0; i < chain.size(); ++i) {
        poll();
        for (const int next : roots_beside(graph, roots, form, chain[i])) {
          if (taken[next]) continue;
          taken[next] = 1;
          chain.push_back(next);
        }
      }
      if (chain.size() >= 12) chains.push_back(std::move(chain));
    }
  }
  return chains;
}

/// Finds the threads of a mesh one after the other; their faces and edges are taken.
class ThreadSearch {
 public:
  explicit ThreadSearch(const TriangleMesh& mesh) : taken_(mesh.triangles.size(), 0) {
    graph_.vertices = mesh.vertices;
    graph_.faces = mesh.triangles;
    graph_.measure();
    for (std::size_t k = 0; k < graph_.borders.size(); ++k) {
      if (graph_.borders[k].bend <= -kRootBend) roots_.push_back(static_cast<int>(k));
    }
  }

  void run(RootForm form) {
    std::vector<std::vector<int>> chains = root_chains(graph_, form);
    std::stable_sort(chains.begin(), chains.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
    if (chains.size() > kMostChains) chains.resize(kMostChains);
    for (const std::vector<int>& chain : chains) {
      throw_if_interrupted();
      const auto known = std::count_if(chain.begin(), chain.end(), [&](int k) { return on_known(k); });
      if (2 * known > static_cast<std::ptrdiff_t>(chain.size())) continue;  // another start or piece of the same thread
      if (auto thread = thread_along(chain, form)) take(std::move(*thread));
    }
  }

  std::vector<ScrewThread> found;

 private:
  bool on_known(int border) const {
    return taken_[graph_.borders[border].first] || taken_[graph_.borders[border].second];
  }

  std::optional<ScrewThread> thread_along(const std::vector<int>& chain, RootForm form) const {
    std::optional<Helix> helix = helix_along(graph_, chain, form);
    std::vector<int> along = chain;
    for (int fit = 0; fit < kFits && helix; ++fit) {
      along = edges_along(graph_, roots_, along, *helix);
      helix = helix_along(graph_, along, form);
    }
    if (!helix) return std::nullopt;
    refine_axis(graph_, along, *helix);
    const std::vector<int> turns = edges_of_one_thread(graph_, edges_in_phase(graph_, along, form, *helix), *helix);
    if (turns.empty()) return std::nullopt;
    refine_axis(graph_, turns, *helix);
    HelixSpan heights;
    double root = 0;
    if (!is_thread_root(graph_, turns, *helix, heights, root)) return std::nullopt;
    return thread_around(graph_, *helix, heights, root);
  }

  void take(ScrewThread thread) {
    const auto again = std::count_if(thread.faces.begin(), thread.faces.end(), [&](int f) { return taken_[f] != 0; });
    if (2 * again > static_cast<std::ptrdiff_t>(thread.faces.size())) return;
    for (const int f : thread.faces) taken_[f] = 1;
    roots_.erase(std::remove_if(roots_.begin(), roots_.end(), [&](int k) { return on_known(k); }), roots_.end());
    found.push_back(std::move(thread));
  }

  FaceGraph graph_;
  std::vector<char> taken_;  // Faces of threads that are found.
  std::vector<int> roots_;   // Edges that bend inwards, those of found threads left out.
};

}  // namespace

std::vector<ScrewThread> find_threads(const TriangleMesh& mesh) {
  ThreadSearch search(mesh);
  for (const RootForm form : {RootForm::swept, RootForm::stepped}) search.run(form);
  return std::move(search.found);
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

std::vector<Vector3d> smoothed_normals(const TriangleMesh& mesh, const std::vector<ScrewThread>& threads) {
  std::vector<Vector3d> out(mesh.triangles.size(), Vector3d::Zero());
  for (const ScrewThread& thread : threads) {
    const Vector3d axis = thread.T_mesh_thread.linear().col(2), point = thread.T_mesh_thread.translation();
    const double outward = is_external(thread) ? 1 : -1;
    for (const int f : thread.faces) {
      const auto& t = mesh.triangles[f];
      const Vector3d d = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3 - point;
      const Vector3d radial = d - d.dot(axis) * axis;
      if (radial.norm() > 0) out[f] = outward * radial.normalized();
    }
  }
  return out;
}

}  // namespace mmgrasp::detail
