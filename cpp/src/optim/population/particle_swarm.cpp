// Particle swarm optimisation as P2 3.5.1 describes it: random neighbours, discrete variables copied.
#include <numeric>
#include <utility>

#include "optim/population/population_run.hpp"

namespace mmgrasp {
namespace {

constexpr double kCopyOwn = 0.3, kCopyBest = 0.4;  // chances for discrete variables; else they stay

struct Particle {
  SearchPoint now, best;
  Eigen::VectorXd velocity;
  std::vector<std::size_t> neighbours;
};

class ParticleSwarm : public PopulationSearch {
 public:
  std::string name() const override { return "pso"; }

 private:
  /// Itself and as many others as the connectivity says (truncated, as in P2), drawn once.
  static std::vector<std::size_t> neighbours_of(Run& run, std::size_t own) {
    const std::size_t count = run.options.population;
    std::vector<std::size_t> others(count);
    std::iota(others.begin(), others.end(), 0);
    std::swap(others[0], others[own]);
    const auto wanted =
        std::min(count - 1, static_cast<std::size_t>(run.options.connectivity * run.options.population));
    for (std::size_t i = 1; i <= wanted; ++i) std::swap(others[i], others[i + run.rng.index(count - i)]);
    others.resize(wanted + 1);
    return others;
  }

  static void move(Run& run, Particle& p, const Eigen::VectorXd& best) {
    for (int i = 0; i < run.size(); ++i) {
      const double a = run.rng.uniform(), b = run.rng.uniform();
      double& x = p.now.x(i);
      if (run.discrete(i)) {
        x = a < kCopyOwn ? p.best.x(i) : a < kCopyOwn + kCopyBest ? best(i) : x;
        continue;
      }
      const double pull = run.options.acceleration;
      const SearchVariable& v = run.variables()[i];
      p.velocity(i) = run.options.inertia * p.velocity(i) + pull * a * (p.best.x(i) - x) + pull * b * (best(i) - x);
      p.velocity(i) = std::clamp(p.velocity(i), v.lower - v.upper, v.upper - v.lower);
      x += p.velocity(i);
    }
  }

  void search(Run& run) const override {
    std::vector<Particle> swarm;
    while (static_cast<int>(swarm.size()) < run.options.population && !run.done()) {
      const SearchPoint start = run.point(run.draw());
      swarm.push_back({start, start, Eigen::VectorXd::Zero(run.size()), {}});
    }
    if (run.done()) return;
    for (std::size_t i = 0; i < swarm.size(); ++i) swarm[i].neighbours = neighbours_of(run, i);
    while (!run.done()) {
      for (std::size_t i = 0; i < swarm.size() && !run.done(); ++i) {
        Particle& p = swarm[i];
        const SearchPoint* best = &p.best;
        for (const std::size_t k : p.neighbours) {
          if (swarm[k].best.value.better_than(best->value)) best = &swarm[k].best;
        }
        move(run, p, best->x);
        p.now = run.point(p.now.x);
        if (p.now.value.better_than(p.best.value)) p.best = p.now;
      }
    }
  }
};

}  // namespace

std::unique_ptr<PopulationSearch> make_particle_swarm() {
  return std::make_unique<ParticleSwarm>();
}

}  // namespace mmgrasp
