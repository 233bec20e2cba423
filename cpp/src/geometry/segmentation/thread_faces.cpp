// The faces of a screw thread, and its radii, where its root is known.
#include "geometry/segmentation/thread_faces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/segmentation/axis_frame.hpp"
#include "mmgrasp/core/detail/interruption.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
/// Cosine to the axis of the normals of faces across it: steeper than the flanks of metric threads.
constexpr double kAcross = 0.9;
/// Cosine to the radius of the normals of faces along a shaft: flanks are steeper.
constexpr double kAlong = 0.94;
/// Depth of a thread from root to crest, in pitches; metric threads have 0.61, square ones 0.5.
constexpr double kDeepest = 1.0;
/// Radii of a thread are those that this share of its vertices does not go beyond.
constexpr double kNearlyAll = 0.98;
/// Noise moves vertices between the ends of a thread out of it by up to so many times what they may be off elsewhere.
constexpr double kLoose = 3;

/// How far a face looks away from the axis: the cosine to the radius, negative in a nut.
double outward(const FaceGraph& graph, int face, const Helix& helix) {
  return graph.normals[face].dot(place_at(helix, graph.centres[face]).outward);
}

enum class Among { no, ends, turns };  // `ends`: runs out of the thread's ends.

/// Where a face is of a thread that reaches from one radius to another.
Among place_among(const FaceGraph& graph, int face, const Helix& helix, const HelixSpan& heights, double low,
                  double high) {
  const double pitch = 2 * kPi * std::abs(helix.pitch_per_radian), slack = 0.05 * pitch + 3e-3 * low;
  HelixSpan radii, along;
  for (const int v : graph.faces[face]) {
    const HelixPlace at = place_at(helix, graph.vertices[v]);
    radii.add(at.radius);
    along.add(at.height);
  }
  const double off = std::max(low - radii.low, radii.high - high);  // How far it reaches out of the thread's radii.
  // Between the ends of the root there is nothing but the thread, whose noise may be as large as its faces.
  if (along.low >= heights.low && along.high <= heights.high) return off > kLoose * slack ? Among::no : Among::turns;
  const bool too_far = along.low <= heights.low - 0.75 * pitch || along.high >= heights.high + 0.75 * pitch;
  // Past the ends of the root lie the shafts that the thread ends on and the face of a head or shoulder.
  const bool on_a_shaft = radii.high - radii.low < slack && std::abs(outward(graph, face, helix)) > kAlong;
  const bool across = std::abs(graph.normals[face].dot(helix.axis)) > kAcross;
  return off > slack || too_far || on_a_shaft || across ? Among::no : Among::ends;
}

/// Faces from one radius to another between the ends of the root, and what runs on from them by half a pitch.
std::vector<int> faces_between(const FaceGraph& graph, const Helix& helix, const HelixSpan& heights, double low,
                               double high) {
  std::vector<Among> among(graph.faces.size());
  std::vector<int> out;
  InterruptionPoll poll;
  for (int f = 0; f < graph.size(); ++f) {
    poll();
    among[f] = place_among(graph, f, helix, heights, low, high);
    if (among[f] == Among::turns) out.push_back(f);
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    poll();
    for (int at = graph.first_border[out[i]]; at < graph.first_border[out[i] + 1]; ++at) {
      const int next = graph.other(graph.border_of[at], out[i]);
      if (among[next] != Among::ends) continue;
      among[next] = Among::turns;
      out.push_back(next);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// The radii from which nearly all vertices of a thread do not stand out, down or up. Edges say roughly where they are:
/// with noise those of a flank may pass for the root's.
struct ThreadRadii {
  bool external;
  double low, high;
};
std::optional<ThreadRadii> thread_radii(const FaceGraph& graph, const Helix& helix, const HelixSpan& heights,
                                        double root) {
  const double deepest = kDeepest * 2 * kPi * std::abs(helix.pitch_per_radian);
  const std::vector<int> faces = faces_between(graph, helix, heights, root - deepest, root + deepest);
  double outwards = 0;
  for (const int f : faces) outwards += graph.areas[f] * outward(graph, f, helix);
  std::vector<double> radii;
  for (const int f : faces) {
    if (outward(graph, f, helix) * outwards <= 0) continue;  // The bore of a bolt, the outside of a nut.
    for (const int v : graph.faces[f]) {
      const HelixPlace at = place_at(helix, graph.vertices[v]);
      if (at.height >= heights.low && at.height <= heights.high) radii.push_back(at.radius);
    }
  }
  if (radii.empty()) return std::nullopt;
  const auto reached_by = [&](double share) {
    const auto at = radii.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(radii.size() - 1));
    std::nth_element(radii.begin(), at, radii.end());
    return *at;
  };
  return ThreadRadii{outwards > 0, reached_by(1 - kNearlyAll), reached_by(kNearlyAll)};
}

}  // namespace

std::optional<ScrewThread> thread_around(const FaceGraph& graph, const Helix& helix, const HelixSpan& heights,
                                         double root) {
  const double pitch = 2 * kPi * std::abs(helix.pitch_per_radian);
  const std::optional<ThreadRadii> radii = thread_radii(graph, helix, heights, root);
  if (!radii) return std::nullopt;
  ScrewThread out;
  out.faces = faces_between(graph, helix, heights, radii->low, radii->high);
  if (out.faces.empty()) return std::nullopt;
  HelixSpan span;
  for (const int f : out.faces) {
    for (const int v : graph.faces[f]) span.add(place_at(helix, graph.vertices[v]).height);
  }
  const bool right_handed = helix.pitch_per_radian > 0;
  out.pitch = right_handed ? pitch : -pitch;
  out.root_radius = radii->external ? radii->low : radii->high;
  out.crest_radius = radii->external ? radii->high : radii->low;
  if (std::abs(out.crest_radius - out.root_radius) < 0.1 * pitch) return std::nullopt;
  out.length = span.high - span.low;
  out.T_mesh_thread.linear() = frame_along(helix.axis);
  out.T_mesh_thread.translation() = helix.point + 0.5 * (span.low + span.high) * helix.axis;
  return out;
}

}  // namespace mmgrasp::detail
