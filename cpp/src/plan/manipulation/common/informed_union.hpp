#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "plan/manipulation/common/grasp_ends.hpp"

namespace mmgrasp::detail {

/// Draws uniformly from the union of the informed ellipsoids of all pairs of ends of all grasps, cut by the sampling
/// bounds (P2 5.2.3, Algorithms 5.8-5.12 with their errata: the cross radius is sqrt(c^2 - c_min^2) / 2; pairs farther
/// apart than c have no ellipsoid; that of a pair of equal ends is a sphere; draws from the whole bounds are not
/// thinned).
///
/// Where the paper keeps a draw from one of a overlapping ellipsoids with probability 1/a, which needs all of them
/// counted, a draw is kept here when the ellipsoid it was made in is the first of those that contain it: the same
/// distribution, and the count ends at the first that does.
///
/// Where angles wrap, a pair's set is all q with distance(start, q) + distance(q, goal) below the cost. Unrolled, that
/// is a union of ellipsoids, from the start to every image of the goal by whole turns. A draw from one of them counts
/// when it is the image of q nearest to the start and the goal's image is the one nearest to it: each q does so once,
/// so the draws are uniform still, and only the two nearest turns of each angle matter. Where joints have weights, the
/// ellipsoids are those of the metric's coordinates, whose volumes these are.
class MMGRASP_EXPORT InformedUnion {
 public:
  InformedUnion(const GraspEnds& ends, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

  /// The cost to beat; infinite at first. Must not grow.
  void set_cost(double cost);
  double cost() const { return cost_; }
  /// How many grasps have a set that is not empty: these are the first ones.
  int grasps() const { return grasps_; }
  /// Upper bounds on the volume of a grasp's set and of the union: the sum over the ellipsoids, which may overlap and
  /// leave the bounds, but at most the volume of the bounds.
  double volume(int grasp);
  double volume();
  double box_volume() const { return box_volume_; }
  bool contains(int grasp, const double* q) const { return ends_.estimate(grasp, q) < cost_; }

  /// Writes a configuration to `q` and returns a grasp: uniform among the ellipsoids that contain it. -1 when the union
  /// is empty, or lies so nearly outside of the sampling bounds that ten thousand tries did not hit it.
  int draw(Rng& rng, double* q);
  /// Draws uniformly over the sampling bounds, whatever the cost, and over the grasps that can still win.
  int draw_box(Rng& rng, double* q);
  /// Draws from the ellipsoid around one of a grasp's pairs that holds paths a little more than `factor` times as long
  /// as the straight line, clamped to the bounds, whatever the cost.
  void draw_around(Rng& rng, int grasp, double factor, double* q);

 private:
  struct Pair {
    int grasp, start, goal;
    double c_min;   ///< Distance of the start and this image of the goal.
    double volume;  ///< Sum of the volumes up to this pair.
    /// Bit k is set where the k-th angle that wraps goes the long way round to the goal. 0: the nearest image.
    std::uint64_t long_ways = 0;
  };

  static bool same_ends(const Pair& a, const Pair& b) { return a.start == b.start && a.goal == b.goal; }
  void prepare();
  /// Adds a pair to `pairs_`, with all images of its goal that have an ellipsoid.
  void append_images(const Pair& nearest);
  /// The goal's image that a pair's ellipsoid ends at; valid until the next call where angles wrap.
  const double* goal_of(const Pair& pair);
  /// True for exactly one of all images of a point of the pair's set, one that lies in one of the pair's ellipsoids.
  bool is_representative(const Pair& pair, const double* q);
  double ellipsoid_volume(const Pair& pair) const;
  void draw_ellipsoid(Rng& rng, const Pair& pair, double c, double* q);
  bool in_box(const double* q) const;
  bool in_pair(const Pair& pair, const double* q) const;
  bool first_to_contain(std::size_t pair, const double* q) const;
  int any_containing(Rng& rng, const double* q) const;

  const GraspEnds& ends_;
  Eigen::VectorXd lower_, upper_;
  double unit_ball_volume_, box_volume_;
  double cost_;
  int grasps_;
  std::vector<Pair> all_;                ///< All pairs, by grasp.
  std::vector<Pair> pairs_;              ///< Pairs with an ellipsoid, by grasp; images of a goal in a row.
  std::vector<std::size_t> first_of_;    ///< Per grasp: its first pair in `all_`; at the end the number of pairs.
  std::vector<std::size_t> first_pair_;  ///< Per grasp: its first pair in `pairs_`.
  std::vector<double> volumes_;          ///< Per grasp: sum over its ellipsoids.
  bool prepared_ = false;
  Eigen::VectorXd direction_, goal_;  ///< Scratch.
};

}  // namespace mmgrasp::detail
