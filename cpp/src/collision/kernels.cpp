#include "collision/kernels.hpp"

namespace mmgrasp::detail {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define MMGRASP_HAS_AVX2
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace avx2 {
#define MMGRASP_KERNEL_NAME "avx2"
#include "collision/kernels_body.inc"
#undef MMGRASP_KERNEL_NAME
}  // namespace avx2
#pragma GCC pop_options
#endif

namespace portable {
#define MMGRASP_KERNEL_NAME "portable"
#include "collision/kernels_body.inc"
#undef MMGRASP_KERNEL_NAME
}  // namespace portable

const Kernels& portable_kernels() {
  return portable::kTable;
}

const Kernels& kernels() {
#ifdef MMGRASP_HAS_AVX2
  static const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (wide) return avx2::kTable;
#endif
  return portable::kTable;
}

}  // namespace mmgrasp::detail
