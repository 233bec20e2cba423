#include "collision/checker/motion_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {

namespace {

// Where a body may be, seen from some frame, whatever the values of the joints in between.
struct Region {
  Eigen::Vector3d centre;
  double radius;
};

// Distance of a point from the motion's axis.
double off_axis(const ElementaryMotion& motion, const Eigen::Vector3d& point) {
  return (point - motion.axis.dot(point) * motion.axis).norm();
}

// How far a prismatic motion can come from its rest.
double travel(const ElementaryMotion& motion, const Eigen::VectorXd& largest) {
  const double factor = std::abs(motion.drive.multiplier);
  return std::abs(motion.drive.offset) + (factor > 0 ? factor * largest[motion.drive.column] : 0);
}

// The region that holds the body at every value of the joint, seen from its frame before it moves; the same holds the
// other way round.
Region swept(const ElementaryMotion& motion, Region region, const Eigen::VectorXd& largest) {
  switch (motion.motion) {
    case Motion::revolute:
      region.radius += off_axis(motion, region.centre);
      region.centre = motion.axis.dot(region.centre) * motion.axis;
      break;
    case Motion::prismatic:
      region.radius += travel(motion, largest);
      break;
    case Motion::spherical:
      region.radius += region.centre.norm();
      region.centre.setZero();
      break;
  }
  return region;
}

// How far a body's points move per unit of the joint's value, seen from the joint's frame.
double rate_about(const ElementaryMotion& motion, const Region& region) {
  const double factor = std::abs(motion.drive.multiplier);
  switch (motion.motion) {
    case Motion::revolute:
      return factor * (off_axis(motion, region.centre) + region.radius);
    case Motion::prismatic:
      return factor;
    case Motion::spherical:
      break;
  }
  return region.centre.norm() + region.radius;
}

// rates[i]: how fast the body in `sphere` moves about joint path[i]; the path leads from its frame up to joint `top` -
// 1 and down from joint `top` on.
std::vector<double> rates_on_path(const std::vector<const ElementaryMotion*>& path, std::size_t top,
                                  const FrameSphere& sphere, const Eigen::VectorXd& largest) {
  std::vector<double> rates;
  Region region{Eigen::Vector3d(sphere.p), sphere.radius};
  for (std::size_t i = 0; i < path.size(); ++i) {
    const ElementaryMotion& motion = *path[i];
    const bool up = i < top;
    if (!up) region.centre = motion.rest.R.transpose() * (region.centre - motion.rest.t);
    rates.push_back(rate_about(motion, region));
    region = swept(motion, region, largest);
    if (up) region.centre = motion.rest * region.centre;
  }
  return rates;
}

}  // namespace

MotionBounds::MotionBounds(const JointGroup& group)
    : kinematics_(group.data().model->kinematics), has_base_(group.has_base()), columns_(group.size()) {
  for (const ElementaryMotion& motion : tree().motions) bends_ = bends_ && motion.motion != Motion::spherical;
}

std::vector<MotionBounds::JointReach> MotionBounds::joints_above(const FrameSphere& sphere,
                                                                 const Eigen::VectorXd& largest) const {
  std::vector<JointReach> joints;
  // Walking up: `radius` always bounds the distance from the points to the origin of the frame at hand.
  double radius = Eigen::Vector3d(sphere.p).norm() + sphere.radius;
  for (const ElementaryMotion* motion : tree().motions_above(sphere.frame)) {
    const int column = motion->drive.column;
    const double factor = std::abs(motion->drive.multiplier);
    const bool slides = motion->motion == Motion::prismatic;
    joints.push_back({column, slides ? 0 : factor, slides ? factor : factor * radius});
    if (motion->motion == Motion::spherical) {
      // A rotation vector's rate is never less than the angular velocity it makes.
      for (const int k : {1, 2}) joints.push_back({column + k, 1, radius});
    }
    if (slides) radius += travel(*motion, largest);
    radius += motion->rest.t.norm();
  }
  if (has_base_) {
    joints.push_back({2, 1, radius});
    for (const int k : {0, 1}) joints.push_back({k, 0, 1});
  }
  return joints;
}

void MotionBounds::joints_between(const FrameSphere& a, const FrameSphere& b, const Eigen::VectorXd& largest,
                                  std::vector<JointReach>& of_a, std::vector<JointReach>& of_b) const {
  std::size_t up = 0;
  std::vector<const ElementaryMotion*> path = motions_between(a.frame, b.frame, up);
  const auto reaches = [&](std::size_t top, const FrameSphere& sphere, std::vector<JointReach>& out) {
    const std::vector<double> rates = rates_on_path(path, top, sphere, largest);
    out.clear();
    for (std::size_t i = 0; i < path.size(); ++i) {
      const ElementaryMotion& motion = *path[i];
      const bool slides = motion.motion == Motion::prismatic;
      out.push_back({motion.drive.column, slides ? 0 : std::abs(motion.drive.multiplier), rates[i]});
    }
  };
  reaches(up, a, of_a);
  std::reverse(path.begin(), path.end());
  reaches(path.size() - up, b, of_b);
}

Eigen::VectorXd MotionBounds::point_rates(const FrameSphere& sphere, const Eigen::VectorXd& largest) const {
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(columns_);
  for (const JointReach& joint : joints_above(sphere, largest)) rates[joint.column] += joint.rate;
  return rates;
}

Eigen::VectorXd MotionBounds::closing_rates(const FrameSphere& a, const FrameSphere& b,
                                            const Eigen::VectorXd& largest) const {
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(columns_);
  std::vector<JointReach> of_a, of_b;
  joints_between(a, b, largest, of_a, of_b);
  const auto spherical = [&](int column) {
    const std::vector<ElementaryMotion>& motions = tree().motions;
    return std::any_of(motions.begin(), motions.end(), [&](const ElementaryMotion& motion) {
      return motion.motion == Motion::spherical && motion.drive.column == column;
    });
  };
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    const JointReach& joint = of_a[i];
    const double rate = std::min(joint.rate, of_b[of_b.size() - 1 - i].rate);
    // A rotation vector's rate is never less than the angular velocity it makes.
    for (int k = 0; k < (spherical(joint.column) ? 3 : 1); ++k) rates[joint.column + k] += rate;
  }
  return rates;
}

// With the angular velocities w_k of the joints from the root outwards and u_k from joint k to the point, the
// acceleration is the sum over k of w_k x (w_k x u_k) + 2 w_j x (w_k x u_k) for all j before k.
Eigen::VectorXd MotionBounds::bends_of(const std::vector<JointReach>& joints) const {
  Eigen::VectorXd bends = Eigen::VectorXd::Zero(columns_ * (columns_ + 1) / 2);
  const auto entry = [&](int i, int j) -> double& {
    if (i > j) std::swap(i, j);
    return bends[i * columns_ - i * (i - 1) / 2 + j - i];
  };
  for (std::size_t k = 0; k < joints.size(); ++k) {
    entry(joints[k].column, joints[k].column) += joints[k].rate * joints[k].turning;
    for (std::size_t j = k + 1; j < joints.size(); ++j)
      entry(joints[j].column, joints[k].column) += 2 * joints[j].turning * joints[k].rate;
  }
  return bends;
}

Eigen::VectorXd MotionBounds::point_bends(const FrameSphere& sphere, const Eigen::VectorXd& largest) const {
  return bends_of(joints_above(sphere, largest));
}

Eigen::VectorXd MotionBounds::closing_bends(const FrameSphere& a, const FrameSphere& b, const Eigen::VectorXd& largest,
                                            bool& b_moves) const {
  std::vector<JointReach> of_a, of_b;
  joints_between(a, b, largest, of_a, of_b);
  const Eigen::VectorXd bends_a = bends_of(of_a), bends_b = bends_of(of_b);
  b_moves = bends_b.sum() < bends_a.sum();
  return b_moves ? bends_b : bends_a;
}

void MotionBounds::squares(const Eigen::VectorXd& values, Eigen::VectorXd& out) {
  const Eigen::Index n = values.size();
  out.resize(n * (n + 1) / 2);
  for (Eigen::Index i = 0, at = 0; i < n; at += n - i++) out.segment(at, n - i) = values[i] * values.tail(n - i);
}

std::vector<const ElementaryMotion*> MotionBounds::motions_between(int from, int to, std::size_t& up) const {
  std::vector<const ElementaryMotion*> path = tree().motions_above(from), down = tree().motions_above(to);
  for (; !path.empty() && !down.empty() && path.back() == down.back(); path.pop_back()) down.pop_back();
  up = path.size();
  path.insert(path.end(), down.rbegin(), down.rend());
  return path;
}

}  // namespace mmgrasp::detail
