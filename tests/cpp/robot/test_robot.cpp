#include "mmgrasp/robot/robot.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "mmgrasp/core/error.hpp"
#include "support/robot_support.hpp"
#include "support/temporary_folder.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;
using mmgrasp::test::TemporaryFolder;

namespace {

struct Expected {
  const char* urdf;
  std::size_t links;
  int movable;  ///< joints that are neither fixed nor mimic
  int mimic;
  bool meshes;  ///< false where the data holds none
};

/// Counted in the files by hand (grep for <link name=, type= and <mimic).
const Expected kRobots[] = {
    {"robots/panda/expanded/panda.urdf", 12, 8, 1, true},
    {"robots/panda_vamp/panda/panda.urdf", 13, 7, 0, true},
    {"robots/panda_vamp/panda/panda_spherized.urdf", 13, 7, 0, true},
    {"robots/ur/expanded/ur5e.urdf", 11, 6, 0, true},
    {"robots/ur/expanded/ur10e.urdf", 11, 6, 0, true},
    {"robots/ur5_vamp/ur5/ur5.urdf", 22, 6, 0, true},
    {"robots/kuka_iiwa/kuka_lbr_iiwa_support/urdf/lbr_iiwa_14_r820.urdf", 10, 7, 0, true},
    {"robots/tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf", 38, 12, 0, true},
    {"robots/tiago/example-robot-data/robots/tiago_description/robots/tiago.urdf", 78, 48, 0, true},
    {"robots/ridgeback/expanded/ridgeback.urdf", 19, 5, 0, true},
    {"robots/robotiq_2f85/robotiq_arg85_description/robots/robotiq_arg85_description.URDF", 9, 1, 5, true},
    {"robots/robotiq/expanded/robotiq_3f_articulated.urdf", 14, 11, 0, true},
    {"robots/wsg50/wsg_50_simulation/urdf/wsg_50.urdf", 5, 2, 0, true},
    {"robots/pr2/example-robot-data/robots/pr2_description/urdf/pr2.urdf", 82, 20, 10, false},
    {"reference/trac_ik/launch/pr2.urdf", 88, 39, 6, false},
    {"reference/pinocchio_models/link_and_joint_identical_name.urdf", 2, 0, 0, true},
    {"reference/pinocchio_models/3DOF_planar.urdf", 4, 3, 0, true},
};

std::string failure(const std::string& urdf, const RobotOptions& options, const std::string& origin) {
  try {
    Robot::from_strings(urdf, "", options, origin);
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

const char* kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::string mesh_robot(const std::string& uri) {
  return "<robot name=\"m\"><link name=\"a\"><collision><geometry><mesh filename=\"" + uri +
         "\" scale=\"0.5 1 2\"/></geometry></collision></link></robot>";
}

}  // namespace

TEST(Robot, LoadsEveryRobotOfTheData) {
  MMGRASP_NEEDS_SHARED_DATA();
  for (const Expected& expected : kRobots) {
    RobotOptions options;
    options.load_meshes = expected.meshes;
    const Robot robot = Robot::load(shared(expected.urdf), "", options);
    int movable = 0, mimic = 0;
    for (const Joint& joint : robot.joints()) {
      movable += joint.value_index >= 0;
      mimic += joint.mimic_joint >= 0;
    }
    EXPECT_EQ(robot.links().size(), expected.links) << expected.urdf;
    EXPECT_EQ(robot.joints().size() + 1, expected.links) << expected.urdf;
    EXPECT_EQ(movable, expected.movable) << expected.urdf;
    EXPECT_EQ(mimic, expected.mimic) << expected.urdf;
    for (const Link& link : robot.links())
      for (const LinkShape& shape : link.collisions)
        if (!shape.mesh_uri.empty()) {
          ASSERT_TRUE(std::holds_alternative<MeshShape>(shape.shape));
          EXPECT_TRUE(std::get<MeshShape>(shape.shape).mesh != nullptr);
          EXPECT_TRUE(std::filesystem::exists(shape.mesh_path));
        }
  }
}

TEST(Robot, LinksAndJointsAreBreadthFirst) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot robot = tiago();
  for (std::size_t i = 0; i < robot.joints().size(); ++i) {
    const Joint& joint = robot.joints()[i];
    EXPECT_EQ(joint.child_link, static_cast<int>(i) + 1);
    EXPECT_LT(joint.parent_link, joint.child_link);
    if (i > 0) {
      EXPECT_GE(joint.parent_link, robot.joints()[i - 1].parent_link);
    }
    EXPECT_EQ(robot.links()[i + 1].parent_joint, static_cast<int>(i));
    EXPECT_EQ(robot.joint_index(joint.name), static_cast<int>(i));
  }
  EXPECT_EQ(robot.links()[0].parent_joint, -1);
}

TEST(Robot, SrdfGroupsStatesAndPairs) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot robot = panda();
  ASSERT_EQ(robot.groups().size(), 3u);
  EXPECT_EQ(robot.groups()[0].name, "panda_arm");
  EXPECT_EQ(robot.groups()[0].joints.size(), 7u);
  EXPECT_EQ(robot.groups()[0].base_link, "panda_link0");
  EXPECT_EQ(robot.groups()[0].tip_link, "panda_link8");
  EXPECT_EQ(robot.groups()[2].joints.size(), 8u);  // subgroups arm and hand; the second finger mimics the first
  EXPECT_EQ(robot.group_states().at("panda_arm").at("ready").at("panda_joint4"), -2.356);
  // Every pair of the file, found by plain text search, is disabled; hardly any other is.
  std::ifstream file(shared("robots/panda/moveit_resources_panda_moveit_config/config/panda.srdf"));
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  const std::regex line("<disable_collisions link1=\"(\\w+)\" link2=\"(\\w+)\"");
  int pairs = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it, ++pairs)
    EXPECT_TRUE(robot.pair_disabled(robot.link_index((*it)[1]), robot.link_index((*it)[2]))) << it->str();
  EXPECT_EQ(pairs, 34);
  EXPECT_EQ(robot.disabled_pairs().size(), 36u);  // panda_link8 has no shape and is not in the file: 7-8 and 8-hand
  EXPECT_FALSE(robot.pair_disabled(robot.link_index("panda_link0"), robot.link_index("panda_link6")));

  const Robot wheeled = tiago();
  const GroupDescription& arm = wheeled.groups()[1];
  EXPECT_EQ(arm.name, "arm_torso");  // given joint by joint, the last one fixed
  EXPECT_EQ(arm.joints.front(), "torso_lift_joint");
  EXPECT_EQ(arm.tip_link, "arm_tool_link");
  bool named = false;
  for (const std::string& warning : wheeled.report().warnings)
    named = named || warning.find("\"base_laser_link\"") != std::string::npos;
  EXPECT_TRUE(named);
}

TEST(Robot, SrdfByLinksChainsSubgroupsAndUnknownNames) {
  const std::string urdf = R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
    <joint name="j1" type="continuous"><parent link="a"/><child link="b"/><limit velocity="2" effort="3"/></joint>
    <joint name="j2" type="prismatic"><parent link="b"/><child link="c"/>
      <limit lower="0.1" upper="1" velocity="1" effort="1"/></joint>
    <joint name="j3" type="continuous"><parent link="b"/><child link="d"/>
      <limit velocity="2" effort="3"/></joint></robot>)";
  const std::string srdf = R"(<robot name="r">
    <group name="by_links"><link name="c"/><link name="b"/></group>
    <group name="by_chain"><chain base_link="a" tip_link="d"/></group>
    <group name="both"><group name="by_links"/><group name="by_chain"/></group>
    <group name="gone"><joint name="nope"/></group>
    <group_state name="home" group="by_links"><joint name="j2" value="0.4"/><joint name="nope" value="1"/></group_state>
    <end_effector name="tool" parent_link="c" group="by_chain"/>
    <disable_collisions link1="a" link2="d" reason="Never"/>
      <disable_collisions link1="a" link2="nowhere" reason="Never"/>
    </robot>)";
  const Robot robot = Robot::from_strings(urdf, srdf);
  ASSERT_EQ(robot.groups().size(), 3u);
  EXPECT_EQ(robot.groups()[0].joints, (std::vector<std::string>{"j1", "j2"}));
  EXPECT_EQ(robot.groups()[0].tip_link, "c");
  EXPECT_EQ(robot.groups()[1].joints, (std::vector<std::string>{"j1", "j3"}));
  EXPECT_EQ(robot.groups()[2].joints.size(), 3u);
  EXPECT_TRUE(robot.groups()[2].tip_link.empty());
  EXPECT_EQ(robot.end_effectors().at(0).parent_link, "c");
  EXPECT_EQ(robot.disabled_pairs().at({0, 3}), DisabledReason::never);
  EXPECT_EQ(robot.report().warnings.size(), 4u);  // the joint in "gone", its being dropped, the state's joint, the link
  EXPECT_EQ(robot.default_values(), Eigen::Vector3d(0, 0.1, 0));
  EXPECT_EQ(robot.values({{"j2", 0.5}})[1], 0.5);
  EXPECT_THROW(robot.values({{"j2", 1.5}}), InvalidInput);
  EXPECT_THROW(robot.values({{"j9", 0.5}}), InvalidInput);
  EXPECT_EQ(robot.joints()[0].velocity, 2);
  EXPECT_EQ(robot.joints()[0].effort, 3);
  EXPECT_THROW(Robot::from_strings(urdf, "<robot name='r'><group name='g'><group name='g'/></group></robot>"),
               InvalidInput);
  EXPECT_THROW(Robot::from_strings(urdf, "<robot name='r'><group name='g'></robot>"), InvalidInput);
}

TEST(Robot, PlanarAndFloatingJointsInClosedForm) {
  const Robot robot = Robot::from_strings(R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
    <joint name="p" type="planar"><parent link="a"/><child link="b"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/></joint>
    <joint name="f" type="floating"><parent link="b"/><child link="c"/></joint></robot>)");
  ASSERT_EQ(robot.value_count(), 9);
  Eigen::VectorXd values(9);
  values << 1, 2, 0.3, 4, 5, 6, 0, 0.5, 0;
  const Poses poses = robot.link_poses(values);
  const Pose expected = pose_from_xyz_rpy({1, 2, 1}, {0, 0, 0.3}) * pose_from_xyz_rpy({4, 5, 6}, {0, 0.5, 0});
  EXPECT_LT((poses[2].matrix() - expected.matrix()).norm(), 1e-14);
}

TEST(Robot, FindsMeshesWhereAPackageMayLie) {
  TemporaryFolder folder;
  folder.write("ws/src/my_robot/meshes/t.obj", kTetrahedron);
  folder.write("ws/src/my_robot/package.xml", "<package><name>robot_description</name></package>");
  folder.write("ws/src/plain/meshes/t.obj", kTetrahedron);
  folder.write("given/meshes/t.obj", kTetrahedron);
  folder.write("ros/in_path/meshes/t.obj", kTetrahedron);
  folder.write("ws/src/my_robot/urdf/own/t.obj", kTetrahedron);
  const std::string origin = (folder.path() / "ws/src/my_robot/urdf/r.urdf").string();
  setenv("ROS_PACKAGE_PATH", (folder.path() / "ros").c_str(), 1);
  RobotOptions options;
  options.package_dirs["given_pkg"] = (folder.path() / "given").string();
  const auto found = [&](const std::string& uri) {
    const Robot robot = Robot::from_strings(mesh_robot(uri), "", options, origin);
    const LinkShape& shape = robot.links()[0].collisions.at(0);
    // The scale is applied: the tetrahedron spans 0.5 x 1 x 2.
    EXPECT_LT((shape_bounds(shape.shape).sizes() - Eigen::Vector3d(0.5, 1, 2)).norm(), 1e-12);
    return std::filesystem::relative(shape.mesh_path, std::filesystem::canonical(folder.path())).string();
  };
  EXPECT_EQ(found("package://robot_description/meshes/t.obj"),
            "ws/src/my_robot/meshes/t.obj");                                            // by package.xml's name
  EXPECT_EQ(found("package://my_robot/meshes/t.obj"), "ws/src/my_robot/meshes/t.obj");  // by folder name
  EXPECT_EQ(found("package://plain/meshes/t.obj"), "ws/src/plain/meshes/t.obj");        // beside an ancestor
  EXPECT_EQ(found("package://given_pkg/meshes/t.obj"), "given/meshes/t.obj");
  EXPECT_EQ(found("package://in_path/meshes/t.obj"), "ros/in_path/meshes/t.obj");
  EXPECT_EQ(found("package://own/t.obj"), "ws/src/my_robot/urdf/own/t.obj");
  EXPECT_EQ(found("own/t.obj"), "ws/src/my_robot/urdf/own/t.obj");
  EXPECT_EQ(found("../meshes/t.obj"), "ws/src/my_robot/meshes/t.obj");
  EXPECT_EQ(found("file://" + (folder.path() / "given/meshes/t.obj").string()), "given/meshes/t.obj");
  EXPECT_EQ(found((folder.path() / "given/meshes/t.obj").string()), "given/meshes/t.obj");
  unsetenv("ROS_PACKAGE_PATH");

  const std::string message = failure(mesh_robot("package://nowhere/t.obj"), options, origin);
  EXPECT_NE(message.find("link \"a\""), std::string::npos) << message;
  EXPECT_NE(message.find("package://nowhere/t.obj"), std::string::npos) << message;
  EXPECT_NE(message.find("package_dirs"), std::string::npos) << message;
  options.allow_missing_meshes = true;
  const Robot robot = Robot::from_strings(mesh_robot("package://nowhere/t.obj"), "", options, origin);
  EXPECT_EQ(robot.report().missing, (std::vector<std::string>{"package://nowhere/t.obj"}));
  EXPECT_TRUE(robot.links()[0].collisions.empty());
}

TEST(Robot, LooksForMeshesInTheOrderThatIsPromised) {
  TemporaryFolder folder;
  for (const char* place : {"given/m/t.obj", "ros/pkg/m/t.obj", "ament/share/pkg/m/t.obj", "gazebo/pkg/m/t.obj",
                            "ws/pkg/m/t.obj", "ws/pkg/urdf/m/t.obj"})
    folder.write(place, kTetrahedron);
  folder.write("ws/pkg/package.xml", "<package><name>pkg</name></package>");
  const std::string origin = (folder.path() / "ws/pkg/urdf/r.urdf").string();
  RobotOptions options;
  const auto found = [&](const std::string& uri) {
    const Robot robot = Robot::from_strings(mesh_robot(uri), "", options, origin);
    return std::filesystem::relative(robot.links()[0].collisions.at(0).mesh_path,
                                     std::filesystem::canonical(folder.path()))
        .string();
  };
  setenv("ROS_PACKAGE_PATH", (folder.path() / "ros").c_str(), 1);
  setenv("AMENT_PREFIX_PATH", (folder.path() / "ament").c_str(), 1);
  setenv("GAZEBO_MODEL_PATH", ("/nowhere:" + (folder.path() / "gazebo").string()).c_str(), 1);
  options.package_dirs["pkg"] = (folder.path() / "given").string();
  EXPECT_EQ(found("package://pkg/m/t.obj"), "given/m/t.obj");
  options.package_dirs.clear();
  EXPECT_EQ(found("package://pkg/m/t.obj"), "ros/pkg/m/t.obj");
  unsetenv("ROS_PACKAGE_PATH");
  EXPECT_EQ(found("package://pkg/m/t.obj"), "ament/share/pkg/m/t.obj");
  unsetenv("AMENT_PREFIX_PATH");
  EXPECT_EQ(found("model://pkg/m/t.obj"), "gazebo/pkg/m/t.obj");
  unsetenv("GAZEBO_MODEL_PATH");
  EXPECT_EQ(found("model://pkg/m/t.obj"), "ws/pkg/m/t.obj");
  EXPECT_EQ(found("package://nobody/m/t.obj"), "ws/pkg/urdf/m/t.obj");  // relative in disguise
}

TEST(Robot, WarnsOfDoubtfulUnits) {
  const auto warnings = [](const std::string& size) {
    return Robot::from_strings("<robot name='r'><link name='a'><collision><geometry><box size='" + size +
                               "'/></geometry></collision></link></robot>")
        .report()
        .warnings.size();
  };
  EXPECT_EQ(warnings("100 50 20"), 1u);  // millimetres
  EXPECT_EQ(warnings("0.0001 0.0002 0.0001"), 1u);
  EXPECT_EQ(warnings("0.1 0.2 0.1"), 0u);
}

TEST(Robot, DisabledPairsCoverJointsFlangesAndRigidNeighbours) {
  const Robot robot = Robot::from_strings(R"(<robot name="r">
    <link name="a"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
    <link name="flange"/>
    <link name="c"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
    <link name="d"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
    <link name="e"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
    <joint name="j1" type="continuous"><parent link="a"/><child link="flange"/></joint>
    <joint name="j2" type="fixed"><parent link="flange"/><child link="c"/></joint>
    <joint name="j3" type="fixed"><parent link="c"/><child link="d"/></joint>
    <joint name="j4" type="continuous"><parent link="d"/><child link="e"/></joint></robot>)");
  const auto off = [&robot](const char* a, const char* b) {
    return robot.pair_disabled(robot.link_index(a), robot.link_index(b));
  };
  EXPECT_TRUE(off("a", "flange"));
  EXPECT_TRUE(off("a", "c"));       // across the flange, which has no shape
  EXPECT_TRUE(off("flange", "d"));  // one rigid body
  EXPECT_FALSE(off("a", "d"));
  EXPECT_FALSE(off("c", "e"));
  // A mesh that is not loaded still counts as a shape between its neighbours.
  RobotOptions options;
  options.load_meshes = false;
  const Robot meshed = Robot::from_strings(R"(<robot name="r"><link name="a"/>
    <link name="b"><collision><geometry><mesh filename="m.stl"/></geometry></collision></link><link name="c"/>
    <joint name="j1" type="continuous"><parent link="a"/><child link="b"/></joint>
    <joint name="j2" type="continuous"><parent link="b"/><child link="c"/></joint></robot>)",
                                           "", options);
  EXPECT_FALSE(meshed.pair_disabled(0, 2));
  const Robot none = robot.with_disabled_pairs({});
  EXPECT_FALSE(none.pair_disabled(0, 1));
  EXPECT_NE(none.hash(), robot.hash());
  EXPECT_THROW(robot.with_disabled_pairs({{{3, 1}, DisabledReason::user}}), InvalidInput);
}

TEST(Robot, HashSeesEveryHair) {
  MMGRASP_NEEDS_SHARED_DATA();
  std::ifstream file(shared("robots/wsg50/wsg_50_simulation/urdf/wsg_50.urdf"));
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  const std::string origin = shared("robots/wsg50/wsg_50_simulation/urdf/wsg_50.urdf");
  const auto hash = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const std::size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    changed.replace(at, from.size(), to);
    return Robot::from_strings(changed, "", {}, origin).hash();
  };
  const std::string same = hash("wsg_50_simulation/meshes", "wsg_50_simulation/meshes");
  EXPECT_EQ(same, Robot::load(origin).hash());
  EXPECT_NE(hash("lower=\"-0.055\"", "lower=\"-0.0550000001\""), same);
  EXPECT_NE(hash("axis xyz=\"1 0 0\"", "axis xyz=\"-1 0 0\""), same);
  EXPECT_EQ(hash("damping=\"100\"", "damping=\"50\""), same);  // nothing that we compute depends on it
}
