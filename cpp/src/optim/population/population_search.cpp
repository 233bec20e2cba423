#include "mmgrasp/optim/population_search.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "optim/population/population_run.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

struct Entry {
  const char* name;
  std::unique_ptr<PopulationSearch> (*make)();
};
constexpr Entry kSearches[] = {{"bees", make_bees}, {"ga", make_genetic}, {"pso", make_particle_swarm}};

}  // namespace

bool ConstrainedValue::better_than(const ConstrainedValue& other) const {
  if (violation > 0 || other.violation > 0) return violation < other.violation;
  return objective < other.objective;
}

void PopulationProblem::check() const {
  require(!variables.empty(), "variables", "[]", "must not be empty");
  require(static_cast<bool>(evaluate), "evaluate", "none", "must be a function");
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const SearchVariable& v = variables[i];
    const std::string field = "variables[" + std::to_string(i) + "]";
    require(std::isfinite(v.lower) && std::isfinite(v.upper) && v.lower <= v.upper, field + ".upper", v.upper,
            "bounds must be finite, lower = " + std::to_string(v.lower) + " not above upper");
    const bool whole = std::floor(v.lower) == v.lower && std::floor(v.upper) == v.upper;
    require(v.kind == SearchVariable::Kind::real || whole, field + ".lower", v.lower, "bounds must be whole numbers");
    require_not_negative(v.mutation, field + ".mutation");
  }
}

void PopulationOptions::check() const {
  const auto share = [](double value, const char* field, bool zero) {
    require((zero ? value >= 0 : value > 0) && value <= 1, field, value,
            zero ? "must be in [0, 1]" : "must be in (0, 1]");
  };
  require_count(population, "population", 4, 1'000'000);
  require_count(max_evaluations, "max_evaluations");
  require(!std::isnan(target), "target", target, "must be a number");
  require(best_sites >= 1 && best_sites <= population, "best_sites", best_sites, "must be from 1 to the population");
  require(elite_sites >= 0 && elite_sites <= best_sites, "elite_sites", elite_sites, "must be from 0 to best_sites");
  require_count(elite_recruits, "elite_recruits", 1, 1'000'000);
  require_count(recruits, "recruits", 1, 1'000'000);
  const int local = elite_sites * elite_recruits + (best_sites - elite_sites) * recruits;
  require(local <= population, "population", population,
          "must be at least the recruits of all sites together, " + std::to_string(local));
  require_count(stagnation_limit, "stagnation_limit");
  share(neighbourhood, "neighbourhood", false);
  share(shrinking, "shrinking", false);
  share(mutation_rate, "mutation_rate", true);
  share(mutation_size, "mutation_size", false);
  share(connectivity, "connectivity", false);
  require_not_negative(inertia, "inertia");
  require_positive(acceleration, "acceleration");
}

double PopulationSearch::Run::draw(const VectorXd& x, int i) {
  const double low = variables()[i].lower, high = upper(x, i);
  if (!discrete(i)) return rng.uniform(low, high);
  return low + static_cast<double>(rng.index(static_cast<std::size_t>(std::floor(high) - low) + 1));
}

VectorXd PopulationSearch::Run::draw() {
  VectorXd x = VectorXd::Zero(size());
  for (int i = 0; i < size(); ++i) x(i) = draw(x, i);
  return x;
}

VectorXd PopulationSearch::Run::neighbour(const VectorXd& x, double share) {
  if (problem_.neighbour) return problem_.neighbour(x, share, rng);
  VectorXd near = x;
  for (int i = 0; i < size(); ++i) {
    const SearchVariable& v = variables()[i];
    if (v.kind == SearchVariable::Kind::category) {
      if (rng.uniform() < share) near(i) = draw(near, i);
      continue;
    }
    const double reach = share / 2 * (v.upper - v.lower);
    near(i) += rng.uniform(-reach, reach);
  }
  return near;
}

void PopulationSearch::Run::bring_inside(VectorXd& x) const {
  for (int i = 0; i < size(); ++i) {
    const double high = upper(x, i);
    if (discrete(i)) x(i) = std::round(x(i));
    x(i) = std::clamp(x(i), variables()[i].lower, discrete(i) ? std::floor(high) : high);
  }
}

SearchPoint PopulationSearch::Run::point(VectorXd x) {
  bring_inside(x);
  const ConstrainedValue value = problem_.evaluate(x);
  const bool first = result.evaluations++ == 0;
  if (first || value.better_than(result.value)) {
    result.x = x;
    result.value = value;
  }
  const bool feasible = result.value.violation == 0;
  result.history.push_back(feasible ? result.value.objective : detail::kInfinity);
  if (feasible && result.value.objective <= options.target) {
    result.outcome = Outcome::solved;
    done_ = true;
  }
  if (monitor_.stopped()) {
    if (!done_) result.outcome = Outcome::stopped;
    done_ = true;
  }
  done_ = done_ || result.evaluations >= options.max_evaluations;
  monitor_.report("population", static_cast<double>(result.evaluations) / options.max_evaluations);
  return {std::move(x), value};
}

PopulationSearch::~PopulationSearch() = default;

PopulationResult PopulationSearch::solve(const PopulationProblem& problem, const PopulationOptions& options,
                                         const Monitor& monitor) const {
  problem.check();
  options.check();
  Run run(problem, options, monitor);
  search(run);
  return std::move(run.result);
}

std::vector<std::string> population_search_names() {
  std::vector<std::string> names;
  for (const Entry& entry : kSearches) names.emplace_back(entry.name);
  return names;
}

std::unique_ptr<PopulationSearch> make_population_search(const std::string& name) {
  for (const Entry& entry : kSearches) {
    if (name == entry.name) return entry.make();
  }
  std::string known;
  for (const Entry& entry : kSearches) known += std::string(known.empty() ? "" : ", ") + entry.name;
  throw InvalidInput("algorithm = " + name + ": must be one of " + known);
}

}  // namespace mmgrasp
