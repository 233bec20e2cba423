#include "collision/checker/placement.hpp"

#include <algorithm>

namespace mmgrasp::detail {

Placement::Placement(std::shared_ptr<const Snapshot> snapshot, std::shared_ptr<const PairPlan> plan,
                     const JointGroup& group)
    : snapshot_(std::move(snapshot)),
      plan_(std::move(plan)),
      group_(group),
      q_(group.size()),
      frames_(plan_->frame_bounds.tree().frames, Pose::Identity()),
      sphere_row_(static_cast<int>((plan_->spheres.size() + kLanes - 1) / kLanes * kLanes)),
      shape_centres_(snapshot_->shapes.size(), Eigen::Vector3d::Zero()),
      poses_(snapshot_->shapes.size()),
      pose_stamp_(snapshot_->shapes.size(), 0),
      moves_(snapshot_->shapes.size(), 0) {
  sphere_numbers_.resize(4 * sphere_row_);
  for (const int s : plan_->moving) moves_[s] = 1;
}

void Placement::place(const double* q) {
  ++stamp_;
  std::copy(q, q + q_.size(), q_.begin());
  const bool first = !frames_valid_;
  if (first) {
    frames_[0] = group_.T_world_root();
    fixed_stamp_ = stamp_;
    frames_valid_ = true;
  }
  if (group_.has_base()) frames_[0] = pose_from_planar({q[0], q[1], q[2]});
  const GroupKinematics& kinematics = *group_.data().kinematics;
  double* numbers = frames_[0].data();
  kinematics.place_frames(q, numbers);
  const std::size_t count = first ? plan_->spheres.size() : plan_->moving.size();
  kernels().place_spheres(plan_->spheres.data(), static_cast<int>(count), numbers, sphere_numbers_.data(), sphere_row_);
}

void Placement::place_links(const Eigen::VectorXd& q) {
  place(q.data());
  const bool first = !links_valid_;
  group_.data().kinematics->place_other_links(links_valid_, frames_[0].data());
  links_valid_ = true;
  const auto place_centre = [&](int s) {
    const BodyShape& shape = snapshot_->shapes[s];
    const Pose& T = frames_[shape.link];
    shape_centres_[s].noalias() = T.linear() * shape.sphere_centre + T.translation();
  };
  for (const int s : plan_->moving) place_centre(s);
  if (!first) return;
  for (const int s : plan_->fixed) place_centre(s);
}

void Placement::set_root(const Pose& T_world_root) {
  group_ = group_.at(T_world_root);
  forget();
}

void Placement::compute_pose(int s) {
  const PlacedShape& shape = plan_->placed[s];
  const Rigid T = frame(shape.frame);
  poses_[s].R.noalias() = T.R * shape.in_frame.R;
  poses_[s].t.noalias() = T.R * shape.in_frame.t + T.t;
  pose_stamp_[s] = moves_[s] ? stamp_ : fixed_stamp_;
}

}  // namespace mmgrasp::detail
