// Cylinders, cones and spheres that a segment's outward surface lies on.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "geometry/segmentation/axis_frame.hpp"
#include "geometry/segmentation/ransac_models.hpp"
#include "geometry/segmentation/refine_models.hpp"
#include "geometry/segmentation/segment_surface.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
/// Points no farther from a model than this share of the segment's size lie on it.
constexpr double kOnSurface = 0.01;
/// An outline is as long as its crests reach, which are no farther off it than this share.
constexpr double kOnCrest = 0.001;
/// Angle of a face's normal to the model's below which it lies on it [rad]: a facet of a wall of 12 sides does.
constexpr double kAlike = 0.3;
constexpr std::size_t kMostPoints = 3000;
/// Models looked for, one after the other, in what the ones before left over.
constexpr int kMostModels = 4;
constexpr int kSectors = 36;
/// Normals that fewer faces have, as a share of an even spread, are those of rounded edges.
constexpr double kLeastInSector = 0.1;
constexpr double kLeastTurn = 0.5, kLeastSphere = 0.25, kLeastShare = 0.05;
/// Share of a model's area that must lie on no larger one of its kind.
constexpr double kLeastOwn = 0.5;
/// Share of an outline's area, between the ends of the surface on it, that must have some behind it.
constexpr double kLeastBehind = 0.5;

/// Cosine to a model's normal of faces that look outwards; the caps of a cylinder look along it.
constexpr double kOutwards = 0.05;

/// How faces lie on a model: along it, or anyhow close to it, as the flanks of grooves and knurls do on the outline
/// that their crests have.
enum class FacesOn { along, any };

/// How much area lies in which direction around an axis.
class Sectors {
 public:
  /// A face that reaches from the least to the most of the angles, which are within half a turn of `at` [rad].
  void add(double at, const std::array<double, 3>& angles, double area) {
    double low = 0, high = 0;
    for (const double angle : angles) {
      low = std::min(low, shortest_turn(angle - at));
      high = std::max(high, shortest_turn(angle - at));
    }
    const double width = kTwoPi / kSectors;
    const int first = static_cast<int>(std::floor((at + low) / width + 0.01));
    const int count = std::max(1, static_cast<int>(std::ceil((at + high) / width - 0.01)) - first);
    for (int k = first; k < first + count; ++k) areas_[((k % kSectors) + kSectors) % kSectors] += area / count;
  }
  /// Share of the turn that has more than so much of what an even spread would give it.
  double covered(double least) const {
    const double even = std::accumulate(areas_.begin(), areas_.end(), 0.0) / kSectors;
    const auto some = [&](double area) { return area > least * even; };
    return static_cast<double>(std::count_if(areas_.begin(), areas_.end(), some)) / kSectors;
  }

 private:
  std::array<double, kSectors> areas_{};
};

struct Cover {
  double area = 0;       ///< Area, seen along the model's normals, of the faces that lie on it.
  double turn = 0;       ///< Share of the turn around the axis where there are some.
  double bent = 0;       ///< Share of the turn that their normals take: the sides of a prism stay at a few directions.
  double deviation = 0;  ///< Mean distance of their corners.
  std::vector<int> faces;                     ///< Those faces.
  double low = kInfinity, high = -kInfinity;  ///< Where they begin and end along the axis.
};

Cover cover_of(const SegmentSurface& s, const RoundFit& fit, FacesOn on) {
  Cover out;
  const Vector3d u = fit.axis.unitOrthogonal(), v = fit.axis.cross(u);
  const auto angle_of = [&](const Vector3d& x) { return std::atan2(x.dot(v), x.dot(u)); };
  Sectors places, directions;
  for (std::size_t f = 0; f < s.corners.size(); ++f) {
    const Vector3d middle = (s.corners[f][0] + s.corners[f][1] + s.corners[f][2]) / 3;
    Vector3d normal, unused;
    fit.distance(middle, normal);
    double off = 0;
    for (const Vector3d& corner : s.corners[f]) off = std::max(off, std::abs(fit.distance(corner, unused)));
    const double cosine = s.face_normals[f].dot(normal);
    if (off > kOnSurface || cosine < (on == FacesOn::along ? std::cos(kAlike) : kOutwards)) continue;
    for (const Vector3d& corner : s.corners[f]) {
      if (on == FacesOn::any && std::abs(fit.distance(corner, unused)) > kOnCrest) continue;  // a chamfer's foot
      out.low = std::min(out.low, (corner - fit.point).dot(fit.axis));
      out.high = std::max(out.high, (corner - fit.point).dot(fit.axis));
    }
    const double area = on == FacesOn::along ? s.areas[f] : cosine * s.areas[f];
    out.area += area;
    out.faces.push_back(static_cast<int>(f));
    out.deviation += area * off;
    // A wide facet covers all sectors between its corners, and bends from one corner's normal to the next.
    std::array<double, 3> at, towards;
    for (int i = 0; i < 3; ++i) {
      at[i] = angle_of(s.corners[f][i] - fit.point);
      towards[i] = angle_of(s.corner_normals[f][i]);
    }
    places.add(angle_of(middle - fit.point), at, area);
    directions.add(angle_of(s.face_normals[f]), towards, area);
  }
  out.turn = places.covered(0);
  out.bent = directions.covered(kLeastInSector);
  if (out.area > 0) out.deviation /= out.area;
  return out;
}

void pick(const std::vector<Vector3d>& from, const std::vector<int>& indices, std::vector<Vector3d>& out) {
  out.clear();
  for (const int i : indices) out.push_back(from[i]);
}

std::optional<RoundFit> refit(RoundModel model, const std::vector<Vector3d>& points,
                              const std::vector<Vector3d>& normals) {
  if (model == RoundModel::cylinder) return cylinder_through(points, normals);
  if (model == RoundModel::cone) return cone_through(points, normals);
  return sphere_through(points);
}

/// The points that lie on a model by place and normal.
std::vector<int> points_on(const std::vector<Vector3d>& points, const std::vector<Vector3d>& normals,
                           const RoundFit& fit) {
  std::vector<int> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vector3d normal;
    const double off = fit.distance(points[i], normal);
    if (std::abs(off) <= kOnSurface && std::abs(normals[i].dot(normal)) > std::cos(kAlike)) {
      out.push_back(static_cast<int>(i));
    }
  }
  return out;
}

FittedPrimitive placed(const SegmentSurface& s, const RoundFit& fit, const Cover& cover) {
  FittedPrimitive out;
  out.deviation = s.scale * cover.deviation;
  if (fit.kind == RoundFit::Kind::sphere) {
    out.kind = PrimitiveKind::sphere;
    out.T_mesh_primitive.translation() = s.to_mesh(fit.point);
    out.size.setConstant(2 * s.scale * fit.radius);
    out.volume = kPi / 6 * std::pow(out.size.x(), 3);
    out.widths.push_back({out.size.x(), Vector3d::UnitZ(), cover.area / (4 * kPi * fit.radius * fit.radius)});
    return out;
  }
  double low = kInfinity, high = -low;
  for (const Vector3d& p : s.hull.points) {
    low = std::min(low, (p - fit.point).dot(fit.axis));
    high = std::max(high, (p - fit.point).dot(fit.axis));
  }
  double foot = fit.radius, top = fit.radius;
  out.kind = PrimitiveKind::cylinder;
  if (fit.kind == RoundFit::Kind::cone) {
    out.kind = PrimitiveKind::cone;
    high = std::min(high, 0.0);
    foot = -low * std::tan(fit.half_angle);
    top = -high * std::tan(fit.half_angle);
  }
  const double length = std::max(0.0, high - low);
  out.size = s.scale * Vector3d(2 * foot, 2 * top, length);
  out.volume = std::pow(s.scale, 3) * kPi * length * (foot * foot + foot * top + top * top) / 3;
  out.T_mesh_primitive.linear() = frame_along(fit.axis);
  out.T_mesh_primitive.translation() = s.to_mesh(fit.point + 0.5 * (low + high) * fit.axis);
  // A cone slips out of fingers, so it has no width to offer.
  if (out.kind == PrimitiveKind::cylinder) out.widths.push_back({out.size.x(), fit.axis, cover.turn});
  return out;
}

/// Points with their outward normals.
struct OrientedPoints {
  std::vector<Vector3d> places, normals;
};

/// No more than kMostPoints of a surface's points, evenly out of all.
OrientedPoints some_points(const SegmentSurface& s) {
  OrientedPoints out;
  const std::size_t stride = 1 + s.points.size() / kMostPoints;
  for (std::size_t i = 0; i < s.points.size(); i += stride) {
    out.places.push_back(s.points[i]);
    out.normals.push_back(s.normals[i]);
  }
  return out;
}

/// The surface of a segment's hull, in the segment's frame.
SegmentSurface hull_surface(const SegmentSurface& s) {
  TriangleMesh hull;
  hull.vertices = s.hull.points;
  hull.triangles = s.hull.triangles;
  std::vector<int> all(hull.triangles.size());
  std::iota(all.begin(), all.end(), 0);
  SegmentSurface out = segment_surface(hull, all, CornerWeight::area);
  for (Vector3d& p : out.points) p = out.to_mesh(p);
  for (auto& face : out.corners)
    for (Vector3d& corner : face) corner = out.to_mesh(corner);
  for (double& area : out.areas) area *= out.scale * out.scale;
  return out;
}

/// A model, and the mean distance from it of the points that it was fitted to.
struct SpreadFit {
  RoundFit fit;
  double spread = 0;
};

double mean_distance(const std::vector<Vector3d>& points, const std::vector<int>& on, const RoundFit& fit) {
  double sum = 0;
  Vector3d unused;
  for (const int i : on) sum += std::abs(fit.distance(points[i], unused));
  return sum / static_cast<double>(on.size());
}

/// Models on points: one after the other, each in what those before left over.
std::vector<SpreadFit> models_on(OrientedPoints points, RoundModel model, const Monitor& monitor) {
  std::vector<SpreadFit> out;
  for (int round = 0; round < kMostModels && points.places.size() >= 8 && !monitor.stopped(); ++round) {
    std::vector<int> on = points_on_model(points.places, points.normals, model, kOnSurface);
    if (on.size() < 8) break;
    std::vector<Vector3d> p, n;
    std::optional<RoundFit> fit;
    for (int step = 0; step < 3; ++step) {
      pick(points.places, on, p);
      pick(points.normals, on, n);
      const std::optional<RoundFit> better = refit(model, p, n);
      if (!better) break;
      std::vector<int> next = points_on(points.places, points.normals, *better);
      if (2 * next.size() < on.size()) break;
      fit = better;
      on = std::move(next);
    }
    if (fit) out.push_back({*fit, mean_distance(points.places, on, *fit)});
    std::vector<char> taken(points.places.size(), 0);
    for (const int i : on) taken[i] = 1;
    OrientedPoints rest;
    for (std::size_t i = 0; i < points.places.size(); ++i) {
      if (taken[i]) continue;
      rest.places.push_back(points.places[i]);
      rest.normals.push_back(points.normals[i]);
    }
    if (rest.places.size() == points.places.size()) break;
    points = std::move(rest);
  }
  return out;
}

/// The model moved out to the outer ones of its points: a hull has corners on the chamfers of an outline's ends, too.
SpreadFit fit_around(const OrientedPoints& points, RoundModel model, const SpreadFit& through) {
  const std::vector<int> on = points_on(points.places, points.normals, through.fit);
  std::vector<int> outer;
  std::vector<Vector3d> p, n;
  Vector3d unused;
  for (const int i : on)
    if (through.fit.distance(points.places[i], unused) >= 0) outer.push_back(i);
  pick(points.places, outer, p);
  pick(points.normals, outer, n);
  const std::optional<RoundFit> around = outer.size() < 8 ? std::nullopt : refit(model, p, n);
  if (!around) return through;
  return {*around, mean_distance(points.places, outer, *around)};
}

/// Area of a cylinder or cone between two heights along its axis.
double area_between(const RoundFit& fit, double low, double high) {
  if (fit.kind == RoundFit::Kind::cylinder) return kTwoPi * fit.radius * (high - low);
  const double radius = std::abs(low + high) / 2 * std::tan(fit.half_angle);
  return kTwoPi * radius * (high - low) / std::cos(fit.half_angle);
}

/// Whether enough of a surface lies along a model and bends with it.
bool is_covered(const SegmentSurface& s, const RoundFit& fit, const Cover& cover) {
  if (cover.area <= kLeastShare * s.area) return false;
  if (fit.kind == RoundFit::Kind::sphere) return cover.area > kLeastSphere * 4 * kPi * fit.radius * fit.radius;
  return cover.turn >= kLeastTurn && cover.bent >= kLeastTurn;
}

/// Whether enough of a surface lies behind an outline.
bool is_backed(const RoundFit& fit, const Cover& cover) {
  if (fit.kind == RoundFit::Kind::sphere) return cover.area > kLeastSphere * 4 * kPi * fit.radius * fit.radius;
  return cover.turn >= kLeastTurn && cover.area >= kLeastBehind * area_between(fit, cover.low, cover.high);
}

RoundCandidate candidate(const SegmentSurface& s, const SpreadFit& with, const Cover& cover) {
  return {placed(s, with.fit, cover), s.to_mesh(with.fit.point + (cover.low + cover.high) / 2 * with.fit.axis),
          s.scale * (cover.high - cover.low), s.scale * with.spread};
}

/// Without models on faces that a larger one lies on, too: a wall with slivers, or one that runs into a fillet, leaves
/// points over on which a second, tilted one lies. By area, the largest first.
void drop_doubles(const SegmentSurface& s, std::vector<std::pair<SpreadFit, Cover>>& found) {
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.second.area > b.second.area; });
  std::vector<char> taken(s.areas.size(), 0);
  std::vector<std::pair<SpreadFit, Cover>> kept;
  for (auto& model : found) {
    double own = 0;
    for (const int f : model.second.faces) own += taken[f] ? 0 : s.areas[f];
    if (own < kLeastOwn * model.second.area) continue;
    for (const int f : model.second.faces) taken[f] = 1;
    kept.push_back(std::move(model));
  }
  found.swap(kept);
}

constexpr RoundModel kModels[] = {RoundModel::cylinder, RoundModel::cone, RoundModel::sphere};

}  // namespace

void RoundCandidate::trim() {
  if (primitive.kind != PrimitiveKind::cylinder) return;
  primitive.T_mesh_primitive.translation() = wall_middle;
  primitive.size.z() = wall_length;
  primitive.volume = kPi / 4 * primitive.size.x() * primitive.size.y() * wall_length;
}
std::vector<RoundCandidate> round_candidates(const SegmentSurface& s, const Monitor& monitor) {
  std::vector<RoundCandidate> out;
  for (const RoundModel model : kModels) {
    std::vector<std::pair<SpreadFit, Cover>> found;
    for (const SpreadFit& with : models_on(some_points(s), model, monitor)) {
      Cover cover = cover_of(s, with.fit, FacesOn::along);
      if (is_covered(s, with.fit, cover)) found.emplace_back(with, std::move(cover));
    }
    drop_doubles(s, found);
    for (const auto& [with, cover] : found) out.push_back(candidate(s, with, cover));
  }
  return out;
}

std::vector<RoundCandidate> outline_candidates(const SegmentSurface& s, const Monitor& monitor) {
  std::vector<RoundCandidate> out;
  if (s.hull.triangles.empty()) return out;
  const SegmentSurface hull = hull_surface(s);
  for (const RoundModel model : kModels) {
    const OrientedPoints points = some_points(hull);
    for (const SpreadFit& through : models_on(points, model, monitor)) {
      const SpreadFit with = fit_around(points, model, through);
      if (!is_covered(hull, with.fit, cover_of(hull, with.fit, FacesOn::along))) continue;
      const Cover behind = cover_of(s, with.fit, FacesOn::any);
      if (is_backed(with.fit, behind)) out.push_back(candidate(s, with, behind));
    }
  }
  return out;
}

}  // namespace mmgrasp::detail
