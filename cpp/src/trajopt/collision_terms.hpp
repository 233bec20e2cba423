#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/detail/named_bodies.hpp"
#include "mmgrasp/trajopt/whole_body_trajectory.hpp"
#include "trajopt/interval_point.hpp"
#include "trajopt/terms.hpp"
#include "trajopt/tool_chain.hpp"
#include "trajopt/whole_body_nlp.hpp"

namespace mmgrasp::detail {

/// A plane between two bodies that came near: the point of `a` has to stay `margin` in front of the point of `b` along
/// a normal that is kept. Smooth in the configuration, and at the place where it was taken equal to their signed
/// distance (P1 4.10) up to second order.
struct SeparatingPlane {
  std::shared_ptr<const ToolChain> a, b;  ///< Chains to the links of the nearest points; `b` null: that point is fixed.
  Eigen::Vector3d p_a = Eigen::Vector3d::Zero(),
                  p_b = p_a;                          ///< The points in their links' frames, fixed: in the world.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Unit, from b to a.
  double margin = 0;
};

/// Gaps along separating planes at one fraction of an interval. Variables: locals of an IntervalPoint.
class CollisionTerm : public CurvedTerm {
 public:
  CollisionTerm(const IntervalPoint& point, std::vector<SeparatingPlane> planes);
  void value(const double* x, double* out) const override;
  void jacobian(const double* x, double* out) const override;
  void hessian(const double* x, const double* multipliers, double* out) const override;

 private:
  /// Where the links are that have points of planes.
  struct Place {
    Eigen::VectorXd x;  ///< Locals that it belongs to.
    std::vector<ToolChain::State> links;
  };
  struct Links {
    int a, b;  ///< Where a plane's links are in `chains_`; -1: fixed.
  };
  /// Solvers ask for value, Jacobian and Hessian in turn at the same x.
  const Place& placed(const double* x) const;
  int index_of(const std::shared_ptr<const ToolChain>& chain);

  IntervalPoint point_;
  std::vector<SeparatingPlane> planes_;
  std::vector<std::shared_ptr<const ToolChain>> chains_;
  std::vector<Links> links_;
  mutable Place place_;
};

/// Where which pairs of bodies have to be kept apart; planes are taken anew along every trajectory.
class MMGRASP_EXPORT CollisionRows {
 public:
  /// `pinned`: waypoints whose configuration or tool pose is prescribed; bodies that are closer than the margin there
  /// are given what room they have. The paddings of the checkers' worlds are kept beside the margin.
  CollisionRows(std::vector<CollisionChecker*> checkers, std::vector<int> pinned, double margin,
                double constraint_distance);

  /// Looks along a trajectory, and where its judge finds collisions between the places looked at; false when nothing
  /// collides. Pairs that collide anywhere are constrained from then on wherever they are within constraint_distance.
  bool look_along(const WholeBodyTrajectory& trajectory);
  /// `positions`, one per waypoint, are known to be free, also straight between them: what is within
  /// constraint_distance of the scene there is constrained. With `keeps_sides`, bodies that collide later are pushed
  /// apart to the sides on which they lie there, so that this motion stays within all constraints.
  void keep_clear(const std::vector<Eigen::VectorXd>& positions, bool keeps_sides);
  void add_to(WholeBodyNlp& nlp, bool diff_drive) const;

 private:
  using Pair = std::tuple<bool, std::string, std::string>;  // with the scene; a; b
  using Sample = std::pair<int, double>;                    // interval, fraction
  /// Notes the pairs that are near each other.
  void watch_at(CollisionChecker& checker, const Eigen::VectorXd& q);
  void take_planes(const WholeBodyTrajectory& trajectory);
  void take_planes_at(const Sample& sample, const Eigen::VectorXd& q, const std::map<Pair, double>& rooms);
  Eigen::VectorXd reference(const Sample& sample) const;
  std::set<Sample> regular_samples() const;
  double padding_of(const CollisionChecker& checker, const DistanceResult& d) const;
  void watch(const CollisionChecker& checker, const DistanceResult& d);
  /// What the padding of a pair asks for, without the margin [m].
  double kept_apart(const Pair& pair) const;
  /// The distance that each pair has to keep.
  std::map<Pair, double> rooms_along(const std::vector<Eigen::VectorXd>& positions);

  std::vector<CollisionChecker*> checkers_;
  std::vector<int> pinned_;
  double margin_, constraint_distance_;
  std::map<const CollisionChecker*, BodyPadding> bodies_;
  double padding_ = 0;  ///< No pair's is larger [m].
  std::set<Pair> watched_;
  std::set<Pair> corners_;           ///< Pairs whose padding met though they were that far apart.
  std::map<Pair, double> paddings_;  ///< Padding of those watched pairs that have any [m].
  std::set<Sample> samples_;         // samples beside the regular ones
  std::vector<Eigen::VectorXd> reference_;
  std::map<int, std::shared_ptr<const ToolChain>> chains_;  ///< To links that have points of planes.
  std::map<Sample, std::map<Pair, std::vector<SeparatingPlane>>> planes_;
};

}  // namespace mmgrasp::detail
