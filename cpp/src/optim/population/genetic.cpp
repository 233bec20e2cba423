// A genetic algorithm as P2 3.5.1 describes it: real coding, binary tournaments, one-point crossover at rate 1,
// mutation.
#include <utility>

#include "optim/population/population_run.hpp"

namespace mmgrasp {
namespace {

/// Each round keeps the best point and fills the population with children of tournament winners.
class Genetic : public PopulationSearch {
 public:
  std::string name() const override { return "ga"; }

 private:
  static const SearchPoint& winner(Run& run, const std::vector<SearchPoint>& all) {
    const SearchPoint &a = all[run.rng.index(all.size())], &b = all[run.rng.index(all.size())];
    return b.value.better_than(a.value) ? b : a;
  }

  static void mutate(Run& run, Eigen::VectorXd& x) {
    for (int i = 0; i < run.size(); ++i) {
      if (run.rng.uniform() >= run.options.mutation_rate) continue;
      const SearchVariable& v = run.variables()[i];
      if (run.discrete(i)) {
        x(i) = v.upper - v.lower == 1 ? v.lower + v.upper - x(i) : run.draw(x, i);  // P2 flips what has two values
        continue;
      }
      const double reach = v.mutation > 0 ? v.mutation : run.options.mutation_size * (v.upper - v.lower);
      x(i) = run.rng.uniform(std::max(v.lower, x(i) - reach), std::min(run.upper(x, i), x(i) + reach));
    }
  }

  void search(Run& run) const override {
    std::vector<SearchPoint> parents;
    while (static_cast<int>(parents.size()) < run.options.population && !run.done())
      parents.push_back(run.point(run.draw()));
    while (!run.done()) {
      // P2 does not say what survives: the best parent does, so the best is never lost.
      std::vector<SearchPoint> next{
          *std::min_element(parents.begin(), parents.end(),
                            [](const SearchPoint& a, const SearchPoint& b) { return a.value.better_than(b.value); })};
      while (static_cast<int>(next.size()) < run.options.population && !run.done()) {
        Eigen::VectorXd a = winner(run, parents).x, b = winner(run, parents).x;
        if (run.size() > 1) {
          const auto cut = 1 + static_cast<Eigen::Index>(run.rng.index(run.size() - 1));
          a.tail(a.size() - cut).swap(b.tail(b.size() - cut));
        }
        for (Eigen::VectorXd* child : {&a, &b}) {
          if (static_cast<int>(next.size()) >= run.options.population || run.done()) break;
          mutate(run, *child);
          next.push_back(run.point(std::move(*child)));
        }
      }
      parents = std::move(next);
    }
  }
};

}  // namespace

std::unique_ptr<PopulationSearch> make_genetic() {
  return std::make_unique<Genetic>();
}

}  // namespace mmgrasp
