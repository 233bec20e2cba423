// The kernels of chains for AVX-512.
#include "mmgrasp/robot/detail/chain_kernel.hpp"

#ifdef MMGRASP_X86_KERNELS
#define MMGRASP_TARGET __attribute__((target("avx2,fma,avx512f,avx512dq,avx512vl")))
#define MMGRASP_LANES 8

namespace mmgrasp::detail {
namespace {

#include "robot/kinematics/chain_batch.inl"

}  // namespace

const KinematicsKernels kAvx512Kinematics{MMGRASP_LANES, &single, &batch, &frames};

}  // namespace mmgrasp::detail
#endif
