// The kernels of chains for AVX2.
#include "mmgrasp/robot/detail/chain_kernel.hpp"

#ifdef MMGRASP_X86_KERNELS
#define MMGRASP_TARGET __attribute__((target("avx2,fma")))
#define MMGRASP_LANES 4

namespace mmgrasp::detail {
namespace {

#include "robot/kinematics/chain_batch.inl"

}  // namespace

const KinematicsKernels kAvx2Kinematics{MMGRASP_LANES, &single, &batch, &frames};

}  // namespace mmgrasp::detail
#endif
