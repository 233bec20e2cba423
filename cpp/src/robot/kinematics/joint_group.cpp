#include "mmgrasp/robot/joint_group.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"

namespace mmgrasp {

JointGroup::Data::Data(std::shared_ptr<const detail::GroupModel> of, const Pose& T)
    : model(std::move(of)), T_world_root(T), kinematics(model->kinematics.get()) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(kinematics->first_angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Map<Eigen::Matrix3d>(root.R, 3, 3) = T.linear() * turn;
  Eigen::Map<Eigen::Vector3d>(root.p, 3) = T.translation();
}

JointGroup::JointGroup(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

const Robot& JointGroup::robot() const {
  return data_->model->robot;
}
const std::string& JointGroup::name() const {
  return data_->model->name;
}
const std::vector<std::string>& JointGroup::names() const {
  return data_->model->names;
}
int JointGroup::size() const {
  return static_cast<int>(data_->model->names.size());
}
bool JointGroup::has_base() const {
  return data_->model->has_base;
}
int JointGroup::tip_link() const {
  return data_->model->tip_link;
}
const Eigen::VectorXd& JointGroup::lower() const {
  return data_->model->lower;
}
const Eigen::VectorXd& JointGroup::upper() const {
  return data_->model->upper;
}
const Eigen::VectorXd& JointGroup::velocity_limits() const {
  return data_->model->velocity;
}
const Eigen::VectorXd& JointGroup::acceleration_limits() const {
  return data_->model->acceleration;
}
const std::vector<bool>& JointGroup::wraps() const {
  return data_->model->wraps;
}
const Eigen::VectorXd& JointGroup::reference() const {
  return data_->model->reference;
}
const Pose& JointGroup::T_world_root() const {
  return data_->T_world_root;
}
const std::vector<int>& JointGroup::moving_links() const {
  return data_->kinematics->moving_links;
}
const std::vector<int>& JointGroup::joints() const {
  return data_->model->joints;
}

JointGroup JointGroup::with_reference(const Eigen::VectorXd& full_values) const {
  const int expected = robot().value_count();
  require(full_values.size() == expected, "full_values length", static_cast<double>(full_values.size()),
          "must be " + std::to_string(expected));
  for (Eigen::Index i = 0; i < full_values.size(); ++i)
    require(std::abs(full_values[i]) <= kLargestLength, "full_values[" + std::to_string(i) + "]", full_values[i],
            "must be finite and within 1e6");
  auto model = std::make_shared<detail::GroupModel>(*data_->model);
  model->reference = full_values;
  detail::flatten(*model);
  return JointGroup(std::make_shared<Data>(std::move(model), data_->T_world_root));
}

JointGroup JointGroup::at(const Pose& T_world_root) const {
  if (has_base())
    throw InvalidInput("group \"" + name() +
                       "\": its base joints already say where the root stands, at() is for groups without");
  return JointGroup(std::make_shared<Data>(data_->model, T_world_root));
}

JointGroup JointGroup::with_acceleration_limits(const Eigen::VectorXd& limits) const {
  check_configuration(limits, "acceleration_limits");
  for (Eigen::Index i = 0; i < limits.size(); ++i)
    require(limits[i] > 0, "acceleration_limits[" + std::to_string(i) + "]", limits[i], "must be positive");
  auto model = std::make_shared<detail::GroupModel>(*data_->model);
  model->acceleration = limits;
  return JointGroup(std::make_shared<Data>(std::move(model), data_->T_world_root));
}

bool JointGroup::within_limits(const Eigen::VectorXd& q, double slack) const {
  const detail::GroupModel& model = *data_->model;
  if (q.size() != model.lower.size()) return false;
  for (Eigen::Index i = 0; i < q.size(); ++i)
    if (!(q[i] >= model.lower[i] - slack && q[i] <= model.upper[i] + slack)) return false;
  return true;
}

Eigen::VectorXd JointGroup::sample_lower() const {
  Eigen::VectorXd bounds = lower();
  for (Eigen::Index i = 0; i < bounds.size(); ++i)
    if (!std::isfinite(bounds[i])) bounds[i] = -detail::kPi;
  return bounds;
}

Eigen::VectorXd JointGroup::sample_upper() const {
  Eigen::VectorXd bounds = upper();
  for (Eigen::Index i = 0; i < bounds.size(); ++i)
    if (!std::isfinite(bounds[i])) bounds[i] = detail::kPi;
  return bounds;
}

Eigen::VectorXd JointGroup::full_values(const Eigen::VectorXd& q) const {
  const detail::GroupModel& model = *data_->model;
  Eigen::VectorXd values = model.reference;
  int place = 0;  // within the values of a joint
  for (int i = model.base_columns(); i < size(); ++i) {
    const int joint = model.joints[i];
    const bool same = i > 0 && model.joints[i - 1] == joint;
    place = same ? place + 1 : 0;
    values[model.robot.joints()[joint].value_index + place] = q[i];
  }
  return values;
}

Pose JointGroup::root_pose(const Eigen::VectorXd& q) const {
  return has_base() ? pose_from_planar(q.head<3>()) : data_->T_world_root;
}

void JointGroup::check_configuration(const Eigen::VectorXd& q, const std::string& field) const {
  require(q.size() == size(), field + " length", static_cast<double>(q.size()),
          "must be " + std::to_string(size()) + " (group \"" + name() + "\")");
  for (Eigen::Index i = 0; i < q.size(); ++i)
    require(std::abs(q[i]) <= kLargestLength, field + "[" + std::to_string(i) + "]", q[i],
            "must be finite and within 1e6 (joint \"" + names()[i] + "\")");
}

}  // namespace mmgrasp
