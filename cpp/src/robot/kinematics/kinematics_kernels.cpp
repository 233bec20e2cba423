// Which version of the kinematics loops runs.

#include "mmgrasp/core/detail/instruction_set.hpp"
#include "mmgrasp/robot/detail/chain_kernel.hpp"

namespace mmgrasp::detail {

const KinematicsKernels& kinematics_kernels() {
#ifdef MMGRASP_X86_KERNELS
  static constexpr const KinematicsKernels* kVersions[] = {&kPortableKinematics, &kAvx2Kinematics, &kAvx512Kinematics};
  return *kVersions[static_cast<int>(instruction_set())];
#else
  return kPortableKinematics;
#endif
}

}  // namespace mmgrasp::detail
