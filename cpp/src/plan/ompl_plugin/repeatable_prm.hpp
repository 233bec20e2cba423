#pragma once

#include <ompl/geometric/planners/prm/PRM.h>

namespace mmgrasp_ompl {

/// OMPL's PRM searches its roadmap for a path in a second thread, so what it returns depends on timing. This one
/// grows and searches in turns, in one thread: the same seed gives the same roadmap and path.
class RepeatablePrm : public ompl::geometric::PRM {
 public:
  /// `keep_improving` spends the whole budget and returns the best path; otherwise the first path ends the run.
  RepeatablePrm(const ompl::base::SpaceInformationPtr& si, bool star, bool keep_improving)
      : PRM(si, star), keep_improving_(keep_improving) {}
  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& ptc) override;

 private:
  bool keep_improving_;
};

}  // namespace mmgrasp_ompl
