#include "mmgrasp/structure/object_path.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "structure/object_path/attached_object.hpp"
#include "structure/object_path/configuration_graph.hpp"
#include "structure/object_path/path_configurations.hpp"

namespace mmgrasp {
namespace {

using detail::ConfigurationGraph;
using detail::kInfinity;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFinalStep = 0.005;  // [rad or m]
constexpr int kMany = 64;             // configurations at a pose

/// One grasp's configurations and what is known of them.
struct Configurations {
  std::vector<MatrixXd> q;               ///< A column each, one matrix a waypoint.
  std::vector<std::vector<char>> known;  ///< 0: not checked, 1: free, 2: rejected.
  std::vector<VectorXd> manipulability;
};

/// Where the group stands; a base that moves in the middle of its bounds.
VectorXd configuration_of(const JointGroup& group) {
  VectorXd q = 0.5 * (group.sample_lower() + group.sample_upper());
  int place = 0;  // within the values of a joint
  for (int i = group.has_base() ? 3 : 0; i < group.size(); ++i) {
    const int joint = group.joints()[i];
    place = i > 0 && group.joints()[i - 1] == joint ? place + 1 : 0;
    q[i] = group.reference()[group.robot().joints()[joint].value_index + place];
  }
  return q;
}

/// The pose half way, turned about one axis.
Pose half_way(const Pose& a, const Pose& b) {
  Pose middle = Pose::Identity();
  middle.translation() = (a.translation() + b.translation()) / 2;
  middle.linear() = Eigen::Quaterniond(a.linear()).slerp(0.5, Eigen::Quaterniond(b.linear())).toRotationMatrix();
  return middle;
}

}  // namespace

void ObjectPathProblem::check() const {
  require(!group.has_base() || group.robot().base() != BaseKind::diff_drive, "group", group.name(),
          "moves a diff_drive base, which cannot go sideways as the object's path may ask; give the arm alone");
  require(!object.empty(), "object", "[]", "must have shapes");
  require(T_world_object.size() >= 2, "T_world_object", std::to_string(T_world_object.size()) + " poses",
          "must be at least two: where the object lies, then where it goes");
  for (std::size_t i = 0; i < T_world_object.size(); ++i) {
    checked_pose(T_world_object[i].matrix(), "T_world_object[" + std::to_string(i) + "]");
  }
  require(!world.has(object_name), "object_name", object_name,
          "is in the world already; the world is without the object");
  if (gripper) gripper->check();
  if (frame) frame->check();
}

void ObjectPathOptions::check() const {
  const auto weight = [](double value, const char* field) { require_not_negative(value, field); };
  const auto positive = [](double value, const char* field) { require_positive(value, field); };
  weight(motion_weight, "motion_weight");
  weight(deflection_weight, "deflection_weight");
  weight(manipulability_weight, "manipulability_weight");
  positive(motion_scale, "motion_scale");
  positive(deflection_scale, "deflection_scale");
  positive(manipulability_scale, "manipulability_scale");
  positive(max_joint_step, "max_joint_step");
  positive(position_tolerance, "position_tolerance");
  positive(rotation_tolerance, "rotation_tolerance");
  positive(edge_step, "edge_step");
  weight(gravity, "gravity");
  weight(max_sag, "max_sag");
  require_count(redundant_values, "redundant_values", 0, 10'000);
  positive(base_spacing, "base_spacing");
  require_count(base_headings, "base_headings", 1, 3600);
}

struct ObjectPathEvaluator::Impl {
  ObjectPathProblem problem;
  ObjectPathOptions options;
  detail::AttachedObject held{problem};
  EdgeOptions edge;
  std::map<const JointGroup*, detail::PathConfigurations> solvers;  ///< One for each opening of the fingers.
  const JointGroup* group = nullptr;
  detail::PathConfigurations* solver = nullptr;
  detail::AttachedChecker* checker = nullptr;
  Poses half_way_poses;         ///< Poses of the object half-way to the next, one after each pose.
  bool stress_limited = false;  ///< Some member's material has a limit.

  Impl(const ObjectPathProblem& given, const ObjectPathOptions& with) : problem(given), options(with) {}
  Configurations find(const Poses& T_world_hand, ObjectPathResult& result) const;
  bool is_free(Configurations& found, std::size_t layer, int i, ObjectPathResult& result);
  void count_violations(Configurations& found, ObjectPathResult& result);
  VectorXd step(const Eigen::Ref<const VectorXd>& from, const Eigen::Ref<const VectorXd>& to) const;
  ConfigurationGraph graph(const Configurations& found) const;
  bool stays_near(std::size_t layer, const VectorXd& from, const VectorXd& to, const Pose& T_hand_object) const;
  void bend(const Grasp& grasp, ObjectPathResult& result) const;
  void finish(const Configurations& found, const ConfigurationGraph::Path& path, ObjectPathResult& result) const;
};

Configurations ObjectPathEvaluator::Impl::find(const Poses& T_world_hand, ObjectPathResult& result) const {
  Configurations found;
  solver->place_bases(T_world_hand);
  VectorXd last = options.single_configuration ? configuration_of(*group) : VectorXd();
  for (std::size_t i = 0; i < T_world_hand.size(); ++i) {
    detail::throw_if_interrupted();
    const Vector6d motion = i == 0 ? Vector6d::Zero().eval() : pose_difference(T_world_hand[i - 1], T_world_hand[i]);
    detail::PathConfigurations::Layer layer = options.single_configuration
                                                  ? solver->single(T_world_hand[i], motion, last)
                                                  : solver->at(T_world_hand[i], motion);
    const Eigen::Index count = layer.q.cols();
    if (count == 0) {
      result.violations[i] = 2;
      result.rejections += layer.rejections;
    } else if (options.single_configuration) {
      last = layer.q.col(0);
    }
    result.configurations += static_cast<int>(count);
    found.q.push_back(std::move(layer.q));
    found.known.emplace_back(count, 0);
    found.manipulability.push_back(std::move(layer.manipulability));
  }
  return found;
}

bool ObjectPathEvaluator::Impl::is_free(Configurations& found, std::size_t layer, int i, ObjectPathResult& result) {
  char& known = found.known[layer][i];
  if (known == 0) {
    detail::throw_if_interrupted();
    const VectorXd q = found.q[layer].col(i);
    const Rejection verdict = checker->is_free(q) ? Rejection::none : checker->rejection(q);
    if (verdict != Rejection::none) result.rejections.add(verdict);
    known = verdict == Rejection::none ? 1 : 2;
  }
  return known == 1;
}

VectorXd ObjectPathEvaluator::Impl::step(const Eigen::Ref<const VectorXd>& from,
                                         const Eigen::Ref<const VectorXd>& to) const {
  VectorXd difference = to - from;
  for (Eigen::Index i = 0; i < difference.size(); ++i) {
    if (group->wraps()[i]) difference(i) = detail::shortest_turn(difference(i));
  }
  return difference;
}

void ObjectPathEvaluator::Impl::count_violations(Configurations& found, ObjectPathResult& result) {
  for (std::size_t i = 0; i < found.q.size(); ++i) {
    bool any = false;
    for (int k = 0; k < found.q[i].cols() && !any; ++k) any = is_free(found, i, k, result);
    if (!any && result.violations[i] == 0) result.violations[i] = 1;
  }
}

ConfigurationGraph ObjectPathEvaluator::Impl::graph(const Configurations& found) const {
  std::vector<int> sizes;
  for (const MatrixXd& q : found.q) sizes.push_back(static_cast<int>(q.cols()));
  ConfigurationGraph graph(sizes);
  const double motion = options.motion_weight / options.motion_scale;
  const double force = options.manipulability_weight / options.manipulability_scale;
  const auto& wraps = group->wraps();
  std::vector<int> order;
  for (std::size_t layer = 0; layer + 1 < sizes.size(); ++layer) {
    detail::throw_if_interrupted();
    // When there are many configurations only those are tried that are near in the value that spreads most.
    const MatrixXd& q = found.q[layer];
    Eigen::Index value = -1;
    double widest = 0;
    for (Eigen::Index k = 0; sizes[layer] > kMany && k < q.rows(); ++k) {
      const double spread = wraps[k] ? 0 : q.row(k).maxCoeff() - q.row(k).minCoeff();
      if (spread <= widest) continue;
      widest = spread;
      value = k;
    }
    order.resize(sizes[layer]);
    std::iota(order.begin(), order.end(), 0);
    if (value >= 0)
      std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return q(value, a) < q(value, b); });
    for (int b = 0; b < sizes[layer + 1]; ++b) {
      const double* to = found.q[layer + 1].col(b).data();
      auto at = order.begin();
      if (value >= 0) {
        at = std::lower_bound(order.begin(), order.end(), to[value] - options.max_joint_step,
                              [&](int a, double least) { return q(value, a) < least; });
      }
      for (; at != order.end() && !(value >= 0 && q(value, *at) > to[value] + options.max_joint_step); ++at) {
        const double* from = q.col(*at).data();
        double squared = 0;
        bool jumps = false;
        for (Eigen::Index k = 0; k < q.rows() && !jumps; ++k) {
          double move = to[k] - from[k];
          if (wraps[k]) move = detail::shortest_turn(move);
          jumps = std::abs(move) > options.max_joint_step;
          squared += move * move;
        }
        if (!jumps)
          graph.add_edge(layer, *at, b, motion * std::sqrt(squared) + force * found.manipulability[layer + 1](b));
      }
    }
  }
  return graph;
}

/// The object, half way between two poses.
bool ObjectPathEvaluator::Impl::stays_near(std::size_t layer, const VectorXd& from, const VectorXd& to,
                                           const Pose& T_hand_object) const {
  const Pose T = group->fk(from + step(from, to) / 2) * T_hand_object;
  const Pose& wanted = half_way_poses[layer];
  return (T.translation() - wanted.translation()).norm() <= options.position_tolerance &&
         rotation_distance(T, wanted) <= options.rotation_tolerance;
}

void ObjectPathEvaluator::Impl::bend(const Grasp& grasp, ObjectPathResult& result) const {
  if (!problem.frame) return;
  const SupportedFrame held(*problem.frame, {beam_support(grasp)});
  for (const Pose& T : problem.T_world_object) {
    detail::throw_if_interrupted();
    const Eigen::Vector3d gravity = gravity_in_object(T, options.gravity);
    bool yields = false;
    if (stress_limited) {
      const BeamState state = held.state(gravity);
      result.sag.push_back(state.displacement.value);
      yields = state.over_limit && state.over_limit->value > 1;
    } else {
      result.sag.push_back(held.largest_displacement(gravity).value);
    }
    if (yields || (options.max_sag > 0 && result.sag.back() > options.max_sag)) {
      result.overloaded.push_back(static_cast<int>(result.sag.size()) - 1);
    }
  }
  for (std::size_t i = 1; i < result.sag.size(); ++i) result.deflection += result.sag[i];
}

void ObjectPathEvaluator::Impl::finish(const Configurations& found, const ConfigurationGraph::Path& path,
                                       ObjectPathResult& result) const {
  for (std::size_t i = 0; i < found.q.size(); ++i) {
    VectorXd q = found.q[i].col(path.vertices[i]);
    if (i > 0) {
      q = result.path.waypoints.back() + step(result.path.waypoints.back(), q);
      result.joint_motion += (q - result.path.waypoints.back()).norm();
      result.force_manipulability += found.manipulability[i](path.vertices[i]);
    }
    result.path.waypoints.push_back(q);
  }
  result.cost = options.motion_weight * result.joint_motion / options.motion_scale +
                options.deflection_weight * result.deflection / options.deflection_scale +
                options.manipulability_weight * result.force_manipulability / options.manipulability_scale;
  result.outcome = Outcome::solved;
}

ObjectPathEvaluator::ObjectPathEvaluator(const ObjectPathProblem& problem, const ObjectPathOptions& options)
    : impl_(new Impl(problem, options)) {
  problem.check();
  options.check();
  impl_->edge.joint_step = options.edge_step;
  for (std::size_t i = 0; i + 1 < problem.T_world_object.size(); ++i) {
    impl_->half_way_poses.push_back(half_way(problem.T_world_object[i], problem.T_world_object[i + 1]));
  }
  if (!problem.frame) {
    require(options.max_sag == 0, "max_sag", options.max_sag, "needs the problem's frame, which says how it bends");
    return;
  }
  for (const BeamMember& member : problem.frame->members) {
    if (member.material.stress_limit > 0) impl_->stress_limited = true;
  }
}
ObjectPathEvaluator::ObjectPathEvaluator(ObjectPathEvaluator&&) noexcept = default;
ObjectPathEvaluator& ObjectPathEvaluator::operator=(ObjectPathEvaluator&&) noexcept = default;
ObjectPathEvaluator::~ObjectPathEvaluator() = default;
ObjectPathEvaluator ObjectPathEvaluator::clone() const {
  return {impl_->problem, impl_->options};
}
const ObjectPathProblem& ObjectPathEvaluator::problem() const {
  return impl_->problem;
}
const ObjectPathOptions& ObjectPathEvaluator::options() const {
  return impl_->options;
}

ObjectPathResult ObjectPathEvaluator::evaluate(const Grasp& grasp) {
  checked_pose(grasp.T_object_hand.matrix(), "grasp.T_object_hand");
  Impl& own = *impl_;
  if (own.problem.frame) beam_support(grasp);
  own.checker = &own.held.hold(grasp);
  own.group = &own.held.group();
  own.solver = &own.solvers.try_emplace(own.group, *own.group, own.options).first->second;
  Poses T_world_hand;
  for (const Pose& T : own.problem.T_world_object) T_world_hand.push_back(T * grasp.T_object_hand);
  ObjectPathResult result;
  result.violations.assign(T_world_hand.size(), 0);
  Configurations found = own.find(T_world_hand, result);
  const auto violated = [&] {
    result.violation = 0;
    for (const int violation : result.violations) result.violation += violation;
    result.violation += static_cast<int>(result.overloaded.size());
    return result.violation > 0;
  };
  const bool limited = own.stress_limited || own.options.max_sag > 0;
  if (limited) own.bend(grasp, result);
  if (violated()) {
    own.count_violations(found, result);
    violated();
    return result;
  }
  ConfigurationGraph graph = own.graph(found);
  const Pose T_hand_object = grasp.T_object_hand.inverse();
  const auto stays_near = [&](std::size_t i, int a, int b) {
    return own.stays_near(i, found.q[i].col(a), found.q[i + 1].col(b), T_hand_object);
  };
  // Neighbours on a grid often leave the path half way: checked on the way, not one path after the other.
  const ConfigurationGraph::Check check{
      [&](std::size_t i, int vertex) { return own.is_free(found, i, vertex, result); },
      [&](std::size_t i, int a, int b) {
        const bool near = stays_near(i, a, b);
        result.refused_edges += !near;
        return near;
      }};
  const bool sampled = own.solver->sampled();
  std::vector<std::map<std::pair<int, int>, bool>> checked(T_world_hand.size());
  for (;;) {
    const ConfigurationGraph::Path path = graph.cheapest(sampled ? &check : nullptr);
    if (path.vertices.empty()) break;
    bool stands = true;
    for (std::size_t i = 0; i < path.vertices.size(); ++i) {
      if (own.is_free(found, i, path.vertices[i], result)) continue;
      graph.remove_vertex(i, path.vertices[i]);
      stands = false;
    }
    for (std::size_t i = 0; stands && i + 1 < path.vertices.size(); ++i) {
      detail::throw_if_interrupted();
      const std::pair<int, int> ends(path.vertices[i], path.vertices[i + 1]);
      if (!checked[i].emplace(ends, true).second) continue;
      const VectorXd from = found.q[i].col(ends.first), to = found.q[i + 1].col(ends.second);
      if ((sampled || stays_near(i, ends.first, ends.second)) &&
          (!own.options.check_edges || own.checker->edge_stays_free(from, from + own.step(from, to), own.edge)))
        continue;
      graph.remove_edge(i, ends.first, ends.second);
      ++result.refused_edges;
      stands = false;
    }
    if (!stands) continue;
    if (!limited) own.bend(grasp, result);
    own.finish(found, path, result);
    return result;
  }
  own.count_violations(found, result);
  for (std::size_t i = 0; i < found.q.size(); ++i) {  // count_violations knows of more that collide
    for (int k = 0; k < found.q[i].cols(); ++k) {
      if (found.known[i][k] == 2) graph.remove_vertex(i, k);
    }
  }
  if (!violated()) {
    result.gaps = graph.gaps();
    const auto gaps = result.gaps.size() - std::count(result.gaps.begin(), result.gaps.end(), 0);
    result.violation = std::max(1, static_cast<int>(gaps));
  }
  return result;
}

ObjectPathResult follow_object_path(const ObjectPathProblem& problem, const Grasp& grasp,
                                    const ObjectPathOptions& options) {
  ObjectPathOptions finer = options;
  finer.edge_step = std::min(options.edge_step, kFinalStep);
  ObjectPathResult result = ObjectPathEvaluator(problem, finer).evaluate(grasp);
  for (std::size_t i = 0; i < result.path.waypoints.size(); ++i) {
    const Pose wanted = problem.T_world_object[i] * grasp.T_object_hand, T = problem.group.fk(result.path.waypoints[i]);
    if ((T.translation() - wanted.translation()).norm() < 1e-4 && rotation_distance(T, wanted) < 1e-3) continue;
    throw Error("follow_object_path: waypoint " + std::to_string(i) + " misses its pose; this is a fault of mmgrasp");
  }
  return result;
}

}  // namespace mmgrasp
