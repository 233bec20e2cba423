#include "robot/ik/ik_null_space.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/detail/ik_descent.hpp"
#include "mmgrasp/robot/ik_objective.hpp"

namespace mmgrasp::detail {
namespace {

double total(const IkObjectives& objectives, const Eigen::VectorXd& q, Eigen::VectorXd& gradient) {
  double cost = 0;
  gradient.setZero(q.size());
  Eigen::VectorXd part;
  for (const auto& objective : objectives) {
    cost += objective->evaluate(q, part);
    gradient += part;
  }
  return cost;
}

/// Steepest descent on the solutions: joints that stand on a limit and would leave through it are fixed.
Eigen::VectorXd downhill(const JointGroup& group, const Eigen::VectorXd& q, const Matrix6Xd& J,
                         const Eigen::VectorXd& gradient, const std::vector<double>& weights) {
  constexpr double kOnLimit = 1e-9;
  std::vector<bool> fixed(q.size(), false);
  for (Eigen::Index round = 0; round <= q.size(); ++round) {
    Eigen::VectorXd step = null_space_part(J, -gradient, weights, fixed);
    bool again = false;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const bool outward =
          (step[i] < 0 && q[i] <= group.lower()[i] + kOnLimit) || (step[i] > 0 && q[i] >= group.upper()[i] - kOnLimit);
      if (!outward || fixed[i]) continue;
      fixed[i] = true;
      again = true;
    }
    if (!again) return step;
  }
  return Eigen::VectorXd::Zero(q.size());
}

/// The longest multiple of `step` that stays inside limits.
double room(const JointGroup& group, const Eigen::VectorXd& q, const Eigen::VectorXd& step) {
  double most = kInfinity;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (step[i] > 0) most = std::min(most, (group.upper()[i] - q[i]) / step[i]);
    if (step[i] < 0) most = std::min(most, (group.lower()[i] - q[i]) / step[i]);
  }
  return most;
}

}  // namespace

Eigen::VectorXd null_space_part(const Matrix6Xd& J, const Eigen::VectorXd& xi, const std::vector<double>& weights,
                                const std::vector<bool>& fixed) {
  // With s = sqrt(weight), the plain pseudo-inverse of the scaled columns J / s is the weighted one of J.
  Eigen::MatrixXd scaled = J;
  Eigen::VectorXd x = xi, scale = Eigen::VectorXd::Ones(xi.size());
  for (Eigen::Index i = 0; i < xi.size(); ++i) {
    if (!weights.empty()) scale[i] = 1 / std::sqrt(weights[i]);
    if (fixed[i]) scale[i] = 0;
    scaled.col(i) *= scale[i];
    x[i] *= scale[i];
  }
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inverse(scaled);
  // Projected twice: the first leaves roundings of the size of xi, the second of what is left.
  for (int i = 0; i < 2; ++i) x -= inverse.solve(scaled * x);
  return scale.cwiseProduct(x);
}

double slide_along_solutions(const JointGroup& group, const Pose& T_world_tip, const IkOptions& options,
                             const ConfigurationFilter& valid, IkWorkspace& workspace, Eigen::VectorXd& q,
                             int& iterations) {
  constexpr double kLongest = 0.3;    // [rad or m] First guess of a step: what the largest joint moves
  constexpr double kShortest = 1e-5;  // [rad or m] Steps below end the slide
  IkOptions pull = options;
  pull.position_tolerance *= 0.01;  // room for the caller's own check
  pull.rotation_tolerance *= 0.01;
  pull.max_iterations = 15;
  Eigen::VectorXd gradient, next_gradient, next;
  double cost = total(options.objectives, q, gradient);
  double length = kLongest;
  Pose T_world_now;
  for (int i = 0; i < options.objective_iterations; ++i) {
    workspace.J.resize(6, q.size());
    group.fk_jacobian(q, T_world_now, workspace.J);
    const Eigen::VectorXd step = downhill(group, q, workspace.J, gradient, options.joint_weights);
    const double largest = step.cwiseAbs().maxCoeff();
    if (!(largest > 1e-12 * (1 + gradient.cwiseAbs().maxCoeff()))) break;
    bool better = false;
    for (length = std::min(kLongest, 2 * length); !better && length > kShortest; length *= 0.5) {
      next = q + std::min(length / largest, room(group, q, step)) * step;
      const DescentEnd end = descend(group, T_world_tip, next, pull, workspace, true);
      iterations += end.iterations;
      if (!end.converged) continue;
      const double next_cost = total(options.objectives, next, next_gradient);
      if (!(next_cost < cost - 1e-12 * std::abs(cost)) || (valid && valid(next) != Rejection::none)) continue;
      better = true;
      q.swap(next);
      gradient.swap(next_gradient);
      cost = next_cost;
    }
    if (!better) break;
  }
  return cost;
}

double total_cost(const IkObjectives& objectives, const Eigen::VectorXd& q) {
  Eigen::VectorXd gradient;
  return total(objectives, q, gradient);
}

}  // namespace mmgrasp::detail

namespace mmgrasp {

Eigen::VectorXd project_onto_null_space(const Matrix6Xd& J, const Eigen::VectorXd& xi,
                                        const std::vector<double>& weights) {
  const std::size_t n = J.cols();
  const std::string rule = "must be " + std::to_string(n) + ", the Jacobian's columns";
  require(static_cast<std::size_t>(xi.size()) == n, "xi length", static_cast<double>(xi.size()), rule);
  require(weights.empty() || weights.size() == n, "weights length", static_cast<double>(weights.size()), rule);
  for (std::size_t i = 0; i < weights.size(); ++i)
    require_positive(weights[i], "weights[" + std::to_string(i) + "]", "", kLargestNumber);
  return detail::null_space_part(J, xi, weights, std::vector<bool>(n, false));
}

}  // namespace mmgrasp
