#pragma once

#include <algorithm>

#include "mmgrasp/optim/population_search.hpp"

namespace mmgrasp {

/// A point and its value.
struct SearchPoint {
  Eigen::VectorXd x;
  ConstrainedValue value;
};

/// What the algorithms share: draws, bounds, budget, the best point. Points beyond the budget are not evaluated: each
/// algorithm looks at done() after every point.
class PopulationSearch::Run {
 public:
  Run(const PopulationProblem& problem, const PopulationOptions& options, const Monitor& monitor)
      : options(options), rng(options.seed), problem_(problem), monitor_(monitor) {}

  const PopulationOptions& options;
  Rng rng;
  PopulationResult result;

  const std::vector<SearchVariable>& variables() const { return problem_.variables; }
  int size() const { return static_cast<int>(problem_.variables.size()); }
  bool discrete(int i) const { return variables()[i].kind != SearchVariable::Kind::real; }
  double upper(const Eigen::VectorXd& x, int i) const {
    const double own = variables()[i].upper;
    return problem_.upper ? std::clamp(problem_.upper(x, i), variables()[i].lower, own) : own;
  }
  /// Uniform over variable i, given those before it.
  double draw(const Eigen::VectorXd& x, int i);
  Eigen::VectorXd draw();
  Eigen::VectorXd neighbour(const Eigen::VectorXd& x, double size);
  /// Inside the bounds and whole where it must be; evaluated.
  SearchPoint point(Eigen::VectorXd x);
  bool done() const { return done_; }

 private:
  void bring_inside(Eigen::VectorXd& x) const;

  const PopulationProblem& problem_;
  const Monitor& monitor_;
  bool done_ = false;
};

std::unique_ptr<PopulationSearch> make_bees();
std::unique_ptr<PopulationSearch> make_genetic();
std::unique_ptr<PopulationSearch> make_particle_swarm();

}  // namespace mmgrasp
