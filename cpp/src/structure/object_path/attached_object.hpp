#pragma once

#include <map>
#include <utility>
#include <vector>

#include "mmgrasp/collision/detail/attached_checker.hpp"
#include "mmgrasp/grasp/detail/with_fingers.hpp"
#include "mmgrasp/structure/object_path.hpp"

namespace mmgrasp::detail {

/// The object of a path in the hand, as each grasp in turn holds it: a checker for each opening of the fingers, in
/// which only the object's place changes.
class MMGRASP_EXPORT AttachedObject {
 public:
  explicit AttachedObject(const ObjectPathProblem& problem) : problem_(problem) {}

  AttachedChecker& hold(const Grasp& grasp);
  /// The arm, its fingers as the last grasp holds them.
  const JointGroup& group() const { return now_->first; }
  /// How far any point moves with each joint at most, with the last grasp held [m/rad].
  const Eigen::VectorXd& levers();

 private:
  const ObjectPathProblem& problem_;
  std::map<std::pair<double, std::vector<double>>, std::pair<JointGroup, AttachedChecker>> holding_;
  std::pair<JointGroup, AttachedChecker>* now_ = nullptr;
};

}  // namespace mmgrasp::detail
