#include "plan/ompl_plugin/planners.hpp"

#include <ompl/geometric/planners/est/BiEST.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/informedtrees/ABITstar.h>
#include <ompl/geometric/planners/informedtrees/AITstar.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/BKPIECE1.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/prm/LazyPRMstar.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>

#include "plan/ompl_plugin/repeatable_prm.hpp"

namespace mmgrasp_ompl {
namespace ob = ompl::base;
namespace og = ompl::geometric;
namespace {

template <typename Planner>
ob::PlannerPtr make(const ob::SpaceInformationPtr& si) {
  return std::make_shared<Planner>(si);
}

ob::PlannerPtr make_prm(const ob::SpaceInformationPtr& si) {
  return std::make_shared<RepeatablePrm>(si, false, false);
}
ob::PlannerPtr make_prm_star(const ob::SpaceInformationPtr& si) {
  return std::make_shared<RepeatablePrm>(si, true, true);
}

}  // namespace

const PlannerEntry kPlanners[] = {
    // Measured on the 7-joint arm problems of docs/methods/plan.md: a fifth of the diagonal takes two to three times as
    // long.
    {"ompl_rrt_connect", make<og::RRTConnect>, false, false, false, false, 0.05},
    {"rrt", make<og::RRT>, true, false, false, false, 0},
    {"est", make<og::EST>, true, true, false, false, 0},
    {"bi_est", make<og::BiEST>, true, true, false, false, 0},
    {"kpiece", make<og::KPIECE1>, true, true, false, false, 0},
    {"bkpiece", make<og::BKPIECE1>, true, true, false, false, 0},
    {"prm", make_prm, true, false, false, true, 0},
    {"prm_star", make_prm_star, true, false, true, true, 0},
    {"lazy_prm_star", make<og::LazyPRMstar>, true, true, true, true, 0, true},
    {"rrt_star", make<og::RRTstar>, true, true, true, false, 0},
    {"informed_rrt_star", make<og::InformedRRTstar>, true, true, true, false, 0},
    {"bit_star", make<og::BITstar>, true, true, true, false, 0},
    {"abit_star", make<og::ABITstar>, true, true, true, false, 0},
    {"ait_star", make<og::AITstar>, true, true, true, false, 0},
};
const std::size_t kPlannerCount = sizeof(kPlanners) / sizeof(kPlanners[0]);

}  // namespace mmgrasp_ompl
