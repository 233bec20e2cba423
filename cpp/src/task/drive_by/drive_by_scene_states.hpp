#pragma once

#include <map>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "task/drive_by/drive_by_goals.hpp"
#include "task/drive_by/drive_by_steps.hpp"

namespace mmgrasp::detail {

/// The world as it changes while parts are taken.
class SceneStates {
 public:
  /// `prepared`: a checker of the group and world, whose options all checkers have then; or null.
  SceneStates(const JointGroup& group, const World& world, const std::vector<DriveByStep>& tasks,
              const CollisionChecker* prepared = nullptr);

  CollisionChecker& before(std::size_t task);  ///< Checks the way to a task; earlier parts are gone.
  CollisionChecker& at(std::size_t task);      ///< Checks while its part is taken: fingers may touch it.
  /// One checker per interval. Parts are held as the sequence takes them; valid until the next call.
  std::vector<CollisionChecker*> along(const std::vector<int>& intervals, const ConfigurationSequence& sequence);

 private:
  const JointGroup& group_;
  const World& world_;
  const std::vector<DriveByStep>& tasks_;
  const CheckerOptions options_;
  World left(std::size_t task) const;  ///< The world without the parts of earlier tasks.
  /// Checks with the part of a step in the hand, as it was taken in this configuration.
  CollisionChecker holding(std::size_t step, const Eigen::VectorXd& q) const;
  std::map<std::size_t, CollisionChecker> before_, at_, attached_;
};

}  // namespace mmgrasp::detail
