#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "plan/manipulation/common/grasp_ends.hpp"

namespace mmgrasp::detail {

/// Draws uniformly from the union of the informed ellipsoids of all pairs of ends of all grasps, cut by the joint box
/// (P2 5.2.3, Algorithms 5.8-5.12 with their errata: the cross radius is sqrt(c^2 - c_min^2) / 2; pairs farther apart
/// than c have no ellipsoid; a pair of equal ends has a ball; draws from the whole box are not thinned).
///
/// Where the paper keeps a draw from one of a overlapping ellipsoids with probability 1/a, which needs all of them
/// counted, a draw is kept here when the ellipsoid it was made in is the first of those that contain it: the same
/// distribution, and the count ends at the first that does.
class MMGRASP_EXPORT InformedUnion {
 public:
  InformedUnion(const GraspEnds& ends, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

  /// The cost to beat; infinite at first. Must not grow.
  void set_cost(double cost);
  double cost() const { return cost_; }
  /// Grasps whose set is not empty: the first so many.
  int grasps() const { return grasps_; }
  /// Volume of a grasp's set and of the union, or more: that of the ellipsoids together, which may overlap and leave
  /// the box, at most the box.
  double volume(int grasp);
  double volume();
  double box_volume() const { return box_volume_; }
  bool contains(int grasp, const double* q) const { return ends_.estimate(grasp, q) < cost_; }

  /// Writes a configuration to `q` and returns a grasp: uniform among the ellipsoids that contain it. -1 when the union
  /// is empty, or so nearly outside of the joint box that ten thousand tries did not meet it.
  int draw(Rng& rng, double* q);
  /// Uniform over the joint box, whatever the cost, and over the grasps that can still win.
  int draw_box(Rng& rng, double* q);
  /// From the ellipsoid of one of a grasp's pairs for paths `factor` times as long as its straight line, and a little;
  /// where that leaves the box, at its border. Whatever the cost.
  void draw_around(Rng& rng, int grasp, double factor, double* q);

 private:
  struct Pair {
    int grasp, start, goal;
    double c_min;   ///< Distance of the two ends.
    double volume;  ///< Cumulative over all pairs before and with this one.
  };

  void prepare();
  double ellipsoid_volume(const Pair& pair) const;
  void draw_ellipsoid(Rng& rng, const Pair& pair, double c, double* q);
  bool in_box(const double* q) const;
  bool in_pair(const Pair& pair, const double* q) const;
  bool first_to_contain(std::size_t pair, const double* q) const;
  int any_containing(Rng& rng, const double* q) const;

  const GraspEnds& ends_;
  Eigen::VectorXd lower_, upper_;
  double ball_volume_, box_volume_;
  double cost_;
  int grasps_;
  std::vector<Pair> all_;                ///< Of each grasp side by side, in the order of the grasps.
  std::vector<Pair> pairs_;              ///< Those with an ellipsoid.
  std::vector<std::size_t> first_of_;    ///< Of each grasp, in `all_`; and their number.
  std::vector<std::size_t> first_pair_;  ///< Of each grasp, in `pairs_`.
  std::vector<double> volumes_;          ///< Of each grasp: of its ellipsoids together.
  bool prepared_ = false;
  Eigen::VectorXd ball_;
};

}  // namespace mmgrasp::detail
