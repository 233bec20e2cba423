// Depth of overlap by the expanding polytope algorithm (van den Bergen 2001): the difference of the bodies is
// approximated from inside by a polytope whose face nearest to the origin is pushed out until it lies on the surface.

#include <algorithm>
#include <array>
#include <vector>

#include "collision/narrow/convex_clearance.hpp"
#include "collision/narrow/simplex.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

constexpr int kMaxExpansions = 400;

struct Face {
  std::array<int, 3> corner;  // seen from outside against the clock
  Eigen::Vector3d normal;     // unit, outwards
  double offset;              // of its plane from the origin; negative when the origin lies outside
};

/// A polytope inside the difference of two bodies that overlap, grown towards the face nearest to the origin.
class Polytope {
 public:
  Polytope(const Convex& a, const Convex& b, const Rigid& b_in_a) : a_(a), b_(b), b_in_a_(b_in_a) {}

  // Corner of the difference farthest along d.
  SimplexPoint support(const Eigen::Vector3d& d) const {
    SimplexPoint p;
    p.on_a = a_.support(d);
    p.on_b = b_in_a_ * b_.support(b_in_a_.R.transpose() * -d);
    p.w = p.on_a - p.on_b;
    return p;
  }

  // A first tetrahedron of corners far apart. False when the difference is flat: `flat_normal` is a direction in which
  // it has no extent.
  bool start(Eigen::Vector3d& flat_normal) {
    double widest = 0;
    for (int k = 0; k < 3; ++k) {
      const SimplexPoint low = support(-Eigen::Vector3d::Unit(k)), high = support(Eigen::Vector3d::Unit(k));
      const double width = (high.w - low.w).norm();
      scale_ = std::max(scale_, std::max(low.w.norm(), high.w.norm()));
      if (width <= widest) continue;
      widest = width;
      points_ = {low, high};
    }
    const double tiny = 1e-9 * scale_;
    flat_normal = Eigen::Vector3d::UnitX();
    if (widest <= tiny) return false;
    const Eigen::Vector3d line = (points_[1].w - points_[0].w).normalized();
    const Eigen::Vector3d side = line.unitOrthogonal(), other = line.cross(side);
    flat_normal = side;
    if (!add_farthest(
            {side, -side, other, -other},
            [&](const Eigen::Vector3d& w) { return (w - points_[0].w).cross(line).norm(); }, tiny))
      return false;
    const Eigen::Vector3d normal = line.cross(points_[2].w - points_[0].w).normalized();
    flat_normal = normal;
    if (!add_farthest(
            {normal, -normal}, [&](const Eigen::Vector3d& w) { return std::abs(normal.dot(w - points_[0].w)); }, tiny))
      return false;
    const bool above = normal.dot(points_[3].w - points_[0].w) > 0;
    const std::array<std::array<int, 3>, 4> corners =
        above ? std::array<std::array<int, 3>, 4>{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}}
              : std::array<std::array<int, 3>, 4>{{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
    for (const auto& c : corners) add_face(c);
    return faces_.size() == 4;
  }

  const Face& nearest() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < faces_.size(); ++i) {
      if (faces_[i].offset < faces_[best].offset) best = i;
    }
    return faces_[best];
  }

  // Takes in a point beyond a face: the faces that see it go, new ones join it to the rim they leave. False, with
  // nothing changed, when rounding leaves no proper rim.
  bool expand(const SimplexPoint& p) {
    const std::array<int, 3> from = nearest().corner;
    seen_.clear();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const Face face = faces_[i];
      if (face.normal.dot(p.w) - face.offset <= 1e-13 * scale_)
        faces_[kept++] = face;
      else
        seen_.push_back(face);
    }
    faces_.resize(kept);
    find_rim();
    // Faces that hang together have a rim of at most two edges more than they are. Where rounding lets others, apart
    // from them, see the point, each would get a rim of its own, and the faces become three times as many every time.
    if (rim_.size() > seen_.size() + 2) {
      keep_what_is_apart_from(from);
      kept = faces_.size();
      find_rim();
    }
    const int corner = static_cast<int>(points_.size());
    points_.push_back(p);
    for (const auto& edge : rim_) add_face({edge[0], edge[1], corner});
    const bool is_proper = rim_.size() >= 3 && rim_.size() <= seen_.size() + 2;
    if (is_proper && faces_.size() == kept + rim_.size()) return true;
    faces_.resize(kept);
    faces_.insert(faces_.end(), seen_.begin(), seen_.end());
    return false;
  }

  // The point of the surface nearest to the origin, on both bodies. Of several faces in one plane only one holds it.
  void witness(Eigen::Vector3d& on_a, Eigen::Vector3d& on_b) const {
    const double offset = nearest().offset;
    double least = kInfinity;
    for (const Face& face : faces_) {
      if (face.offset > offset + 1e-9 * scale_) continue;
      Simplex simplex;
      for (const int c : face.corner) simplex.add(points_[c]);
      simplex.reduce();
      if (simplex.closest().squaredNorm() >= least) continue;
      least = simplex.closest().squaredNorm();
      simplex.witness(on_a, on_b);
    }
  }

  double scale() const { return scale_; }

 private:
  template <class Measure>
  bool add_farthest(std::initializer_list<Eigen::Vector3d> directions, const Measure& measure, double tiny) {
    SimplexPoint best;
    double most = 0;
    for (const Eigen::Vector3d& d : directions) {
      const SimplexPoint p = support(d);
      const double far = measure(p.w);
      if (far > most) most = far, best = p;
    }
    if (most <= tiny) return false;
    points_.push_back(best);
    return true;
  }

  void add_face(const std::array<int, 3>& c) {
    const Eigen::Vector3d& p = points_[c[0]].w;
    const Eigen::Vector3d normal = (points_[c[1]].w - p).cross(points_[c[2]].w - p);
    const double area = normal.norm();
    if (!(area > 1e-16 * scale_ * scale_)) return;
    faces_.push_back({c, normal / area, normal.dot(p) / area});
  }

  void find_rim() {
    rim_.clear();
    for (const Face& face : seen_)
      for (int e = 0; e < 3; ++e) cross_edge(face.corner[e], face.corner[(e + 1) % 3]);
  }

  // Faces that see a point stay seen only where they hang together with one of them, by its corners.
  void keep_what_is_apart_from(const std::array<int, 3>& from) {
    const auto first = std::find_if(seen_.begin(), seen_.end(), [&](const Face& face) { return face.corner == from; });
    if (first == seen_.end()) return;
    std::iter_swap(seen_.begin(), first);
    std::size_t together = 1;  // of them, those in front
    for (std::size_t done = 0; done < together; ++done) {
      for (std::size_t i = together; i < seen_.size(); ++i) {
        if (share_an_edge(seen_[done], seen_[i])) std::swap(seen_[i], seen_[together++]);
      }
    }
    faces_.insert(faces_.end(), seen_.begin() + static_cast<std::ptrdiff_t>(together), seen_.end());
    seen_.resize(together);
  }

  static bool share_an_edge(const Face& a, const Face& b) {
    int shared = 0;
    for (const int corner : a.corner) shared += std::count(b.corner.begin(), b.corner.end(), corner) > 0;
    return shared == 2;
  }

  // An edge crossed in both directions lies between two faces that go: only edges crossed once are the rim.
  void cross_edge(int from, int to) {
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      if (rim_[i][0] != to || rim_[i][1] != from) continue;
      rim_[i] = rim_.back();
      rim_.pop_back();
      return;
    }
    rim_.push_back({from, to});
  }

  const Convex &a_, &b_;
  const Rigid& b_in_a_;
  std::vector<SimplexPoint> points_;
  std::vector<Face> faces_, seen_;
  std::vector<std::array<int, 2>> rim_;
  double scale_ = 0;
};

}  // namespace

ConvexClearance convex_penetration(const Convex& a, const Convex& b, const Rigid& b_in_a) {
  Polytope polytope(a, b, b_in_a);
  ConvexClearance clearance;
  double depth = kInfinity;
  Eigen::Vector3d outward = Eigen::Vector3d::UnitX();
  if (!polytope.start(outward)) {
    // Cores without volume (points, segments): they meet, and any shift out of their common plane parts them.
    const SimplexPoint p = polytope.support(outward);
    depth = std::max(0.0, outward.dot(p.w));
    clearance.on_a = p.on_a;
    clearance.on_b = p.on_a - depth * outward;
  } else {
    const double accuracy = 1e-12 * polytope.scale();
    for (int i = 0; i < kMaxExpansions; ++i) {
      const Face face = polytope.nearest();
      const SimplexPoint p = polytope.support(face.normal);
      const double height = face.normal.dot(p.w);  // no shift along this normal parts them sooner
      if (height < depth) {
        depth = height;
        outward = face.normal;
      }
      if (height - face.offset <= accuracy || !polytope.expand(p)) break;
    }
    depth = std::max(0.0, depth);
    polytope.witness(clearance.on_a, clearance.on_b);
    clearance.on_b = clearance.on_a - depth * outward;
  }
  clearance.distance = -depth - a.radius - b.radius;
  clearance.normal = -outward;
  clearance.on_a -= a.radius * clearance.normal;
  clearance.on_b += b.radius * clearance.normal;
  return clearance;
}

}  // namespace mmgrasp::detail
