#pragma once

#include <sys/resource.h>

#include <string>
#include <vector>

#include "mmgrasp/collision/disabled_pairs.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace bench {

struct ReachCase {
  std::string name;
  mmgrasp::JointGroup arm;
};

/// The shipped robot's arm and the Panda's, seven joints each.
inline std::vector<ReachCase> reach_cases(const std::string& only) {
  using namespace mmgrasp;
  std::vector<ReachCase> out;
  if (only.empty() || only == "fetchlike") {
    const std::string folder = std::string(MMGRASP_ASSETS) + "/robots/fetchlike/";
    const Robot robot = Robot::load(folder + "fetchlike.urdf", folder + "fetchlike.srdf");
    out.push_back({"fetchlike", compute_disabled_pairs(robot).group("arm")});
  }
  if (only.empty() || only == "panda") {
    const std::string folder = std::string(MMGRASP_SHARED_DATA) + "/robots/panda/";
    RobotOptions options;
    options.package_dirs["moveit_resources_panda_description"] = folder + "moveit_resources_panda_description";
    const Robot robot = Robot::load(folder + "expanded/panda.urdf",
                                    folder + "moveit_resources_panda_moveit_config/config/panda.srdf", options);
    out.push_back({"panda", robot.chain("panda_link0", "panda_link8")});
  }
  return out;
}

/// Processor time of all threads so far [s]: what a busy machine leaves alone.
inline double processor_time() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

/// Most memory used so far [GiB].
inline double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / (1 << 20);
}

}  // namespace bench
