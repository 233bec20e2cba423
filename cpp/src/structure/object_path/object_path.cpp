#include "mmgrasp/structure/object_path.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "structure/object_path/configuration_graph.hpp"
#include "structure/object_path/held_object.hpp"

namespace mmgrasp {
namespace {

using detail::ConfigurationGraph;
using detail::kInfinity;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFinalStep = 0.005;  // [rad or m]

/// One grasp's configurations and what is known of them.
struct Configurations {
  std::vector<MatrixXd> q;               ///< A column each, one matrix a waypoint.
  std::vector<std::vector<char>> known;  ///< 0: not checked, 1: free, 2: rejected.
  std::vector<VectorXd> manipulability;
};

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
  const auto weight = [](double value, const char* field) {
    require(std::isfinite(value) && value >= 0, field, value, "must be zero or positive");
  };
  const auto positive = [](double value, const char* field) {
    require(std::isfinite(value) && value > 0, field, value, "must be positive");
  };
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
  require(redundant_values >= 0, "redundant_values", redundant_values, "must not be negative");
}

struct ObjectPathEvaluator::Impl {
  ObjectPathProblem problem;
  ObjectPathOptions options;
  detail::HeldObject held{problem};
  IkOptions ik;
  EdgeOptions edge;
  const JointGroup* group = nullptr;
  detail::AttachedChecker* checker = nullptr;
  bool stress_limited = false;  ///< Some member's material has a limit.

  Impl(const ObjectPathProblem& given, const ObjectPathOptions& with) : problem(given), options(with) {}
  Configurations find(const Poses& T_world_hand, ObjectPathResult& result) const;
  bool is_free(Configurations& found, std::size_t layer, int i, ObjectPathResult& result);
  void keep_nearest(Configurations& found, ObjectPathResult& result);
  void count_violations(Configurations& found, ObjectPathResult& result);
  VectorXd step(const Eigen::Ref<const VectorXd>& from, const Eigen::Ref<const VectorXd>& to) const;
  ConfigurationGraph graph(const Configurations& found) const;
  bool edge_is_allowed(std::size_t layer, const VectorXd& from, const VectorXd& to, const Pose& T_hand_object);
  void bend(const Grasp& grasp, ObjectPathResult& result) const;
  void finish(const Configurations& found, const ConfigurationGraph::Path& path, ObjectPathResult& result) const;
};

Configurations ObjectPathEvaluator::Impl::find(const Poses& T_world_hand, ObjectPathResult& result) const {
  Configurations found;
  Matrix6Xd J(6, group->size());
  Pose T;
  for (std::size_t i = 0; i < T_world_hand.size(); ++i) {
    const IkBranches branches =
        solve_ik_branches(*group, T_world_hand[i], ik, {}, options.redundant_values, {}, options.all_turns);
    const auto count = static_cast<Eigen::Index>(branches.solutions.size());
    if (count == 0) {
      result.violations[i] = 2;
      result.rejections += branches.rejections;
    }
    result.configurations += static_cast<int>(count);
    found.q.emplace_back(group->size(), count);
    found.known.emplace_back(count, 0);
    found.manipulability.emplace_back(VectorXd::Zero(count));
    for (Eigen::Index k = 0; k < count; ++k) found.q[i].col(k) = branches.solutions[k];
    if (i == 0 || options.manipulability_weight == 0) continue;
    const Vector6d motion = pose_difference(T_world_hand[i - 1], T_world_hand[i]);
    if (motion.norm() < 1e-12) continue;  // P2's direction is undefined: nothing is added
    for (Eigen::Index k = 0; k < count; ++k) {
      group->fk_jacobian(found.q[i].col(k), T, J);
      found.manipulability[i](k) = motion.norm() / (J.transpose() * motion).norm();
    }
  }
  return found;
}

bool ObjectPathEvaluator::Impl::is_free(Configurations& found, std::size_t layer, int i, ObjectPathResult& result) {
  char& known = found.known[layer][i];
  if (known == 0) {
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

/// P2's single-IK variant: one configuration a waypoint, the free one nearest to the last.
void ObjectPathEvaluator::Impl::keep_nearest(Configurations& found, ObjectPathResult& result) {
  VectorXd last;
  for (std::size_t i = 0; i < found.q.size(); ++i) {
    int best = -1;
    for (int k = 0; k < found.q[i].cols(); ++k) {
      if (!is_free(found, i, k, result)) continue;
      if (best < 0 || (i > 0 && step(last, found.q[i].col(k)).norm() < step(last, found.q[i].col(best)).norm()))
        best = k;
    }
    if (best < 0) {
      result.violations[i] = 1;
      continue;
    }
    last = found.q[i].col(best);
    found.q[i] = last;
    found.known[i] = {1};
    found.manipulability[i] = VectorXd::Constant(1, found.manipulability[i](best));
  }
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
  for (std::size_t layer = 0; layer + 1 < sizes.size(); ++layer) {
    for (int a = 0; a < sizes[layer]; ++a) {
      for (int b = 0; b < sizes[layer + 1]; ++b) {
        const double *from = found.q[layer].col(a).data(), *to = found.q[layer + 1].col(b).data();
        double squared = 0;
        bool jumps = false;
        for (Eigen::Index k = 0; k < found.q[layer].rows() && !jumps; ++k) {
          double move = to[k] - from[k];
          if (wraps[k]) move = detail::shortest_turn(move);
          jumps = std::abs(move) > options.max_joint_step;
          squared += move * move;
        }
        if (!jumps) {
          graph.edge(layer, a, b) = motion * std::sqrt(squared) + force * found.manipulability[layer + 1](b);
        }
      }
    }
  }
  return graph;
}

bool ObjectPathEvaluator::Impl::edge_is_allowed(std::size_t layer, const VectorXd& from, const VectorXd& to,
                                                const Pose& T_hand_object) {
  const VectorXd end = from + step(from, to);
  const Pose T = group->fk((from + end) / 2) * T_hand_object;
  const Pose wanted = half_way(problem.T_world_object[layer], problem.T_world_object[layer + 1]);
  if ((T.translation() - wanted.translation()).norm() > options.position_tolerance) return false;
  if (rotation_distance(T, wanted) > options.rotation_tolerance) return false;
  return !options.check_edges || checker->edge_is_free(from, end, edge);
}

void ObjectPathEvaluator::Impl::bend(const Grasp& grasp, ObjectPathResult& result) const {
  if (!problem.frame) return;
  const SupportedFrame held(*problem.frame, {beam_support(grasp)});
  for (const Pose& T : problem.T_world_object) {
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
  const bool unreachable = violated();
  if (unreachable || own.options.single_configuration) {
    if (unreachable) {
      own.count_violations(found, result);
    } else {
      own.keep_nearest(found, result);
    }
    if (violated()) return result;
  }
  ConfigurationGraph graph = own.graph(found);
  const Pose T_hand_object = grasp.T_object_hand.inverse();
  std::vector<std::map<std::pair<int, int>, bool>> checked(T_world_hand.size());
  for (;;) {
    const ConfigurationGraph::Path path = graph.cheapest();
    if (path.vertices.empty()) break;
    bool stands = true;
    for (std::size_t i = 0; i < path.vertices.size(); ++i) {
      if (own.is_free(found, i, path.vertices[i], result)) continue;
      graph.remove_vertex(i, path.vertices[i]);
      stands = false;
    }
    for (std::size_t i = 0; stands && i + 1 < path.vertices.size(); ++i) {
      const std::pair<int, int> ends(path.vertices[i], path.vertices[i + 1]);
      if (checked[i].count(ends)) continue;
      checked[i][ends] = true;
      if (own.edge_is_allowed(i, found.q[i].col(ends.first), found.q[i + 1].col(ends.second), T_hand_object)) continue;
      graph.edge(i, ends.first, ends.second) = kInfinity;
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
  if (!violated()) result.violation = std::max(1, graph.gaps());
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
