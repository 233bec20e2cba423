#include "structure/object_path/path_bound.hpp"

#include <algorithm>

namespace mmgrasp::detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector7 = Eigen::Matrix<double, 7, 1>;

namespace {

/// A bound from below that is linear: the error comes off.
LinearForm below(LinearForm f) {
  f.centre -= f.error;
  f.error = 0;
  return f;
}

/// Sum of the errors of a configuration, each weighed.
double errors(const FormConfiguration& q, const Vector7& weights) {
  double sum = 0;
  for (int j = 0; j < 7; ++j) sum += std::abs(weights[j]) * q[j].error;
  return sum;
}

}  // namespace

PathBound::PathBound(const ObjectPathProblem& problem, const Pipe& pipe, const ObjectPathOptions& options,
                     const PipeGraspOptions& grasp)
    : T_world_object_(problem.T_world_object),
      pipe_(pipe),
      options_(options),
      grasp_(grasp),
      wraps_(problem.group.wraps()),
      arm_(problem.group) {
  std::vector<Vector3d> gravity;
  turns_.emplace_back(Vector3d::Zero());
  for (std::size_t i = 1; i < T_world_object_.size(); ++i) {
    turns_.emplace_back(pose_difference(T_world_object_[i - 1], T_world_object_[i]).tail<3>());
    gravity.push_back(gravity_in_object(T_world_object_[i], options.gravity));
  }
  if (problem.frame && options.deflection_weight > 0) sag_.emplace(*problem.frame, std::move(gravity));
}

/// Where the tip is: on the section's axis, turned about it.
FormPose PathBound::hand(const GraspBox& box, std::size_t pose) const {
  const Pose T_section = T_world_object_[pose] * pipe_.T_object_section(box.section);
  const Matrix3d& R = T_section.linear();
  // The hand at angle 0, in the section's axes (place_pipe_grasp).
  const double sign = box.flipped ? -1 : 1;
  Matrix3d at_zero, axes;
  at_zero.col(0) = Vector3d::UnitY();
  at_zero.col(1) = sign * Vector3d::UnitZ();
  at_zero.col(2) = sign * Vector3d::UnitX();
  axes << grasp_.approach, grasp_.closing, grasp_.approach.cross(grasp_.closing);
  const Matrix3d hand = at_zero * axes.transpose();
  const LinearForm angle(box.angle, 0, box.half_angle, 0), c = cosine(angle), s = sine(angle);
  FormPose T;
  for (int k = 0; k < 3; ++k) {
    const Vector3d v = hand.col(k), still = R.col(0) * v.x(), with_c = R.col(1) * v.y() + R.col(2) * v.z(),
                   with_s = R.col(2) * v.y() - R.col(1) * v.z();
    for (int i = 0; i < 3; ++i) T.axes[k][i] = LinearForm(still[i]) + with_c[i] * c + with_s[i] * s;
  }
  const Vector3d middle = T_section * Vector3d(box.length, 0, 0);
  for (int i = 0; i < 3; ++i) T.origin[i] = LinearForm(middle[i], box.half_length * R(i, 0), 0, 0);
  return T;
}

/// Bounds the force manipulability (3.3) along the tip's motion from the pose before from below; its error is 0.
LinearForm PathBound::force(const FormConfiguration& q, const FormPose& before, const FormPose& at,
                            std::size_t pose) const {
  const FormVector v = at.origin - before.origin;  // linear without error
  const Vector3d middle(v[0].centre, v[1].centre, v[2].centre), slope(v[0].slope[0], v[1].slope[0], v[2].slope[0]);
  const double length = std::hypot(middle.norm(), turns_[pose].norm());
  if (length < 1e-9) return {};
  const LinearForm motion(length, middle.dot(slope) / length, 0, 0);  // a norm lies above its tangents
  LinearForm effect2;
  for (const LinearForm& effect : arm_.joint_effects(q, at, v, turns_[pose])) effect2 += squared(effect);
  const LinearForm most = -below(-effect2);
  if (most.high() <= 0 || motion.low() <= 0) return {};
  const LinearForm least(motion.low() / std::sqrt(most.high()));
  if (most.centre <= 0) return least;
  // 1 / sqrt lies above its tangents, too
  const double root = 1 / std::sqrt(most.centre);
  LinearForm inverse = (-0.5 * root / most.centre) * most;
  inverse.centre = root;
  const LinearForm product = below(motion * inverse);
  return inverse.low() > 0 && product.low() > least.centre ? product : least;
}

/// False when every such motion is a jump.
bool PathBound::join(const FormConfiguration& from, const FormConfiguration& to, BoxGraph::Edge& edge) const {
  constexpr double kSlack = 1e-8;
  const double weight = options_.motion_weight / options_.motion_scale;
  Vector7 middle;
  std::array<LinearForm, 7> move{};
  double least2 = 0;
  bool known = true;
  for (int j = 0; j < 6; ++j) {
    move[j] = to[j] - from[j];
    if (wraps_[j]) move[j].centre = shortest_turn(move[j].centre);
    const double radius = move[j].radius(), off = std::abs(move[j].centre);
    double least = std::max(0.0, off - radius);
    if (wraps_[j]) {  // the short way may be the other one
      least = std::min(least, std::max(0.0, kTwoPi - off - radius));
      known = known && off + radius < kPi;
    }
    if (least > options_.max_joint_step + kSlack) return false;
    least2 += least * least;
    middle[j] = move[j].centre;
  }
  edge.estimate = weight * middle.head<6>().norm();
  edge.centre = weight * std::sqrt(least2);
  const auto try_direction = [&](const Vector7& u) {
    LinearForm along;
    for (int j = 0; j < 7; ++j) along += u[j] * move[j];
    const double bound = weight * (along.centre - along.error);
    if (along.low() <= 0 || bound <= edge.centre) return;
    edge.direction = u;
    edge.centre = weight * along.centre;
    for (int k = 0; k < 2; ++k) edge.slope[k] = weight * along.slope[k];
  };
  // The sum of joints 4 and 6 over sqrt(2) is one component of the motion in turned axes; the other is left out.
  const int sign = arm_.wrist_sign();
  const bool unknown = from[3].error + to[3].error + from[5].error + to[5].error > 0.1;
  middle[6] = 0;
  if (known && middle.norm() > 0) try_direction(middle.normalized());
  if (known && sign != 0 && unknown) {
    move[6] = to[6] - from[6];
    move[6].centre = shortest_turn(move[6].centre);
    if (std::abs(move[6].centre) + move[6].radius() + 2 * options_.max_joint_step < kTwoPi) {
      Vector7 u;
      u << middle[0], middle[1], middle[2], 0, middle[4], 0, move[6].centre / std::sqrt(2.0);
      const double length = u.norm();
      if (length > 0) {
        u /= length;
        u[6] /= std::sqrt(2.0);
        try_direction(u);
      }
    }
  }
  return true;
}

BoxGraph PathBound::graph(const GraspBox& box) const {
  BoxGraph graph;
  graph.motion_ = options_.motion_weight / options_.motion_scale;
  const double force_weight = options_.manipulability_weight / options_.manipulability_scale;
  std::vector<FormPose> poses;
  for (std::size_t i = 0; i < T_world_object_.size(); ++i) {
    poses.push_back(hand(box, i));
    BoxGraph::Layer layer;
    layer.q = arm_.within_limits(poses.back());
    layer.alive.assign(layer.q.size(), 1);
    graph.layers_.push_back(std::move(layer));
    if (graph.layers_.back().q.empty()) return graph;
  }
  for (std::size_t i = 1; i < graph.layers_.size(); ++i) {
    BoxGraph::Layer &from = graph.layers_[i - 1], &to = graph.layers_[i];
    std::vector<char> reached(to.q.size(), 0);
    for (int a = 0; a < static_cast<int>(from.q.size()); ++a) {
      if (!from.alive[a]) continue;
      for (int b = 0; b < static_cast<int>(to.q.size()); ++b) {
        BoxGraph::Edge edge{a, b};
        if (!join(from.q[a], to.q[b], edge)) continue;
        reached[b] = 1;
        to.edges.push_back(edge);
      }
    }
    to.alive = reached;
  }
  // What leads nowhere goes, then the force is worth bounding.
  for (std::size_t i = graph.layers_.size() - 1; i > 0; --i) {
    BoxGraph::Layer &from = graph.layers_[i - 1], &to = graph.layers_[i];
    std::vector<char> leads(from.q.size(), 0);
    to.edges.erase(std::remove_if(to.edges.begin(), to.edges.end(),
                                  [&](const BoxGraph::Edge& e) { return !from.alive[e.from] || !to.alive[e.to]; }),
                   to.edges.end());
    for (const BoxGraph::Edge& edge : to.edges) leads[edge.from] = 1;
    from.alive = leads;
    if (force_weight == 0) continue;
    std::vector<LinearForm> forces(to.q.size());
    for (std::size_t b = 0; b < to.q.size(); ++b) {
      if (to.alive[b]) forces[b] = force_weight * force(to.q[b], poses[i - 1], poses[i], i);
    }
    for (BoxGraph::Edge& edge : to.edges) {
      edge.centre += forces[edge.to].centre;
      edge.estimate += forces[edge.to].centre;
      for (int k = 0; k < 2; ++k) edge.slope[k] += forces[edge.to].slope[k];
    }
  }
  if (sag_) {
    graph.sag_ =
        options_.deflection_weight / options_.deflection_scale * sag_->below(box.section, box.length, box.half_length);
  }
  return graph;
}

BoxGraph::Bound BoxGraph::bound() const {
  Bound best;
  if (layers_.empty() || layers_.back().edges.empty()) return best;
  const auto unknown = [&](std::size_t layer, int branch, const Vector7& turn) {
    return motion_ * errors(layers_[layer].q[branch], turn);
  };
  // The motions' bounds meet in a configuration with the directions of both: what is not known of it counts with their
  // difference only. Hence the edges are the states. A path's bound is linear over the box, so its least is in a
  // corner.
  const std::array<std::array<double, 2>, 5> corners{{{-1, -1}, {-1, 1}, {1, -1}, {1, 1}, {0, 0}}};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const bool middle = k == 4;
    const auto [x, y] = corners[k];
    std::vector<double> cost;
    std::vector<std::vector<int>> before(layers_.size());
    for (std::size_t i = 1; i < layers_.size(); ++i) {
      const std::vector<Edge>& edges = layers_[i].edges;
      std::vector<double> next(edges.size(), kInfinity);
      before[i].assign(edges.size(), -1);
      for (std::size_t e = 0; e < edges.size(); ++e) {
        const Edge& edge = edges[e];
        if (!layers_[i].alive[edge.to] || !layers_[i - 1].alive[edge.from]) continue;
        double least = kInfinity;
        if (i == 1) {
          least = middle ? 0 : -unknown(0, edge.from, edge.direction);
        } else {
          for (std::size_t d = 0; d < cost.size(); ++d) {
            const Edge& last = layers_[i - 1].edges[d];
            if (last.to != edge.from || cost[d] == kInfinity) continue;
            const double through =
                cost[d] - (middle ? 0 : unknown(i - 1, edge.from, Vector7(edge.direction - last.direction)));
            if (through >= least) continue;
            least = through;
            before[i][e] = static_cast<int>(d);
          }
        }
        if (least == kInfinity) continue;
        next[e] = least + (middle ? edge.estimate : edge.centre + x * edge.slope[0] + y * edge.slope[1]);
        if (i + 1 == layers_.size() && !middle) next[e] -= unknown(i, edge.to, edge.direction);
      }
      cost.swap(next);
    }
    const auto last = std::min_element(cost.begin(), cost.end());
    if (last == cost.end() || *last == kInfinity) return {};
    if (middle) {
      best.estimate = *last + sag_.centre;
      continue;
    }
    const double all = *last + sag_.centre + x * sag_.slope[0] + y * sag_.slope[1] - sag_.error;
    if (all >= best.cost) continue;
    best.cost = all;
    best.branches.assign(layers_.size(), 0);
    auto e = static_cast<int>(last - cost.begin());
    for (std::size_t i = layers_.size() - 1; i > 0; --i) {
      best.branches[i] = layers_[i].edges[e].to;
      best.branches[i - 1] = layers_[i].edges[e].from;
      e = before[i][e];
    }
  }
  best.cost = std::max(0.0, best.cost - 1e-9);
  return best;
}

}  // namespace mmgrasp::detail
