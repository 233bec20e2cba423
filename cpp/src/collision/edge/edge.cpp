#include "mmgrasp/collision/edge.hpp"

#include <algorithm>
#include <cmath>

#include "collision/checker/bodies.hpp"
#include "collision/checker/edge_walk.hpp"
#include "collision/checker/moving_frames.hpp"
#include "collision/edge/edge_continuous.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp {

void EdgeOptions::check() const {
  require(std::isfinite(joint_step) && joint_step > 0, "joint_step", joint_step, "must be finite and > 0 [rad or m]");
  require(workspace_step > 0, "workspace_step", workspace_step, "must be > 0 [m]");
  require(std::isfinite(tolerance) && tolerance > 0, "tolerance", tolerance, "must be finite and > 0 [m]");
}

namespace {

// A body that moves with a frame, as the ball around it.
struct Traveller {
  int frame;
  double radius;  ///< Farthest point from the frame's origin [m].
};

std::vector<Traveller> travellers(const CollisionChecker& checker, const detail::MovingFrames& frames) {
  const Robot& robot = checker.group().robot();
  std::vector<Traveller> out;
  const auto add = [&](int link, const Pose& T_link_body, const std::vector<LinkShape>& shapes) {
    for (const LinkShape& shape : shapes) {
      const auto solid = detail::shared_solid(shape.shape, 0);
      if (solid->never_collides()) continue;
      const Eigen::Vector3d centre =
          frames.link_in_frame(link) * (T_link_body * (shape.T_link_shape * solid->ball_centre));
      out.push_back({frames.frame_of(link), centre.norm() + solid->ball_radius});
    }
  };
  for (std::size_t link = 0; link < robot.links().size(); ++link)
    add(static_cast<int>(link), Pose::Identity(), robot.links()[link].collisions);
  for (const auto& [name, held] : checker.world().attached())
    add(robot.link_index(held.link), held.T_link_object, held.shapes);
  return out;
}

// Pieces of the edge so that neither bound is passed.
long pieces_of(const CollisionChecker& checker, const Eigen::VectorXd& delta, const EdgeOptions& options) {
  double pieces = std::max(1.0, std::ceil(delta.maxCoeff() / options.joint_step - 1e-9));
  if (std::isfinite(options.workspace_step)) {
    const double motion = (motion_bounds(checker).array() * delta.array()).sum();
    if (delta.maxCoeff() > 0) pieces = std::max(pieces, std::ceil(motion / options.workspace_step - 1e-9));
  }
  require(pieces < detail::kMaxPieces, "joint_step and workspace_step", pieces,
          "must not cut the edge into 1e9 pieces");
  return static_cast<long>(pieces);
}

EdgeResult stepped_edge(CollisionChecker& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                        const EdgeOptions& options) {
  const Eigen::VectorXd delta = (q1 - q0).cwiseAbs();
  const long pieces = pieces_of(checker, delta, options);
  const std::size_t before = checker.queries();
  EdgeResult result;
  // The quick answer first: most edges are asked about because they are likely to be free.
  const double step = delta.maxCoeff() > 0 ? delta.maxCoeff() / static_cast<double>(pieces) : 1;
  result.free = checker.edge_is_free(q0, q1, step);
  result.checks = static_cast<int>(checker.queries() - before);
  if (result.free) return result;
  long i = 0;
  Eigen::VectorXd q = q0;
  while (i < pieces && checker.is_free(q)) {
    ++i;
    q = q0 + (q1 - q0) * (static_cast<double>(i) / static_cast<double>(pieces));
  }
  result.fraction = static_cast<double>(i) / static_cast<double>(pieces);
  if (checker.rejection(q) != Rejection::limits) result.contact = checker.first_contact(q);
  result.checks = static_cast<int>(checker.queries() - before);
  return result;
}

}  // namespace

EdgeResult check_edge(CollisionChecker& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                      const EdgeOptions& options) {
  options.check();
  checker.group().check_configuration(q0, "q0");
  checker.group().check_configuration(q1, "q1");
  if (options.continuous) return detail::advance_edge(checker, q0, q1, options);
  return stepped_edge(checker, q0, q1, options);
}

Eigen::VectorXd motion_bounds(const CollisionChecker& checker) {
  const JointGroup& group = checker.group();
  const detail::MovingFrames frames(group);
  // Limits are kept up to rounding.
  const Eigen::VectorXd largest =
      group.lower().cwiseAbs().cwiseMax(group.upper().cwiseAbs()) + Eigen::VectorXd::Constant(group.size(), 1e-6);
  Eigen::VectorXd bounds = Eigen::VectorXd::Zero(group.size()), rates(group.size());
  for (const Traveller& body : travellers(checker, frames)) {
    rates.setZero();
    frames.add_rates(body.frame, body.radius, -1, largest, rates);
    bounds = bounds.cwiseMax(rates);
  }
  return bounds;
}

std::vector<char> are_free(const CollisionChecker& checker, const Eigen::MatrixXd& Q, int threads) {
  require(Q.rows() == checker.group().size(), "Q rows", static_cast<double>(Q.rows()),
          "must be " + std::to_string(checker.group().size()) + " (group \"" + checker.group().name() + "\")");
  for (Eigen::Index i = 0; i < Q.cols(); ++i) {
    if (!Q.col(i).allFinite()) checker.group().check_configuration(Q.col(i), "Q column " + std::to_string(i) + " q");
  }
  constexpr Eigen::Index kBlock = 64;
  const auto blocks = static_cast<std::size_t>((Q.cols() + kBlock - 1) / kBlock);
  const int workers = std::min(resolve_threads(threads), std::max(1, static_cast<int>(blocks)));
  std::vector<CollisionChecker> checkers;
  for (int i = 0; i < workers; ++i) checkers.push_back(checker.clone());
  std::vector<char> free(static_cast<std::size_t>(Q.cols()));
  parallel_for(blocks, workers, [&](std::size_t block, int worker) {
    const Eigen::Index first = static_cast<Eigen::Index>(block) * kBlock;
    Eigen::VectorXd q(Q.rows());
    for (Eigen::Index i = first; i < std::min(first + kBlock, Q.cols()); ++i) {
      q = Q.col(i);
      free[i] = checkers[worker].is_free(q);
    }
  });
  return free;
}

}  // namespace mmgrasp
