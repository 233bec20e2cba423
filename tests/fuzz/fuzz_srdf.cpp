// SRDF for a fixed small robot: its groups work or say why not, and what is written of it reads back the same.
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "expect.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/robot.hpp"

using namespace mmgrasp;
using fuzzing::expect;

namespace {

/// A base with an arm of two joints and a hand of two fingers, one of which follows the other, and a castor.
const std::string kUrdf = R"(<robot name="r">
<link name="base"/><link name="a"/><link name="b"/><link name="hand"/><link name="f"/><link name="g"/><link name="c"/>
<joint name="j1" type="revolute"><parent link="base"/><child link="a"/><limit lower="-1" upper="2" velocity="1"/></joint>
<joint name="j2" type="prismatic"><parent link="a"/><child link="b"/><limit lower="0" upper="1" velocity="1"/></joint>
<joint name="h" type="fixed"><parent link="b"/><child link="hand"/></joint>
<joint name="p" type="prismatic"><parent link="hand"/><child link="f"/><limit lower="0" upper="1" velocity="1"/></joint>
<joint name="q" type="prismatic"><parent link="hand"/><child link="g"/><limit lower="0" upper="1" velocity="1"/>
<mimic joint="p"/></joint>
<joint name="w" type="continuous"><parent link="base"/><child link="c"/></joint>
</robot>)";

void use_groups(const Robot& robot) {
  for (const GroupDescription& description : robot.groups()) {
    try {
      const JointGroup group = robot.group(description.name);
      Eigen::VectorXd middle = 0.5 * (group.lower() + group.upper());
      for (double& value : middle)
        if (!std::isfinite(value)) value = 0;  // a joint that turns on and on
      expect(group.fk(middle).matrix().allFinite(), "a pose is finite");
    } catch (const InvalidInput&) {
      // no chain, or without joints
    }
  }
}

/// The names of a group's columns; none when it is no chain.
std::vector<std::string> joints_of(const Robot& robot, const std::string& group) {
  try {
    return robot.group(group).names();
  } catch (const InvalidInput&) {
    return {};
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;  // no SRDF
  const std::string text(reinterpret_cast<const char*>(data), size);
  std::optional<Robot> robot;
  try {
    robot = Robot::from_strings(kUrdf, text, {}, "fuzz.urdf");
  } catch (const InvalidInput& refusal) {
    fuzzing::expect_names(refusal, "fuzz.urdf (SRDF)");
    return 0;
  }
  expect(robot->has_srdf(), "an SRDF was read");
  use_groups(*robot);
  const Robot again = Robot::from_strings(robot->to_urdf(), robot->to_srdf(), {}, "written.urdf");
  expect(again.groups().size() == robot->groups().size(), "the same groups after writing and reading");
  for (std::size_t i = 0; i < again.groups().size(); ++i)
    expect(joints_of(again, again.groups()[i].name) == joints_of(*robot, robot->groups()[i].name),
           "of the same joints");
  expect(again.group_states() == robot->group_states(), "the same states");
  expect(again.passive_joints() == robot->passive_joints(), "the same passive joints");
  expect(again.disabled_pairs() == robot->disabled_pairs(), "the same disabled pairs");
  return 0;
}
