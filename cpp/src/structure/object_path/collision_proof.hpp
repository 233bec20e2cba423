#pragma once

#include <map>
#include <vector>

#include "structure/object_path/attached_object.hpp"
#include "structure/object_path/path_bound.hpp"

namespace mmgrasp::detail {

/// Rules out arm configurations that collide wherever in a box of grasps they are: two bodies that overlap in the
/// middle by more than any of their points moves over the box.
class MMGRASP_EXPORT CollisionProof {
 public:
  explicit CollisionProof(const ObjectPathProblem& problem) : object_(problem) {}

  /// Looks at one configuration for each pose and excludes those that are proven to collide; true when there was one.
  bool exclude(BoxGraph& graph, const std::vector<int>& branches, const Grasp& middle);

 private:
  AttachedObject object_;
};

}  // namespace mmgrasp::detail
