// The kernels of chains for any machine, and the choice among the sets.
#include <cmath>

#include "mmgrasp/robot/detail/chain_kernel.hpp"

#define MMGRASP_TARGET
#define MMGRASP_LANES 2

namespace mmgrasp::detail {
namespace {

#include "robot/kinematics/chain_batch.inl"

}  // namespace

const KinematicsKernels kPortableKinematics{MMGRASP_LANES, &single, &batch, &links};

void any_sines(const AngleTable& angles, const double* q, double* sines, double* cosines) {
  for (int i = 0; i < angles.count; ++i) {
    const double angle = angles.multiplier[i] * q[angles.column[i]] + angles.offset[i];
    sines[i] = std::sin(angle);
    cosines[i] = std::cos(angle);
  }
}

}  // namespace mmgrasp::detail
