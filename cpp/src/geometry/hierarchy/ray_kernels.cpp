#include "geometry/hierarchy/ray_kernels.hpp"

#include "mmgrasp/core/detail/instruction_set.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

// Compiled with -ffp-contract=off (CMakeLists.txt): a fused product would judge an edge otherwise than its neighbour
// does, and the sets of instructions would differ.
namespace mmgrasp::detail {

#if defined(MMGRASP_X86_KERNELS) && !defined(__clang__)
#define MMGRASP_HAS_AVX2
#pragma GCC push_options
#pragma GCC target("avx2,bmi")
namespace avx2 {
#define MMGRASP_KERNEL_NAME "avx2"
#define MMGRASP_KERNEL_AVX2  // g++ does not set __AVX2__ for the pragma
#include "geometry/hierarchy/ray_kernels_body.inc"
#undef MMGRASP_KERNEL_AVX2
#undef MMGRASP_KERNEL_NAME
}  // namespace avx2
#pragma GCC pop_options
#endif

namespace portable {
#define MMGRASP_KERNEL_NAME "portable"
#include "geometry/hierarchy/ray_kernels_body.inc"
#undef MMGRASP_KERNEL_NAME
}  // namespace portable

const RayKernels& ray_kernels() {
#ifdef MMGRASP_HAS_AVX2
  static const bool has_bmi = __builtin_cpu_supports("bmi");
  if (has_bmi && instruction_set() != InstructionSet::portable) return avx2::kTable;
#endif
  return portable::kTable;
}

}  // namespace mmgrasp::detail
