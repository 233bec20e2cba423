#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/robot.hpp"
#include "support/robot_support.hpp"
#include "support/small_robots.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

using Names = std::vector<std::string>;

std::string read_file(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

double mass_sum(const std::string& urdf) {
  const std::regex mass("<mass\\s+value=\"([^\"]+)\"");
  double sum = 0;
  for (std::sregex_iterator it(urdf.begin(), urdf.end(), mass), end; it != end; ++it) sum += std::stod((*it)[1]);
  return sum;
}

/// Everything an SRDF says, compared item by item.
void expect_same_srdf(const Robot& a, const Robot& b) {
  ASSERT_EQ(a.groups().size(), b.groups().size());
  for (std::size_t i = 0; i < a.groups().size(); ++i) {
    EXPECT_EQ(a.groups()[i].name, b.groups()[i].name);
    EXPECT_EQ(a.groups()[i].joints, b.groups()[i].joints) << a.groups()[i].name;
    EXPECT_EQ(a.groups()[i].base_link, b.groups()[i].base_link) << a.groups()[i].name;
    EXPECT_EQ(a.groups()[i].tip_link, b.groups()[i].tip_link) << a.groups()[i].name;
  }
  EXPECT_EQ(a.passive_joints(), b.passive_joints());
  EXPECT_EQ(a.disabled_pairs(), b.disabled_pairs());
  ASSERT_EQ(a.end_effectors().size(), b.end_effectors().size());
  for (std::size_t i = 0; i < a.end_effectors().size(); ++i) {
    EXPECT_EQ(a.end_effectors()[i].name, b.end_effectors()[i].name);
    EXPECT_EQ(a.end_effectors()[i].group, b.end_effectors()[i].group);
    EXPECT_EQ(a.end_effectors()[i].parent_link, b.end_effectors()[i].parent_link);
  }
  ASSERT_EQ(a.group_states().size(), b.group_states().size());
  for (const auto& [group, states] : a.group_states())
    for (const auto& [state, values] : states)
      for (const auto& [name, value] : values)
        EXPECT_NEAR(b.group_states().at(group).at(state).at(name), value, 1e-15)
            << group << " " << state << " " << name;
}

const std::string kTiago = "robots/tiago/example-robot-data/robots/tiago_description/robots/";
const std::string kPr2 = "robots/pr2/example-robot-data/robots/pr2_description/";

const std::map<std::string, std::string> kSrdfs = {
    {"robots/panda/moveit_resources_panda_moveit_config/config/panda.srdf", "robots/panda/expanded/panda.urdf"},
    {"robots/panda_vamp/panda/panda.srdf", "robots/panda_vamp/panda/panda.urdf"},
    {kPr2 + "srdf/pr2.srdf", kPr2 + "urdf/pr2.urdf"},
    {kPr2 + "srdf/pr2_manipulation.srdf", kPr2 + "urdf/pr2.urdf"},
    {"robots/tiago/tiago_moveit_config/config/srdf/tiago_no-ee.srdf", kTiago + "tiago_no_hand.urdf"},
    {"robots/tiago/tiago_moveit_config/config/srdf/tiago_pal-gripper.srdf", kTiago + "tiago.urdf"},
    {"robots/tiago/tiago_moveit_config/config/srdf/tiago_pal-hey5.srdf", kTiago + "tiago.urdf"},
    {"robots/ur/ur5e_moveit_config/config/ur5e.srdf", "robots/ur/expanded/ur5e.urdf"},
    {"robots/ur/ur10e_moveit_config/config/ur10e.srdf", "robots/ur/expanded/ur10e.urdf"},
    {"robots/ur5_vamp/ur5/ur5.srdf", "robots/ur5_vamp/ur5/ur5.urdf"},
};

/// A mast with a planar joint, a turning one, a floating one, a castor, and a finger that follows.
const char* kMixedUrdf = R"(<robot name="r">
  <link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="castor"/><link name="e"/><link name="f"/>
  <joint name="p" type="planar"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit velocity="2"/></joint>
  <joint name="j" type="continuous"><parent link="b"/><child link="c"/><limit velocity="1"/></joint>
  <joint name="fl" type="floating"><parent link="c"/><child link="d"/><limit velocity="1"/></joint>
  <joint name="k" type="continuous"><parent link="a"/><child link="castor"/><limit velocity="1"/></joint>
  <joint name="m" type="continuous"><parent link="d"/><child link="e"/><limit velocity="1"/><mimic joint="j"/></joint>
  <joint name="g" type="continuous"><parent link="castor"/><child link="f"/><limit velocity="1"/></joint></robot>)";

}  // namespace

TEST(Srdf, EveryFileOfTheDataComesBackAsItWasRead) {
  MMGRASP_NEEDS_SHARED_DATA();
  std::set<std::string> there;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(shared("robots")))
    if (entry.path().extension() == ".srdf") there.insert(entry.path().string().substr(shared("").size()));
  ASSERT_EQ(there.size(), kSrdfs.size());
  for (const auto& [srdf, urdf] : kSrdfs) {
    SCOPED_TRACE(srdf);
    ASSERT_TRUE(there.count(srdf));
    RobotOptions options;
    options.load_meshes = false;
    const Robot robot = Robot::load(shared(urdf), shared(srdf), options);
    const std::string written = robot.to_srdf();
    const Robot again = Robot::from_strings(read_file(shared(urdf)), written, options, shared(urdf));
    expect_same_srdf(robot, again);
    EXPECT_EQ(again.to_srdf(), written);
    EXPECT_EQ(again.hash(), robot.hash());
    const std::string original = read_file(shared(srdf));
    EXPECT_EQ(count(written, "<virtual_joint"), count(original, "<virtual_joint"));
    // What was written names nothing unknown, but for the effector whose group's links the URDF lacks.
    for (const std::string& warning : again.report().warnings)
      EXPECT_TRUE(warning.find("SRDF") == std::string::npos ||
                  warning.find("<end_effector name=\"gripper\">") != std::string::npos)
          << warning;
  }
}

TEST(Srdf, PassiveJointsAreInNoGroup) {
  MMGRASP_NEEDS_SHARED_DATA();
  RobotOptions options;
  options.load_meshes = false;
  const Robot robot = Robot::load(shared(kTiago + "tiago.urdf"),
                                  shared("robots/tiago/tiago_moveit_config/config/srdf/tiago_pal-hey5.srdf"), options);
  // 35 in the file; tiago.urdf holds all but those it lacks, which are reported.
  const std::set<std::string> passive(robot.passive_joints().begin(), robot.passive_joints().end());
  int lacking = 0;
  for (const std::string& warning : robot.report().warnings)
    if (warning.find("<passive_joint") != std::string::npos) ++lacking;
  EXPECT_EQ(static_cast<int>(passive.size()) + lacking, 35);
  EXPECT_GT(passive.size(), 20u);
  for (const GroupDescription& group : robot.groups())
    for (const std::string& joint : group.joints) EXPECT_FALSE(passive.count(joint)) << group.name << " " << joint;
}

TEST(Srdf, JointsWithSeveralValuesStayInGroupsInOrder) {
  const Robot robot = Robot::from_strings(kMixedUrdf, R"(<robot name="r">
    <virtual_joint name="world" type="planar" parent_frame="odom" child_link="a"/>
    <passive_joint name="k"/><passive_joint name="world"/><passive_joint name="nobody"/>
    <group name="arm"><chain base_link="a" tip_link="e"/></group>
    <group name="both"><chain base_link="a" tip_link="f"/><chain base_link="a" tip_link="d"/></group>
    <group name="gap"><joint name="p"/><joint name="fl"/></group>
    <group_state name="s" group="arm"><joint name="p" value="1 2 0.5"/><joint name="j" value="0.25"/>
      <joint name="fl" value="4 5 6 0 0.6 0 0.8"/></group_state>
    <disable_collisions link1="a" link2="f" reason="Always"/>
    <enable_collisions link1="a" link2="b"/></robot>)");
  EXPECT_EQ(robot.groups()[0].joints, (Names{"p", "j", "fl"}));
  EXPECT_EQ(robot.groups()[0].tip_link, "e");
  EXPECT_EQ(robot.groups()[1].joints, (Names{"p", "j", "g", "fl"}));  // breadth first; the castor's joint is passive
  EXPECT_TRUE(robot.groups()[1].tip_link.empty());
  EXPECT_EQ(robot.groups()[2].joints, (Names{"p", "fl"}));
  EXPECT_EQ(robot.passive_joints(), Names{"k"});
  ASSERT_EQ(robot.report().warnings.size(), 1u) << robot.report().warnings.back();  // nobody
  EXPECT_FALSE(robot.pair_disabled(robot.link_index("a"), robot.link_index("b")));

  const auto& state = robot.group_states().at("arm").at("s");
  EXPECT_EQ(state.at("p/theta"), 0.5);
  EXPECT_NEAR(state.at("fl/ry"), 2 * std::atan2(0.6, 0.8), 1e-15);
  // As values of the robot they put the links where the file says.
  const Poses poses = robot.link_poses(robot.values(state));
  Pose floating = Pose::Identity();
  floating.translation() = Eigen::Vector3d(4, 5, 6);
  floating.linear() = Eigen::Quaterniond(0.8, 0, 0.6, 0).toRotationMatrix();
  const Pose expected =
      pose_from_xyz_rpy({1, 2, 0}, {0, 0, 0.5}) * Pose(Eigen::AngleAxisd(0.25, Eigen::Vector3d::UnitX())) * floating;
  EXPECT_LT((poses[robot.link_index("d")].matrix() - expected.matrix()).norm(), 1e-14);

  const Robot again = Robot::from_strings(kMixedUrdf, robot.to_srdf());
  expect_same_srdf(robot, again);
  EXPECT_EQ(again.to_srdf(), robot.to_srdf());
  EXPECT_TRUE(again.report().warnings.empty());
  EXPECT_NE(robot.to_srdf().find("parent_frame=\"odom\""), std::string::npos);
}

TEST(Srdf, BadStatesOfJointsWithSeveralValues) {
  const auto load = [](const std::string& value) {
    return Robot::from_strings(kMixedUrdf,
                               "<robot name='r'><group name='g'><joint name='p'/><joint name='fl'/></group>"
                               "<group_state name='s' group='g'>" +
                                   value + "</group_state></robot>");
  };
  EXPECT_THROW(load("<joint name='p' value='1 2'/>"), InvalidInput);
  EXPECT_THROW(load("<joint name='p' value='1 2 nan'/>"), InvalidInput);
  EXPECT_THROW(load("<joint name='fl' value='0 0 0 0 0 0'/>"), InvalidInput);
  EXPECT_THROW(load("<joint name='fl' value='0 0 0 0 0 0 0'/>"), InvalidInput);  // no rotation
  EXPECT_NO_THROW(load("<joint name='fl' value='0 0 0 0 0 0 1'/>"));
}

TEST(Srdf, ValuesOfJointsByName) {
  const Robot robot = Robot::from_strings(kMixedUrdf);
  EXPECT_EQ(robot.values({{"p/y", 3.0}})[1], 3.0);
  EXPECT_EQ(robot.values({{"fl/rz", 0.5}}).sum(), 0.5);
  EXPECT_THROW(robot.values({{"p", 3.0}}), InvalidInput);
  EXPECT_THROW(robot.values({{"p/rz", 3.0}}), InvalidInput);
  EXPECT_THROW(robot.values({{"p/x", std::nan("")}}), InvalidInput);
}

TEST(Srdf, WrittenRobotsKeepTheirMasses) {
  MMGRASP_NEEDS_SHARED_DATA();
  RobotOptions options;
  options.load_meshes = false;
  const std::string ur = shared("robots/ur/expanded/ur5e.urdf"),
                    base = shared("robots/ridgeback/expanded/ridgeback.urdf");
  const Robot arm = Robot::load(ur, "", options), wheels = Robot::load(base, "", options);
  const double arm_mass = mass_sum(read_file(ur)), wheels_mass = mass_sum(read_file(base));
  EXPECT_GT(arm_mass, 15);
  EXPECT_NEAR(mass_sum(arm.to_urdf()), arm_mass, 1e-12);
  const Robot both = wheels.mount(arm, "top_link", Pose::Identity());
  EXPECT_NEAR(mass_sum(both.to_urdf()), arm_mass + wheels_mass, 1e-9);
  EXPECT_NEAR(mass_sum(Robot::from_strings(both.to_urdf()).to_urdf()), arm_mass + wheels_mass, 1e-9);
}

TEST(Srdf, BadInertiasAreLeftOutNotRefused) {
  const auto load = [](const std::string& inertial) {
    return Robot::from_strings("<robot name='r'><link name='a'><inertial>" + inertial + "</inertial></link></robot>");
  };
  for (const char* bad : {"<mass value='nan'/>", "<mass value='1'/><inertia ixx='inf'/>", "<origin xyz='1 2'/>"}) {
    const Robot robot = load(bad);
    EXPECT_EQ(robot.report().warnings.size(), 1u) << bad;
    EXPECT_EQ(robot.to_urdf().find("inertia"), std::string::npos);
  }
  const Robot good = load("<origin xyz='1 2 3'/><mass value='4'/>");
  EXPECT_TRUE(good.report().warnings.empty());
  EXPECT_NE(good.to_urdf().find("<mass value=\"4\""), std::string::npos);
}
