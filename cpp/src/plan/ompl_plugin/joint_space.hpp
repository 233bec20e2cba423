#pragma once

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <cmath>
#include <memory>
#include <vector>

#include "plan/ompl_plugin/run_context.hpp"

namespace mmgrasp_ompl {

/// Weighted joint values within sampling bounds, of which some wrap at half a turn. Distance is Euclidean over shortest
/// differences, so that it equals the length of the joint-space edge that is checked and driven.
class JointSpace : public ompl::base::RealVectorStateSpace {
 public:
  explicit JointSpace(std::shared_ptr<RunContext> context);

  bool any_wraps() const { return any_wraps_; }
  bool wraps(unsigned int index) const { return turns_[index] > 0; }
  /// A value that wraps, within half a turn of 0.
  double wrapped(double value, unsigned int index) const { return std::remainder(value, turns_[index]); }
  double distance(const ompl::base::State* a, const ompl::base::State* b) const override;
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double t,
                   ompl::base::State* state) const override;
  void enforceBounds(ompl::base::State* state) const override;
  bool equalStates(const ompl::base::State* a, const ompl::base::State* b) const override;
  double getMaximumExtent() const override;
  double bounds_diagonal() const;  ///< A value that wraps counts with its full turn.
  ompl::base::StateSamplerPtr allocDefaultStateSampler() const override;
  void registerProjections() override;

 private:
  double difference(double from, double to, unsigned int index) const;

  std::shared_ptr<RunContext> context_;
  std::vector<double> turns_;  ///< A whole turn of each value that wraps; 0: it does not.
  bool any_wraps_ = false;
};

class JointValidity : public ompl::base::StateValidityChecker {
 public:
  JointValidity(const ompl::base::SpaceInformationPtr& si, std::shared_ptr<RunContext> context)
      : StateValidityChecker(si), context_(std::move(context)) {}
  bool isValid(const ompl::base::State* state) const override;

 private:
  std::shared_ptr<RunContext> context_;
};

/// Leaves whole edges to the caller's edge check.
class EdgeValidity : public ompl::base::MotionValidator {
 public:
  EdgeValidity(const ompl::base::SpaceInformationPtr& si, std::shared_ptr<RunContext> context)
      : MotionValidator(si), context_(std::move(context)) {}
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2) const override;
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2,
                   std::pair<ompl::base::State*, double>& last_valid) const override;

 private:
  std::shared_ptr<RunContext> context_;
};

/// Path length. In a space that wraps, OMPL's direct sampling of the informed set would miss paths that go round, so
/// states are then drawn anywhere and rejected.
class LengthObjective : public ompl::base::PathLengthOptimizationObjective {
 public:
  LengthObjective(const ompl::base::SpaceInformationPtr& si, bool any_wraps)
      : PathLengthOptimizationObjective(si), any_wraps_(any_wraps) {}
  ompl::base::InformedSamplerPtr allocInformedStateSampler(const ompl::base::ProblemDefinitionPtr& definition,
                                                           unsigned int max_calls) const override;

 private:
  bool any_wraps_;
};

inline const double* values(const ompl::base::State* state) {
  return static_cast<const ompl::base::RealVectorStateSpace::StateType*>(state)->values;
}
inline double* values(ompl::base::State* state) {
  return static_cast<ompl::base::RealVectorStateSpace::StateType*>(state)->values;
}

}  // namespace mmgrasp_ompl
