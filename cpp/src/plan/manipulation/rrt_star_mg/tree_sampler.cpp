#include "plan/manipulation/rrt_star_mg/tree_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace mmgrasp::detail {
namespace {

constexpr int kRandomGuesses = 32;  // Random grasps tried before all of them are.

}  // namespace

TreeSampler::TreeSampler(GraspTrees& trees, InformedUnion& informed, const RrtStarMgOptions& options,
                         const RrtStarMgTuning& tuning)
    : trees_(trees), informed_(informed), options_(options), tuning_(tuning), q_(trees.ends().dimension()) {}

TreeSampler::Sample TreeSampler::draw(Rng& rng) {
  const int grasp = options_.informed ? informed_.draw(rng, q_.data()) : informed_.draw_box(rng, q_.data());
  if (grasp < 0) return {};
  return {trees_.add_configuration(q_.data()), grasp};
}

int TreeSampler::draw_near_straight_line(Rng& rng, int grasp) {
  if (options_.informed && rng.uniform() < tuning_.near_line_probability) {
    const double detour = rng.uniform();
    informed_.draw_around(rng, grasp, tuning_.min_detour + tuning_.detour_range * detour * detour, q_.data());
  } else {
    informed_.draw_box(rng, q_.data());
  }
  return trees_.add_configuration(q_.data());
}

int TreeSampler::pick_grasp(Rng& rng) const {
  const int count = informed_.grasps();
  return std::min(count - 1, static_cast<int>(std::pow(count + 1.0, rng.uniform())) - 1);
}

TreeSampler::Sample TreeSampler::draw_reassigned(Rng& rng, int side) {
  while (!reassigned_.empty()) {
    const std::size_t at = rng.index(reassigned_.size());
    const int configuration = reassigned_[at];
    reassigned_[at] = reassigned_.back();
    reassigned_.pop_back();
    const double* q = trees_.configuration(configuration);
    const auto may_improve = [&](int grasp) {
      return informed_.contains(grasp, q) && trees_.find(GraspTrees::tree(grasp, side), configuration) < 0;
    };
    const std::size_t count = informed_.grasps();
    int grasp = -1;
    for (int i = 0; i < kRandomGuesses && grasp < 0; ++i) {
      const int guess = static_cast<int>(rng.index(count));
      if (may_improve(guess)) grasp = guess;
    }
    std::size_t found = 0;
    for (int g = 0; g < informed_.grasps() && (grasp < 0 || found > 0); ++g)
      if (may_improve(g) && rng.index(++found) == 0) grasp = g;
    if (grasp >= 0) return {configuration, grasp};
  }
  return {};
}

}  // namespace mmgrasp::detail
