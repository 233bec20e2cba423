#include "geometry/hierarchy/ray_kernels.hpp"

#include <atomic>

#include "mmgrasp/core/error.hpp"

// Compiled with -ffp-contract=off (CMakeLists.txt): a fused product would judge an edge otherwise than its neighbour
// does, and the sets of instructions would differ.
namespace mmgrasp::detail {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
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

namespace {

const RayKernels& quickest() {
#ifdef MMGRASP_HAS_AVX2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi")) return avx2::kTable;
#endif
  return portable::kTable;
}

std::atomic<const RayKernels*>& chosen() {
  static std::atomic<const RayKernels*> table{&quickest()};
  return table;
}

}  // namespace

const RayKernels& ray_kernels() {
  return *chosen().load(std::memory_order_relaxed);
}

void use_ray_kernels(const std::string& name) {
  if (!name.empty() && name != "portable") throw InvalidInput("name = " + name + ": must be portable or empty");
  chosen().store(name.empty() ? &quickest() : &portable::kTable);
}

}  // namespace mmgrasp::detail
