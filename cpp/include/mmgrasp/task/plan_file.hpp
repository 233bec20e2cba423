#pragma once

#include <string>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/task/part_supply.hpp"

namespace mmgrasp {

/// What plan.json says beside problem and plan.
struct MMGRASP_EXPORT PlanFileOptions {
  std::string name = "round";        ///< Title of the round in reports.
  std::string source = "a program";  ///< Where the problem came from.
  double closing_speed = 0.1;        ///< How fast the gripper's opening shrinks [m/s]; in (0, 10].
  void check() const;                ///< Throws InvalidInput naming field, value and rule.
};

/// The text of plan.json (docs/plan_format.md): robot, room, parts and the whole answer, so that `mmgrasp verify` and
/// `mmgrasp view` take it. The database is the one that the plan was made with. Plans that failed are written, too:
/// they say why. Throws InvalidInput where plan_to_check() does and for shapes that a plan cannot hold (planes but for
/// the floor, voxels, meshes without a file), IoError for mesh files that are gone.
MMGRASP_EXPORT std::string plan_json(const PartSupplyProblem& problem, const ReachDatabase& database,
                                     const PartSupplyPlan& plan, const PlanFileOptions& options = {});

/// Writes plan_json() to a file, whole or not at all.
///
///     const PartSupplyPlan plan = plan_part_supply(problem, database);
///     write_plan(problem, database, plan, "plan.json");  // then: mmgrasp verify plan.json
MMGRASP_EXPORT void write_plan(const PartSupplyProblem& problem, const ReachDatabase& database,
                               const PartSupplyPlan& plan, const std::string& path,
                               const PlanFileOptions& options = {});

}  // namespace mmgrasp
