#include "mmgrasp/geometry/detail/quiet_pcl.hpp"

#include <pcl/console/print.h>

#include <mutex>

namespace mmgrasp::detail {
namespace {

struct Level {
  std::mutex mutex;
  int users = 0;
  pcl::console::VERBOSITY_LEVEL before = pcl::console::L_INFO;
};

Level& level() {
  static Level shared;
  return shared;
}

}  // namespace

QuietPcl::QuietPcl() {
  Level& shared = level();
  const std::lock_guard<std::mutex> lock(shared.mutex);
  if (shared.users++ > 0) return;
  shared.before = pcl::console::getVerbosityLevel();
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
}

QuietPcl::~QuietPcl() {
  Level& shared = level();
  const std::lock_guard<std::mutex> lock(shared.mutex);
  if (--shared.users == 0) pcl::console::setVerbosityLevel(shared.before);
}

}  // namespace mmgrasp::detail
