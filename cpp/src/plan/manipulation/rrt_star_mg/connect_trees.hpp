#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/plan/rrt_star_mg.hpp"
#include "plan/manipulation/rrt_star_mg/incumbent.hpp"
#include "plan/manipulation/rrt_star_mg/near_vertices.hpp"
#include "plan/manipulation/rrt_star_mg/tree_checks.hpp"
#include "plan/manipulation/rrt_star_mg/tree_connections.hpp"
#include "plan/manipulation/rrt_star_mg/tuning.hpp"

namespace mmgrasp::detail {

/// ConnectTrees (P2 Algorithm 5.7): the cheapest free edge from a new vertex to the other tree of its grasp.
class MMGRASP_EXPORT ConnectTrees {
 public:
  struct Attempt {
    bool connected = false;
    int blocked_vertex = -1;  ///< The nearest vertex of the other tree when every edge to that tree is blocked.
  };

  ConnectTrees(const GraspTrees& trees, TreeChecks& checks, const NearVertices& near_vertices,
               const Incumbent& incumbent, TreeConnections& connections, const RrtStarMgOptions& options,
               const RrtStarMgTuning& tuning);

  /// Adds the connection when with it the grasp's path is worth having. Nothing for a vertex that was removed.
  Attempt connect(int vertex);

 private:
  /// What a path of this grasp must cost less than.
  double bound(int grasp) const;

  const GraspTrees& trees_;
  TreeChecks& checks_;
  const NearVertices& near_vertices_;
  const Incumbent& incumbent_;
  TreeConnections& connections_;
  const RrtStarMgOptions& options_;
  const RrtStarMgTuning& tuning_;
  std::vector<GraspTrees::Near> near_;  ///< Scratch.
  Eigen::VectorXd q_;                   ///< Scratch.
};

}  // namespace mmgrasp::detail
