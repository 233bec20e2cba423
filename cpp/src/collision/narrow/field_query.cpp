// Bodies against distance fields: branch and bound over the pieces of a body. The true distance changes by at most the
// way walked, so one value proves a whole sphere.
#include "collision/narrow/field_query.hpp"

#include <algorithm>
#include <cmath>

#include "collision/narrow/field_body.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

namespace {

using Eigen::Vector3d;

constexpr int kBatch = 16;           // points of one call of the field
constexpr int kOverlapBatches = 32;  // examined once a body overlaps: its deepest points may fill a surface

/// Values at up to kBatch points. Matrices of every size are kept, since fields take whole ones.
class Samples {
 public:
  void clear() { count_ = 0; }
  int count() const { return count_; }
  void add(const Vector3d& point) { points_[count_++] = point; }
  void evaluate(const DistanceField& field) {
    if (count_ == 0) return;
    Eigen::Matrix3Xd& at = matrices_[count_];
    at.resize(3, count_);
    for (int i = 0; i < count_; ++i) at.col(i) = points_[i];
    distances_ = field.distances(at, gradients_);
  }
  double distance(int i) const { return distances_[i]; }
  Vector3d gradient(int i) const { return gradients_.col(i); }

 private:
  Vector3d points_[kBatch];
  Eigen::Matrix3Xd matrices_[kBatch + 1], gradients_;
  Eigen::VectorXd distances_;
  int count_ = 0;
};

/// A convex part of the body: the sphere around its middle holds it.
struct Region {
  enum class Kind { whole, node, simplex, box, inside };
  Region() { corners.fill(Vector3d::Zero()); }
  double lower = -kInfinity;  ///< No value in it is below this.
  Kind kind = Kind::node;
  int node = 0, count = 0;          ///< Node of the tree; number of a simplex's corners.
  std::array<Vector3d, 4> corners;  ///< Corners of a simplex, in the body's frame.
  Eigen::AlignedBox3d box;          ///< Box of what is no simplex, in the body's frame.
  bool operator<(const Region& other) const { return lower > other.lower; }
};

/// Looks for the least value of the field over a body, in the field's frame.
class Search {
 public:
  Search(const Solid& solid, const Rigid& body_in_field, const FieldView& view)
      : body_(solid.field_body()),
        T_(body_in_field),
        view_(view),
        heap_(scratch().heap),
        samples_(scratch().samples),
        one_(scratch().one) {
    heap_.clear();
  }

  void let_unknown_pass(bool pass) { unknown_passes_ = pass; }

  /// False proves that no value is `level` or less.
  bool falls_to(double level) {
    best_ = level;
    slack_ = 0;
    decide_ = true;
    return run();
  }

  /// The least value to `slack` [m], if it is below `bound`, and where it is.
  bool least(double bound, double slack) {
    best_ = bound;
    slack_ = slack;
    decide_ = false;
    run();
    return found_;
  }
  double value() const { return best_; }
  const Vector3d& where() const { return where_; }
  const Vector3d& gradient() const { return gradient_; }

 private:
  struct Looked {
    Region region;
    Vector3d middle, value_at;
    double radius = 0;
  };

  /// Kept from one search to the next, so that most allocate nothing.
  struct Scratch {
    std::vector<Region> heap;
    Samples samples, one;
  };
  static Scratch& scratch() {
    thread_local Scratch kept;
    return kept;
  }

  double target() const { return best_ - slack_; }

  void push(Region region) {
    heap_.push_back(std::move(region));
    std::push_heap(heap_.begin(), heap_.end());
  }

  bool run() {
    Region root;
    const BoxTree::Node& node = body_.tree().nodes()[0];
    root.box = {Vector3d(node.centre - node.half), Vector3d(node.centre + node.half)};
    if (!body_.corners().empty()) root.kind = Region::Kind::whole;
    push(root);
    if (body_.hollow()) {
      root.kind = Region::Kind::inside;
      push(root);
    }
    Looked looked[kBatch];
    int overlapping = 0;
    while (!heap_.empty() && overlapping < kOverlapBatches) {
      overlapping += found_ && best_ < 0;
      int count = 0;
      samples_.clear();
      while (count < kBatch && !heap_.empty() && beats(heap_.front().lower)) {
        std::pop_heap(heap_.begin(), heap_.end());
        look(looked[count], std::move(heap_.back()));
        heap_.pop_back();
        if (view_.unknown_is_free && outside(looked[count])) continue;
        samples_.add(looked[count].value_at);
        ++count;
      }
      if (count == 0 && (heap_.empty() || !beats(heap_.front().lower))) return false;
      samples_.evaluate(*view_.field);
      for (int i = 0; i < count; ++i) {
        if (judge(looked[i], i) && decide_) return true;
      }
    }
    return false;
  }

  bool beats(double lower) const { return decide_ ? lower <= best_ : lower < target(); }

  void look(Looked& out, Region region) const {
    Eigen::AlignedBox3d box;
    if (region.kind == Region::Kind::whole) {
      out.middle = body_.middle();
      out.radius = 0;
      for (const Vector3d& corner : body_.corners()) out.radius = std::max(out.radius, (corner - out.middle).norm());
    } else if (region.kind == Region::Kind::simplex) {
      out.middle.setZero();
      for (int i = 0; i < region.count; ++i) out.middle += region.corners[i] / region.count;
      out.radius = 0;
      for (int i = 0; i < region.count; ++i) out.radius = std::max(out.radius, (region.corners[i] - out.middle).norm());
    } else {
      out.middle = region.box.center();
      out.radius = 0.5 * region.box.diagonal().norm();
    }
    out.middle = T_ * out.middle;
    out.region = std::move(region);
    // The part of the region that lies in the domain is no farther from the nearest point of the domain.
    const Eigen::AlignedBox3d& domain = view_.properties.domain;
    out.value_at = out.middle.cwiseMax(domain.min()).cwiseMin(domain.max());
  }

  bool outside(const Looked& looked) const {
    const Eigen::AlignedBox3d& domain = view_.properties.domain;
    bool out[6] = {true, true, true, true, true, true};
    corners(looked, [&](const Vector3d& corner) {
      for (int k = 0; k < 3; ++k) {
        out[k] = out[k] && corner[k] < domain.min()[k];
        out[3 + k] = out[3 + k] && corner[k] > domain.max()[k];
      }
    });
    return std::any_of(out, out + 6, [](bool beyond) { return beyond; });
  }

  template <class Visit>
  void corners(const Looked& looked, const Visit& visit) const {
    const Region& region = looked.region;
    if (region.kind == Region::Kind::whole) {
      for (const Vector3d& corner : body_.corners()) visit(T_ * corner);
      return;
    }
    if (region.kind == Region::Kind::simplex) {
      for (int i = 0; i < region.count; ++i) visit(T_ * region.corners[i]);
      return;
    }
    for (int i = 0; i < 8; ++i) visit(T_ * region.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }

  /// Where what the field does not know is an obstacle, it is as near as the end of the domain.
  double with_unknown(double value, const Vector3d& point) const {
    if (view_.unknown_is_free) return value;
    const Eigen::AlignedBox3d& domain = view_.properties.domain;
    return std::min(value, std::min((point - domain.min()).minCoeff(), (domain.max() - point).minCoeff()));
  }

  bool known_inside(const Looked& looked) const {
    switch (looked.region.kind) {
      case Region::Kind::whole:
      case Region::Kind::simplex:
      case Region::Kind::box:
        return true;
      case Region::Kind::node:
        return false;
      case Region::Kind::inside:
        break;
    }
    return body_.contains(looked.region.box.center());
  }

  /// True: a point of the body has a value of `best_` or less, or none can be distinguished from it.
  bool judge(const Looked& looked, int sample) {
    const double raw = samples_.distance(sample);
    const bool known = !std::isnan(raw), in_domain = looked.value_at == looked.middle;
    if (!known && !view_.unknown_is_free && known_inside(looked)) return take(0, looked.middle, Vector3d::Zero());
    double value = known ? with_unknown(raw, looked.value_at) : -kInfinity;
    if (!in_domain && !view_.unknown_is_free) value = -(looked.middle - looked.value_at).norm();
    const bool witness = known && (in_domain || !view_.unknown_is_free);
    if (witness && value <= best_ && known_inside(looked)) {
      if (take(value, looked.middle, samples_.gradient(sample)) && decide_) return true;
    }
    if (witness && in_domain && descend(looked, value, samples_.gradient(sample)) && decide_) return true;
    const double lower = std::max(looked.region.lower, known ? value - looked.radius : -kInfinity);
    if (!beats(lower)) return false;
    if (known && in_domain && lifted(looked, value, samples_.gradient(sample))) return false;
    if (looked.radius <= 0.5 * view_.resolution) {
      // A node or a cell too small to be distinguished from what it holds.
      if (!known && view_.unknown_is_free && unknown_passes_) return false;
      return take(known ? std::min(value, best_) : 0, looked.middle,
                  known ? samples_.gradient(sample) : Vector3d(0, 0, 0));
    }
    split(looked.region, lower);
    return false;
  }

  /// Looks at the corner of a piece that lies farthest down the gradient, where most pieces are lowest.
  bool descend(const Looked& looked, double value, const Vector3d& gradient) {
    if (looked.region.kind == Region::Kind::node || looked.region.kind == Region::Kind::inside) return false;
    Vector3d lowest = looked.middle;
    double change = 0;
    corners(looked, [&](const Vector3d& corner) {
      const double down = gradient.dot(corner - looked.middle);
      if (down >= change) return;
      change = down;
      lowest = corner;
    });
    if (!(value + change <= best_) || change == 0) return false;
    one_.clear();
    one_.add(lowest);
    one_.evaluate(*view_.field);
    const double there = one_.distance(0);
    if (std::isnan(there)) return false;
    return take(with_unknown(there, lowest), lowest, one_.gradient(0));
  }

  bool take(double value, const Vector3d& where, const Vector3d& gradient) {
    if (!(value <= best_)) return false;
    best_ = value;
    where_ = where;
    gradient_ = gradient;
    found_ = true;
    return true;
  }

  /// Whether a sphere about a point farther from the surface holds the region: what lies beyond a plane needs one such
  /// sphere only, where spheres about its own points would be many.
  bool lifted(const Looked& looked, double value, const Vector3d& gradient) const {
    double lowest = kInfinity;
    corners(looked, [&](const Vector3d& corner) { lowest = std::min(lowest, gradient.dot(corner - looked.middle)); });
    const double room = value + lowest - target();
    if (!(room > 1e-12) || gradient.squaredNorm() < 0.5) return false;
    const double way = 0.6 * looked.radius * looked.radius / room + looked.radius;
    const Vector3d from = looked.middle + way * gradient;
    if (!(way < 1e3) || !view_.properties.domain.contains(from)) return false;
    const double there = with_unknown(view_.field->distance(from), from);
    double farthest = 0;
    corners(looked, [&](const Vector3d& corner) { farthest = std::max(farthest, (corner - from).norm()); });
    return there - farthest > target();
  }

  void split(const Region& region, double lower) {
    switch (region.kind) {
      case Region::Kind::whole: {
        Region root = region;
        root.lower = lower;
        root.kind = Region::Kind::node;
        push(root);
        return;
      }
      case Region::Kind::node: {
        const BoxTree::Node& node = body_.tree().nodes()[region.node];
        if (node.count == 0) {
          for (int child = node.first; child < node.first + 2; ++child) {
            const BoxTree::Node& at = body_.tree().nodes()[child];
            Region part;
            part.lower = lower;
            part.node = child;
            part.box = {Vector3d(at.centre - at.half), Vector3d(at.centre + at.half)};
            push(part);
          }
          return;
        }
        for (int i = node.first; i < node.first + node.count; ++i) {
          const FieldBody::Piece piece = body_.piece(i);
          Region part;
          part.lower = lower;
          part.kind = piece.count == 0 ? Region::Kind::box : Region::Kind::simplex;
          part.count = piece.count;
          part.corners = piece.corners;
          part.box = piece.box;
          push(part);
        }
        return;
      }
      case Region::Kind::simplex:
        split_simplex(region, lower);
        return;
      case Region::Kind::box:
      case Region::Kind::inside:
        split_box(region, lower);
        return;
    }
  }

  void split_simplex(const Region& region, double lower) {
    int from = 0, to = 0;
    double longest = -1;
    for (int i = 0; i < region.count; ++i)
      for (int j = i + 1; j < region.count; ++j) {
        const double length = (region.corners[i] - region.corners[j]).squaredNorm();
        if (length > longest) {
          longest = length;
          from = i;
          to = j;
        }
      }
    Region half = region;
    half.lower = lower;
    half.corners[from] = half.corners[to] = 0.5 * (region.corners[from] + region.corners[to]);
    half.corners[from] = region.corners[from];
    push(half);
    half.corners[from] = half.corners[to];
    half.corners[to] = region.corners[to];
    push(half);
  }

  void split_box(const Region& region, double lower) {
    Eigen::Index axis = 0;
    region.box.sizes().maxCoeff(&axis);
    Region half = region;
    half.lower = lower;
    const double middle = region.box.center()[axis];
    for (const bool upper : {false, true}) {
      half.box = region.box;
      (upper ? half.box.min() : half.box.max())[axis] = middle;
      if (region.kind != Region::Kind::inside || body_.meets(half.box)) push(half);
    }
  }

  const FieldBody& body_;
  const Rigid T_;
  const FieldView& view_;
  std::vector<Region>& heap_;
  Samples &samples_, &one_;
  double best_ = 0, slack_ = 0;
  bool decide_ = true, found_ = false;
  bool unknown_passes_ = false;  ///< Where nothing is asked beyond the body itself, unknown points of it are free.
  Vector3d where_ = Vector3d::Zero(), gradient_ = Vector3d::Zero();
};

}  // namespace

FieldView::FieldView(const FieldObstacle& obstacle)
    : field(obstacle.field),
      properties(obstacle.field->properties()),
      resolution(obstacle.resolution),
      unknown_is_free(obstacle.unknown_is_free) {}

std::shared_ptr<const Solid> make_field_solid(const FieldObstacle& obstacle, double padding) {
  auto solid = std::make_shared<Solid>();
  solid->kind = SolidKind::field;
  solid->margin = padding;
  solid->field = std::make_shared<const FieldView>(obstacle);
  solid->box_half.setConstant(kInfinity);
  solid->sphere_radius = kInfinity;
  return solid;
}

double field_clearance(const FieldView& field, const Eigen::Vector3d& centre, double radius) {
  const Eigen::AlignedBox3d& domain = field.properties.domain;
  const Eigen::Vector3d inside = centre.cwiseMax(domain.min()).cwiseMin(domain.max());
  const double value = field.field->distance(inside);
  if (std::isnan(value)) return -kInfinity;
  const double lower = value - field.properties.error - radius;
  if (field.unknown_is_free) return lower;
  if (inside != centre) return -kInfinity;
  return std::min({lower, (centre - domain.min()).minCoeff() - radius, (domain.max() - centre).minCoeff() - radius});
}

bool field_collides(const Solid& body, const Rigid& T_body, const FieldView& field, const Rigid& T_field, double more) {
  if (body.never_collides()) return false;
  const Rigid body_in_field = T_field.to(T_body);
  if (field_clearance(field, body_in_field * body.sphere_centre, body.sphere_radius) > more) return false;
  const double grown = body.field_body().radius() + body.margin + more;
  Search search(body, body_in_field, field);
  search.let_unknown_pass(grown == 0);
  return search.falls_to(grown + field.properties.error);
}

SolidClearance field_distance(const Solid& body, const Rigid& T_body, const FieldView& field, const Rigid& T_field,
                              double bound) {
  SolidClearance out;
  if (body.never_collides()) return out;
  // What the field may be off, what the search leaves open and the rounding of the body lie between value and distance.
  const double radius = body.field_body().radius(), off = radius + field.properties.error + field.resolution;
  Search search(body, T_field.to(T_body), field);
  if (!search.least(bound + off, field.resolution)) return out;
  out.distance = search.value() - off;
  const Eigen::Vector3d gradient = search.gradient();
  if (gradient.squaredNorm() > 0) out.normal = T_field.R * gradient.normalized();
  out.on_a = T_field * search.where() - radius * out.normal;
  out.on_b = out.on_a - out.distance * out.normal;
  return out;
}

}  // namespace mmgrasp::detail
