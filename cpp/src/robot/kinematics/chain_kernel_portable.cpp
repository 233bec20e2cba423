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

void turn_any(const TurnTable& turns, const double* q, double* sines, double* cosines) {
  for (int i = 0; i < turns.count; ++i) {
    const double angle = turns.multiplier[i] * q[turns.column[i]] + turns.offset[i];
    sines[i] = std::sin(angle);
    cosines[i] = std::cos(angle);
  }
}

}  // namespace mmgrasp::detail
