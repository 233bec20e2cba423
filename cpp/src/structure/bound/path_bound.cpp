#include "structure/bound/path_bound.hpp"

#include <algorithm>

namespace mmgrasp::detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

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

/// Encloses the force manipulability (3.3) along the tip's motion from the pose before; error 0: a bound from below.
LinearForm PathBound::force(const FormConfiguration& q, const FormPose& before, const FormPose& at,
                            std::size_t pose) const {
  const FormVector v = at.origin - before.origin;
  LinearForm length2 = squared_norm(v), effect2;
  length2 += LinearForm(turns_[pose].squaredNorm());
  for (const LinearForm& effect : arm_.joint_effects(q, at.origin, v, turns_[pose])) effect2 += squared(effect);
  if (length2.high() <= 0 || effect2.high() <= 0) return {};
  const double least = std::sqrt(std::max(0.0, length2.low()) / effect2.high());
  LinearForm below(least);
  if (length2.low() > 0.1 * length2.centre && effect2.low() > 0.1 * effect2.centre) {
    LinearForm linear = square_root(length2) * reciprocal(square_root(effect2));
    linear.centre -= linear.error;
    linear.error = 0;
    if (linear.low() > least) below = linear;
  }
  return below;
}

BoxGraph PathBound::graph(const GraspBox& box) const {
  constexpr double kSlack = 1e-8;
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
        bool jumps = false;
        Vector6 middle;
        double least2 = 0;
        std::array<LinearForm, 6> move;
        for (int j = 0; j < 6 && !jumps; ++j) {
          move[j] = to.q[b][j] - from.q[a][j];
          if (wraps_[j]) move[j].centre = shortest_turn(move[j].centre);
          const double radius = move[j].radius();
          double least = std::max(0.0, std::abs(move[j].centre) - radius);
          if (wraps_[j] && radius >= kPi) least = 0;
          // the short way round may be the other one
          if (wraps_[j]) least = std::min(least, std::max(0.0, kTwoPi - std::abs(move[j].centre) - radius));
          jumps = least > options_.max_joint_step + kSlack;
          least2 += least * least;
          middle[j] = move[j].centre;
        }
        if (jumps) continue;
        reached[b] = 1;
        const double length = middle.norm();
        edge.estimate = graph.motion_ * length;
        edge.centre = graph.motion_ * std::sqrt(least2);
        bool linear = length > 0;
        for (int j = 0; j < 6; ++j) linear = linear && (!wraps_[j] || std::abs(middle[j]) + move[j].radius() < kPi);
        if (linear) {
          const Vector6 u = middle / length;
          LinearForm along;
          for (int j = 0; j < 6; ++j) along += u[j] * move[j];
          if (along.low() > 0) {
            edge.direction = u;
            edge.centre = graph.motion_ * length;
            for (int k = 0; k < 2; ++k) edge.slope[k] = graph.motion_ * along.slope[k];
          }
        }
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
    graph.sag_ = options_.deflection_weight / options_.deflection_scale *
                 sag_->below(box.section, box.length, box.half_length);
  }
  return graph;
}

BoxGraph::Bound BoxGraph::bound() const {
  Bound best;
  if (layers_.empty() || layers_.back().edges.empty()) return best;
  const auto errors = [&](std::size_t layer, int branch, const Vector6& turn) {
    double sum = 0;
    for (int j = 0; j < 6; ++j) sum += std::abs(turn[j]) * layers_[layer].q[branch][j].error;
    return motion_ * sum;
  };
  // The motions' bounds meet in a configuration with the directions of both: what is not known of it counts with their
  // difference only. Hence the edges are the states. A path's bound is linear over the box, so its least is in a corner.
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
          least = middle ? 0 : -errors(0, edge.from, edge.direction);
        } else {
          for (std::size_t d = 0; d < cost.size(); ++d) {
            const Edge& last = layers_[i - 1].edges[d];
            if (last.to != edge.from || cost[d] == kInfinity) continue;
            const double through =
                cost[d] - (middle ? 0 : errors(i - 1, edge.from, Vector6(edge.direction - last.direction)));
            if (through >= least) continue;
            least = through;
            before[i][e] = static_cast<int>(d);
          }
        }
        if (least == kInfinity) continue;
        next[e] = least + (middle ? edge.estimate : edge.centre + x * edge.slope[0] + y * edge.slope[1]);
        if (i + 1 == layers_.size() && !middle) next[e] -= errors(i, edge.to, edge.direction);
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
