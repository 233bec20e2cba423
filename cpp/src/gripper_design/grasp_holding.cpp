#include "mmgrasp/gripper_design/grasp_holding.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Wrench = Eigen::Matrix<double, 6, 1>;

constexpr int kPerPad = 4;          // pressure, two tangential forces, torque
constexpr double kBalanced = 1e-9;  // residual of the balance that counts as none, relative to the load

/// The pads of a grasp in the tool frame, and what each of them does to the part.
struct Pads {
  ContactArea contact;
  Vector3d middle = Vector3d::Zero();
  /// Columns by pad: pressure, tangential forces, torque / torsion radius; moments about the middle, over half the
  /// opening, so that all rows are forces.
  MatrixXd wrenches;
};

Wrench scaled(const Vector3d& force, const Vector3d& moment, double arm) {
  Wrench out;
  out << force, moment / arm;
  return out;
}

Pads pads_of(const AssemblyGrasp& grasp, const FingerGrip& grip) {
  const double arm = grasp.opening / 2;
  Pads pads;
  pads.contact = grasp.fingers == 2
                     ? flat_contact(grasp.contact_length, grasp.contact_width)
                     : line_contact(grip.force, arm, grasp.contact_length, grasp.contact_width, grip.modulus,
                                    grip.pad_radius < arm ? detail::kInfinity : grip.pad_radius);
  pads.middle = Vector3d(0, 0, -grasp.contact_length / 2);
  pads.wrenches.resize(6, static_cast<Eigen::Index>(kPerPad) * grasp.fingers);
  for (int i = 0; i < grasp.fingers; ++i) {
    const double turn = detail::kTwoPi * i / grasp.fingers;
    const Vector3d outwards(std::cos(turn), std::sin(turn), 0), along = Vector3d::UnitZ();
    const Vector3d across = along.cross(outwards), at = arm * outwards;
    const Eigen::Index first = static_cast<Eigen::Index>(kPerPad) * i;
    pads.wrenches.col(first) = scaled(-outwards, Vector3d::Zero(), arm);
    pads.wrenches.col(first + 1) = scaled(across, at.cross(across), arm);
    pads.wrenches.col(first + 2) = scaled(along, at.cross(along), arm);
    pads.wrenches.col(first + 3) = scaled(Vector3d::Zero(), pads.contact.torsion_radius * outwards, arm);
  }
  return pads;
}

/// What each pad does against a wrench: the share with the least sum of squares. Empty when there is none.
VectorXd share(const Pads& pads, const Wrench& load) {
  const VectorXd out = pads.wrenches.completeOrthogonalDecomposition().solve(-load);
  if ((pads.wrenches * out + load).norm() > kBalanced * (1 + load.norm())) return {};
  return out;
}

/// The factor by which a load may grow.
double factor(const Pads& pads, const FingerGrip& grip, const Wrench& load) {
  const VectorXd shares = share(pads, load);
  if (shares.size() == 0) return 0;
  double least = detail::kInfinity;
  for (Eigen::Index i = 0; i < shares.size(); i += kPerPad) {
    const double slip = shares.segment<3>(i + 1).norm() + grip.friction * std::max(0.0, -shares[i]);
    if (slip > kBalanced * grip.force) least = std::min(least, grip.friction * grip.force / slip);
  }
  return least;
}

/// The least torque that a pad holds beside the forces that it carries.
double torque_beside(const Pads& pads, const FingerGrip& grip, const Wrench& load) {
  const VectorXd shares = share(pads, load);
  if (shares.size() == 0) return 0;
  double least = detail::kInfinity;
  for (Eigen::Index i = 0; i < shares.size(); i += kPerPad) {
    const double pressure = std::max(0.0, grip.force + std::min(0.0, shares[i]));
    least = std::min(least, soft_finger_torque(pressure, grip.friction, pads.contact.torsion_radius,
                                               shares.segment<2>(i + 1).norm()));
  }
  return least;
}

}  // namespace

void FingerGrip::check() const {
  require_positive(force, "force", "N");
  require_positive(friction, "friction");
  require_positive(modulus, "modulus", "Pa", kLargestNumber);
  require(pad_radius > 0, "pad_radius", pad_radius, "must be a positive length [m], or infinite");
}

void AssemblyLoad::check() const {
  require_numbers(weight, "weight", "N");
  require_numbers(centre, "centre", "m");
  require_numbers(resistance, "resistance", "N");
  require_numbers(hole, "hole", "m");
}

GraspHolding grasp_holding(const AssemblyGrasp& grasp, const FingerGrip& grip, const AssemblyLoad& load) {
  grasp.check();
  grip.check();
  load.check();
  require_positive(grasp.contact_length, "contact_length", "m");
  require_positive(grasp.contact_width, "contact_width", "m");
  const Pads pads = pads_of(grasp, grip);
  const Pose T_tool = grasp.T_active_tool.inverse();
  const auto wrench = [&](const Vector3d& force, const Vector3d& at) {
    const Vector3d f = T_tool.linear() * force;
    return scaled(f, (T_tool * at - pads.middle).cross(f), grasp.opening / 2);
  };
  const Wrench weight = wrench(load.weight, load.centre), resistance = wrench(load.resistance, load.hole);
  GraspHolding out;
  out.contact = pads.contact;
  out.insertion_moment = resistance.tail<3>().norm() * grasp.opening / 2;
  out.safety = std::min(factor(pads, grip, weight), factor(pads, grip, weight + resistance));
  out.pad_torque = torque_beside(pads, grip, weight + resistance);
  return out;
}

}  // namespace mmgrasp
