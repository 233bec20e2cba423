#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {

/// One unknown of a population search.
struct MMGRASP_EXPORT SearchVariable {
  enum class Kind {
    real,      ///< Any number from lower to upper.
    whole,     ///< Whole numbers from lower to upper.
    category,  ///< Whole numbers that only name choices: no one is between two others.
  };
  std::string name;
  Kind kind = Kind::real;
  double lower = 0, upper = 1;  ///< Finite; whole for whole numbers and categories.
  double mutation = 0;  ///< "ga", of a real one: half width of its mutation; 0: by PopulationOptions::mutation_size.
};

/// What a point is worth: constraints broken, and the objective, which counts only where none is.
struct MMGRASP_EXPORT ConstrainedValue {
  double violation = 0;  ///< >= 0; 0: feasible.
  double objective = 0;
  /// The three rules of P2 3.3.1 (Deb 2000): feasible before infeasible; of two infeasible ones the less violated; of
  /// two feasible ones the cheaper.
  bool better_than(const ConstrainedValue& other) const;
};

/// Real, whole and categorical unknowns, of which nothing is known but values at points.
struct MMGRASP_EXPORT PopulationProblem {
  std::vector<SearchVariable> variables;
  /// Called from the searching thread with x inside the bounds.
  std::function<ConstrainedValue(const Eigen::VectorXd& x)> evaluate;
  /// Upper bound of variable i where it depends on those before it (a length on the chosen section); empty: none does.
  std::function<double(const Eigen::VectorXd& x, int i)> upper;
  /// A point near x for Bees: `size` is the neighbourhood as a share of each range. Empty: P2's Str1, all variables
  /// drawn from a box around x, beyond a bound put onto it. The result is brought inside the bounds.
  std::function<Eigen::VectorXd(const Eigen::VectorXd& x, double size, Rng& rng)> neighbour;
  void check() const;
};

/// Size and budget of a population search, then the parameters of each algorithm; ns, nb, ... are P2's names for them.
struct MMGRASP_EXPORT PopulationOptions {
  int population = 34;         ///< Points a round (P2's ns); >= 4.
  int max_evaluations = 1530;  ///< Budget (P2's ns times iterations); > 0.
  /// Ends as solved once a feasible point costs no more; lowest: never.
  double target = -std::numeric_limits<double>::infinity();
  unsigned seed = 1;  ///< Same seed, same answer.
  // "bees" (P2 table 3.2); setting 7 of table 3.5
  int elite_sites = 1;         ///< ne; in [0, best_sites].
  int best_sites = 4;          ///< nb; in [1, population].
  int elite_recruits = 10;     ///< nre; > 0.
  int recruits = 3;            ///< nrb; > 0; recruits of all sites at most the population.
  int stagnation_limit = 10;   ///< Rounds without progress after which a site is abandoned; > 0. P2 does not print it.
  double neighbourhood = 0.2;  ///< Its width as a share of each range at first; in (0, 1]. P2 does not print it.
  double shrinking = 0.8;      ///< Factor after a round without progress; in (0, 1]. P2 does not print it.
  // "ga"
  double mutation_rate = 0.3;  ///< Chance of each variable; in [0, 1].
  /// Half width of a real variable's mutation as a share of its range, where the variable has none of its own; in
  /// (0, 1].
  double mutation_size = 0.25;
  // "pso"
  double connectivity = 0.5;  ///< Share of the swarm, the closest ones, that each particle hears of; in (0, 1].
  double inertia = 0.7;       ///< >= 0
  double acceleration = 2.0;  ///< c1 and c2; > 0.
  void check() const;
};

/// The best point that a population search saw, and how the best objective fell while it ran.
struct MMGRASP_EXPORT PopulationResult {
  /// solved: the target was met. timeout: the budget ended it, and says nothing about how good x is. stopped.
  Outcome outcome = Outcome::timeout;
  Eigen::VectorXd x;       ///< The best point seen.
  ConstrainedValue value;  ///< What it is worth.
  int evaluations = 0;
  std::vector<double> history;  ///< Best objective after each evaluation; infinite while nothing was feasible.
};

/// A population that moves towards better points. Ties go to the earlier point, so answers depend on the seed alone.
///
///     const PopulationResult found = make_population_search("bees")->solve(problem);
class MMGRASP_EXPORT PopulationSearch {
 public:
  virtual ~PopulationSearch();
  virtual std::string name() const = 0;
  /// Throws InvalidInput for bad problems and options.
  PopulationResult solve(const PopulationProblem& problem, const PopulationOptions& options = {},
                         const Monitor& monitor = {}) const;

 protected:
  class Run;

 private:
  virtual void search(Run& run) const = 0;
};

/// "bees" (Bees Algorithm; Pham et al. 2006; P2 Algorithm 3.2), "ga" (binary tournaments, one-point crossover, mutation
/// as P2 3.5.1), "pso" (particle swarm; each particle hears of the closest ones and copies categories, as P2 3.5.1).
MMGRASP_EXPORT std::vector<std::string> population_search_names();
/// Throws InvalidInput listing the known names on a wrong one.
MMGRASP_EXPORT std::unique_ptr<PopulationSearch> make_population_search(const std::string& name);

}  // namespace mmgrasp
