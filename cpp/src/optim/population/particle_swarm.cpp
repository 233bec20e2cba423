// Particle swarm optimisation as P2 3.5.1 describes it: each particle hears of the closest ones, choices are copied.
#include <numeric>
#include <utility>

#include "optim/population/population_run.hpp"

namespace mmgrasp {
namespace {

constexpr double kCopyOwn = 0.3, kCopyBest = 0.4;  // chances for categories; else they stay

struct Particle {
  SearchPoint now, best;
  Eigen::VectorXd velocity;
};

bool is_category(const SearchVariable& v) {
  return v.kind == SearchVariable::Kind::category;
}

/// Each particle is drawn to its own best point and to the best of those near it.
class ParticleSwarm : public PopulationSearch {
 public:
  std::string name() const override { return "pso"; }

 private:
  /// P2 names no metric: here differences over the variables' ranges are squared and added; another choice counts as a
  /// whole range.
  static double squared_distance(const Run& run, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    double sum = 0;
    for (int i = 0; i < run.size(); ++i) {
      const SearchVariable& v = run.variables()[i];
      const double range = v.upper - v.lower;
      const double off = is_category(v) ? (a(i) != b(i) ? 1 : 0) : range > 0 ? (a(i) - b(i)) / range : 0;
      sum += off * off;
    }
    return sum;
  }

  /// The best that a particle or its closest others, as many as the connectivity says (truncated, as in P2), know of.
  static const SearchPoint& best_heard_of(const Run& run, const std::vector<Particle>& swarm, std::size_t own) {
    const auto wanted = static_cast<std::size_t>(run.options.connectivity * run.options.population);
    std::vector<double> distance(swarm.size());
    std::vector<std::size_t> order(swarm.size());
    std::iota(order.begin(), order.end(), 0);
    std::swap(order[0], order[own]);
    if (wanted + 1 < swarm.size()) {
      for (std::size_t k = 0; k < swarm.size(); ++k)
        distance[k] = squared_distance(run, swarm[own].now.x, swarm[k].now.x);
      std::nth_element(
          order.begin() + 1, order.begin() + 1 + static_cast<std::ptrdiff_t>(wanted), order.end(),
          [&](std::size_t a, std::size_t b) { return distance[a] != distance[b] ? distance[a] < distance[b] : a < b; });
      order.resize(wanted + 1);
      std::sort(order.begin() + 1, order.end());  // ties go to the earlier one
    }
    const SearchPoint* best = &swarm[own].best;
    for (const std::size_t k : order) {
      if (swarm[k].best.value.better_than(best->value)) best = &swarm[k].best;
    }
    return *best;
  }

  static void move(Run& run, Particle& p, const Eigen::VectorXd& best) {
    for (int i = 0; i < run.size(); ++i) {
      const double a = run.rng.uniform(), b = run.rng.uniform();
      double& x = p.now.x(i);
      const SearchVariable& v = run.variables()[i];
      if (is_category(v)) {
        x = a < kCopyOwn ? p.best.x(i) : a < kCopyOwn + kCopyBest ? best(i) : x;
        continue;
      }
      const double pull = run.options.acceleration;
      p.velocity(i) = run.options.inertia * p.velocity(i) + pull * a * (p.best.x(i) - x) + pull * b * (best(i) - x);
      p.velocity(i) = std::clamp(p.velocity(i), v.lower - v.upper, v.upper - v.lower);
      x += p.velocity(i);
    }
  }

  void search(Run& run) const override {
    std::vector<Particle> swarm;
    while (static_cast<int>(swarm.size()) < run.options.population && !run.done()) {
      const SearchPoint start = run.point(run.draw());
      swarm.push_back({start, start, Eigen::VectorXd::Zero(run.size())});
    }
    while (!run.done()) {
      for (std::size_t i = 0; i < swarm.size() && !run.done(); ++i) {
        Particle& p = swarm[i];
        move(run, p, Eigen::VectorXd(best_heard_of(run, swarm, i).x));
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
