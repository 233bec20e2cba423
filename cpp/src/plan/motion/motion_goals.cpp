#include "plan/motion/motion_goals.hpp"

#include <utility>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/detail/whole_turns.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp::detail {
namespace {

/// A pose of the region; the first is its own.
Pose drawn_pose(const ToolRegion& region, int sample, Rng& rng) {
  if (sample == 0) return region.T_world_region;
  const Eigen::Vector3d xyz = rng.uniform(-region.position, region.position);
  const Eigen::Vector3d rpy = rng.uniform(-region.rotation, region.rotation);
  return region.T_world_region * pose_from_xyz_rpy(xyz, rpy);
}

/// Turns the goals of a motion into configurations, and counts why others were rejected.
class GoalSearch {
 public:
  GoalSearch(MotionEdges& edges, const Eigen::VectorXd& start, const MotionOptions& options, Rejections& rejections,
             std::vector<Contact>& contacts)
      : edges_(edges),
        start_(start),
        options_(options),
        rejections_(rejections),
        contacts_(contacts),
        turns_(edges.checker().group()) {}

  void add_configuration(const Eigen::VectorXd& q, int goal) {
    const Rejection cause = edges_.rejection(q);
    rejections_.add(cause);
    if (cause == Rejection::none) {
      found.push_back({q, goal});
    } else if (contacts_.empty()) {
      contacts_ = edges_.checker().contacts(q);
    }
  }

  bool add_pose(const Pose& T_world_tip, int goal) {
    IkOptions ik;
    ik.seed = options_.seed;
    ik.time_limit = std::min(ik.time_limit, options_.time_limit);
    Rejection cause = Rejection::unreachable;
    const std::vector<Eigen::VectorXd> all =
        solve_ik_all(edges_.checker().group(), T_world_tip, options_.ik_solutions, ik, [&](const Eigen::VectorXd& q) {
          const Rejection why = edges_.rejection(q);
          if (why != Rejection::none) cause = why;
          if (contacts_.empty() && (why == Rejection::self_collision || why == Rejection::scene)) {
            contacts_ = edges_.checker().contacts(q);
          }
          return why;
        });
    for (const auto& q : all) add_turns(q, goal);
    if (all.empty()) rejections_.add(cause);
    return !all.empty();
  }

  std::vector<GoalConfiguration> found;

 private:
  void add_turns(const Eigen::VectorXd& q, int goal) {
    if (!turns_.any()) {
      found.push_back({q, goal});
      return;
    }
    bool turned = false;
    for (Eigen::VectorXd& each : turns_.of(q, start_)) {
      found.push_back({std::move(each), goal, turned});
      turned = true;
    }
  }

  MotionEdges& edges_;
  const Eigen::VectorXd& start_;
  const MotionOptions& options_;
  Rejections& rejections_;
  std::vector<Contact>& contacts_;
  const WholeTurns turns_;
};

}  // namespace

std::vector<GoalConfiguration> allowed_goals(MotionEdges& edges, const Eigen::VectorXd& start, const MotionGoals& goals,
                                             const MotionOptions& options, const Monitor& monitor,
                                             Rejections& rejections, std::vector<Contact>& contacts) {
  GoalSearch search(edges, start, options, rejections, contacts);
  int goal = 0;
  for (const auto& q : goals.configurations) search.add_configuration(q, goal++);
  for (const Pose& T : goals.tool_poses) {
    if (!monitor.stopped()) search.add_pose(T, goal);
    ++goal;
  }
  for (const ToolRegion& region : goals.regions) {
    Rng rng(options.seed, 3 + static_cast<std::uint64_t>(goal));
    for (int i = 0; i < options.region_samples && !monitor.stopped(); ++i) {
      search.add_pose(drawn_pose(region, i, rng), goal);
    }
    ++goal;
  }
  return std::move(search.found);
}

}  // namespace mmgrasp::detail
