#include "mmgrasp/reach/capability_map.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/hash.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "reach/capability/capability_data.hpp"

namespace mmgrasp {
namespace {

constexpr double kMostPoses = 4e8;  ///< All voxels together: some 33 bytes each for an arm of seven joints.

double steps_along(const CapabilityOptions& options, int axis) {
  return (options.upper[axis] - options.lower[axis]) / options.voxel;
}

}  // namespace

void CapabilityOptions::check() const {
  require_positive(voxel, "voxel", "m");
  double voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    require_number(lower[axis], "lower", "m");
    require_number(upper[axis], "upper", "m");
    require(upper[axis] > lower[axis], "upper", upper[axis], "must be finite and above lower [m]");
    const double steps = steps_along(*this, axis);
    require(std::abs(steps - std::round(steps)) < 1e-6 * steps + 1e-9 && steps > 0.5, "upper", upper[axis],
            "must be a whole number of voxels above lower");
    voxels *= std::round(steps);
  }
  require(poses >= 1 && poses <= 10000, "poses", poses, "must be in [1, 10000]");
  require(voxels * poses <= kMostPoses, "voxel", voxel,
          "must not make more than 4e8 tool poses (voxels times `poses`)");
  require(rolls >= 1 && rolls <= poses && poses % rolls == 0, "rolls", rolls, "must divide poses");
  require_numbers(approach, "approach");
  require(approach.norm() > 1e-9, "approach", approach.norm(), "must not be zero");
  require(samples >= 0 && samples <= 10000, "samples", samples, "must be in [0, 10000]");
  require_count(sweeps, "sweeps", 0, 255);
  require_count(restarts, "restarts", 0);
  require_not_negative(padding, "padding", "m");
  resolve_threads(threads);  // says what is wrong
}

namespace detail {

Poses sphere_poses(const CapabilityOptions& options) {
  const int directions = options.poses / options.rolls;
  const double golden = kPi * (3 - std::sqrt(5.0));
  const Eigen::Vector3d approach = options.approach.normalized();
  Poses poses;
  for (int k = 0; k < directions; ++k) {
    const double z = 1 - (2.0 * k + 1) / directions, ring = std::sqrt(std::max(0.0, 1 - z * z));
    const Eigen::Vector3d outwards(ring * std::cos(golden * k), ring * std::sin(golden * k), z);
    const Eigen::Quaterniond point = Eigen::Quaterniond::FromTwoVectors(approach, -outwards);
    const double start = k * std::sqrt(2.0) - std::floor(k * std::sqrt(2.0));
    for (int roll = 0; roll < options.rolls; ++roll) {
      const double angle = kTwoPi * (roll + start) / options.rolls;
      Pose pose = Pose::Identity();
      pose.linear() = (Eigen::AngleAxisd(angle, -outwards) * point).normalized().toRotationMatrix();
      pose.translation() = 0.5 * options.voxel * outwards;
      poses.push_back(pose);
    }
  }
  return poses;
}

std::string capability_arm_key(const JointGroup& arm) {
  Hasher hasher;
  hasher.add(kCapabilityFormat).add(arm.robot().hash()).add(arm.size());
  for (const std::string& name : arm.names()) hasher.add(name);
  hasher.add(arm.robot().links()[arm.tip_link()].name);
  hasher.add(Eigen::MatrixXd(arm.full_values(Eigen::VectorXd::Zero(arm.size()))));
  return hasher.hex();
}

}  // namespace detail

void CapabilityMap::Data::lay_out() {
  for (int axis = 0; axis < 3; ++axis) shape[axis] = static_cast<int>(std::lround(steps_along(options, axis)));
  tool_poses = detail::sphere_poses(options);
}

void CapabilityMap::Data::complete() {
  const std::size_t voxels = voxel_count();
  index.assign(voxels, 0);
  first.assign(voxels + 1, 0);
  rejections = {};
  for (std::size_t v = 0; v < voxels; ++v) {
    std::int64_t count = 0;
    for (std::size_t k = 0; k < poses(); ++k) {
      const auto cause = static_cast<Rejection>(classes[v * poses() + k]);
      if (cause == Rejection::none)
        ++count;
      else
        rejections.add(cause);
    }
    index[v] = static_cast<float>(count) / static_cast<float>(poses());
    first[v + 1] = first[v] + count;
  }
}

Eigen::Vector3d CapabilityMap::Data::centre(std::int64_t voxel) const {
  const std::int64_t z = voxel % shape[2], y = voxel / shape[2] % shape[1], x = voxel / shape[2] / shape[1];
  return options.lower + options.voxel * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
}

Pose CapabilityMap::Data::pose(std::size_t at) const {
  Pose T = tool_poses[at % poses()];
  T.translation() += centre(static_cast<std::int64_t>(at / poses()));
  return T;
}

CapabilityMap::CapabilityMap(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

const CapabilityOptions& CapabilityMap::options() const {
  return data_->options;
}
const std::string& CapabilityMap::arm_key() const {
  return data_->arm_key;
}
const std::array<int, 3>& CapabilityMap::shape() const {
  return data_->shape;
}
std::int64_t CapabilityMap::voxel_count() const {
  return data_->voxel_count();
}
int CapabilityMap::joint_count() const {
  return data_->joints;
}
const std::vector<float>& CapabilityMap::index() const {
  return data_->index;
}
const std::vector<std::uint8_t>& CapabilityMap::classes() const {
  return data_->classes;
}
const std::vector<float>& CapabilityMap::configurations() const {
  return data_->configurations;
}
std::int64_t CapabilityMap::reached() const {
  return data_->first.empty() ? 0 : data_->first.back();
}
const Rejections& CapabilityMap::rejections() const {
  return data_->rejections;
}

std::int64_t CapabilityMap::voxel(int x, int y, int z) const {
  const auto check = [&](int value, std::size_t axis, const char* name) {
    require(value >= 0 && value < data_->shape[axis], name, value,
            "must be in [0, " + std::to_string(data_->shape[axis]) + ")");
  };
  check(x, 0, "x");
  check(y, 1, "y");
  check(z, 2, "z");
  return (static_cast<std::int64_t>(x) * data_->shape[1] + y) * data_->shape[2] + z;
}

std::int64_t CapabilityMap::voxel_at(const Eigen::Vector3d& p_root_point) const {
  std::array<int, 3> at{};
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::floor((p_root_point[axis] - data_->options.lower[axis]) / data_->options.voxel);
    if (!(cell >= 0 && cell < data_->shape[axis])) return -1;
    at[axis] = static_cast<int>(cell);
  }
  return voxel(at[0], at[1], at[2]);
}

namespace {

void check_place(const CapabilityMap& map, std::int64_t voxel, int pose) {
  require(voxel >= 0 && voxel < map.voxel_count(), "voxel", static_cast<double>(voxel),
          "must be in [0, " + std::to_string(map.voxel_count()) + ")");
  require(pose >= 0 && pose < map.options().poses, "pose", pose,
          "must be in [0, " + std::to_string(map.options().poses) + ")");
}

}  // namespace

Eigen::Vector3d CapabilityMap::centre(std::int64_t voxel) const {
  check_place(*this, voxel, 0);
  return data_->centre(voxel);
}

Pose CapabilityMap::tool_pose(std::int64_t voxel, int pose) const {
  check_place(*this, voxel, pose);
  return data_->pose(voxel * data_->poses() + pose);
}

Rejection CapabilityMap::classified(std::int64_t voxel, int pose) const {
  check_place(*this, voxel, pose);
  return static_cast<Rejection>(data_->classes[voxel * data_->poses() + pose]);
}

Eigen::VectorXd CapabilityMap::configuration(std::int64_t voxel, int pose) const {
  if (classified(voxel, pose) != Rejection::none) return {};
  const auto start = data_->classes.begin() + voxel * static_cast<std::int64_t>(data_->poses());
  const std::int64_t row = data_->first[voxel] + std::count(start, start + pose, 0);
  return Eigen::Map<const Eigen::VectorXf>(data_->configurations.data() + row * data_->joints, data_->joints)
      .cast<double>();
}

double CapabilityMap::index_at(const Eigen::Vector3d& p_root_point) const {
  const std::int64_t at = voxel_at(p_root_point);
  return at < 0 ? 0.0 : static_cast<double>(data_->index[at]);
}

std::int64_t CapabilityMap::best_voxel() const {
  if (data_->index.empty()) return -1;
  return std::max_element(data_->index.begin(), data_->index.end()) - data_->index.begin();
}

double CapabilityMap::maximum() const {
  const std::int64_t best = best_voxel();
  return best < 0 ? 0.0 : static_cast<double>(data_->index[best]);
}

double CapabilityMap::score(const Poses& T_world_tip, const Pose& T_world_root, double cone) const {
  require(!T_world_tip.empty(), "T_world_tip", "[]", "must hold at least one pose");
  require(cone > 0, "cone", cone, "must be positive [rad]");
  const Pose T_root_world = T_world_root.inverse();
  const Eigen::Vector3d approach = data_->options.approach.normalized();
  double sum = 0;
  detail::InterruptionPoll poll(256);
  for (const Pose& pose : T_world_tip) {
    poll();
    const Pose T = T_root_world * pose;
    const std::int64_t at = voxel_at(T.translation());
    if (at < 0) continue;
    if (cone >= detail::kPi) {
      sum += static_cast<double>(data_->index[at]);
      continue;
    }
    const Eigen::Vector3d direction = T.linear() * approach;
    int near = 0, reached = 0;
    for (std::size_t k = 0; k < data_->poses(); ++k) {
      if ((data_->tool_poses[k].linear() * approach).dot(direction) < std::cos(cone)) continue;
      ++near;
      reached += data_->classes[at * data_->poses() + k] == 0;
    }
    if (near > 0) sum += static_cast<double>(reached) / near;
  }
  return sum / static_cast<double>(T_world_tip.size());
}

BaseDistance best_base_distance(const CapabilityMap& map, const Poses& T_world_tip, double heading,
                                const std::vector<double>& distances, double cone) {
  require_number(heading, "heading", "rad");
  require(!T_world_tip.empty(), "T_world_tip", "[]", "must hold at least one pose");
  require(!distances.empty(), "distances", "[]", "must hold at least one distance [m]");
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Pose& pose : T_world_tip) middle += pose.translation() / static_cast<double>(T_world_tip.size());
  BaseDistance result;
  result.score = -1;
  for (const double distance : distances) {
    require_number(distance, "distances", "m");
    const Eigen::Vector3d base(middle[0] - distance * std::cos(heading), middle[1] - distance * std::sin(heading),
                               heading);
    const double score = map.score(T_world_tip, pose_from_planar(base), cone);
    result.scores.push_back(score);
    if (score > result.score || (score == result.score && distance < result.distance)) {
      result.score = score;
      result.distance = distance;
    }
  }
  return result;
}

}  // namespace mmgrasp
