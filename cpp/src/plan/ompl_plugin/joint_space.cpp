#include "plan/ompl_plugin/joint_space.hpp"

#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/samplers/informed/RejectionInfSampler.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp_ompl {
namespace ob = ompl::base;
namespace {

constexpr double kLeastBoxShare = 1e-3;  // Smallest box around the start or a goal, as a share of the bounds.

/// Draws from a generator of its own: OMPL's are seeded from one per process, and would differ from run to run.
class SeededSampler : public ob::StateSampler {
 public:
  SeededSampler(const JointSpace* space, std::shared_ptr<RunContext> context)
      : StateSampler(space), space_(space), context_(std::move(context)), generator_(context_->next_sampler_seed()) {}

  void sampleUniform(ob::State* state) override {
    context_->count_draw();
    const double near_end = context_->roadmap() ? context_->problem().near_end_probability : 0;
    if (near_end > 0 && uniform() < near_end) return sample_around_end(state);
    const auto& bounds = space_->getBounds();
    for (unsigned int i = 0; i < space_->getDimension(); ++i) {
      values(state)[i] = between(bounds.low[i], bounds.high[i]);
    }
  }

  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    context_->count_draw();
    for (unsigned int i = 0; i < space_->getDimension(); ++i) {
      values(state)[i] = values(near)[i] + between(-distance, distance);
    }
    space_->enforceBounds(state);
  }

  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    context_->count_draw();
    for (unsigned int i = 0; i < space_->getDimension(); ++i) {
      values(state)[i] = values(mean)[i] + deviation * normal();
    }
    space_->enforceBounds(state);
  }

 private:
  /// Samples a box around the start or a goal, of any size down to kLeastBoxShare: all orders of magnitude equally
  /// likely.
  void sample_around_end(ob::State* state) {
    const MmgraspOmplProblem& problem = context_->problem();
    const int goal = static_cast<int>(uniform() * 2 * problem.goal_count) - problem.goal_count;
    const double* end = goal < 0 ? problem.start : problem.goals + goal * problem.size;
    const double share = std::pow(kLeastBoxShare, uniform());
    const auto& bounds = space_->getBounds();
    for (unsigned int i = 0; i < space_->getDimension(); ++i) {
      const double reach = share * (bounds.high[i] - bounds.low[i]);
      values(state)[i] =
          space_->wraps(i) ? space_->wrapped(end[i] + between(-reach, reach) / 2, i)
                           : between(std::max(bounds.low[i], end[i] - reach), std::min(bounds.high[i], end[i] + reach));
    }
  }

  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1.0p-53; }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  double normal() { return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(mmgrasp::detail::kTwoPi * uniform()); }

  const JointSpace* space_;
  std::shared_ptr<RunContext> context_;
  std::mt19937_64 generator_;
};

/// The first three values: of an arm those that move the tool most. OMPL's defaults for real vectors draw random
/// planes, and the one for two values reads past its state.
class FirstJointsProjection : public ob::ProjectionEvaluator {
 public:
  explicit FirstJointsProjection(const JointSpace* space) : ProjectionEvaluator(space), space_(space) {}

  unsigned int getDimension() const override { return std::min(3u, space_->getDimension()); }

  void defaultCellSizes() override {
    cellSizes_.resize(getDimension());
    for (unsigned int i = 0; i < getDimension(); ++i) {
      cellSizes_[i] = (space_->getBounds().high[i] - space_->getBounds().low[i]) / 20;
    }
  }

  void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> projection) const override {
    for (unsigned int i = 0; i < getDimension(); ++i) projection[i] = values(state)[i];
  }

 private:
  const JointSpace* space_;
};

}  // namespace

JointSpace::JointSpace(std::shared_ptr<RunContext> context)
    : RealVectorStateSpace(context->problem().size), context_(std::move(context)) {
  const MmgraspOmplProblem& problem = context_->problem();
  ob::RealVectorBounds bounds(problem.size);
  for (int i = 0; i < problem.size; ++i) {
    turns_.push_back(problem.turns[i]);
    const bool wraps = turns_.back() > 0;
    any_wraps_ |= wraps;
    bounds.setLow(i, wraps ? -0.5 * turns_.back() : problem.lower[i]);
    bounds.setHigh(i, wraps ? 0.5 * turns_.back() : problem.upper[i]);
  }
  setBounds(bounds);
  if (any_wraps_) type_ = ob::STATE_SPACE_UNKNOWN;
}

double JointSpace::difference(double from, double to, unsigned int index) const {
  return wraps(index) ? wrapped(to - from, index) : to - from;
}

double JointSpace::distance(const ob::State* a, const ob::State* b) const {
  double sum = 0;
  for (unsigned int i = 0; i < dimension_; ++i) {
    const double d = difference(values(a)[i], values(b)[i], i);
    sum += d * d;
  }
  return std::sqrt(sum);
}

void JointSpace::interpolate(const ob::State* from, const ob::State* to, double t, ob::State* state) const {
  for (unsigned int i = 0; i < dimension_; ++i) {
    const double value = values(from)[i] + t * difference(values(from)[i], values(to)[i], i);
    values(state)[i] = wraps(i) ? wrapped(value, i) : value;
  }
}

void JointSpace::enforceBounds(ob::State* state) const {
  for (unsigned int i = 0; i < dimension_; ++i) {
    double& value = values(state)[i];
    value = wraps(i) ? wrapped(value, i) : std::clamp(value, bounds_.low[i], bounds_.high[i]);
  }
}

bool JointSpace::equalStates(const ob::State* a, const ob::State* b) const {
  return distance(a, b) < 1e-12;
}

double JointSpace::getMaximumExtent() const {
  double sum = 0;
  for (unsigned int i = 0; i < dimension_; ++i) {
    const double extent = wraps(i) ? 0.5 * turns_[i] : bounds_.high[i] - bounds_.low[i];
    sum += extent * extent;
  }
  return std::sqrt(sum);
}

double JointSpace::bounds_diagonal() const {
  double sum = 0;
  for (unsigned int i = 0; i < dimension_; ++i) sum += std::pow(bounds_.high[i] - bounds_.low[i], 2);
  return std::sqrt(sum);
}

ob::StateSamplerPtr JointSpace::allocDefaultStateSampler() const {
  return std::make_shared<SeededSampler>(this, context_);
}

void JointSpace::registerProjections() {
  registerDefaultProjection(std::make_shared<FirstJointsProjection>(this));
}

bool JointValidity::isValid(const ob::State* state) const {
  return si_->satisfiesBounds(state) && context_->is_free(values(state));
}

bool EdgeValidity::checkMotion(const ob::State* s1, const ob::State* s2) const {
  const bool free = context_->edge_is_free(values(s1), values(s2));
  ++(free ? valid_ : invalid_);
  return free;
}

bool EdgeValidity::checkMotion(const ob::State* s1, const ob::State* s2,
                               std::pair<ob::State*, double>& last_valid) const {
  if (checkMotion(s1, s2)) return true;
  // Halving finds a free stretch from s1 within 1/64 of the edge, which is all the callers of this form use it for.
  ob::State* trial = si_->allocState();
  double good = 0, step = 0.5;
  for (int k = 0; k < 6; ++k, step /= 2) {
    si_->getStateSpace()->interpolate(s1, s2, good + step, trial);
    if (context_->edge_is_free(values(s1), values(trial))) good += step;
  }
  si_->freeState(trial);
  last_valid.second = good;
  if (last_valid.first) si_->getStateSpace()->interpolate(s1, s2, good, last_valid.first);
  return false;
}

ob::InformedSamplerPtr LengthObjective::allocInformedStateSampler(const ob::ProblemDefinitionPtr& definition,
                                                                  unsigned int max_calls) const {
  if (any_wraps_) return std::make_shared<ob::RejectionInfSampler>(definition, max_calls);
  return PathLengthOptimizationObjective::allocInformedStateSampler(definition, max_calls);
}

}  // namespace mmgrasp_ompl
