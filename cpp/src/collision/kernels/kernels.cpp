#include "collision/kernels/kernels.hpp"

#include <atomic>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define MMGRASP_HAS_AVX2
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace avx2 {
#define MMGRASP_KERNEL_NAME "avx2"
#include "collision/kernels/kernels_body.inc"
#undef MMGRASP_KERNEL_NAME
}  // namespace avx2
#pragma GCC pop_options
#endif

namespace portable {
#define MMGRASP_KERNEL_NAME "portable"
#include "collision/kernels/kernels_body.inc"
#undef MMGRASP_KERNEL_NAME
}  // namespace portable

namespace {

const Kernels& quickest() {
#ifdef MMGRASP_HAS_AVX2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return avx2::kTable;
#endif
  return portable::kTable;
}

std::atomic<const Kernels*>& chosen() {
  static std::atomic<const Kernels*> table{&quickest()};
  return table;
}

}  // namespace

const Kernels& kernels() {
  return *chosen().load(std::memory_order_relaxed);
}

void use_collision_kernels(const std::string& name) {
  if (!name.empty() && name != "portable") throw InvalidInput("name = " + name + ": must be portable or empty");
  chosen().store(name.empty() ? &quickest() : &portable::kTable);
}

std::string collision_kernels() {
  return kernels().name;
}

}  // namespace mmgrasp::detail
