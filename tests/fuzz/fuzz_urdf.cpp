// URDF: what is accepted has finite poses, and what is written of it reads back as the same robot.
#include <optional>

#include "expect.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/robot.hpp"

using namespace mmgrasp;
using fuzzing::expect;

namespace {

void expect_same(const Robot& a, const Robot& b) {
  expect(a.links().size() == b.links().size(), "as many links after writing and reading");
  expect(a.joints().size() == b.joints().size(), "as many joints after writing and reading");
  for (std::size_t i = 0; i < a.links().size(); ++i) expect(a.links()[i].name == b.links()[i].name, "the same links");
  for (std::size_t i = 0; i < a.joints().size(); ++i) {
    const Joint &x = a.joints()[i], &y = b.joints()[i];
    expect(x.name == y.name && x.type == y.type && x.mimic_joint == y.mimic_joint, "the same joint " + x.name);
    expect(x.lower == y.lower && x.upper == y.upper && x.velocity == y.velocity, "the same limits of " + x.name);
  }
  const Poses p = a.link_poses(a.default_values()), q = b.link_poses(b.default_values());
  for (std::size_t i = 0; i < p.size(); ++i)
    expect(p[i].isApprox(q[i], 1e-6) || (p[i].matrix() - q[i].matrix()).norm() < 1e-6, "the same poses");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  RobotOptions options;
  options.load_meshes = false;
  std::optional<Robot> robot;
  try {
    robot = Robot::from_strings(text, "", options, "fuzz.urdf");
  } catch (const InvalidInput& refusal) {
    fuzzing::expect_names(refusal, "fuzz.urdf");
    return 0;
  }
  for (const Pose& pose : robot->link_poses(robot->default_values()))
    expect(pose.matrix().allFinite(), "poses are finite");
  expect_same(*robot, Robot::from_strings(robot->to_urdf(), robot->to_srdf(), options, "written.urdf"));
  return 0;
}
