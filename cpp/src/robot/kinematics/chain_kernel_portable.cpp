// The kernels of chains for any machine, and the choice among the sets.
#include <cmath>

#include "mmgrasp/robot/detail/chain_kernel.hpp"
#include "robot/model/joint_motion.hpp"

#define MMGRASP_TARGET
#define MMGRASP_LANES 2

namespace mmgrasp::detail {
namespace {

#include "robot/kinematics/chain_batch.inl"

}  // namespace

const KinematicsKernels kPortableKinematics{MMGRASP_LANES, &single, &batch, &frames};

void any_sines(const AngleTable& angles, const double* q, double* sines, double* cosines) {
  for (int i = 0; i < angles.count; ++i) {
    const double angle = angles.multiplier[i] * q[angles.column[i]] + angles.offset[i];
    sines[i] = std::sin(angle);
    cosines[i] = std::cos(angle);
  }
}

void rotation_columns(const double* rotation_vector, double* R) {
  Eigen::Map<Eigen::Matrix<double, 4, 3>> columns(R);
  columns.topRows<3>() = rotation_of(Eigen::Map<const Eigen::Vector3d>(rotation_vector));
  columns.row(3).setZero();
}

}  // namespace mmgrasp::detail
