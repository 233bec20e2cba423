#include "collision/kernels/kernels.hpp"

#include "mmgrasp/core/detail/instruction_set.hpp"

namespace mmgrasp::detail {

// Clang does not know these pragmas.
#if defined(MMGRASP_X86_KERNELS) && !defined(__clang__)
#define MMGRASP_AVX2_COLLISION
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace avx2 {
#define MMGRASP_LANES_AVX2  // g++ does not set __AVX2__ for the pragma
#include "collision/kernels/kernels_body.inc"
#undef MMGRASP_LANES_AVX2
}  // namespace avx2
#pragma GCC pop_options
#endif

namespace portable {
#include "collision/kernels/kernels_body.inc"
}  // namespace portable

const Kernels& kernels() {
#ifdef MMGRASP_AVX2_COLLISION
  // Eight numbers fill AVX2's registers: AVX-512 would gain nothing.
  if (instruction_set() != InstructionSet::portable) return avx2::kTable;
#endif
  return portable::kTable;
}

}  // namespace mmgrasp::detail
