#pragma once

#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// The hot loops of kinematics and of collision checks are compiled once for each of these; which version runs is
/// decided at run time, for the whole process. Each set has what the ones before it have. AVX2 is meant with FMA.
enum class InstructionSet { portable, avx2, avx512 };

/// Defined where the compiler can make the versions for AVX.
#if defined(__x86_64__) && defined(__GNUC__)
#define MMGRASP_X86_KERNELS
#endif

/// The best set that this machine has, unless use_instruction_set() chose another.
InstructionSet instruction_set();

/// Names of the sets that this machine has, best first; "portable" is always the last.
MMGRASP_EXPORT std::vector<std::string> instruction_sets();
/// Chooses a set by name, for tests and measurements while nothing else runs: values differ between sets by roundings.
/// Throws InvalidInput for a set that this machine has not.
MMGRASP_EXPORT void use_instruction_set(const std::string& name);

}  // namespace mmgrasp::detail
