#include "trajopt/collision_terms.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "mmgrasp/core/detail/numbers.hpp"
#include "trajopt/whole_body_check.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kRegular = 3;          // samples of each interval
constexpr double kFar = 2.0;         // distance up to which bodies that have to be separated are checked [m]
constexpr int kFiner = 10;           // when looking for collisions
constexpr double kLeastRoom = 2e-4;  // the check takes gaps below 1e-4 m for contact
constexpr double kCorners = 1.75;    // a padded body's corners are this much farther out than its faces

VectorXd at_sample(const WholeBodyTrajectory& t, int interval, double s) {
  const std::size_t i = interval;
  return s == 0 ? t.positions()[i] : t.at(t.times()[i] + s * (t.times()[i + 1] - t.times()[i]));
}

/// The point p of a link, in the world.
Eigen::Vector3d point_on(const ToolChain::State& link, const Eigen::Vector3d& p) {
  return link.p + link.rotation * p;
}

double separation(const SeparatingPlane& plane, const VectorXd& q) {
  ToolChain::State link;
  const auto placed = [&](const std::shared_ptr<const ToolChain>& chain, const Eigen::Vector3d& p) {
    if (!chain) return p;
    chain->evaluate(q.data(), link);
    return point_on(link, p);
  };
  return plane.normal.dot(placed(plane.a, plane.p_a) - placed(plane.b, plane.p_b));
}

/// Bodies that lie face to face touch at no point of their own: each answer names another, and a plane through that one
/// alone lets them tilt about it. So planes of one face add up, those of other faces go.
void add_plane(std::vector<SeparatingPlane>& planes, const SeparatingPlane& plane) {
  constexpr double kSameFace = 0.95, kSamePoint = 2e-3;  // cosine between normals; [m]
  planes.erase(std::remove_if(planes.begin(), planes.end(),
                              [&](const SeparatingPlane& other) {
                                return other.normal.dot(plane.normal) < kSameFace ||
                                       ((other.p_a - plane.p_a).norm() < kSamePoint &&
                                        (other.p_b - plane.p_b).norm() < kSamePoint);
                              }),
               planes.end());
  planes.push_back(plane);
}

/// Planes between bodies in one configuration.
class PlaneMaker {
 public:
  PlaneMaker(CollisionChecker& checker, const VectorXd& q, std::map<int, std::shared_ptr<const ToolChain>>& chains)
      : checker_(checker), q_(q), chains_(chains) {
    checker.group().link_poses(q, T_world_link_);
  }
  const VectorXd& q() const { return q_; }
  std::vector<DistanceResult> distances(double within) { return checker_.distances(q_, within); }
  SeparatingPlane plane(const DistanceResult& d, double margin) const {
    SeparatingPlane plane;
    std::tie(plane.a, plane.p_a) = on_link(d.a, d.point_a);
    if (d.with_scene)
      plane.p_b = d.point_b;
    else
      std::tie(plane.b, plane.p_b) = on_link(d.b, d.point_b);
    plane.normal = (d.point_a - d.point_b) / d.value;
    plane.margin = margin;
    return plane;
  }

 private:
  /// The chain to the link that a body belongs to, and the point in its frame.
  std::pair<std::shared_ptr<const ToolChain>, Eigen::Vector3d> on_link(const std::string& body,
                                                                       const Eigen::Vector3d& p_world) const {
    const auto& attached = checker_.world().attached();
    const auto held = attached.find(body);
    const JointGroup& group = checker_.group();
    const int link = group.robot().link_index(held == attached.end() ? body : held->second.link);
    std::shared_ptr<const ToolChain>& chain = chains_[link];
    if (!chain) chain = std::make_shared<const ToolChain>(group, link);
    return {chain, T_world_link_[link].inverse() * p_world};
  }

  CollisionChecker& checker_;
  VectorXd q_;
  std::map<int, std::shared_ptr<const ToolChain>>& chains_;
  Poses T_world_link_;
};

}  // namespace

CollisionTerm::CollisionTerm(const IntervalPoint& point, std::vector<SeparatingPlane> planes)
    : point_(point), planes_(std::move(planes)) {
  kind = "collision";
  const Eigen::Index rows = static_cast<Eigen::Index>(planes_.size());
  lower.resize(rows);
  for (Eigen::Index i = 0; i < rows; ++i) lower[i] = planes_[i].margin;
  upper = VectorXd::Constant(rows, kInfinity);
  for (const SeparatingPlane& plane : planes_) links_.push_back({index_of(plane.a), index_of(plane.b)});
  place_.links.resize(chains_.size());
}

int CollisionTerm::index_of(const std::shared_ptr<const ToolChain>& chain) {
  if (!chain) return -1;
  const auto known = std::find(chains_.begin(), chains_.end(), chain);
  const int index = static_cast<int>(known - chains_.begin());
  if (known == chains_.end()) chains_.push_back(chain);
  return index;
}

const CollisionTerm::Place& CollisionTerm::placed(const double* x) const {
  const Eigen::Map<const VectorXd> locals(x, point_.locals());
  if (place_.x.size() > 0 && place_.x == locals) return place_;
  place_.x = locals;
  const VectorXd q = point_.q(x);
  for (std::size_t i = 0; i < chains_.size(); ++i) chains_[i]->evaluate(q.data(), place_.links[i]);
  return place_;
}

void CollisionTerm::value(const double* x, double* out) const {
  const Place& place = placed(x);
  for (std::size_t r = 0; r < planes_.size(); ++r) {
    const SeparatingPlane& plane = planes_[r];
    const Eigen::Vector3d p_a = point_on(place.links[links_[r].a], plane.p_a);
    const Eigen::Vector3d p_b = links_[r].b < 0 ? plane.p_b : point_on(place.links[links_[r].b], plane.p_b);
    *out++ = plane.normal.dot(p_a - p_b);
  }
}

void CollisionTerm::jacobian(const double* x, double* out) const {
  const Place& place = placed(x);
  const MatrixXd D = point_.jacobian(x);
  VectorXd gradient(point_.columns());
  for (std::size_t r = 0; r < planes_.size(); ++r) {
    gradient.setZero();
    const auto add = [&](int i, const Eigen::Vector3d& p, double sign) {
      if (i < 0) return;
      const ToolChain::State& link = place.links[i];
      const Eigen::Vector3d along = sign * planes_[r].normal, moment = (link.rotation * p).cross(along);
      for (std::size_t j = 0; j < link.v.size(); ++j)
        gradient[chains_[i]->steps()[j].column] += along.dot(link.v[j]) + moment.dot(link.w[j]);
    };
    add(links_[r].a, planes_[r].p_a, 1);
    add(links_[r].b, planes_[r].p_b, -1);
    Eigen::Map<VectorXd>(out + static_cast<Eigen::Index>(r) * D.cols(), D.cols()) = D.transpose() * gradient;
  }
}

void CollisionTerm::hessian(const double* x, const double* multipliers, double* out) const {
  const Place& place = placed(x);
  VectorXd gradient = VectorXd::Zero(point_.columns());
  MatrixXd curvature = MatrixXd::Zero(point_.columns(), point_.columns());
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    // All planes pull at a link with one force and, from its origin, one matrix of arms times forces.
    const ToolChain::State& link = place.links[i];
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force;
    Eigen::Matrix3d arms = Eigen::Matrix3d::Zero();
    const auto pull = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& f) {
      const Eigen::Vector3d arm = link.rotation * p;
      force += f;
      moment += arm.cross(f);
      arms += arm * f.transpose();
    };
    for (std::size_t r = 0; r < planes_.size(); ++r) {
      if (links_[r].a == static_cast<int>(i)) pull(planes_[r].p_a, multipliers[r] * planes_[r].normal);
      if (links_[r].b == static_cast<int>(i)) pull(planes_[r].p_b, -multipliers[r] * planes_[r].normal);
    }
    const auto column = [&](std::size_t j) { return chains_[i]->steps()[j].column; };
    for (std::size_t j = 0; j < link.v.size(); ++j) {
      gradient[column(j)] += force.dot(link.v[j]) + moment.dot(link.w[j]);
      const Eigen::Vector3d turned = arms.transpose() * link.w[j] - arms.trace() * link.w[j];
      for (std::size_t k = j; k < link.v.size(); ++k) {
        // w_j x (v_k + w_k x arm) . force
        const double second = force.dot(ToolChain::second(link, j, k)) + turned.dot(link.w[k]);
        curvature(column(j), column(k)) += second;
        if (j != k) curvature(column(k), column(j)) += second;
      }
    }
  }
  const MatrixXd D = point_.jacobian(x);
  MatrixXd H = D.transpose() * curvature * D;
  point_.add_curvature(x, gradient, H);
  for (Eigen::Index i = 0; i < H.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) *out++ = H(i, j);
}

CollisionRows::CollisionRows(std::vector<CollisionChecker*> checkers, std::vector<int> pinned, double margin,
                             double constraint_distance)
    : checkers_(std::move(checkers)),
      pinned_(std::move(pinned)),
      margin_(margin),
      constraint_distance_(constraint_distance) {
  for (CollisionChecker* checker : checkers_) {
    if (!checker || bodies_.count(checker) > 0) continue;
    padding_ = std::max(padding_, 2 * checker->world().padding().most() + checker->options().padding);
    bodies_.emplace(checker, BodyPadding(checker->group().robot(), checker->world()));
  }
}

bool CollisionRows::look_along(const WholeBodyTrajectory& trajectory) {
  constexpr double kLast = 0.98;  // the end of an interval is the next one's
  bool collides = false;
  for (int i = 0; i < static_cast<int>(checkers_.size()); ++i) {
    CollisionChecker* checker = checkers_[i];
    if (!checker) continue;
    for (int k = 0; k <= kFiner; ++k) {
      const double s = static_cast<double>(k) / kFiner;
      const VectorXd q = at_sample(trajectory, i, s);
      if (checker->is_free(q) || !checker->first_contact(q)) continue;
      collides = true;
      if (k < kFiner) samples_.insert({i, s});
      watch_at(*checker, q);
    }
  }
  if (!collides) {
    for (const auto& [i, s] : collision_places(trajectory, checkers_)) {
      collides = true;
      samples_.insert({i, std::min(s, kLast)});
      watch_at(*checkers_[i], at_sample(trajectory, i, s));
    }
  }
  if (collides) take_planes(trajectory);
  return collides;
}

void CollisionRows::watch_at(CollisionChecker& checker, const VectorXd& q) {
  const double within = margin_ + 1e-3;
  for (const DistanceResult& d : checker.distances(q, within + kCorners * padding_)) {
    if (d.value < within + kCorners * padding_of(checker, d)) watch(checker, d);
  }
  for (const Contact& c : padding_ > 0 ? checker.contacts(q) : std::vector<Contact>{})
    if (c.by_padding) corners_.insert({c.with_scene, c.a, c.b});
}

void CollisionRows::keep_clear(const std::vector<VectorXd>& positions, bool keeps_sides) {
  reference_ = positions;
  for (int i = 0; i < static_cast<int>(checkers_.size()); ++i) {
    CollisionChecker* checker = checkers_[i];
    if (!checker) continue;
    for (const DistanceResult& d : checker->distances(positions[i], constraint_distance_ + kCorners * padding_))
      if (d.with_scene && d.gradient.cwiseAbs().maxCoeff() > 0) watch(*checker, d);
  }
  const std::map<Pair, double> rooms = rooms_along(positions);
  for (const Sample& sample : regular_samples()) take_planes_at(sample, reference(sample), rooms);
  if (!keeps_sides) reference_.clear();
}

std::map<CollisionRows::Pair, double> CollisionRows::rooms_along(const std::vector<VectorXd>& positions) {
  std::map<Pair, double> rooms;
  for (const Pair& pair : watched_) rooms[pair] = margin_ + kept_apart(pair);
  for (int waypoint : pinned_) {
    const int interval = std::min(waypoint, static_cast<int>(checkers_.size()) - 1);
    CollisionChecker* checker = checkers_[interval];
    if (!checker) continue;
    const VectorXd& q = positions[waypoint];
    for (const DistanceResult& d : checker->distances(q, 2 * margin_ + kCorners * padding_ + 1e-6)) {
      const Pair pair{d.with_scene, d.a, d.b};
      const auto room = rooms.find(pair);
      if (room == rooms.end() || d.value <= 0) continue;
      const double padding = std::min(kept_apart(pair), d.value - kLeastRoom);
      room->second = std::min(room->second, padding + 0.5 * (d.value - padding));
    }
  }
  for (auto& [pair, room] : rooms) room = std::max(room, kLeastRoom);
  return rooms;
}

double CollisionRows::padding_of(const CollisionChecker& checker, const DistanceResult& d) const {
  if (padding_ == 0 || !d.with_scene) return 0;
  const BodyPadding& bodies = bodies_.at(&checker);
  const bool held = checker.world().attached().count(d.a) > 0;
  return bodies.object(d.b) + (held ? bodies.attached(d.a) : std::max(checker.options().padding, bodies.link(d.a)));
}

void CollisionRows::watch(const CollisionChecker& checker, const DistanceResult& d) {
  const Pair pair{d.with_scene, d.a, d.b};
  watched_.insert(pair);
  const double padding = padding_of(checker, d);
  if (padding > 0) paddings_[pair] = std::max(paddings_[pair], padding);
}

double CollisionRows::kept_apart(const Pair& pair) const {
  const auto padding = paddings_.find(pair);
  if (padding == paddings_.end()) return 0;
  return padding->second * (corners_.count(pair) > 0 ? kCorners : 1);
}

std::set<CollisionRows::Sample> CollisionRows::regular_samples() const {
  std::set<Sample> samples;
  for (int i = 0; i < static_cast<int>(checkers_.size()); ++i)
    for (int k = 0; k < kRegular; ++k) samples.insert({i, static_cast<double>(k) / kRegular});
  return samples;
}

VectorXd CollisionRows::reference(const Sample& sample) const {
  const auto& [i, s] = sample;
  const std::size_t at = i;
  return (1 - s) * reference_[at] + s * reference_[at + 1];
}

void CollisionRows::take_planes(const WholeBodyTrajectory& trajectory) {
  const std::map<Pair, double> rooms = rooms_along(trajectory.positions());
  std::set<Sample> samples = regular_samples();
  samples.insert(samples_.begin(), samples_.end());
  for (const Sample& sample : samples)
    take_planes_at(sample, at_sample(trajectory, sample.first, sample.second), rooms);
}

void CollisionRows::take_planes_at(const Sample& sample, const VectorXd& q, const std::map<Pair, double>& rooms) {
  CollisionChecker* checker = checkers_[sample.first];
  if (!checker || sample == Sample{0, 0.0}) return;
  PlaneMaker here(*checker, q, chains_);
  std::optional<PlaneMaker> apart;  // where they are known to be
  std::map<Pair, DistanceResult> known;
  for (const DistanceResult& d : here.distances(constraint_distance_ + kCorners * padding_)) {
    const Pair pair{d.with_scene, d.a, d.b};
    if (watched_.count(pair) == 0 || std::abs(d.value) < 1e-9) continue;
    if (d.gradient.cwiseAbs().maxCoeff() < 1e-12) continue;  // no joint can separate them
    std::vector<SeparatingPlane>& planes = planes_[sample][pair];
    const double room = rooms.at(pair);
    if (reference_.empty()) {
      add_plane(planes, here.plane(d, room));
      continue;
    }
    const double clear = d.value - kept_apart(pair);
    if (!planes.empty() && clear > 0) continue;
    if (!apart) {
      apart.emplace(*checker, reference(sample), chains_);
      for (const DistanceResult& r : apart->distances(kFar)) known[{r.with_scene, r.a, r.b}] = r;
    }
    const auto r = known.find(pair);
    if (r == known.end() || r->second.value < room) {
      add_plane(planes, here.plane(d, room));
      continue;
    }
    SeparatingPlane parted = apart->plane(r->second, room);
    if (clear > 0) {
      planes.push_back(parted);
      continue;
    }
    // Points fixed to the bodies represent whole bodies: the distance they missed is added to what is to be kept, as
    // far as there is room.
    for (SeparatingPlane& plane : planes)
      plane.margin = std::max(plane.margin, std::min(plane.margin - clear, 0.8 * separation(plane, apart->q())));
    // Whichever of the points in question is further beyond.
    SeparatingPlane touching = here.plane(d, room);
    touching.normal = parted.normal;
    planes.push_back(separation(parted, q) < separation(touching, q) ? parted : touching);
  }
}

void CollisionRows::add_to(WholeBodyNlp& nlp, bool diff_drive) const {
  const WholeBodyLayout& layout = nlp.layout();
  for (const auto& [sample, planes] : planes_) {
    const auto& [i, s] = sample;
    std::vector<SeparatingPlane> list;
    std::string names;
    for (const auto& [pair, several] : planes) {
      list.insert(list.end(), several.begin(), several.end());
      names += (names.empty() ? "" : ", ") + std::get<1>(pair) + " and " + std::get<2>(pair);
    }
    if (list.empty()) continue;
    auto term = std::make_unique<CollisionTerm>(IntervalPoint(layout.columns(), diff_drive, s), std::move(list));
    term->waypoint = i;
    term->what = names;
    for (int c = 0; c < layout.columns(); ++c) term->variables.push_back(layout.q(i, c));
    if (s > 0) {
      for (int end = i; end <= i + 1; ++end)
        for (int d = 0; d < layout.drives(); ++d) term->variables.push_back(layout.v(end, d));
      term->variables.push_back(layout.h(layout.segment(i)));
    }
    nlp.add(std::move(term));
  }
}

}  // namespace mmgrasp::detail
