#include <atomic>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/chain_kernel.hpp"
#include "mmgrasp/robot/kinematics_batch.hpp"

namespace mmgrasp {
namespace detail {
namespace {

/// What this machine can run, best first.
std::vector<const KinematicsKernels*> usable() {
  std::vector<const KinematicsKernels*> list;
#ifdef MMGRASP_X86_KERNELS
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    list.push_back(&kAvx512Kinematics);
  if (avx2) list.push_back(&kAvx2Kinematics);
#endif
  list.push_back(&kPortableKinematics);
  return list;
}

std::atomic<const KinematicsKernels*> chosen{&kPortableKinematics};  // right before any other file's statics are made
[[maybe_unused]] const bool upgraded = [] {
  chosen = usable().front();
  return true;
}();

}  // namespace

const KinematicsKernels& kinematics_kernels() {
  return *chosen.load(std::memory_order_relaxed);
}

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (const KinematicsKernels* each : usable()) names.emplace_back(each->name);
  return names;
}

void use_instruction_set(const std::string& name) {
  std::string known;
  for (const KinematicsKernels* each : usable()) {
    if (each->name == name) return chosen.store(each);
    known += (known.empty() ? "" : ", ") + std::string(each->name);
  }
  throw InvalidInput("instruction set = \"" + name + "\": this machine has " + known);
}

}  // namespace detail
}  // namespace mmgrasp
