#pragma once

#include <cstdint>
#include <optional>

#include "collision/checker/bodies.hpp"
#include "collision/narrow/narrow.hpp"
#include "mmgrasp/collision/checker.hpp"

namespace mmgrasp {

/// Solvers and interpolation leave rounding at the limits.
constexpr double kLimitSlack = 1e-9;

/// Gaps are not looked for where a body moves farther than this: most would not do [m].
constexpr double kGapReach = 0.1;

namespace detail {

/// A pair of shapes, with a number its distance is not below.
struct Candidate {
  double bound = 0;
  int shape = 0;
  int other = 0;  ///< Another shape, or one of the scene.
  bool with_scene = false;
};

struct NearestPair {
  Candidate pair;
  SolidClearance gap;  ///< Infinite: there is none.
};

}  // namespace detail

/// Scratch of one checker on top of shared, immutable preparation.
struct CollisionChecker::Impl {
  class EdgeWalk;

  Impl(std::shared_ptr<const detail::Snapshot> snapshot_in, const JointGroup& group_in);

  /// Places what yes-or-no answers need: the group's frames and the balls of moving shapes.
  void place_balls(const double* q);
  /// The same, and all links' poses and `balls`.
  void place(const Eigen::VectorXd& q);
  /// Forgets what depends on root and reference.
  void forget();

  Rejection rejection(const Eigen::VectorXd& q);
  /// The same yes or no, but whatever hit last time is looked at first.
  bool is_free(const Eigen::VectorXd& q);
  /// The same for a configuration within limits that is placed already.
  bool placed_is_free();
  /// What touches first in a configuration that is placed already.
  std::optional<Contact> placed_contact();

  bool self_collides();
  bool scene_collides();
  /// Exact answers. What balls can tell is told by them.
  bool pair_collides(const detail::ShapePair& pair);
  bool hits_scene(int shape, int scene_shape);
  const detail::Rigid& pose(int shape);

  /// What the balls of the two say; the first one's grown by `more` [m], when only "apart" means anything.
  detail::CoverAnswer pair_balls(const detail::ShapePair& pair, double more = 0);
  detail::CoverAnswer scene_balls(int shape, int scene_shape, double more = 0);
  /// With `more` > 0 [m] false proves a gap wider than that, and true nothing. `hulls_meet`: their hulls are known to.
  bool pair_collides_exactly(const detail::ShapePair& pair, double more = 0, bool hulls_meet = false);
  bool hits_scene_exactly(int shape, int scene_shape, double more = 0);
  /// Whether the two touch (kOverlap), stay apart while they come no more than `motion` [m] closer (kApart), or
  /// neither. Without motion only the first is asked. `hulls_meet`: their hulls did not long ago, so that those are not
  /// asked; set when they do.
  detail::CoverAnswer pair_within(const detail::ShapePair& pair, double motion, char& hulls_meet);
  detail::CoverAnswer scene_within(int shape, int scene_shape, double motion);
  bool balls_apart(const detail::ShapePair& pair) const;
  /// In the order of the plan.
  detail::BallRows placed_balls() const {
    const float* x = ball_numbers.data();
    return {x, x + ball_row, x + 2 * ball_row, x + 3 * ball_row};
  }
  Eigen::Vector3d ball_centre(int ball) const {
    const detail::BallRows balls = placed_balls();
    return {balls.x[ball], balls.y[ball], balls.z[ball]};
  }
  /// False when plan->moving[body] hits a bounded scene shape. Clears `proven` unless it stays free while none of its
  /// points moves more than `motion` [m].
  bool body_is_free(int body, double motion, bool& proven);
  /// Fills `near` with the bounded scene shapes whose boxes meet the balls first .. last of the plan.
  void gather_near(int first, int last);
  /// The first of `count` shapes of the plan that hits the scene, with what it hits; false when none does.
  bool find_scene_hit(const std::vector<int>& shapes, int count, int first_ball);
  bool moving_hit_scene() { return find_scene_hit(plan->moving, plan->moving_in_scene, 0); }
  bool fixed_hit_scene() {
    return find_scene_hit(plan->fixed, plan->fixed_in_scene, static_cast<int>(plan->moving.size()));
  }

  /// The nearest pair at the configuration placed last.
  detail::NearestPair nearest();
  /// `still`: two of the robot's own shapes in the frame they share, so that the answer is the same digit for digit
  /// wherever they are.
  detail::SolidClearance gap_of(const detail::Candidate& pair, double bound, bool still = false);
  double box_bound(const detail::Candidate& pair, bool still = false);
  /// A gap of two still shapes, as the last place() puts it into the world.
  void to_world(detail::NearestPair& nearest) const;
  /// Calls visit(candidate) for every pair, bounded by spheres: those no configuration changes, or the others.
  template <class Visit>
  void each_pair(bool still, const Visit& visit) const;
  DistanceResult described(const detail::NearestPair& nearest) const;
  Eigen::VectorXd gradient(const detail::NearestPair& nearest, const Eigen::VectorXd& q);

  std::shared_ptr<const detail::Snapshot> snapshot;
  std::shared_ptr<const detail::PairPlan> plan;
  JointGroup group;
  std::size_t queries = 0;

  std::vector<double> frames;       ///< Of the last configuration; see Kernels::place_frames.
  std::vector<float> ball_numbers;  ///< Of the last configuration; see placed_balls.
  int ball_row;                     ///< Balls of the plan, whole lanes.
  bool frames_valid = false;
  Poses links;  ///< Of the last configuration given to place().
  bool links_valid = false;
  std::vector<Eigen::Vector3d> balls;  ///< World frame, per shape; of the last place().
  std::vector<detail::Rigid> poses;    ///< World frame, per shape; made when first asked for.
  std::vector<std::uint64_t> pose_stamp;
  std::uint64_t stamp = 0, fixed_stamp = 0;
  std::vector<char> moves;  ///< Per shape.

  struct Near {
    int shape, other;  ///< `other`: a scene shape, or the number of a varying pair.
  };
  std::vector<Near> near, unsure;
  std::vector<std::uint8_t> masks, pair_masks;

  std::optional<bool> constant_self;  ///< Pairs whose relative pose no configuration changes.
  std::optional<bool> fixed_scene;    ///< Links that no configuration moves, against the scene.
  int last_pair = -1;                 ///< What collided last tends to collide again.
  int last_shape = -1, last_scene = -1;

  std::optional<detail::NearestPair> nearest_still;  ///< Of the pairs that no configuration changes; see gap_of.
  std::vector<detail::Candidate> candidates;         ///< Scratch of nearest().
  Matrix6Xd point_jacobian;                          ///< Scratch of gradient().
};

}  // namespace mmgrasp
