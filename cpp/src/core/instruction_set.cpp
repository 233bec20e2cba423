#include "mmgrasp/core/detail/instruction_set.hpp"

#include <atomic>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

constexpr const char* kNames[] = {"portable", "avx2", "avx512"};

InstructionSet best() {
#ifdef MMGRASP_X86_KERNELS
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return InstructionSet::portable;
  const bool avx512 =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  return avx512 ? InstructionSet::avx512 : InstructionSet::avx2;
#else
  return InstructionSet::portable;
#endif
}

// Right before any other file's statics are made: every machine has the portable set.
std::atomic<InstructionSet> chosen{InstructionSet::portable};
[[maybe_unused]] const bool upgraded = [] {
  chosen = best();
  return true;
}();

}  // namespace

InstructionSet instruction_set() {
  return chosen.load(std::memory_order_relaxed);
}

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (int set = static_cast<int>(best()); set >= 0; --set) names.emplace_back(kNames[set]);
  return names;
}

void use_instruction_set(const std::string& name) {
  std::string known;
  for (int set = static_cast<int>(best()); set >= 0; --set) {
    if (name == kNames[set]) return chosen.store(static_cast<InstructionSet>(set));
    known += (known.empty() ? "" : ", ") + std::string(kNames[set]);
  }
  throw InvalidInput("instruction set = \"" + name + "\": this machine has " + known);
}

}  // namespace mmgrasp::detail
