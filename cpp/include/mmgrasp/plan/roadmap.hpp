#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/joint_weights.hpp"

namespace mmgrasp {

/// How many configurations a roadmap draws, and which of them it joins.
struct MMGRASP_EXPORT RoadmapOptions {
  int vertices = 5000;  ///< Configurations drawn; in [2, 10 million].
  /// > 0: vertices nearer than gamma (log n / n)^(1/d) are joined (P2 4.3.2.1, which takes 4) [rad or m,
  /// times the root mean square of the weights]. 0: each
  /// vertex is joined with its k nearest ones, k = e (1 + 1/d) log n rounded up (k-nearest PRM*, Karaman and Frazzoli
  /// 2011), which needs no scale and holds together on every robot; >= 0.
  double gamma = 0;
  /// > 0: each vertex is joined with that many nearest ones, and gamma does not count.
  int neighbours = 0;
  JointWeights joint_weights;  ///< What a motion of each joint counts in the lengths of edges.
  unsigned seed = 1;           ///< Same seed, same roadmap.
  void check() const;
};

/// Size and connectivity of a roadmap; shows whether a gamma is large enough for PRM*'s optimality.
struct MMGRASP_EXPORT RoadmapStatistics {
  double mean_degree = 0;
  int components = 0;         ///< Connected components.
  int largest_component = 0;  ///< Vertices in the largest one.
  int neighbours = 0;         ///< Nearest vertices that each is joined with; 0: all within the radius.
  double radius = 0;          ///< Connection radius; with nearest neighbours the longest edge.
  double volume = 0;          ///< Volume of the sampling bounds, sides times the weights.
  double gamma_star = 0;      ///< PRM* asks for gamma > 2 (1 + 1/d)^(1/d) (volume / unit ball)^(1/d); in its unit.
};

/// A probabilistic roadmap without collision checks (P2 4.3.2.1, Algorithm 4.1): configurations of a group drawn within
/// its sampling bounds and joined when near. Planners find out lazily what is blocked and keep that elsewhere, so one
/// roadmap serves every grasp, object and scene:
///
///     const Roadmap roadmap = Roadmap::build(arm, options);
///     roadmap.save("arm.roadmap");  // later: Roadmap::load("arm.roadmap", arm)
///     const ManipulationResult result = plan_manipulation(problem, {}, &roadmap);
///
/// Angles without limits are joined the short way round. Immutable; cheap to copy, safe to share between threads.
/// Vertex i is the same for every number of vertices: a larger roadmap contains a smaller one's vertices.
class MMGRASP_EXPORT Roadmap {
 public:
  /// One end of an edge as seen from the other.
  struct Arc {
    int to;
    int edge;  ///< The same number from both ends, in [0, edge_count()).
    double length;
  };

  /// Throws InvalidInput on bad options or a group without finite bounds. Returns an empty roadmap when stopped.
  static Roadmap build(const JointGroup& group, const RoadmapOptions& options = {}, const Monitor& monitor = {});
  /// Writes to a temporary name and renames. Throws IoError.
  void save(const std::string& path) const;
  /// Throws IoError on a damaged or foreign file, or one made for another robot or other joints.
  static Roadmap load(const std::string& path, const JointGroup& group);

  const JointGroup& group() const;
  const RoadmapOptions& options() const;
  int size() const;  ///< Vertices.
  int edge_count() const;
  const Eigen::MatrixXd& vertices() const;  ///< One column each.
  const Arc* begin(int vertex) const;
  const Arc* end(int vertex) const;
  /// The two vertices of an edge, the smaller number first.
  std::pair<int, int> ends(int edge) const;
  /// Vertices a new configuration would be joined with, ascending; `out` is overwritten.
  void near(const Eigen::VectorXd& q, std::vector<int>& out) const;
  /// Longest edge a new configuration would get; 0 with nearest neighbours, where there is no such bound.
  double radius() const;
  RoadmapStatistics statistics() const;
  /// Says so when less than 99 % of the vertices hang together, and what to set; empty otherwise.
  std::string warning() const;

  struct Data;
  explicit Roadmap(std::shared_ptr<const Data> data);

 private:
  std::shared_ptr<const Data> data_;
};

}  // namespace mmgrasp
