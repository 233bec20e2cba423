#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "collision/checker/bodies.hpp"
#include "collision/checker/pair_plan.hpp"

namespace mmgrasp::detail {

/// Where the robot of a snapshot stands: the frames of its group and the bounding spheres of its shapes in one
/// configuration, and the poses of shapes and links once they are needed. What the group does not move is placed
/// once.
class MMGRASP_EXPORT Placement {
 public:
  Placement(std::shared_ptr<const Snapshot> snapshot, std::shared_ptr<const PairPlan> plan, const JointGroup& group);

  const Snapshot& snapshot() const { return *snapshot_; }
  const std::shared_ptr<const Snapshot>& shared_snapshot() const { return snapshot_; }
  const PairPlan& plan() const { return *plan_; }
  const JointGroup& group() const { return group_; }

  /// Places what yes-or-no answers need: the group's frames and the spheres of moving shapes.
  void place(const double* q);
  /// The same, and all links' poses and the shapes' exact centres.
  void place_links(const Eigen::VectorXd& q);
  void set_root(const Pose& T_world_root);
  /// Places everything anew next time, also what the group does not move.
  void forget() { frames_valid_ = links_valid_ = false; }

  /// The bounding spheres in single precision, in the order of the plan's.
  SphereRows spheres() const {
    const float* x = sphere_numbers_.data();
    return {x, x + sphere_row_, x + 2 * sphere_row_, x + 3 * sphere_row_};
  }
  Eigen::Vector3d sphere_centre(int sphere) const {
    const SphereRows rows = spheres();
    return {rows.x[sphere], rows.y[sphere], rows.z[sphere]};
  }
  /// The configuration that was placed last.
  const std::vector<double>& configuration() const { return q_; }
  Rigid frame(int i) const { return Rigid(frames_[i]); }
  /// T_world_shape.
  const Rigid& pose(int shape) {
    if (pose_stamp_[shape] != (moves_[shape] ? stamp_ : fixed_stamp_)) compute_pose(shape);
    return poses_[shape];
  }
  /// What is remembered of a shape and one of the scene. Answers do not depend on it.
  struct SceneMemory {
    Eigen::Vector3d axis =
        Eigen::Vector3d::Zero();  ///< Along which their hulls were tested last: the next test begins there.
    int piece = -1;               ///< Triangle that was hit last.
  };
  SceneMemory& memory(int shape, int scene_shape) {
    if (memory_.empty()) memory_.resize(snapshot_->shapes.size() * snapshot_->scene.size());
    return memory_[shape * snapshot_->scene.size() + scene_shape];
  }
  /// Poses of the links in the world, one each, set by place_links().
  const Poses& links() const { return frames_; }
  const Eigen::Vector3d& shape_centre(int shape) const { return shape_centres_[shape]; }

 private:
  void compute_pose(int shape);

  std::shared_ptr<const Snapshot> snapshot_;
  std::shared_ptr<const PairPlan> plan_;
  JointGroup group_;

  std::vector<double> q_;
  Poses frames_;  ///< One for each frame of the group's FrameTree; a link's frame number is the link's index.
  bool frames_valid_ = false;
  std::vector<float> sphere_numbers_;  ///< See spheres().
  int sphere_row_;                     ///< Spheres of the plan, rounded up to whole lanes.
  bool links_valid_ = false;
  std::vector<Eigen::Vector3d> shape_centres_;  ///< Centres of the bounding spheres, world frame.
  std::vector<Rigid> poses_;                    ///< T_world_shape, made when first needed.
  std::vector<std::uint64_t> pose_stamp_;       ///< `stamp_` of when each was made.
  std::uint64_t stamp_ = 0, fixed_stamp_ = 0;   ///< Number of the current placement; of that of fixed shapes.
  std::vector<char> moves_;                     ///< Per shape.
  std::vector<SceneMemory> memory_;             ///< See memory().
};

}  // namespace mmgrasp::detail
