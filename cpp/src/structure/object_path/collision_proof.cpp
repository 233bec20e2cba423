#include "structure/object_path/collision_proof.hpp"

namespace mmgrasp::detail {

bool CollisionProof::exclude(BoxGraph& graph, const std::vector<int>& branches, const Grasp& middle) {
  constexpr double kSlack = 1e-5;  // [m] of depths, which come from a polytope grown to its tolerance
  AttachedChecker& checker = object_.hold(middle);
  const Eigen::VectorXd& levers = object_.levers();
  bool any = false;
  Eigen::VectorXd q(6);
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const FormConfiguration& box = graph.configuration(i, branches[i]);
    double moves = kSlack;
    for (int j = 0; j < 6; ++j) {
      q[j] = box[j].centre;
      moves += box[j].radius() * levers[j];
    }
    if (moves > 0.1 || checker.is_free(q)) continue;
    // An attached object stands still in the world; of two links both move.
    const DistanceResult nearest = checker.distance(q);
    if (-nearest.value <= (nearest.with_scene ? 1 : 2) * moves) continue;
    graph.exclude(i, branches[i]);
    any = true;
  }
  return any;
}

}  // namespace mmgrasp::detail
