// Cylinders, cones and spheres that a segment's outward surface lies on.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/segmentation/ransac_models.hpp"
#include "geometry/segmentation/refine_models.hpp"
#include "geometry/segmentation/segment_surface.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
/// Points no farther from a model than this share of the segment's size lie on it.
constexpr double kOnSurface = 0.01;
/// Angle of a face's normal to the model's below which it lies on it [rad]: a facet of a wall of 12 sides does.
constexpr double kAlike = 0.3;
constexpr std::size_t kMostPoints = 3000;
/// Models looked for, one after the other, in what the ones before left over.
constexpr int kMostModels = 4;
constexpr int kSectors = 36;
constexpr double kLeastTurn = 0.5, kLeastSphere = 0.25, kLeastShare = 0.05;
/// Share of a model's area that must lie on no larger one of its kind.
constexpr double kLeastOwn = 0.5;

struct Cover {
  double area = 0;                            ///< Area of the faces that lie on the model and face outwards.
  double turn = 0;                            ///< Share of the turn around the axis where there are some.
  double deviation = 0;                       ///< Mean distance of their corners.
  std::vector<int> faces;                     ///< Those faces.
  double low = kInfinity, high = -kInfinity;  ///< Where they begin and end along the axis.
};

Cover cover_of(const SegmentSurface& s, const RoundFit& fit) {
  Cover out;
  const Vector3d u = fit.axis.unitOrthogonal(), v = fit.axis.cross(u);
  std::array<char, kSectors> sectors{};
  for (std::size_t f = 0; f < s.corners.size(); ++f) {
    const Vector3d middle = (s.corners[f][0] + s.corners[f][1] + s.corners[f][2]) / 3;
    Vector3d normal, unused;
    fit.distance(middle, normal);
    double off = 0;
    for (const Vector3d& corner : s.corners[f]) off = std::max(off, std::abs(fit.distance(corner, unused)));
    if (off > kOnSurface || s.face_normals[f].dot(normal) < std::cos(kAlike)) continue;
    for (const Vector3d& corner : s.corners[f]) {
      out.low = std::min(out.low, (corner - fit.point).dot(fit.axis));
      out.high = std::max(out.high, (corner - fit.point).dot(fit.axis));
    }
    out.area += s.areas[f];
    out.faces.push_back(static_cast<int>(f));
    out.deviation += s.areas[f] * off;
    // A wide facet covers all sectors between its corners.
    double low = 0, high = 0;
    const double at = std::atan2((middle - fit.point).dot(v), (middle - fit.point).dot(u));
    for (const Vector3d& corner : s.corners[f]) {
      const double to = std::atan2((corner - fit.point).dot(v), (corner - fit.point).dot(u));
      const double turned = shortest_turn(to - at);
      low = std::min(low, turned);
      high = std::max(high, turned);
    }
    const double width = 2 * kPi / kSectors;
    for (int k = static_cast<int>(std::floor((at + low) / width + 0.01)); k * width < at + high - 0.01 * width; ++k) {
      sectors[((k % kSectors) + kSectors) % kSectors] = 1;
    }
  }
  out.turn = static_cast<double>(std::count(sectors.begin(), sectors.end(), 1)) / kSectors;
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
  out.T_mesh_primitive.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), fit.axis).toRotationMatrix();
  out.T_mesh_primitive.translation() = s.to_mesh(fit.point + 0.5 * (low + high) * fit.axis);
  // A cone slips out of fingers, so it has no width to offer.
  if (out.kind == PrimitiveKind::cylinder) out.widths.push_back({out.size.x(), fit.axis, cover.turn});
  return out;
}

/// Without models on faces that a larger one lies on, too: a wall with slivers, or one that runs into a fillet, leaves
/// points over on which a second, tilted one lies. By area, the largest first.
void drop_doubles(const SegmentSurface& s, std::vector<std::pair<RoundFit, Cover>>& found) {
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.second.area > b.second.area; });
  std::vector<char> taken(s.areas.size(), 0);
  std::vector<std::pair<RoundFit, Cover>> kept;
  for (auto& model : found) {
    double own = 0;
    for (const int f : model.second.faces) own += taken[f] ? 0 : s.areas[f];
    if (own < kLeastOwn * model.second.area) continue;
    for (const int f : model.second.faces) taken[f] = 1;
    kept.push_back(std::move(model));
  }
  found.swap(kept);
}

}  // namespace

void RoundCandidate::trim() {
  if (primitive.kind != PrimitiveKind::cylinder) return;
  primitive.T_mesh_primitive.translation() = wall_middle;
  primitive.size.z() = wall_length;
  primitive.volume = kPi / 4 * primitive.size.x() * primitive.size.y() * wall_length;
}

std::vector<RoundCandidate> round_candidates(const SegmentSurface& s, const Monitor& monitor) {
  std::vector<RoundCandidate> out;
  for (const RoundModel model : {RoundModel::cylinder, RoundModel::cone, RoundModel::sphere}) {
    std::vector<Vector3d> points, normals;
    std::vector<std::pair<RoundFit, Cover>> found;
    const std::size_t stride = 1 + s.points.size() / kMostPoints;
    for (std::size_t i = 0; i < s.points.size(); i += stride) {
      points.push_back(s.points[i]);
      normals.push_back(s.normals[i]);
    }
    for (int round = 0; round < kMostModels && points.size() >= 8 && !monitor.stopped(); ++round) {
      std::vector<int> on = points_on_model(points, normals, model, kOnSurface);
      if (on.size() < 8) break;
      std::vector<Vector3d> p, n;
      std::optional<RoundFit> fit;
      for (int step = 0; step < 3; ++step) {
        pick(points, on, p);
        pick(normals, on, n);
        const std::optional<RoundFit> better = refit(model, p, n);
        if (!better) break;
        std::vector<int> next = points_on(points, normals, *better);
        if (2 * next.size() < on.size()) break;
        fit = better;
        on = std::move(next);
      }
      if (fit) {
        Cover cover = cover_of(s, *fit);
        const bool sphere = fit->kind == RoundFit::Kind::sphere;
        const bool enough =
            sphere ? cover.area > kLeastSphere * 4 * kPi * fit->radius * fit->radius : cover.turn >= kLeastTurn;
        if (enough && cover.area > kLeastShare * s.area) found.emplace_back(*fit, std::move(cover));
      }
      std::vector<char> taken(points.size(), 0);
      for (const int i : on) taken[i] = 1;
      std::vector<Vector3d> rest, rest_normals;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (taken[i]) continue;
        rest.push_back(points[i]);
        rest_normals.push_back(normals[i]);
      }
      if (rest.size() == points.size()) break;
      points.swap(rest);
      normals.swap(rest_normals);
    }
    drop_doubles(s, found);
    for (const auto& [fit, cover] : found) {
      out.push_back({placed(s, fit, cover), s.to_mesh(fit.point + (cover.low + cover.high) / 2 * fit.axis),
                     s.scale * (cover.high - cover.low)});
    }
  }
  return out;
}

}  // namespace mmgrasp::detail
