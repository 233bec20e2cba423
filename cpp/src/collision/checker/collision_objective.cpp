#include "mmgrasp/collision/collision_objective.hpp"

#include <cmath>
#include <mutex>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

/// Cost of self pairs that come nearer than a margin. Threads that evaluate at the same time get a checker each.
class SelfDistance final : public IkObjective {
 public:
  SelfDistance(const CollisionChecker& checker, double margin, double weight)
      : IkObjective(checker.group().size()), margin_(margin), weight_(weight) {
    idle_.push_back(checker.clone());
  }

  std::string name() const override { return "self distance"; }

  double evaluate(const Eigen::VectorXd& q, Eigen::VectorXd& gradient) const override {
    CollisionChecker checker = taken();
    const std::vector<DistanceResult> near = checker.distances(q, margin_);
    given_back(std::move(checker));
    gradient.setZero(q.size());
    double cost = 0;
    for (const DistanceResult& pair : near) {
      if (pair.with_scene) continue;
      const double lack = 1 - pair.value / margin_;
      cost += weight_ * lack * lack;
      gradient -= 2 * weight_ * lack / margin_ * pair.gradient;
    }
    return cost;
  }

 private:
  // A checker has scratch of its own, so each evaluation that runs at the same time has one to itself.
  CollisionChecker taken() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    CollisionChecker checker = std::move(idle_.back());
    if (idle_.size() > 1)
      idle_.pop_back();
    else
      idle_.back() = checker.clone();
    return checker;
  }

  void given_back(CollisionChecker checker) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    idle_.push_back(std::move(checker));
  }

  double margin_, weight_;
  mutable std::mutex mutex_;
  mutable std::vector<CollisionChecker> idle_;  // never empty
};

}  // namespace

std::shared_ptr<const IkObjective> make_self_distance_objective(const CollisionChecker& checker, double margin,
                                                                double weight) {
  require_positive(margin, "margin");
  require_not_negative(weight, "objective weight");
  return std::make_shared<SelfDistance>(checker, margin, weight);
}

}  // namespace mmgrasp
