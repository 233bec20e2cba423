#include "collision/edge/edge_continuous.hpp"

#include <algorithm>
#include <cmath>

#include "collision/checker/checker_access.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp {

namespace detail {

namespace {

using Impl = CheckerAccess::Impl;

// Along the edge up to which both joint limits (with the checker's slack) hold; 1 when they hold everywhere.
double within_limits_up_to(const JointGroup& group, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1) {
  double end = 1;
  for (Eigen::Index i = 0; i < q0.size(); ++i) {
    const double bound = q1[i] > q0[i] ? group.upper()[i] + kLimitSlack : group.lower()[i] - kLimitSlack;
    const double beyond = q1[i] > q0[i] ? q1[i] - bound : bound - q1[i];
    if (beyond > 0) end = std::min(end, (bound - q0[i]) / (q1[i] - q0[i]));
  }
  return end;
}

// Conservative advancement (Mirtich 1996), each pair at its own pace: a gap divided by how fast the two can close it is
// a stretch of the edge on which they cannot meet, so a pair is looked at again only when its stretch ends.
class Advance {
 public:
  Advance(Impl& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double tolerance)
      : checker_(checker), q0_(q0), delta_(q1 - q0), tolerance_(tolerance) {
    const Eigen::VectorXd way = delta_.cwiseAbs();
    const CheckerOptions& options = checker.snapshot->options;
    const PairPlan& plan = *checker.plan;
    const MotionRates own = plan.rates_along(q0, q1);
    const MotionRates& bounds = plan.rates.finite ? plan.rates : own;
    if (options.check_self && !plan.varying.empty()) {
      const Eigen::VectorXd rates = bounds.pairs.transpose() * way;
      for (std::size_t i = 0; i < plan.varying.size(); ++i)
        add(plan.varying[i].a, plan.varying[i].b, false, rates[static_cast<Eigen::Index>(i)]);
    }
    if (options.check_scene && !plan.moving.empty()) {
      const Eigen::VectorXd rates = bounds.shapes.transpose() * way;
      for (std::size_t i = 0; i < static_cast<std::size_t>(plan.moving_in_scene); ++i) {
        for (int k = 0; k < static_cast<int>(checker.snapshot->scene.size()); ++k)
          add(plan.moving[i], k, true, rates[static_cast<Eigen::Index>(i)]);
      }
    }
  }

  /// Goes up to `end`; true when nothing comes within the tolerance before. `fraction` and `contact` say where it
  /// stops.
  bool run(double end, double& fraction, std::optional<Contact>& contact) {
    double at = 0;
    while (!open_.empty()) {
      ++checker_.queries;
      checker_.place(q0_ + delta_ * at);
      std::size_t kept = 0;
      double next = kInfinity;
      for (Item item : open_) {
        if (item.clear_to <= at + kTogether) {
          const double gap = gap_of(item, item.rate * (end - at) + tolerance_);
          if (gap < tolerance_) {
            fraction = at;
            contact = contact_of(item);
            return false;
          }
          // Half the tolerance stays between them: rounding cannot let them meet.
          item.clear_to = at + (gap - 0.5 * tolerance_) / item.rate;
        }
        if (item.clear_to >= end) continue;
        next = std::min(next, item.clear_to);
        open_[kept++] = item;
      }
      open_.resize(kept);
      if (kept > 0) at = next;
    }
    return true;
  }

 private:
  struct Item {
    int shape, other;
    bool with_scene;
    double rate;      ///< The two approach each other by at most this along the whole edge [m].
    double clear_to;  ///< Up to here they cannot meet.
  };
  // Pairs whose stretches end this close together are looked at in one go.
  static constexpr double kTogether = 0.02;

  void add(int shape, int other, bool with_scene, double rate) {
    if (!(rate <= 0)) open_.push_back({shape, other, with_scene, rate, 0});
  }

  const Solid& solid_of(const Item& item) const {
    const BodyShape& shape = checker_.snapshot->shapes[item.shape];
    return item.with_scene ? *shape.padded : *shape.solid;
  }

  // A number the gap, padding taken off, is not below; the gap itself when that would be below the tolerance or tell
  // of a short stretch only.
  double gap_of(const Item& item, double enough) {
    const Snapshot& snapshot = *checker_.snapshot;
    const Solid& a = solid_of(item);
    const Solid& b = item.with_scene ? *snapshot.scene[item.other].solid : *snapshot.shapes[item.other].solid;
    const Rigid& T_b = item.with_scene ? snapshot.scene[item.other].T_world : checker_.pose(item.other);
    const Eigen::Vector3d& ball_b = item.with_scene ? snapshot.scene[item.other].ball : checker_.balls[item.other];
    const double useful = std::min(enough, 0.1 * item.rate + tolerance_);
    const double balls = (checker_.balls[item.shape] - ball_b).norm() - a.ball_radius - b.ball_radius;
    if (balls >= useful) return balls;
    const double margin = a.margin + b.margin;
    const double boxes = boxes_gap(a, checker_.pose(item.shape), b, T_b) - margin;
    if (boxes >= useful) return boxes;
    return std::min(enough, solids_distance(a, checker_.pose(item.shape), b, T_b, enough + margin).distance - margin);
  }

  Contact contact_of(const Item& item) const {
    const Snapshot& snapshot = *checker_.snapshot;
    return {snapshot.bodies[snapshot.shapes[item.shape].body].name,
            item.with_scene ? snapshot.object_names[snapshot.scene[item.other].object]
                            : snapshot.bodies[snapshot.shapes[item.other].body].name,
            item.with_scene};
  }

  Impl& checker_;
  const Eigen::VectorXd& q0_;
  Eigen::VectorXd delta_;
  double tolerance_;
  std::vector<Item> open_;
};

}  // namespace

EdgeResult advance_edge(CollisionChecker& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                        const EdgeOptions& options) {
  Impl& impl = CheckerAccess::of(checker);
  const std::size_t before = checker.queries();
  EdgeResult result;
  const Rejection start = checker.rejection(q0);
  if (start != Rejection::none) {
    result.fraction = 0;
    if (start != Rejection::limits) result.contact = checker.first_contact(q0);
  } else {
    const double end = within_limits_up_to(checker.group(), q0, q1);
    result.free = Advance(impl, q0, q1, options.tolerance).run(end, result.fraction, result.contact) && end == 1;
    if (!result.free && !result.contact) result.fraction = end;
  }
  result.checks = static_cast<int>(checker.queries() - before);
  return result;
}

}  // namespace detail

}  // namespace mmgrasp
