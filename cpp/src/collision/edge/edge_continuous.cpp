#include "collision/edge/edge_continuous.hpp"

#include <algorithm>
#include <cmath>

#include "collision/checker/pair_tests.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

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

// Conservative advancement (Mirtich 1996), each pair at its own pace: a clearance divided by how fast the two can close
// it is a stretch of the edge on which they cannot meet, so a pair is measured again only when its stretch ends.
class Advance {
 public:
  Advance(Placement& placement, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double tolerance,
          const Eigen::VectorXd& bend)
      : placement_(placement), snapshot_(placement.snapshot()), q0_(q0), delta_(q1 - q0), tolerance_(tolerance) {
    const Eigen::VectorXd way = delta_.cwiseAbs();
    const PairPlan& plan = placement.plan();
    const MotionRates along_edge = plan.rates_along(q0, q1);
    const MotionRates& bounds = plan.rates.finite ? plan.rates : along_edge;
    const Eigen::VectorXd aside = bend.size() > 0 ? bend : Eigen::VectorXd(Eigen::VectorXd::Zero(way.size()));
    if (snapshot_.options.check_self && !plan.varying.empty()) {
      const Eigen::VectorXd rates = bounds.pairs.transpose() * way, strays = bounds.pairs.transpose() * aside;
      for (std::size_t i = 0; i < plan.varying.size(); ++i)
        add(plan.varying[i].a, plan.varying[i].b, false, rates[static_cast<Eigen::Index>(i)],
            strays[static_cast<Eigen::Index>(i)]);
    }
    if (snapshot_.options.check_scene && !plan.moving.empty()) {
      const Eigen::VectorXd rates = bounds.shapes.transpose() * way, strays = bounds.shapes.transpose() * aside;
      for (int i = 0; i < plan.moving_in_scene; ++i) {
        for (int k = 0; k < static_cast<int>(snapshot_.scene.size()); ++k) {
          if (!snapshot_.allowed(plan.moving[i], k)) add(plan.moving[i], k, true, rates[i], strays[i]);
        }
      }
    }
  }

  /// Goes up to `end`; true when nothing comes within the tolerance before. `fraction` and `contact` say where it
  /// stops.
  bool run(double end, double& fraction, std::optional<Contact>& contact) {
    double at = 0;
    while (!open_.empty()) {
      throw_if_interrupted();
      ++checks_;
      placement_.place_links(q0_ + delta_ * at);
      std::size_t kept = 0;
      double next = kInfinity;
      for (Item item : open_) {
        if (item.clear_to <= at + kTogether) {
          const double least = tolerance_ + item.strays;
          const double clearance = clearance_of(item, item.rate * (end - at) + least, least);
          if (clearance < least) {
            fraction = at;
            contact = contact_of(item);
            return false;
          }
          // Half the tolerance stays between them: rounding cannot let them meet.
          item.clear_to = item.rate > 0 ? at + (clearance - item.strays - 0.5 * tolerance_) / item.rate : end;
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

  /// Configurations placed by run().
  std::size_t checks() const { return checks_; }

 private:
  struct Item {
    int shape, other;
    bool with_scene;
    double rate;      ///< The two approach each other by at most this along the whole edge [m],
    double strays;    ///< and by this where the motion leaves the straight line [m].
    double clear_to;  ///< They cannot meet before this fraction of the edge.
  };
  // Pairs whose stretches end this close together are measured in one go, as a fraction of the edge.
  static constexpr double kTogether = 0.02;

  void add(int shape, int other, bool with_scene, double rate, double strays) {
    if (!(rate <= 0) || !(strays <= 0)) open_.push_back({shape, other, with_scene, rate, strays, 0});
  }

  const Solid& solid_of(const Item& item) const {
    const BodyShape& shape = snapshot_.shapes[item.shape];
    return item.with_scene ? *shape.padded : *shape.solid;
  }

  // A lower bound of the clearance, padding taken off; the clearance itself when the bound would be below the tolerance
  // or prove a short stretch only.
  double clearance_of(const Item& item, double enough, double least) {
    const Solid& a = solid_of(item);
    const Solid& b = item.with_scene ? *snapshot_.scene[item.other].solid : *snapshot_.shapes[item.other].solid;
    const Rigid& T_b = item.with_scene ? snapshot_.scene[item.other].T_world : placement_.pose(item.other);
    const Eigen::Vector3d& centre_b =
        item.with_scene ? snapshot_.scene[item.other].sphere_centre : placement_.shape_centre(item.other);
    const double useful = std::min(enough, 0.1 * item.rate + least);
    const double spheres = (placement_.shape_centre(item.shape) - centre_b).norm() - a.sphere_radius - b.sphere_radius;
    if (spheres >= useful) return spheres;
    const double margin = a.margin + b.margin;
    const Rigid& T_a = placement_.pose(item.shape);
    const double boxes = boxes_clearance(a, T_a, b, T_b) - margin;
    if (boxes >= useful) return boxes;
    return std::min(enough, solids_distance(a, T_a, b, T_b, enough + margin).distance - margin);
  }

  Contact contact_of(const Item& item) {
    return {snapshot_.bodies[snapshot_.shapes[item.shape].body].name,
            item.with_scene ? snapshot_.object_names[snapshot_.scene[item.other].object]
                            : snapshot_.bodies[snapshot_.shapes[item.other].body].name,
            item.with_scene, item.with_scene && only_padding_meets(placement_, item.shape, item.other)};
  }

  Placement& placement_;
  const Snapshot& snapshot_;
  const Eigen::VectorXd& q0_;
  Eigen::VectorXd delta_;
  double tolerance_;
  std::vector<Item> open_;
  std::size_t checks_ = 0;
};

}  // namespace

EdgeResult advance_edge(CheckerEngine& engine, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double tolerance,
                        const Eigen::VectorXd& bend) {
  const std::size_t before = engine.queries();
  EdgeResult result;
  const Rejection start = engine.rejection(q0);
  if (start != Rejection::none) {
    result.fraction = 0;
    if (start != Rejection::limits) result.contact = engine.first_contact(q0);
  } else {
    const double end = within_limits_up_to(engine.group(), q0, q1);
    Advance advance(engine.placement(), q0, q1, tolerance, bend);
    result.free = advance.run(end, result.fraction, result.contact) && end == 1;
    engine.count_queries(advance.checks());
    if (!result.free && !result.contact) result.fraction = end;
  }
  result.checks = static_cast<int>(engine.queries() - before);
  return result;
}

}  // namespace mmgrasp::detail
