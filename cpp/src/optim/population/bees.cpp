// The Bees Algorithm (Pham et al. 2006) as P2 runs it (Algorithm 3.2).
#include <utility>

#include "optim/population/population_run.hpp"

namespace mmgrasp {
namespace {

struct Site {
  SearchPoint point;
  double size = 0;  ///< Size of its neighbourhood.
  int without_progress = 0;
};

/// Recruits search around the best sites; sites without progress shrink and are left in the end; scouts draw new ones.
class Bees : public PopulationSearch {
 public:
  std::string name() const override { return "bees"; }

 private:
  void search(Run& run) const override {
    const PopulationOptions& o = run.options;
    const auto scout = [&] { return Site{run.point(run.draw()), o.neighbourhood, 0}; };
    std::vector<Site> sites;
    while (static_cast<int>(sites.size()) < o.population && !run.done()) sites.push_back(scout());
    while (!run.done()) {
      std::stable_sort(sites.begin(), sites.end(),
                       [](const Site& a, const Site& b) { return a.point.value.better_than(b.point.value); });
      sites.resize(std::min(sites.size(), static_cast<std::size_t>(o.best_sites)));
      int used = 0;
      for (std::size_t i = 0; i < sites.size() && !run.done(); ++i) {
        Site& site = sites[i];
        const int bees = static_cast<int>(i) < o.elite_sites ? o.elite_recruits : o.recruits;
        const SearchPoint before = site.point;
        bool better = false;
        for (int k = 0; k < bees && !run.done(); ++k, ++used) {
          SearchPoint found = run.point(run.neighbour(before.x, site.size));
          if (!found.value.better_than(site.point.value)) continue;
          site.point = std::move(found);
          better = true;
        }
        if (better) {
          site.without_progress = 0;
        } else {
          site.size *= o.shrinking;
          // An abandoned site's bee goes scouting; the best point seen is kept by the run.
          if (++site.without_progress >= o.stagnation_limit && !run.done()) site = scout();
        }
      }
      // Keeps the number of evaluations a round as at the beginning: ns - ne nre - (nb - ne) nrb scouts.
      for (; used < o.population && !run.done(); ++used) sites.push_back(scout());
    }
  }
};

}  // namespace

std::unique_ptr<PopulationSearch> make_bees() {
  return std::make_unique<Bees>();
}

}  // namespace mmgrasp
